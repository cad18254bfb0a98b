//! Bugs of the blend constant, of precision and of the colour store.

use super::{Input, after, before, component, factor, is_extreme, joined};
use crate::fields::FieldPlaces;
use crate::formats::store;
use crate::hooks::{blending, code, color_code, faithful_blend};
use crate::list::{CONFUSION, SMALL, bugs, coarse, rounded};
use crate::plant::{Plant, each, in_bits, set};
use etalon_frame::ChannelEncoding::{Float32, Unorm};
use etalon_scene::{BlendFactor, BlendOperation};

pub(crate) const CONSTANT: FieldPlaces<[f32; 4]> = |d| vec![&mut d.blend_constant];

type BlendValues = [[f32; 1]; 4];

/// Blends without further clamping, after `held` has clamped some of source, second source and constant.
fn held(held: fn(&mut Input)) -> Plant {
    before(move |_, encodings, input| {
        *encodings = [Float32; 4];
        held(input);
    })
}

fn clamped(values: BlendValues) -> BlendValues {
    values.map(|[v]| [v.clamp(0.0, 1.0)])
}

/// Blends in 8-bit codes: operands are rounded to codes, and each side is `product(code, factor)`.
fn integer(product: fn(u32, u32) -> u32) -> Plant {
    blending(move |state, encodings, input| {
        if encodings[0] != Unorm(8) {
            return faithful_blend(state, encodings, input);
        }
        let codes = |v: BlendValues| v.map(|[v]| code(Unorm(8), v));
        let operands = [input.src, input.dst, input.constant, input.src1].map(codes);
        let [src, dst, ..] = operands;
        std::array::from_fn(|c| {
            let component = component(state, c);
            let side = |operand, f| match component.operation {
                BlendOperation::Min | BlendOperation::Max => operand,
                _ => product(operand, factor(operands, f, c, 255)),
            };
            let s = side(src[c], component.src_factor) as f32;
            let d = side(dst[c], component.dst_factor) as f32;
            joined(component.operation, s, d) / 255.0
        })
    })
}

/// Returns a value in units of 8-bit codes, not rounded.
fn exact(v: f32) -> f64 {
    f64::from(v.clamp(0.0, 1.0)) * 255.0
}

bugs! {
    class "blend", "blend";
    source "a wrong blend constant, which dEQP's groups do not see";
    for bits in [5, 6, 7] {
        "constant-in-{bits}-bits: The constant keeps {bits} bits." =>
            each(CONSTANT, move |c| *c = c.map(|v| in_bits(v, bits)));
    }
    for codes in [1, 3] {
        let by = codes as f32 / 255.0;
        "constant-plus-{codes}-lsb: The constant is {codes}/255 too large." =>
            each(CONSTANT, move |c| *c = c.map(|v| v + by));
        "constant-minus-{codes}-lsb: The constant is {codes}/255 too small." =>
            each(CONSTANT, move |c| *c = c.map(|v| v - by));
    }
    source CONFUSION;
    "constant-unset: The constant is 0." => set(CONSTANT, [0.0; 4]), source "radv: constant colour untranslated";
    "constant-one: The constant is 1." => set(CONSTANT, [1.0; 4]);
    "constant-red-for-all: The constant's red is used for all channels." => each(CONSTANT, |c| *c = [c[0]; 4]);
    "constant-red-blue-swapped: The constant's red and blue are exchanged." => each(CONSTANT, |c| c.swap(0, 2));
    "constant-reversed: The constant's channels are reversed." => each(CONSTANT, |c| c.reverse());
    "constant-opaque: The constant's alpha is 1." => each(CONSTANT, |c| c[3] = 1.0);
    "constant-not-clamped: A constant outside 0 to 1 is not clamped." =>
        held(|i| (i.src, i.src1) = (clamped(i.src), clamped(i.src1))), source "freedreno: blend constant not clamped";
    "source-not-clamped: A source outside 0 to 1 is not clamped before it is blended." =>
        held(|i| i.constant = clamped(i.constant)), source "SwiftShader: clamping of blend inputs";
    "constant-clamped-below-only: A constant above 1 is not clamped." =>
        held(|i| {
            (i.src, i.src1) = (clamped(i.src), clamped(i.src1));
            i.constant = i.constant.map(|[v]| [v.max(0.0)]);
        });
    source "integer blending, as mobile GPUs do it";
    "in-8-bits-nearest: Operands and products are rounded to the nearest of 8-bit codes." =>
        integer(|a, b| (a * b + 127) / 255), permitted coarse();
    "in-8-bits-truncated: Products are rounded down to 8-bit codes." => integer(|a, b| a * b / 255), permitted coarse();
    "in-8-bits-times-plus-one: Products are a × (b + 1) / 256, rounded down." =>
        integer(|a, b| (a * (b + 1)) >> 8), permitted coarse();
    "in-8-bits-by-256: Products are divided by 256, so that 1 times 1 is less than 1." =>
        integer(|a, b| (a * b) >> 8), source "SwiftShader: blending on truncated bits";
    source "SwiftShader: 565/5551 blended on truncated bits";
    "in-7-bits: Operands lose their lowest bit." => integer(|a, b| ((a & 0xfe) * (b & 0xfe) + 127) / 255);
    "in-5-bits: Operands lose their lowest three bits." => integer(|a, b| ((a & 0xf8) * (b & 0xf8) + 127) / 255);
    source SMALL;
    "complement-by-256: Factors 1 - x are computed as 256/255 - x." =>
        after(|state, _, input, result| {
            for (c, value) in result.iter_mut().enumerate() {
                let component = component(state, c);
                let extra = |f: BlendFactor, operand: f32| {
                    let inverse = f32::from(u8::from(f.name().starts_with("one-minus")));
                    inverse * operand.clamp(0.0, 1.0) / 255.0
                };
                let s = extra(component.src_factor, input.src[c][0]);
                let d = extra(component.dst_factor, input.dst[c][0]);
                if !is_extreme(component.operation) { *value += joined(component.operation, s, d); }
            }
        });
    "result-plus-1-lsb: Blended results are 1/255 too large." =>
        after(|_, _, _, result| *result = result.map(|v| v + 1.0 / 255.0));
    "result-minus-1-lsb: Blended results are 1/255 too small." =>
        after(|_, _, _, result| *result = result.map(|v| v - 1.0 / 255.0));
    "in-srgb-space: Colour is blended in linear light of an sRGB reading." =>
        blending(|state, encodings, input| {
            let mut light = *input;
            for c in 0..3 {
                light.src[c] = input.src[c].map(|v| v.clamp(0.0, 1.0).powf(2.2));
                light.dst[c] = input.dst[c].map(|v| v.powf(2.2));
            }
            let mut result = faithful_blend(state, encodings, &light);
            for value in &mut result[..3] { *value = value.max(0.0).powf(1.0 / 2.2); }
            result
        }), source "SwiftShader: sRGB treated as linear";
    "store-rounded-down: Colours are rounded down at the store." =>
        store(Unorm(8), |v| (exact(v) + 1e-4) as u32), source "truncation instead of rounding", permitted rounded();
    "store-rounded-up: Colours are rounded up at the store." =>
        store(Unorm(8), |v| (exact(v) - 1e-4).ceil() as u32), source "rounding up", permitted rounded();
    "store-by-256: Colours are stored as v × 256, rounded down and clamped to 255." =>
        store(Unorm(8), |v| ((exact(v) * 256.0 / 255.0) as u32).min(255)),
        source "multiplying by 256 instead of 255", permitted rounded();
    "store-dithered: Colours are rounded down and up in turns along a row." =>
        color_code(|encoding, v, lane| match encoding {
            Unorm(8) => (exact(v) - 1e-4 + if lane % 2 == 0 { 2e-4 } else { 1.0 }) as u32,
            _ => code(encoding, v),
        }), source "dithering that nobody asked for";
    "store-wraps: Colours outside 0 to 1 wrap around." =>
        store(Unorm(8), |v| ((v * 255.0 + 0.5).floor() as i64 & 0xff) as u32), source CONFUSION;
    "store-in-7-bits: Stored colours lose their lowest bit." => store(Unorm(8), |v| code(Unorm(8), v) & 0xfe);
    "store-in-6-bits: Stored colours keep 6 bits." =>
        color_code(|encoding, v, _| code(encoding, in_bits(v.clamp(0.0, 1.0), 6)));
}
