//! Bugs of the depth bounds test.

use crate::hooks::{bounds_fail_as_depth, in_bounds};
use crate::list::{List, SMALL};
use crate::plant::in_bits;

pub(super) fn add(list: &mut List) {
    list.class("bounds", "depth");
    list.bug("ignored: Every stored depth passes.")
        .plant(in_bounds(|_, _, _| true));
    list.bug("of-the-incoming-depth: The fragment's own depth is tested.")
        .plant(in_bounds(|[l, h], _, v| l <= v && v <= h));
    list.bug("lower-excluded: The lower bound itself is rejected.")
        .plant(in_bounds(|[l, h], s, _| l < s && s <= h));
    list.bug("upper-excluded: The upper bound itself is rejected.")
        .plant(in_bounds(|[l, h], s, _| l <= s && s < h));
    list.bug("both-excluded: Both bounds themselves are rejected.")
        .plant(in_bounds(|[l, h], s, _| l < s && s < h));
    list.bug("inverted: Depths between the bounds are rejected.")
        .plant(in_bounds(|[l, h], s, _| s < l || h < s));
    list.bug("lower-ignored: The lower bound is not tested.")
        .plant(in_bounds(|[_, h], s, _| s <= h));
    list.bug("upper-ignored: The upper bound is not tested.")
        .plant(in_bounds(|[l, _], s, _| l <= s));
    list.bug("exchanged: The bounds are exchanged.")
        .plant(in_bounds(|[l, h], s, _| h <= s && s <= l));
    list.bug(
        "rejected-as-failed-depth: Fragments outside the bounds count as failing the depth test.",
    )
    .source("a bounds test after the stencil test")
    .plant(bounds_fail_as_depth(|| true));
    list.bug("off-without-depth-test: Without a depth test there are no bounds.")
        .when(|draw| draw.depth.is_none())
        .draws(|draw| draw.depth_bounds = None);
    list.bug("in-4-bits: The bounds keep 4 bits.")
        .source(SMALL)
        .draws(|d| d.depth_bounds = d.depth_bounds.map(|b| b.map(|v| in_bits(v, 4))));
}
