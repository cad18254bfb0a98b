//! Bugs of depth clamp and the viewport's depth range.

use crate::fields::Places;
use crate::hooks::held_to_range;
use crate::list::{CONFUSION, List};
use crate::plant::in_bits;

const RANGE: Places<[f32; 2]> = |d| vec![&mut d.viewport.depth];
const CLAMP: Places<bool> = |d| vec![&mut d.depth_clamp];

pub(super) fn add(list: &mut List) {
    list.class("depth-range", "depth");
    list.source("llvmpipe: reversed depth range");
    list.bug("ignored: The range is 0 to 1.")
        .set(RANGE, [0.0, 1.0]);
    list.bug("reversed: Near and far are exchanged.")
        .each(RANGE, |range| range.reverse());
    list.bug("sorted: A reversed range is treated as not reversed.")
        .each(RANGE, |range| range.sort_by(f32::total_cmp));
    list.bug("near-ignored: Near is 0.")
        .each(RANGE, |r| r[0] = 0.0);
    list.bug("far-ignored: Far is 1.")
        .each(RANGE, |r| r[1] = 1.0);
    list.bug("without-offset: Near is subtracted from both.")
        .each(RANGE, |r| *r = [0.0, r[1] - r[0]]);
    list.bug("without-scale: The range is as long as 0 to 1.")
        .each(RANGE, |r| r[1] = r[0] + 1.0);
    list.bug("in-8-bits: Near and far keep 8 bits.")
        .each(RANGE, |r| *r = r.map(|v| in_bits(v, 8)));
    list.source("llvmpipe: reversed range clamped to near");
    list.bug("reversed-held-to-near: Depths of a reversed range become near.")
        .plant(held_to_range(
            |v, [n, f]| if n > f { n } else { v.clamp(n, f) },
        ));
    list.bug("reversed-held-to-far: Depths of a reversed range become far.")
        .plant(held_to_range(
            |v, [n, f]| if n > f { f } else { v.clamp(n, f) },
        ));
    list.bug("not-held: Written and biased depths leave the viewport's range.")
        .plant(held_to_range(|v, _| v));
    list.source(CONFUSION);
    list.bug("clamp-ignored: Depths beyond near and far are always clipped.")
        .set(CLAMP, false);
    list.bug("clamp-always: Depths beyond near and far are always clamped.")
        .set(CLAMP, true);
    list.bug("clamp-inverted: Clipping and clamping are exchanged.")
        .each(CLAMP, |clamp| *clamp = !*clamp);
    list.bug("clamp-off-with-partial-range: Clamping needs a range of 0 to 1.")
        .when(|draw| draw.viewport.depth != [0.0, 1.0])
        .set(CLAMP, false);
}
