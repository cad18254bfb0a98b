//! Bugs of blending.

pub(super) mod advanced;
pub(super) mod precision;

use super::hooks::{blending, faithful_blend};
use super::list::{CONFUSION, List};
use super::plant::{Plant, alpha_blend, color_blend, draws};
use super::tables;
use etalon_frame::ChannelEncoding;
use etalon_pipeline::BlendInput;
use etalon_scene::{BlendComponent, BlendFactor, BlendOperation, BlendState};

type Input = BlendInput<[f32; 1]>;
type Encodings = [ChannelEncoding; 4];

pub(super) fn add(list: &mut List) {
    list.class("blend", "blend");
    neighbours(list);
    equations(list);
    saturate(list);
    switches(list);
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
                "For colour, factor {} acts as {}.",
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
                    "For alpha, factor {} acts as {}.",
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
            format!("For colour, {} acts as {}.", right.name(), wrong.name()),
            color_blend(swap),
        );
        list.add(
            &format!("alpha-operation-{}-as-{}", right.name(), wrong.name()),
            CONFUSION,
            format!("For alpha, {} acts as {}.", right.name(), wrong.name()),
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
        "In the alpha equation, colour factors use red.",
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
        "Sums above 1 wrap around.",
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
        "For alpha, saturate is computed as for colour.",
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
