//! Bugs of the depth bounds test.

use crate::fields::DEPTH_BOUNDS;
use crate::hooks::{bounds_fail_as_depth, in_bounds};
use crate::list::{SMALL, bugs};
use crate::plant::{draws, in_bits, set};

bugs! {
    class "bounds", "depth";
    "ignored: Every stored depth passes." => in_bounds(|_, _, _| true);
    "of-the-incoming-depth: The fragment's own depth is tested." => in_bounds(|[l, h], _, v| l <= v && v <= h);
    "lower-excluded: The lower bound itself is rejected." => in_bounds(|[l, h], s, _| l < s && s <= h);
    "upper-excluded: The upper bound itself is rejected." => in_bounds(|[l, h], s, _| l <= s && s < h);
    "both-excluded: Both bounds themselves are rejected." => in_bounds(|[l, h], s, _| l < s && s < h);
    "inverted: Depths between the bounds are rejected." => in_bounds(|[l, h], s, _| s < l || h < s);
    "lower-ignored: The lower bound is not tested." => in_bounds(|[_, h], s, _| s <= h);
    "upper-ignored: The upper bound is not tested." => in_bounds(|[l, _], s, _| l <= s);
    "exchanged: The bounds are exchanged." => in_bounds(|[l, h], s, _| h <= s && s <= l);
    "rejected-as-failed-depth: Fragments outside the bounds count as failing the depth test." =>
        bounds_fail_as_depth(|| true), source "a bounds test after the stencil test";
    "off-without-depth-test: Without a depth test there are no bounds." =>
        set(DEPTH_BOUNDS, None), when |draw| draw.depth.is_none();
    "in-4-bits: The bounds keep 4 bits." =>
        draws(|d| d.depth_bounds = d.depth_bounds.map(|b| b.map(|v| in_bits(v, 4)))), source SMALL;
}
