//! Bugs of depth bias.

use super::hooks::{bias, bias_unit, biases_lines};
use super::list::{CONFUSION, List, Row};
use super::plant::{Plant, draws};
use etalon_cpu::steps::{Faithful, Steps};
use etalon_frame::ChannelEncoding;
use etalon_scene::{DepthBias, PolygonMode};

pub(super) fn add(list: &mut List) {
    list.class("bias", "depth");
    biases(list);
    units(list);
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

/// Steps that the text allows: twice as large on fixed-point depth.
const LEGAL_STEPS: [&str; 2] = ["d16-step-of-15-bits", "d24-step-of-23-bits"];

const STEP: &str =
    "Vulkan: Depth Bias: r is one for the attachment and at most 2 * 2^-n for fixed point";

fn units(list: &mut List) {
    use ChannelEncoding::{Float32, Unorm};
    // The bug gets the right step. The powers of two are those of 15, 16, 17, 23, 24 and 32 bits.
    type Step = (&'static str, ChannelEncoding, &'static str, fn(f64) -> f64);
    let steps: [Step; 15] = [
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
        (
            "float-step-of-3-quarters",
            Float32,
            "three quarters as large",
            |r| r * 0.75,
        ),
        (
            "float-step-1-percent-less",
            Float32,
            "a hundredth smaller",
            |r| r * 0.99,
        ),
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
    uneven_steps(list);
}

/// Steps that the text allows one by one, but not beside each other in one attachment.
fn uneven_steps(list: &mut List) {
    use ChannelEncoding::Unorm;
    type Step = (&'static str, &'static str, fn(f64, f64) -> f64);
    let by_depth: [Step; 3] = [
        (
            "far-doubled",
            "twice as large beyond depth 0.5",
            |r, largest| {
                if largest > 0.5 { r * 2.0 } else { r }
            },
        ),
        (
            "near-doubled",
            "twice as large up to depth 0.5",
            |r, largest| {
                if largest > 0.5 { r } else { r * 2.0 }
            },
        ),
        (
            "growing",
            "larger with the depth, up to twice",
            |r, largest| r * (1.0 + largest.clamp(0.0, 1.0)),
        ),
    ];
    for (bits, word) in [(16, "d16"), (24, "d24")] {
        for (name, about, bug) in by_depth {
            list.add(
                &format!("{word}-step-{name}"),
                "a step of floats on fixed-point depth",
                format!("On fixed-point depth of {bits} bits, a step is {about}."),
                bias_unit(move |encoding, largest| {
                    let right = Faithful.bias_unit(encoding, largest);
                    if encoding == Unorm(bits) {
                        bug(right, largest)
                    } else {
                        right
                    }
                }),
            );
        }
    }
    type Constant = (&'static str, &'static str, fn(i32) -> f64);
    let by_constant: [Constant; 3] = [
        (
            "large-constant-grows",
            "Of a constant, what is above 8192 counts half more.",
            |c| {
                let above = f64::from((c.abs() - 8192).max(0));
                f64::from(c) + above * 0.5 * f64::from(c.signum())
            },
        ),
        (
            "negative-constant-grows",
            "Constants below 0 count half more.",
            |c| f64::from(c) * if c < 0 { 1.5 } else { 1.0 },
        ),
        (
            "constant-of-2-digits",
            "A constant keeps two significant digits and grows by 4 percent.",
            |c| {
                let size = 10_f64.powi((c.unsigned_abs().max(10).ilog10() as i32 - 1).max(0));
                (f64::from(c) / size * 1.04).round() * size
            },
        ),
    ];
    for (name, about, bug) in by_constant {
        list.add(
            name,
            CONFUSION,
            about,
            bias(move |state, unit, slope| {
                let zero = DepthBias {
                    constant: 0,
                    ..*state
                };
                if state.clamp != 0.0 {
                    return Faithful.bias(state, unit, slope);
                }
                bug(state.constant) * unit + Faithful.bias(&zero, unit, slope)
            }),
        );
    }
}
