//! Bugs of depth bias, depth clamp, the viewport's depth range, depth bounds and read-only depth.

use super::hooks::{bias, bias_unit, biases_lines, bounds_fail_as_depth, held_to_range, in_bounds};
use super::list::{CONFUSION, List, Row, SMALL};
use super::plant::{Plant, draws, in_bits, scene};
use etalon_cpu::steps::{Faithful, Steps};
use etalon_frame::ChannelEncoding;
use etalon_scene::{DepthBias, Draw, Pass, PolygonMode, StencilOperation};

pub(super) fn add(list: &mut List) {
    list.class("bias", "depth");
    biases(list);
    units(list);
    list.class("depth-range", "depth");
    ranges(list);
    list.class("bounds", "depth");
    bounds(list);
    list.class("read-only", "depth");
    read_only(list);
}

fn states(bug: fn(&mut DepthBias)) -> Plant {
    draws(move |draw| bug(&mut draw.depth_bias))
}

fn biases(list: &mut List) {
    let rows: [Row<fn(&mut DepthBias)>; 13] = [
        ("constant-doubled", "The constant counts twice.", |b| {
            b.constant *= 2;
        }),
        ("constant-halved", "The constant counts half.", |b| {
            b.constant /= 2;
        }),
        ("constant-negated", "The constant changes its sign.", |b| {
            b.constant = -b.constant;
        }),
        ("constant-ignored", "The constant is 0.", |b| b.constant = 0),
        ("slope-doubled", "The slope counts twice.", |b| {
            b.slope *= 2.0;
        }),
        ("slope-halved", "The slope counts half.", |b| b.slope *= 0.5),
        ("slope-negated", "The slope changes its sign.", |b| {
            b.slope = -b.slope;
        }),
        ("slope-ignored", "The slope counts nothing.", |b| {
            b.slope = 0.0
        }),
        (
            "constant-and-slope-swapped",
            "Constant and slope are exchanged.",
            |b| {
                (b.constant, b.slope) = (b.slope as i32, b.constant as f32);
            },
        ),
        (
            "clamp-and-slope-swapped",
            "Clamp and slope are exchanged.",
            |b| {
                (b.clamp, b.slope) = (b.slope, b.clamp);
            },
        ),
        ("clamp-ignored", "The bias is not clamped.", |b| {
            b.clamp = 0.0;
        }),
        ("clamp-negated", "The clamp changes its sign.", |b| {
            b.clamp = -b.clamp;
        }),
        ("ignored", "There is no bias.", |b| {
            *b = DepthBias::default()
        }),
    ];
    list.rows(
        "dEQP sees none of 28; wgpu: arguments swapped",
        states,
        &rows,
    );
    list.add(
        "clamp-on-both-sides",
        CONFUSION,
        "The clamp's magnitude holds biases of either sign.",
        bias(|state, unit, slope| {
            let sum = f64::from(state.constant) * unit + f64::from(state.slope) * slope;
            let most = f64::from(state.clamp.abs());
            if most > 0.0 {
                sum.clamp(-most, most)
            } else {
                sum
            }
        }),
    );
    list.add(
        "negative-lost",
        CONFUSION,
        "Biases below 0 count nothing.",
        bias(|state, unit, slope| Faithful.bias(state, unit, slope).max(0.0)),
    );
    list.add(
        "sign-lost",
        CONFUSION,
        "Biases below 0 count upwards.",
        bias(|state, unit, slope| Faithful.bias(state, unit, slope).abs()),
    );
    list.add(
        "constant-in-whole-depths",
        CONFUSION,
        "The constant is moved by 1 of the depth's range and not by its least step.",
        bias(|state, _, slope| Faithful.bias(state, 1.0, slope)),
    );
    list.add(
        "applied-to-lines",
        CONFUSION,
        "Points and lines are biased as polygons are.",
        biases_lines(|| true),
    );
    list.add(
        "lost-on-outlines",
        CONFUSION,
        "Polygons of which only the edges are drawn are not biased.",
        draws(|draw| {
            if draw.polygon_mode == PolygonMode::Line {
                draw.depth_bias = DepthBias::default();
            }
        }),
    );
}

/// Steps that the text allows: twice as large on fixed-point depth, half as large on floats.
const LEGAL_STEPS: [&str; 3] = [
    "d16-step-of-15-bits",
    "d24-step-of-23-bits",
    "float-step-halved",
];
const STEP: &str = "Vulkan: Depth Bias: r is at most 2 * 2^-n for fixed point, and 2^(e-n) for floats, \
                    whose n may count the hidden bit";

fn units(list: &mut List) {
    use ChannelEncoding::{Float32, Unorm};
    // The bug gets the right step. The powers of two are those of 15, 16, 17, 23, 24 and 32 bits.
    type Step = (&'static str, ChannelEncoding, &'static str, fn(f64) -> f64);
    let steps: [Step; 13] = [
        ("d16-step-of-15-bits", Unorm(16), "that of 15 bits", |r| {
            r * 2.0
        }),
        ("d16-step-of-14-bits", Unorm(16), "that of 14 bits", |r| {
            r * 4.0
        }),
        ("d16-step-of-17-bits", Unorm(16), "that of 17 bits", |r| {
            r / 2.0
        }),
        ("d16-step-of-24-bits", Unorm(16), "that of 24 bits", |r| {
            r / 256.0
        }),
        ("d24-step-of-23-bits", Unorm(24), "that of 23 bits", |r| {
            r * 2.0
        }),
        ("d24-step-of-16-bits", Unorm(24), "that of 16 bits", |r| {
            r * 256.0
        }),
        ("d24-step-of-25-bits", Unorm(24), "that of 25 bits", |r| {
            r / 2.0
        }),
        ("float-step-of-24-bits", Float32, "that of 24 bits", |_| {
            2_f64.powi(-24)
        }),
        ("float-step-of-1", Float32, "that of depth 1", |_| {
            2_f64.powi(-23)
        }),
        ("float-step-of-16-bits", Float32, "that of 16 bits", |_| {
            2_f64.powi(-16)
        }),
        ("float-step-halved", Float32, "half as large", |r| r / 2.0),
        ("float-step-doubled", Float32, "twice as large", |r| r * 2.0),
        ("float-step-quartered", Float32, "a quarter as large", |r| {
            r / 4.0
        }),
    ];
    for (name, format, about, bug) in steps {
        let source = if format == Float32 {
            "SwiftShader: bias unscaled by exponent"
        } else {
            "v3d: D16 units"
        };
        let about = format!("On {format} depth, a step is {about}.");
        let plant = bias_unit(move |encoding, largest| {
            let right = Faithful.bias_unit(encoding, largest);
            if encoding == format {
                bug(right)
            } else {
                right
            }
        });
        let mutant = list.add(name, source, about, plant);
        if LEGAL_STEPS.contains(&name) {
            mutant.legal(STEP);
        }
    }
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

fn read_only(list: &mut List) {
    fn passes(bug: fn(&mut Pass)) -> Plant {
        scene(move |scene| {
            let all = scene.passes.iter_mut();
            all.filter(|p| p.depth_stencil_read_only).for_each(bug);
        })
    }
    let rows: [Row<fn(&mut Pass)>; 4] = [
        (
            "depth-still-written",
            "Read-only depth is still written.",
            |pass| {
                let states = pass.draws.iter_mut().filter_map(|d| d.depth.as_mut());
                states.for_each(|d| d.write = true);
            },
        ),
        ("depth-untested", "Read-only depth is not tested.", |pass| {
            pass.draws.iter_mut().for_each(|d| d.depth = None);
        }),
        (
            "stencil-still-written",
            "Read-only stencil is replaced.",
            |pass| {
                for stencil in pass.draws.iter_mut().filter_map(|d| d.stencil.as_mut()) {
                    stencil.front.pass_op = StencilOperation::Replace;
                    stencil.back.pass_op = StencilOperation::Replace;
                }
            },
        ),
        (
            "stencil-untested",
            "Read-only stencil is not tested.",
            |pass| {
                pass.draws.iter_mut().for_each(|d| d.stencil = None);
            },
        ),
    ];
    list.rows("read-only attachments treated as writable", passes, &rows);
    list.add(
        "from-the-start",
        CONFUSION,
        "A read-only attachment is not written by earlier passes either.",
        scene(|scene| {
            if scene.passes.iter().any(|p| p.depth_stencil_read_only) {
                for draw in scene.passes.iter_mut().flat_map(|p| &mut p.draws) {
                    if let Some(depth) = &mut draw.depth {
                        depth.write = false;
                    }
                }
            }
        }),
    );
}
