//! Bugs of depth clamp and the viewport's depth range.

use crate::fields::FieldPlaces;
use crate::hooks::held_to_range;
use crate::list::{CONFUSION, bugs};
use crate::permission::under;
use crate::plant::{each, in_bits, set};
use etalon_reference::rules::DepthRange;

const RANGE: FieldPlaces<[f32; 2]> = |d| vec![&mut d.viewport.depth];
const CLAMP: FieldPlaces<bool> = |d| vec![&mut d.depth_clamp];

bugs! {
    class "depth-range", "depth";
    source "llvmpipe: reversed depth range";
    "ignored: The range is 0 to 1." => set(RANGE, [0.0, 1.0]);
    "reversed: Near and far are exchanged." => each(RANGE, |range| range.reverse());
    "sorted: A reversed range is treated as not reversed." => each(RANGE, |range| range.sort_by(f32::total_cmp));
    "near-ignored: Near is 0." => each(RANGE, |r| r[0] = 0.0);
    "far-ignored: Far is 1." => each(RANGE, |r| r[1] = 1.0);
    "without-offset: Near is subtracted from both." => each(RANGE, |r| *r = [0.0, r[1] - r[0]]);
    "without-scale: The range is as long as 0 to 1." => each(RANGE, |r| r[1] = r[0] + 1.0);
    "in-8-bits: Near and far keep 8 bits." => each(RANGE, |r| *r = r.map(|v| in_bits(v, 8)));
    source "llvmpipe: reversed range clamped to near";
    "reversed-held-to-near: Depths of a reversed range become near." =>
        held_to_range(|v, [n, f], _| if n > f { n } else { v.clamp(n, f) });
    "reversed-held-to-far: Depths of a reversed range become far." =>
        held_to_range(|v, [n, f], _| if n > f { f } else { v.clamp(n, f) });
    "not-held: Written and biased depths leave the viewport's range." => held_to_range(|v, _, _| v);
    "not-held-unless-clamped: Without depth clamp, written and biased depths leave the viewport's range." =>
        held_to_range(|v, [n, f], clamps| if clamps { v.clamp(n.min(f), n.max(f)) } else { v }),
        source "hardware that clamps to 0 to 1 alone",
        permitted vec![under!(depth_range: DepthRange::Undefined | DepthRange::Unit | DepthRange::Either)];
    source CONFUSION;
    "clamp-ignored: Depths beyond near and far are always clipped." => set(CLAMP, false);
    "clamp-always: Depths beyond near and far are always clamped." => set(CLAMP, true);
    "clamp-inverted: Clipping and clamping are exchanged." => each(CLAMP, |clamp| *clamp = !*clamp);
    "clamp-off-with-partial-range: Clamping needs a range of 0 to 1." =>
        set(CLAMP, false), when |draw| draw.viewport.depth != [0.0, 1.0];
}
