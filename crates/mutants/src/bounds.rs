//! Bugs of the depth bounds test.

use super::hooks::{bounds_fail_as_depth, in_bounds};
use super::list::{CONFUSION, List, Row, SMALL};
use super::plant::{draws, in_bits};

pub(super) fn add(list: &mut List) {
    list.class("bounds", "depth");
    bounds(list);
}

fn bounds(list: &mut List) {
    type Bug = fn([f32; 2], f32, f32) -> bool;
    let rows: [Row<Bug>; 9] = [
        ("ignored", "Every stored depth passes.", |_, _, _| true),
        (
            "of-the-incoming-depth",
            "The fragment's own depth is tested.",
            |[l, h], _, v| l <= v && v <= h,
        ),
        (
            "lower-excluded",
            "The lower bound itself is rejected.",
            |[l, h], s, _| l < s && s <= h,
        ),
        (
            "upper-excluded",
            "The upper bound itself is rejected.",
            |[l, h], s, _| l <= s && s < h,
        ),
        (
            "both-excluded",
            "Both bounds themselves are rejected.",
            |[l, h], s, _| l < s && s < h,
        ),
        (
            "inverted",
            "Depths between the bounds are rejected.",
            |[l, h], s, _| s < l || h < s,
        ),
        (
            "lower-ignored",
            "The lower bound is not tested.",
            |[_, h], s, _| s <= h,
        ),
        (
            "upper-ignored",
            "The upper bound is not tested.",
            |[l, _], s, _| l <= s,
        ),
        ("exchanged", "The bounds are exchanged.", |[l, h], s, _| {
            h <= s && s <= l
        }),
    ];
    list.rows(CONFUSION, in_bounds, &rows);
    list.add(
        "rejected-as-failed-depth",
        "a bounds test after the stencil test",
        "Fragments outside the bounds count as failing the depth test, also for stencil.",
        bounds_fail_as_depth(|| true),
    );
    list.add(
        "off-without-depth-test",
        CONFUSION,
        "Without a depth test there are no bounds.",
        draws(|draw| {
            if draw.depth.is_none() {
                draw.depth_bounds = None;
            }
        }),
    );
    list.add(
        "in-4-bits",
        SMALL,
        "The bounds keep 4 bits.",
        draws(|draw| draw.depth_bounds = draw.depth_bounds.map(|b| b.map(|v| in_bits(v, 4)))),
    );
}
