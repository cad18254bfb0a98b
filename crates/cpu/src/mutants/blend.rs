//! Bugs of blending and of the colour store.

use super::hooks::{blending, code, color_code, faithful_blend};
use super::plant::{Plant, alpha_blend, color_blend, draws, in_bits};
use super::{CONFUSION, List, SMALL, tables};
use etalon_case::state::{BlendComponent, BlendFactor, BlendOperation, BlendState};
use etalon_frame::ChannelEncoding;
use etalon_pipeline::BlendInput;

type Input = BlendInput<[f32; 1]>;
type Encodings = [ChannelEncoding; 4];

const PRECISION: &str = "Vulkan: Blending: precision no lower than that used to represent \
                         destination components, read as codes of the destination";
const ROUNDED: &str = "Vulkan: Fundamentals, Conversion from Floating-Point to Normalized \
                       Fixed-Point: one of the two closest values, the nearest only recommended";

pub(super) fn add(list: &mut List) {
    list.class("blend", "blend");
    neighbours(list);
    equations(list);
    saturate(list);
    constants(list);
    switches(list);
    precision(list);
    stores(list);
}

fn neighbours(list: &mut List) {
    for (right, wrong) in tables::factor_neighbours() {
        let swap = move |component: &mut BlendComponent| {
            for factor in [&mut component.src_factor, &mut component.dst_factor] {
                if *factor == right {
                    *factor = wrong;
                }
            }
        };
        list.add(
            &format!("color-factor-{}-as-{}", right.name(), wrong.name()),
            CONFUSION,
            format!(
                "For colour, factor {} is done as {}.",
                right.name(),
                wrong.name()
            ),
            color_blend(swap),
        );
        if !tables::same_for_alpha(right, wrong) {
            list.add(
                &format!("alpha-factor-{}-as-{}", right.name(), wrong.name()),
                CONFUSION,
                format!(
                    "For alpha, factor {} is done as {}.",
                    right.name(),
                    wrong.name()
                ),
                alpha_blend(swap),
            );
        }
    }
    for (right, wrong) in tables::operation_neighbours() {
        let swap = move |component: &mut BlendComponent| {
            if component.operation == right {
                component.operation = wrong;
            }
        };
        list.add(
            &format!("color-operation-{}-as-{}", right.name(), wrong.name()),
            CONFUSION,
            format!("For colour, {} is done as {}.", right.name(), wrong.name()),
            color_blend(swap),
        );
        list.add(
            &format!("alpha-operation-{}-as-{}", right.name(), wrong.name()),
            CONFUSION,
            format!("For alpha, {} is done as {}.", right.name(), wrong.name()),
            alpha_blend(swap),
        );
    }
}

fn states(bug: impl Fn(&mut BlendState) + Send + Sync + 'static) -> Plant {
    draws(move |draw| {
        let states = draw.targets.iter_mut().filter_map(|t| t.blend.as_mut());
        states.for_each(&bug);
    })
}

/// One side of the equations alone: the other's factors are zero, and the sides are added.
fn side(state: &BlendState, encodings: Encodings, input: &Input, source: bool) -> [f32; 4] {
    let mut state = *state;
    for component in [&mut state.color, &mut state.alpha] {
        component.operation = BlendOperation::Add;
        if source {
            component.dst_factor = BlendFactor::Zero;
        } else {
            component.src_factor = BlendFactor::Zero;
        }
    }
    faithful_blend(&state, encodings, input)
}

fn component(state: &BlendState, c: usize) -> &BlendComponent {
    if c == 3 { &state.alpha } else { &state.color }
}

fn equations(list: &mut List) {
    list.add(
        "min-max-apply-factors",
        "SwiftShader, lima: min/max applying factors",
        "Min and max multiply by the factors first.",
        blending(|state, encodings, input| {
            let right = faithful_blend(state, encodings, input);
            let s = side(state, encodings, input, true);
            let d = side(state, encodings, input, false);
            std::array::from_fn(|c| match component(state, c).operation {
                BlendOperation::Min => s[c].min(d[c]),
                BlendOperation::Max => s[c].max(d[c]),
                _ => right[c],
            })
        }),
    );
    list.add(
        "reverse-subtract-wrong-for-alpha",
        "SwiftShader: reverse-subtract mis-optimised for alpha",
        "Reverse-subtract with a source factor of zero gives the negated destination for alpha.",
        blending(|state, encodings, input| {
            let mut result = faithful_blend(state, encodings, input);
            let alpha = &state.alpha;
            if alpha.operation == BlendOperation::ReverseSubtract
                && alpha.src_factor == BlendFactor::Zero
            {
                result[3] = -result[3];
            }
            result
        }),
    );
    list.add(
        "reverse-subtract-alpha-as-subtract",
        "SwiftShader: reverse-subtract mis-optimised for alpha",
        "Reverse-subtract is subtract for alpha when both factors are one.",
        alpha_blend(|c| {
            if c.operation == BlendOperation::ReverseSubtract
                && c.src_factor == BlendFactor::One
                && c.dst_factor == BlendFactor::One
            {
                c.operation = BlendOperation::Subtract;
            }
        }),
    );
    list.add(
        "alpha-equation-from-color",
        CONFUSION,
        "Alpha takes colour's equation.",
        states(|state| state.alpha = state.color),
    );
    list.add(
        "color-equation-from-alpha",
        CONFUSION,
        "Colour takes alpha's equation.",
        states(|state| state.color = state.alpha),
    );
    list.add(
        "equations-swapped",
        CONFUSION,
        "Colour and alpha exchange their equations.",
        states(|state| std::mem::swap(&mut state.color, &mut state.alpha)),
    );
    list.add(
        "alpha-operation-from-color",
        CONFUSION,
        "Alpha takes colour's operation.",
        states(|state| state.alpha.operation = state.color.operation),
    );
    list.add(
        "alpha-factors-from-color",
        CONFUSION,
        "Alpha takes colour's factors.",
        states(|state| {
            state.alpha.src_factor = state.color.src_factor;
            state.alpha.dst_factor = state.color.dst_factor;
        }),
    );
    list.add(
        "color-factor-not-mapped-for-alpha",
        "dozen: colour factor not mapped to alpha in the alpha equation",
        "In the equation of alpha, factors of colour take red.",
        blending(|state, encodings, input| {
            let mut result = faithful_blend(state, encodings, input);
            // A colour's equation on alpha's operands, with red as the factors' channel.
            let red = |v: [[f32; 1]; 4]| v[0][0];
            let factor = |f: BlendFactor| match f {
                BlendFactor::Src => Some(red(input.src).clamp(0.0, 1.0)),
                BlendFactor::OneMinusSrc => Some(1.0 - red(input.src).clamp(0.0, 1.0)),
                BlendFactor::Dst => Some(red(input.dst)),
                BlendFactor::OneMinusDst => Some(1.0 - red(input.dst)),
                BlendFactor::Constant => Some(red(input.constant).clamp(0.0, 1.0)),
                BlendFactor::OneMinusConstant => Some(1.0 - red(input.constant).clamp(0.0, 1.0)),
                _ => None,
            };
            let mut s = side(state, encodings, input, true)[3];
            let mut d = side(state, encodings, input, false)[3];
            if let Some(f) = factor(state.alpha.src_factor) {
                s = input.src[3][0].clamp(0.0, 1.0) * f;
            }
            if let Some(f) = factor(state.alpha.dst_factor) {
                d = input.dst[3][0] * f;
            }
            match state.alpha.operation {
                BlendOperation::Add => result[3] = s + d,
                BlendOperation::Subtract => result[3] = s - d,
                BlendOperation::ReverseSubtract => result[3] = d - s,
                BlendOperation::Min | BlendOperation::Max => {}
            }
            result
        }),
    );
    list.add(
        "factors-swapped",
        CONFUSION,
        "Source and destination factor are exchanged.",
        states(|state| {
            for c in [&mut state.color, &mut state.alpha] {
                std::mem::swap(&mut c.src_factor, &mut c.dst_factor);
            }
        }),
    );
    list.add(
        "sum-wraps",
        CONFUSION,
        "Sums above 1 wrap round.",
        blending(|state, encodings, input| {
            faithful_blend(state, encodings, input).map(|v| if v > 1.0 { v - 1.0 } else { v })
        }),
    );
    list.add(
        "difference-absolute",
        CONFUSION,
        "Differences below 0 lose their sign.",
        blending(|state, encodings, input| faithful_blend(state, encodings, input).map(f32::abs)),
    );
}

fn saturate(list: &mut List) {
    let is_saturated = |f: BlendFactor| f == BlendFactor::SrcAlphaSaturated;
    list.add(
        "saturate-as-destination-factor-multiplies-source",
        "softpipe: saturate as destination factor multiplying the source",
        "As the destination's factor, saturate multiplies the source.",
        blending(move |state, encodings, input| {
            let mut result = faithful_blend(state, encodings, input);
            let mut swapped = *input;
            swapped.dst[..3].copy_from_slice(&input.src[..3]);
            let s = side(state, encodings, input, true);
            let d = side(state, encodings, &swapped, false);
            if is_saturated(state.color.dst_factor) {
                for c in 0..3 {
                    match state.color.operation {
                        BlendOperation::Add => result[c] = s[c] + d[c],
                        BlendOperation::Subtract => result[c] = s[c] - d[c],
                        BlendOperation::ReverseSubtract => result[c] = d[c] - s[c],
                        BlendOperation::Min | BlendOperation::Max => {}
                    }
                }
            }
            result
        }),
    );
    list.add(
        "saturate-zero-for-color",
        "llvmpipe: saturate forced to 0",
        "Saturate is 0 for colour.",
        color_blend(move |c| {
            for f in [&mut c.src_factor, &mut c.dst_factor] {
                if is_saturated(*f) {
                    *f = BlendFactor::Zero;
                }
            }
        }),
    );
    list.add(
        "saturate-not-one-for-alpha",
        CONFUSION,
        "For alpha, saturate is what it is for colour.",
        blending(move |state, encodings, input| {
            let mut result = faithful_blend(state, encodings, input);
            // Alpha's equation on alpha's operands, computed as if it were red.
            let mut as_red = *input;
            as_red.src[0] = input.src[3];
            as_red.dst[0] = input.dst[3];
            let both = BlendState {
                color: state.alpha,
                alpha: state.alpha,
            };
            if is_saturated(state.alpha.src_factor) || is_saturated(state.alpha.dst_factor) {
                // Red's constant is not alpha's; where one takes part, the bug does not show.
                let constant = |f: BlendFactor| f.name().contains("constant");
                if !constant(state.alpha.src_factor) && !constant(state.alpha.dst_factor) {
                    result[3] = faithful_blend(&both, encodings, &as_red)[0];
                }
            }
            result
        }),
    );
    list.add(
        "saturate-without-destination",
        CONFUSION,
        "Saturate forgets 1 minus the destination's alpha.",
        color_blend(move |c| {
            for f in [&mut c.src_factor, &mut c.dst_factor] {
                if is_saturated(*f) {
                    *f = BlendFactor::SrcAlpha;
                }
            }
        }),
    );
    list.add(
        "saturate-takes-the-larger",
        CONFUSION,
        "Saturate takes the larger of source alpha and 1 minus destination alpha.",
        blending(move |state, encodings, input| {
            let s = input.src[3][0].clamp(0.0, 1.0);
            let rest = 1.0 - input.dst[3][0];
            let mut state = *state;
            for f in [&mut state.color.src_factor, &mut state.color.dst_factor] {
                if is_saturated(*f) {
                    *f = if s > rest {
                        BlendFactor::SrcAlpha
                    } else {
                        BlendFactor::OneMinusDstAlpha
                    };
                }
            }
            faithful_blend(&state, encodings, input)
        }),
    );
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
    let fuzzy = "a blend constant that dEQP's own groups do not see to be wrong";
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
        "The constant's red stands for all.",
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
                dst: input.dst,
                constant: input.constant,
            };
            faithful_blend(state, [ChannelEncoding::Float32; 4], &input)
        }),
    );
    list.add(
        "source-not-clamped",
        "SwiftShader: clamping of what is blended",
        "A source outside 0 to 1 is not clamped before it is blended.",
        blending(|state, _, input| {
            let input = BlendInput {
                src: input.src,
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
                dst: input.dst,
                constant: input.constant.map(|[v]| [v.max(0.0)]),
            };
            faithful_blend(state, [ChannelEncoding::Float32; 4], &input)
        }),
    );
}

fn switches(list: &mut List) {
    let over = BlendComponent {
        operation: BlendOperation::Add,
        src_factor: BlendFactor::SrcAlpha,
        dst_factor: BlendFactor::OneMinusSrcAlpha,
    };
    list.add(
        "never",
        CONFUSION,
        "Blending is off.",
        draws(|draw| draw.targets.iter_mut().for_each(|t| t.blend = None)),
    );
    list.add(
        "off-ignored",
        CONFUSION,
        "A draw without blending is blended over.",
        draws(move |draw| {
            for target in &mut draw.targets {
                target.blend.get_or_insert(BlendState {
                    color: over,
                    alpha: over,
                });
            }
        }),
    );
    list.add(
        "off-for-partial-masks",
        CONFUSION,
        "Blending is off where not all channels are written.",
        draws(|draw| {
            for target in draw.targets.iter_mut().filter(|t| t.write_mask != 0xf) {
                target.blend = None;
            }
        }),
    );
    list.add(
        "off-for-opaque-sources",
        "a driver's shortcut",
        "Sources of alpha 1 replace the destination.",
        blending(|state, encodings, input| {
            if input.src[3][0] >= 1.0 {
                input.src.map(|[v]| v)
            } else {
                faithful_blend(state, encodings, input)
            }
        }),
    );
    list.add(
        "skipped-for-transparent-sources",
        "a driver's shortcut",
        "Sources of alpha 0 leave the destination.",
        blending(|state, encodings, input| {
            if input.src[3][0] <= 0.0 {
                input.dst.map(|[v]| v)
            } else {
                faithful_blend(state, encodings, input)
            }
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
        "SwiftShader: sRGB taken for linear",
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
        "Colours are stored as v × 256, rounded down and held at 255.",
        unorm8(|v| (v * 256.0 / 255.0).floor()),
    )
    .legal(ROUNDED);
    list.add(
        "store-wraps",
        CONFUSION,
        "Colours outside 0 to 1 wrap round.",
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
