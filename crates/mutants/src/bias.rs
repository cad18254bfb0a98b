//! Bugs of depth bias.

use crate::fields::DEPTH_BIAS;
use crate::hooks::{bias, bias_unit, biases_lines};
use crate::list::{CONFUSION, bugs};
use crate::permission::under;
use crate::plant::{Plant, each, set};
use etalon_cpu::steps::{Faithful, Steps};
use etalon_frame::ChannelEncoding::{self, Float32, Unorm};
use etalon_scene::{DepthBias, PolygonMode};

/// Changes the step of one encoding, given the correct step and the largest depth of a primitive.
fn step(encoding: ChannelEncoding, bug: impl Fn(f64, f64) -> f64 + Send + Sync + 'static) -> Plant {
    bias_unit(move |e, largest| {
        let right = Faithful.bias_unit(e, largest);
        if e == encoding {
            bug(right, largest)
        } else {
            right
        }
    })
}

/// Changes the constant of biases without a clamp.
fn constant(bug: fn(i32) -> f64) -> Plant {
    bias(move |state, unit, slope| {
        if state.clamp != 0.0 {
            return Faithful.bias(state, unit, slope);
        }
        let bias = DepthBias {
            constant: 0,
            ..*state
        };
        bug(state.constant) * unit + Faithful.bias(&bias, unit, slope)
    })
}

bugs! {
    class "bias", "depth";
    source "dEQP sees none of 28; wgpu: arguments swapped";
    for (name, about, factor) in [
        ("doubled", "counts twice", 2.0),
        ("halved", "counts half", 0.5),
        ("negated", "changes its sign", -1.0),
        ("ignored", "counts nothing", 0.0),
    ] {
        "constant-{name}: The constant {about}." =>
            each(DEPTH_BIAS, move |b| b.constant = (f64::from(b.constant) * factor) as i32);
        "slope-{name}: The slope {about}." => each(DEPTH_BIAS, move |b| b.slope *= factor as f32);
    }
    "clamp-negated: The clamp changes its sign." => each(DEPTH_BIAS, |b| b.clamp = -b.clamp);
    "clamp-ignored: The bias is not clamped." => each(DEPTH_BIAS, |b| b.clamp = 0.0);
    "constant-and-slope-swapped: Constant and slope are exchanged." =>
        each(DEPTH_BIAS, |b| (b.constant, b.slope) = (b.slope as i32, b.constant as f32));
    "clamp-and-slope-swapped: Clamp and slope are exchanged." =>
        each(DEPTH_BIAS, |b| (b.clamp, b.slope) = (b.slope, b.clamp));
    "ignored: There is no bias." => set(DEPTH_BIAS, DepthBias::default());
    source CONFUSION;
    "lost-on-outlines: Polygons of which only the edges are drawn are not biased." =>
        set(DEPTH_BIAS, DepthBias::default()), when |draw| draw.polygon_mode == PolygonMode::Line;
    "clamp-on-both-sides: The clamp's magnitude holds biases of either sign." =>
        bias(|state, unit, slope| {
            let sum = f64::from(state.constant) * unit + f64::from(state.slope) * slope;
            let most = f64::from(state.clamp.abs());
            if most > 0.0 { sum.clamp(-most, most) } else { sum }
        });
    "negative-lost: Biases below 0 count nothing." =>
        bias(|state, unit, slope| Faithful.bias(state, unit, slope).max(0.0));
    "sign-lost: Biases below 0 count upwards." => bias(|state, unit, slope| Faithful.bias(state, unit, slope).abs());
    "constant-in-whole-depths: The constant counts in the depth's range, not in its steps." =>
        bias(|state, _, slope| Faithful.bias(state, 1.0, slope));
    "applied-to-lines: Points and lines are biased as polygons are." => biases_lines(|| true),
        permitted vec![under!(biases_lines: true)];
    source "v3d: D16 units";
    "d16-step-of-15-bits: On depth of 16 bits, a step is that of 15." =>
        step(Unorm(16), |r, _| r * 2.0),
        permitted vec![under!(depth_bias_unit: unit if unit.unorm16.iter().any(|r| r.0 <= 2.0 && r.1 >= 2.0))];
    "d24-step-of-23-bits: On depth of 24 bits, a step is that of 23." =>
        step(Unorm(24), |r, _| r * 2.0),
        permitted vec![under!(depth_bias_unit: unit if unit.unorm.iter().any(|r| r.0 <= 2.0 && r.1 >= 2.0))];
    for (bits, other) in [(16, 14), (16, 17), (16, 24), (24, 16), (24, 25)] {
        "d{bits}-step-of-{other}-bits: On depth of {bits} bits, a step is that of {other}." =>
            step(Unorm(bits), move |r, _| r * 2_f64.powi(i32::from(bits) - other));
    }
    source "SwiftShader: bias unscaled by exponent";
    for (name, about, exponent) in [
        ("24-bits", "that of 24 bits", -24), ("1", "that of depth 1", -23), ("16-bits", "that of 16 bits", -16),
    ] {
        "float-step-of-{name}: On float depth, a step is {about}." => step(Float32, move |_, _| 2_f64.powi(exponent));
    }
    for (name, about, factor) in [
        ("halved", "half as large", 0.5), ("quartered", "a quarter as large", 0.25),
        ("of-3-quarters", "three quarters as large", 0.75), ("1-percent-less", "a hundredth smaller", 0.99),
    ] {
        "float-step-{name}: On float depth, a step is {about}." => step(Float32, move |r, _| r * factor);
    }
    "float-step-doubled: On float depth, a step is twice as large." =>
        step(Float32, |r, _| r * 2.0), source "NVIDIA, zink, Intel, Mali: a mantissa of 0.M",
        permitted vec![under!(depth_bias_unit: unit if unit.float.iter().any(|r| r.0 <= 2.0 && r.1 >= 2.0))];
    // The specification allows each of these steps, but not different ones in one attachment.
    source "a step of floats on fixed-point depth";
    for (name, about, factor as fn(f64) -> f64) in [
        ("far-doubled", "twice as large beyond depth 0.5", |z| if z > 0.5 { 2.0 } else { 1.0 }),
        ("near-doubled", "twice as large up to depth 0.5", |z| if z > 0.5 { 1.0 } else { 2.0 }),
        ("growing", "larger with the depth, up to twice", |z| 1.0 + z.clamp(0.0, 1.0)),
    ] {
        for bits in [16, 24] {
            "d{bits}-step-{name}: On fixed-point depth of {bits} bits, a step is {about}." =>
                step(Unorm(bits), move |r, largest| r * factor(largest));
        }
    }
    source CONFUSION;
    "large-constant-grows: Of a constant, what is above 8192 counts half more." =>
        constant(|c| {
            let above = f64::from((c.abs() - 8192).max(0));
            f64::from(c) + above * 0.5 * f64::from(c.signum())
        });
    "negative-constant-grows: Constants below 0 count half more." =>
        constant(|c| f64::from(c) * if c < 0 { 1.5 } else { 1.0 });
    "constant-of-2-digits: A constant keeps two digits and grows by 4 percent." =>
        constant(|c| {
            let size = 10_f64.powi((c.unsigned_abs().max(10).ilog10() as i32 - 1).max(0));
            (f64::from(c) / size * 1.04).round() * size
        });
}
