//! Bugs of blending.

pub(super) mod advanced;
pub(super) mod precision;

use crate::fields::{
    ALPHA_EQUATION, ALPHA_FACTORS, BLEND, COLOR_EQUATION, COLOR_FACTORS, EQUATIONS, Places, TARGETS,
};
use crate::hooks::{blending, faithful_blend};
use crate::list::{CONFUSION, List};
use crate::plant::Plant;
use crate::tables;
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
    let color: Places<BlendOperation> = |d| {
        COLOR_EQUATION(d)
            .into_iter()
            .map(|c| &mut c.operation)
            .collect()
    };
    let alpha: Places<BlendOperation> = |d| {
        ALPHA_EQUATION(d)
            .into_iter()
            .map(|c| &mut c.operation)
            .collect()
    };
    factors(list, &tables::factor_neighbours());
    list.swaps(
        "color-operation-",
        "For colour, ",
        color,
        tables::round(BlendOperation::ALL),
    );
    list.swaps(
        "alpha-operation-",
        "For alpha, ",
        alpha,
        tables::round(BlendOperation::ALL),
    );
}

/// Adds the swaps of factors, of colour and of alpha.
pub(super) fn factors(list: &mut List, pairs: &[(BlendFactor, BlendFactor)]) {
    let different = |(right, wrong): &(_, _)| !tables::same_for_alpha(*right, *wrong);
    let for_alpha = pairs.iter().copied().filter(different);
    list.swaps(
        "color-factor-",
        "For colour, factor ",
        COLOR_FACTORS,
        pairs.iter().copied(),
    );
    list.swaps(
        "alpha-factor-",
        "For alpha, factor ",
        ALPHA_FACTORS,
        for_alpha,
    );
}

/// One side of the equations alone: the other's factors are zero, and the sides are added.
fn side(state: &BlendState, encodings: Encodings, input: &Input, source: bool) -> [f32; 4] {
    let mut state = *state;
    for component in [&mut state.color, &mut state.alpha] {
        component.operation = BlendOperation::Add;
        let other = if source {
            &mut component.dst_factor
        } else {
            &mut component.src_factor
        };
        *other = BlendFactor::Zero;
    }
    faithful_blend(&state, encodings, input)
}

fn component(state: &BlendState, c: usize) -> &BlendComponent {
    if c == 3 { &state.alpha } else { &state.color }
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

fn is_extreme(operation: BlendOperation) -> bool {
    [BlendOperation::Min, BlendOperation::Max].contains(&operation)
}

/// Changes what is blended, given the right result.
fn after(
    bug: impl Fn(&BlendState, Encodings, &Input, &mut [f32; 4]) + Send + Sync + 'static,
) -> Plant {
    blending(move |state, encodings, input| {
        let mut result = faithful_blend(state, encodings, input);
        bug(state, encodings, input, &mut result);
        result
    })
}

fn equations(list: &mut List) {
    list.bug("min-max-apply-factors: Min and max multiply by the factors first.")
        .source("SwiftShader, lima: min/max applying factors")
        .plant(after(|state, encodings, input, result| {
            let s = side(state, encodings, input, true);
            let d = side(state, encodings, input, false);
            for c in 0..4 {
                let operation = component(state, c).operation;
                if is_extreme(operation) {
                    result[c] = joined(operation, s[c], d[c]);
                }
            }
        }));
    list.source("SwiftShader: reverse-subtract mis-optimised for alpha");
    list.bug("reverse-subtract-wrong-for-alpha: Reverse-subtract of no source negates alpha.")
        .plant(after(|state, _, _, result| {
            let reverse = state.alpha.operation == BlendOperation::ReverseSubtract;
            if reverse && state.alpha.src_factor == BlendFactor::Zero {
                result[3] = -result[3];
            }
        }));
    list.bug(
        "reverse-subtract-alpha-as-subtract: Reverse-subtract by factors of one subtracts alpha.",
    )
    .each(ALPHA_EQUATION, |c| {
        let factors = [c.src_factor, c.dst_factor];
        if c.operation == BlendOperation::ReverseSubtract && factors == [BlendFactor::One; 2] {
            c.operation = BlendOperation::Subtract;
        }
    });
    list.source(CONFUSION);
    list.bug("alpha-equation-from-color: Alpha takes colour's equation.")
        .each(EQUATIONS, |state| state.alpha = state.color);
    list.bug("color-equation-from-alpha: Colour takes alpha's equation.")
        .each(EQUATIONS, |state| state.color = state.alpha);
    list.bug("equations-swapped: Colour and alpha exchange their equations.")
        .each(EQUATIONS, |state| {
            std::mem::swap(&mut state.color, &mut state.alpha)
        });
    list.bug("alpha-operation-from-color: Alpha takes colour's operation.")
        .each(EQUATIONS, |state| {
            state.alpha.operation = state.color.operation
        });
    list.bug("alpha-factors-from-color: Alpha takes colour's factors.")
        .each(EQUATIONS, |state| {
            let operation = state.alpha.operation;
            state.alpha = BlendComponent {
                operation,
                ..state.color
            };
        });
    list.bug("color-factor-not-mapped-for-alpha: In the alpha equation, colour factors use red.")
        .source("dozen: colour factor not mapped to alpha in the alpha equation")
        .plant(after(|state, encodings, input, result| {
            let held = |v: [[f32; 1]; 4]| v[0][0].clamp(0.0, 1.0);
            let factor = |f: BlendFactor| match f {
                BlendFactor::Src => Some(held(input.src)),
                BlendFactor::OneMinusSrc => Some(1.0 - held(input.src)),
                BlendFactor::Dst => Some(input.dst[0][0]),
                BlendFactor::OneMinusDst => Some(1.0 - input.dst[0][0]),
                BlendFactor::Constant => Some(held(input.constant)),
                BlendFactor::OneMinusConstant => Some(1.0 - held(input.constant)),
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
            if !is_extreme(state.alpha.operation) {
                result[3] = joined(state.alpha.operation, s, d);
            }
        }));
    list.bug("factors-swapped: Source and destination factor are exchanged.")
        .each(EQUATIONS, |state| {
            for c in [&mut state.color, &mut state.alpha] {
                std::mem::swap(&mut c.src_factor, &mut c.dst_factor);
            }
        });
    list.bug("sum-wraps: Sums above 1 wrap around.")
        .plant(after(|_, _, _, result| {
            *result = result.map(|v| if v > 1.0 { v - 1.0 } else { v });
        }));
    list.bug("difference-absolute: Differences below 0 lose their sign.")
        .plant(after(|_, _, _, result| *result = result.map(f32::abs)));
}

/// Replaces saturate in the equation of colour.
fn unsaturated(list: &mut List, text: &str, source: &'static str, factor: BlendFactor) {
    list.bug(text).source(source).each(COLOR_FACTORS, move |f| {
        if *f == BlendFactor::SrcAlphaSaturated {
            *f = factor;
        }
    });
}

fn saturate(list: &mut List) {
    let is_saturated = |f: BlendFactor| f == BlendFactor::SrcAlphaSaturated;
    list.bug(
        "saturate-as-destination-factor-multiplies-source: The destination's saturate \
         multiplies the source.",
    )
    .source("softpipe: saturate as destination factor multiplying the source")
    .plant(after(move |state, encodings, input, result| {
        let mut swapped = *input;
        swapped.dst[..3].copy_from_slice(&input.src[..3]);
        let s = side(state, encodings, input, true);
        let d = side(state, encodings, &swapped, false);
        let operation = state.color.operation;
        if is_saturated(state.color.dst_factor) && !is_extreme(operation) {
            for c in 0..3 {
                result[c] = joined(operation, s[c], d[c]);
            }
        }
    }));
    unsaturated(
        list,
        "saturate-zero-for-color: Saturate is 0 for colour.",
        "llvmpipe: saturate forced to 0",
        BlendFactor::Zero,
    );
    unsaturated(
        list,
        "saturate-without-destination: Saturate forgets 1 minus the destination's alpha.",
        CONFUSION,
        BlendFactor::SrcAlpha,
    );
    list.bug("saturate-not-one-for-alpha: For alpha, saturate is computed as for colour.")
        .plant(after(move |state, encodings, input, result| {
            // Alpha's equation on alpha's operands, computed as if it were red.
            let mut as_red = *input;
            (as_red.src[0], as_red.dst[0]) = (input.src[3], input.dst[3]);
            let both = BlendState {
                color: state.alpha,
                ..*state
            };
            let factors = [state.alpha.src_factor, state.alpha.dst_factor];
            // Red's constant is not alpha's; where one takes part, the bug does not show.
            let constant = factors.iter().any(|f| f.name().contains("constant"));
            if factors.into_iter().any(is_saturated) && !constant {
                result[3] = faithful_blend(&both, encodings, &as_red)[0];
            }
        }));
    list.bug("saturate-takes-the-larger: Saturate takes the larger of both alphas.")
        .plant(blending(move |state, encodings, input| {
            let s = input.src[3][0].clamp(0.0, 1.0);
            let larger = if s > 1.0 - input.dst[3][0] {
                BlendFactor::SrcAlpha
            } else {
                BlendFactor::OneMinusDstAlpha
            };
            let mut state = *state;
            for f in [&mut state.color.src_factor, &mut state.color.dst_factor] {
                if is_saturated(*f) {
                    *f = larger;
                }
            }
            faithful_blend(&state, encodings, input)
        }));
}

/// A source over a destination, by its alpha.
pub(super) const OVER: BlendState = {
    let over = BlendComponent {
        operation: BlendOperation::Add,
        src_factor: BlendFactor::SrcAlpha,
        dst_factor: BlendFactor::OneMinusSrcAlpha,
    };
    BlendState {
        color: over,
        alpha: over,
    }
};

fn switches(list: &mut List) {
    list.bug("never: Blending is off.").set(BLEND, None);
    list.bug("off-ignored: A draw without blending is blended over.")
        .each(BLEND, |blend| *blend = blend.or(Some(OVER)));
    list.bug("off-for-partial-masks: Blending is off where not all channels are written.")
        .each(TARGETS, |target| {
            target.blend = target.blend.filter(|_| target.write_mask == 0xf)
        });
    list.source("a driver's shortcut");
    list.bug("off-for-opaque-sources: Sources of alpha 1 replace the destination.")
        .plant(after(|_, _, input, result| {
            if input.src[3][0] >= 1.0 {
                *result = input.src.map(|[v]| v);
            }
        }));
    list.bug("skipped-for-transparent-sources: Sources of alpha 0 leave the destination.")
        .plant(after(|_, _, input, result| {
            if input.src[3][0] <= 0.0 {
                *result = input.dst.map(|[v]| v);
            }
        }));
}
