//! Bugs of the blend constant, of precision and of the colour store.

use super::component;
use crate::hooks::{blending, code, color_code, faithful_blend};
use crate::list::{CONFUSION, List, SMALL};
use crate::plant::{Plant, draws, in_bits};
use etalon_frame::ChannelEncoding;
use etalon_pipeline::BlendInput;
use etalon_scene::{BlendFactor, BlendOperation};

const PRECISION: &str = "Vulkan: Blending: precision no lower than that used to represent \
                         destination components, read as codes of the destination";
const ROUNDED: &str = "Vulkan: Fundamentals, Conversion from Floating-Point to Normalized \
                       Fixed-Point: one of the two closest values, the nearest only recommended";

pub(crate) fn add(list: &mut List) {
    constants(list);
    precision(list);
    stores(list);
}

fn constants(list: &mut List) {
    let mut add = |name: &str, source, about: &str, bug: fn([f32; 4]) -> [f32; 4]| {
        list.add(
            name,
            source,
            about,
            draws(move |draw| draw.blend_constant = bug(draw.blend_constant)),
        );
    };
    let fuzzy = "a wrong blend constant, which dEQP's groups do not see";
    add(
        "constant-in-5-bits",
        fuzzy,
        "The constant keeps 5 bits.",
        |c| c.map(|v| in_bits(v, 5)),
    );
    add(
        "constant-in-6-bits",
        fuzzy,
        "The constant keeps 6 bits.",
        |c| c.map(|v| in_bits(v, 6)),
    );
    add(
        "constant-in-7-bits",
        fuzzy,
        "The constant keeps 7 bits.",
        |c| c.map(|v| in_bits(v, 7)),
    );
    add(
        "constant-plus-1-lsb",
        fuzzy,
        "The constant is 1/255 too large.",
        |c| c.map(|v| v + 1.0 / 255.0),
    );
    add(
        "constant-minus-1-lsb",
        fuzzy,
        "The constant is 1/255 too small.",
        |c| c.map(|v| v - 1.0 / 255.0),
    );
    add(
        "constant-plus-3-lsb",
        fuzzy,
        "The constant is 3/255 too large.",
        |c| c.map(|v| v + 3.0 / 255.0),
    );
    add(
        "constant-minus-3-lsb",
        fuzzy,
        "The constant is 3/255 too small.",
        |c| c.map(|v| v - 3.0 / 255.0),
    );
    add(
        "constant-unset",
        "radv: constant colour untranslated",
        "The constant is 0.",
        |_| [0.0; 4],
    );
    add("constant-one", CONFUSION, "The constant is 1.", |_| {
        [1.0; 4]
    });
    add(
        "constant-red-for-all",
        CONFUSION,
        "The constant's red is used for all channels.",
        |c| [c[0]; 4],
    );
    add(
        "constant-red-blue-swapped",
        CONFUSION,
        "The constant's red and blue are exchanged.",
        |c| [c[2], c[1], c[0], c[3]],
    );
    add(
        "constant-reversed",
        CONFUSION,
        "The constant's channels are reversed.",
        |c| [c[3], c[2], c[1], c[0]],
    );
    add(
        "constant-opaque",
        CONFUSION,
        "The constant's alpha is 1.",
        |c| [c[0], c[1], c[2], 1.0],
    );
    list.add(
        "constant-not-clamped",
        "freedreno: blend constant not clamped",
        "A constant outside 0 to 1 is not clamped.",
        blending(|state, _, input| {
            let clamp = |v: [[f32; 1]; 4]| v.map(|[v]| [v.clamp(0.0, 1.0)]);
            let input = BlendInput {
                src: clamp(input.src),
                src1: clamp(input.src1),
                dst: input.dst,
                constant: input.constant,
            };
            faithful_blend(state, [ChannelEncoding::Float32; 4], &input)
        }),
    );
    list.add(
        "source-not-clamped",
        "SwiftShader: clamping of blend inputs",
        "A source outside 0 to 1 is not clamped before it is blended.",
        blending(|state, _, input| {
            let input = BlendInput {
                src: input.src,
                src1: input.src1,
                dst: input.dst,
                constant: input.constant.map(|[v]| [v.clamp(0.0, 1.0)]),
            };
            faithful_blend(state, [ChannelEncoding::Float32; 4], &input)
        }),
    );
    list.add(
        "constant-clamped-below-only",
        CONFUSION,
        "A constant above 1 is not clamped.",
        blending(|state, _, input| {
            let clamp = |v: [[f32; 1]; 4]| v.map(|[v]| [v.clamp(0.0, 1.0)]);
            let input = BlendInput {
                src: clamp(input.src),
                src1: clamp(input.src1),
                dst: input.dst,
                constant: input.constant.map(|[v]| [v.max(0.0)]),
            };
            faithful_blend(state, [ChannelEncoding::Float32; 4], &input)
        }),
    );
}

/// The two sides joined.
fn joined(operation: BlendOperation, s: f32, d: f32) -> f32 {
    match operation {
        BlendOperation::Add => s + d,
        BlendOperation::Subtract => s - d,
        BlendOperation::ReverseSubtract => d - s,
        BlendOperation::Min => s.min(d),
        BlendOperation::Max => s.max(d),
    }
}

/// Blending in codes of 8 bits: operands are rounded to codes, each side by `product(code, factor)`.
fn integer(product: fn(u32, u32) -> u32) -> Plant {
    blending(move |state, encodings, input| {
        if encodings[0] != ChannelEncoding::Unorm(8) {
            return faithful_blend(state, encodings, input);
        }
        let codes = |v: [[f32; 1]; 4]| v.map(|[v]| code(ChannelEncoding::Unorm(8), v));
        let (src, dst) = (codes(input.src), codes(input.dst));
        let constant = codes(input.constant);
        let src1 = codes(input.src1);
        let factor = |f: BlendFactor, c: usize| match f {
            BlendFactor::Zero => 0,
            BlendFactor::One => 255,
            BlendFactor::Src => src[c],
            BlendFactor::OneMinusSrc => 255 - src[c],
            BlendFactor::SrcAlpha => src[3],
            BlendFactor::OneMinusSrcAlpha => 255 - src[3],
            BlendFactor::Dst => dst[c],
            BlendFactor::OneMinusDst => 255 - dst[c],
            BlendFactor::DstAlpha => dst[3],
            BlendFactor::OneMinusDstAlpha => 255 - dst[3],
            BlendFactor::SrcAlphaSaturated if c == 3 => 255,
            BlendFactor::SrcAlphaSaturated => src[3].min(255 - dst[3]),
            BlendFactor::Constant => constant[c],
            BlendFactor::OneMinusConstant => 255 - constant[c],
            BlendFactor::ConstantAlpha => constant[3],
            BlendFactor::OneMinusConstantAlpha => 255 - constant[3],
            BlendFactor::Src1 => src1[c],
            BlendFactor::OneMinusSrc1 => 255 - src1[c],
            BlendFactor::Src1Alpha => src1[3],
            BlendFactor::OneMinusSrc1Alpha => 255 - src1[3],
        };
        std::array::from_fn(|c| {
            let component = component(state, c);
            let plain = matches!(
                component.operation,
                BlendOperation::Min | BlendOperation::Max
            );
            let side = |operand: u32, f: BlendFactor| {
                let code = if plain {
                    operand
                } else {
                    product(operand, factor(f, c))
                };
                code as f32
            };
            let s = side(src[c], component.src_factor);
            let d = side(dst[c], component.dst_factor);
            joined(component.operation, s, d) / 255.0
        })
    })
}

fn precision(list: &mut List) {
    list.add(
        "in-8-bits-nearest",
        "integer blending, as mobile GPUs do it",
        "Operands and products are rounded to the nearest of 8-bit codes.",
        integer(|a, b| (a * b + 127) / 255),
    )
    .legal(PRECISION);
    list.add(
        "in-8-bits-truncated",
        "integer blending, as mobile GPUs do it",
        "Products are rounded down to 8-bit codes.",
        integer(|a, b| a * b / 255),
    )
    .legal(PRECISION);
    list.add(
        "in-8-bits-times-plus-one",
        "integer blending, as mobile GPUs do it",
        "Products are a × (b + 1) / 256, rounded down.",
        integer(|a, b| (a * (b + 1)) >> 8),
    )
    .legal(PRECISION);
    list.add(
        "in-8-bits-by-256",
        "SwiftShader: blending on truncated bits",
        "Products are divided by 256, so that 1 times 1 is less than 1.",
        integer(|a, b| (a * b) >> 8),
    );
    list.add(
        "in-7-bits",
        "SwiftShader: 565/5551 blended on truncated bits",
        "Operands lose their lowest bit.",
        integer(|a, b| ((a & 0xfe) * (b & 0xfe) + 127) / 255),
    );
    list.add(
        "in-5-bits",
        "SwiftShader: 565/5551 blended on truncated bits",
        "Operands lose their lowest three bits.",
        integer(|a, b| ((a & 0xf8) * (b & 0xf8) + 127) / 255),
    );
    list.add(
        "complement-by-256",
        SMALL,
        "Factors 1 - x are computed as 256/255 - x.",
        blending(|state, encodings, input| {
            let mut result = faithful_blend(state, encodings, input);
            for (c, value) in result.iter_mut().enumerate() {
                let component = component(state, c);
                let extra = |f: BlendFactor, operand: f32| {
                    if f.name().starts_with("one-minus") {
                        operand.clamp(0.0, 1.0) / 255.0
                    } else {
                        0.0
                    }
                };
                let s = extra(component.src_factor, input.src[c][0]);
                let d = extra(component.dst_factor, input.dst[c][0]);
                if !matches!(
                    component.operation,
                    BlendOperation::Min | BlendOperation::Max
                ) {
                    *value += joined(component.operation, s, d);
                }
            }
            result
        }),
    );
    list.add(
        "result-plus-1-lsb",
        SMALL,
        "Blended results are 1/255 too large.",
        blending(|state, encodings, input| {
            faithful_blend(state, encodings, input).map(|v| v + 1.0 / 255.0)
        }),
    );
    list.add(
        "result-minus-1-lsb",
        SMALL,
        "Blended results are 1/255 too small.",
        blending(|state, encodings, input| {
            faithful_blend(state, encodings, input).map(|v| v - 1.0 / 255.0)
        }),
    );
    list.add(
        "in-srgb-space",
        "SwiftShader: sRGB treated as linear",
        "Colour is blended in linear light of an sRGB reading, though the format is linear.",
        blending(|state, encodings, input| {
            let mut light = *input;
            for c in 0..3 {
                light.src[c] = input.src[c].map(|v| v.clamp(0.0, 1.0).powf(2.2));
                light.dst[c] = input.dst[c].map(|v| v.powf(2.2));
            }
            let result = faithful_blend(state, encodings, &light);
            std::array::from_fn(|c| match c {
                3 => result[c],
                _ => result[c].max(0.0).powf(1.0 / 2.2),
            })
        }),
    );
}

fn stores(list: &mut List) {
    let unorm8 = |round: fn(f64) -> f64| {
        color_code(move |encoding, v| match encoding {
            ChannelEncoding::Unorm(8) => {
                round(f64::from(v.clamp(0.0, 1.0)) * 255.0).clamp(0.0, 255.0) as u32
            }
            _ => code(encoding, v),
        })
    };
    list.add(
        "store-rounded-down",
        "truncation instead of rounding",
        "Colours are rounded down at the store.",
        unorm8(|v| (v + 1e-4).floor()),
    )
    .legal(ROUNDED);
    list.add(
        "store-rounded-up",
        "rounding up",
        "Colours are rounded up at the store.",
        unorm8(|v| (v - 1e-4).ceil()),
    )
    .legal(ROUNDED);
    list.add(
        "store-by-256",
        "multiplying by 256 instead of 255",
        "Colours are stored as v × 256, rounded down and clamped to 255.",
        unorm8(|v| (v * 256.0 / 255.0).floor()),
    )
    .legal(ROUNDED);
    list.add(
        "store-wraps",
        CONFUSION,
        "Colours outside 0 to 1 wrap around.",
        color_code(|encoding, v| match encoding {
            ChannelEncoding::Unorm(8) => ((v * 255.0 + 0.5).floor() as i64 & 0xff) as u32,
            _ => code(encoding, v),
        }),
    );
    list.add(
        "store-in-7-bits",
        SMALL,
        "Stored colours lose their lowest bit.",
        color_code(|encoding, v| match encoding {
            ChannelEncoding::Unorm(8) => code(encoding, v) & 0xfe,
            _ => code(encoding, v),
        }),
    );
    list.add(
        "store-in-6-bits",
        SMALL,
        "Stored colours keep 6 bits.",
        color_code(|encoding, v| code(encoding, in_bits(v.clamp(0.0, 1.0), 6))),
    );
}
