//! Bugs of depth clamp and the viewport's depth range.

use super::hooks::held_to_range;
use super::list::{CONFUSION, List, Row};
use super::plant::{Plant, draws, in_bits};
use etalon_scene::Draw;

pub(super) fn add(list: &mut List) {
    list.class("depth-range", "depth");
    ranges(list);
}

fn ranges(list: &mut List) {
    type RangeBug = fn([f32; 2]) -> [f32; 2];
    fn range(bug: RangeBug) -> Plant {
        draws(move |draw| draw.viewport.depth = bug(draw.viewport.depth))
    }
    let rows: [Row<RangeBug>; 8] = [
        ("ignored", "The range is 0 to 1.", |_| [0.0, 1.0]),
        ("reversed", "Near and far are exchanged.", |[n, f]| [f, n]),
        (
            "sorted",
            "A reversed range is treated as not reversed.",
            |[n, f]| [n.min(f), n.max(f)],
        ),
        ("near-ignored", "Near is 0.", |[_, f]| [0.0, f]),
        ("far-ignored", "Far is 1.", |[n, _]| [n, 1.0]),
        (
            "without-offset",
            "Near is subtracted from both.",
            |[n, f]| [0.0, f - n],
        ),
        (
            "without-scale",
            "The range is as long as 0 to 1.",
            |[n, _]| [n, n + 1.0],
        ),
        ("in-8-bits", "Near and far keep 8 bits.", |r| {
            r.map(|v| in_bits(v, 8))
        }),
    ];
    list.rows("llvmpipe: reversed depth range", range, &rows);
    type HeldBug = fn(f32, [f32; 2]) -> f32;
    let held: [Row<HeldBug>; 3] = [
        (
            "reversed-held-to-near",
            "Depths of a reversed range become near.",
            |v, [n, f]| {
                if n > f { n } else { v.clamp(n, f) }
            },
        ),
        (
            "reversed-held-to-far",
            "Depths of a reversed range become far.",
            |v, [n, f]| {
                if n > f { f } else { v.clamp(n, f) }
            },
        ),
        (
            "not-held",
            "Written and biased depths leave the viewport's range.",
            |v, _| v,
        ),
    ];
    list.rows(
        "llvmpipe: reversed range clamped to near",
        held_to_range,
        &held,
    );
    let clamps: [Row<fn(&mut Draw)>; 4] = [
        (
            "clamp-ignored",
            "Depths beyond near and far are always clipped.",
            |d| {
                d.depth_clamp = false;
            },
        ),
        (
            "clamp-always",
            "Depths beyond near and far are always clamped.",
            |d| {
                d.depth_clamp = true;
            },
        ),
        (
            "clamp-inverted",
            "Clipping and clamping are exchanged.",
            |d| {
                d.depth_clamp = !d.depth_clamp;
            },
        ),
        (
            "clamp-off-with-partial-range",
            "Clamping needs a range of 0 to 1.",
            |d| {
                d.depth_clamp &= d.viewport.depth == [0.0, 1.0];
            },
        ),
    ];
    list.rows(CONFUSION, draws, &clamps);
}
