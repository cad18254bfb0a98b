//! Bugs of blending.

pub(super) mod advanced;
pub(super) mod precision;

use crate::fields::{
    ALPHA_EQUATION, ALPHA_FACTORS, BLEND, COLOR_EQUATION, COLOR_FACTORS, EQUATIONS, FieldPlaces,
    TARGETS,
};
use crate::hooks::{blending, faithful_blend};
use crate::list::{CONFUSION, MutantList, bugs, rows};
use crate::plant::{Plant, each, set, swapped};
use crate::tables::{factor_neighbours, place, round, same_for_alpha};
use etalon_frame::ChannelEncoding;
use etalon_pipeline::BlendInput;
use etalon_scene::{BlendComponent, BlendFactor, BlendOperation, BlendState};
use std::ops::Sub;

pub(super) type Input = BlendInput<[f32; 1]>;
pub(super) type Encodings = [ChannelEncoding; 4];

const COLOR_OPERATION: FieldPlaces<BlendOperation> = |d| {
    COLOR_EQUATION(d)
        .into_iter()
        .map(|c| &mut c.operation)
        .collect()
};
const ALPHA_OPERATION: FieldPlaces<BlendOperation> = |d| {
    ALPHA_EQUATION(d)
        .into_iter()
        .map(|c| &mut c.operation)
        .collect()
};

/// Adds swaps of factors, for colour and for alpha.
pub(super) fn factors(list: &mut MutantList, pairs: &[(BlendFactor, BlendFactor)]) {
    let different = |(right, wrong): &(_, _)| !same_for_alpha(*right, *wrong);
    let (for_color, for_alpha) = (
        pairs.iter().copied(),
        pairs.iter().copied().filter(different),
    );
    rows! { list;
        swaps "color-factor-", "For colour, factor ", COLOR_FACTORS, for_color;
        swaps "alpha-factor-", "For alpha, factor ", ALPHA_FACTORS, for_alpha;
    }
}

/// Returns one side of the equations: the other side's factors are zero, and the sides are added.
pub(super) fn side(
    state: &BlendState,
    encodings: Encodings,
    input: &Input,
    source: bool,
) -> [f32; 4] {
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

pub(super) fn component(state: &BlendState, c: usize) -> &BlendComponent {
    if c == 3 { &state.alpha } else { &state.color }
}

/// Returns the factor of a channel, given source, destination, constant and second source, and the number that stands
/// for 1.
pub(super) fn factor<T>(operands: [[T; 4]; 4], factor: BlendFactor, c: usize, one: T) -> T
where
    T: Copy + Default + PartialOrd + Sub<Output = T>,
{
    let [src, dst, ..] = operands;
    match (place(factor), factor) {
        (Some([row, column]), _) => {
            let operand = operands[row][if column < 2 { c } else { 3 }];
            if column % 2 == 1 {
                one - operand
            } else {
                operand
            }
        }
        (None, BlendFactor::Zero) => T::default(),
        (None, BlendFactor::SrcAlphaSaturated) if c < 3 => {
            let rest = one - dst[3];
            if src[3] < rest { src[3] } else { rest }
        }
        (None, _) => one,
    }
}

/// Combines the two sides.
pub(super) fn joined(operation: BlendOperation, s: f32, d: f32) -> f32 {
    match operation {
        BlendOperation::Add => s + d,
        BlendOperation::Subtract => s - d,
        BlendOperation::ReverseSubtract => d - s,
        BlendOperation::Min => s.min(d),
        BlendOperation::Max => s.max(d),
    }
}

pub(super) fn is_extreme(operation: BlendOperation) -> bool {
    [BlendOperation::Min, BlendOperation::Max].contains(&operation)
}

/// Changes the inputs of blending, and their encodings.
pub(super) fn before(
    bug: impl Fn(&BlendState, &mut Encodings, &mut Input) + Send + Sync + 'static,
) -> Plant {
    blending(move |state, mut encodings, input| {
        let mut input = *input;
        bug(state, &mut encodings, &mut input);
        faithful_blend(state, encodings, &input)
    })
}

/// Changes the result of blending.
pub(super) fn after(
    bug: impl Fn(&BlendState, Encodings, &Input, &mut [f32; 4]) + Send + Sync + 'static,
) -> Plant {
    blending(move |state, encodings, input| {
        let mut result = faithful_blend(state, encodings, input);
        bug(state, encodings, input, &mut result);
        result
    })
}

fn is_saturated(factor: BlendFactor) -> bool {
    factor == BlendFactor::SrcAlphaSaturated
}

/// Replaces the saturate factor in the colour equation.
fn unsaturated(factor: BlendFactor) -> Plant {
    swapped(COLOR_FACTORS, BlendFactor::SrcAlphaSaturated, factor)
}

/// Blends the source over the destination, by the source's alpha.
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

bugs! {
    class "blend", "blend";
    also |list| factors(list, &factor_neighbours());
    swaps "color-operation-", "For colour, ", COLOR_OPERATION, round(BlendOperation::ALL);
    swaps "alpha-operation-", "For alpha, ", ALPHA_OPERATION, round(BlendOperation::ALL);
    "min-max-apply-factors: Min and max multiply by the factors first." =>
        after(|state, encodings, input, result| {
            let s = side(state, encodings, input, true);
            let d = side(state, encodings, input, false);
            for c in 0..4 {
                let operation = component(state, c).operation;
                if is_extreme(operation) { result[c] = joined(operation, s[c], d[c]); }
            }
        }), source "SwiftShader, lima: min/max applying factors";
    source "SwiftShader: reverse-subtract mis-optimised for alpha";
    "reverse-subtract-wrong-for-alpha: Reverse-subtract of no source negates alpha." =>
        after(|state, _, _, result| {
            let reverse = state.alpha.operation == BlendOperation::ReverseSubtract;
            if reverse && state.alpha.src_factor == BlendFactor::Zero { result[3] = -result[3]; }
        });
    "reverse-subtract-alpha-as-subtract: Reverse-subtract by factors of one subtracts alpha." =>
        each(ALPHA_EQUATION, |c| {
            let factors = [c.src_factor, c.dst_factor];
            if c.operation == BlendOperation::ReverseSubtract && factors == [BlendFactor::One; 2] {
                c.operation = BlendOperation::Subtract;
            }
        });
    source CONFUSION;
    "alpha-equation-from-color: Alpha takes colour's equation." => each(EQUATIONS, |state| state.alpha = state.color);
    "color-equation-from-alpha: Colour takes alpha's equation." => each(EQUATIONS, |state| state.color = state.alpha);
    "equations-swapped: Colour and alpha exchange their equations." =>
        each(EQUATIONS, |state| std::mem::swap(&mut state.color, &mut state.alpha));
    "alpha-operation-from-color: Alpha takes colour's operation." =>
        each(EQUATIONS, |state| state.alpha.operation = state.color.operation);
    "alpha-factors-from-color: Alpha takes colour's factors." =>
        each(EQUATIONS, |state| {
            let operation = state.alpha.operation;
            state.alpha = BlendComponent { operation, ..state.color };
        });
    "color-factor-not-mapped-for-alpha: In the alpha equation, colour factors use red." =>
        after(|state, encodings, input, result| {
            let held = |v: [[f32; 1]; 4]| v[0][0].clamp(0.0, 1.0);
            let reds = [held(input.src), input.dst[0][0], held(input.constant)];
            let factor = |f| match place(f) {
                Some([row @ 0..3, 0]) => Some(reds[row]),
                Some([row @ 0..3, 1]) => Some(1.0 - reds[row]),
                _ => None,
            };
            let mut s = side(state, encodings, input, true)[3];
            let mut d = side(state, encodings, input, false)[3];
            if let Some(f) = factor(state.alpha.src_factor) { s = input.src[3][0].clamp(0.0, 1.0) * f; }
            if let Some(f) = factor(state.alpha.dst_factor) { d = input.dst[3][0] * f; }
            if !is_extreme(state.alpha.operation) { result[3] = joined(state.alpha.operation, s, d); }
        }), source "dozen: colour factor not mapped to alpha in the alpha equation";
    "factors-swapped: Source and destination factor are exchanged." =>
        each(EQUATIONS, |state| {
            for c in [&mut state.color, &mut state.alpha] { std::mem::swap(&mut c.src_factor, &mut c.dst_factor); }
        });
    "sum-wraps: Sums above 1 wrap around." =>
        after(|_, _, _, result| *result = result.map(|v| if v > 1.0 { v - 1.0 } else { v }));
    "difference-absolute: Differences below 0 lose their sign." =>
        after(|_, _, _, result| *result = result.map(f32::abs));
    "saturate-as-destination-factor-multiplies-source: The destination's saturate multiplies the source." =>
        after(|state, encodings, input, result| {
            let mut swapped = *input;
            swapped.dst[..3].copy_from_slice(&input.src[..3]);
            let s = side(state, encodings, input, true);
            let d = side(state, encodings, &swapped, false);
            let operation = state.color.operation;
            if is_saturated(state.color.dst_factor) && !is_extreme(operation) {
                (0..3).for_each(|c| result[c] = joined(operation, s[c], d[c]));
            }
        }), source "softpipe: saturate as destination factor multiplying the source";
    "saturate-zero-for-color: Saturate is 0 for colour." =>
        unsaturated(BlendFactor::Zero), source "llvmpipe: saturate forced to 0";
    "saturate-without-destination: Saturate forgets 1 minus the destination's alpha." =>
        unsaturated(BlendFactor::SrcAlpha);
    "saturate-not-one-for-alpha: For alpha, saturate is computed as for colour." =>
        after(|state, encodings, input, result| {
            // The alpha equation with alpha's operands, computed as if for red.
            let mut as_red = *input;
            (as_red.src[0], as_red.dst[0]) = (input.src[3], input.dst[3]);
            let both = BlendState { color: state.alpha, ..*state };
            let factors = [state.alpha.src_factor, state.alpha.dst_factor];
            // Red's constant differs from alpha's, so the bug does not show if a constant takes part.
            let constant = factors.iter().any(|f| f.name().contains("constant"));
            if factors.into_iter().any(is_saturated) && !constant {
                result[3] = faithful_blend(&both, encodings, &as_red)[0];
            }
        });
    "saturate-takes-the-larger: Saturate takes the larger of both alphas." =>
        blending(|state, encodings, input| {
            let larger = input.src[3][0].clamp(0.0, 1.0) > 1.0 - input.dst[3][0];
            let factor = if larger { BlendFactor::SrcAlpha } else { BlendFactor::OneMinusDstAlpha };
            let mut state = *state;
            let factors = [&mut state.color.src_factor, &mut state.color.dst_factor];
            factors.into_iter().filter(|f| is_saturated(**f)).for_each(|f| *f = factor);
            faithful_blend(&state, encodings, input)
        });
    "never: Blending is off." => set(BLEND, None);
    "off-ignored: A draw without blending is blended over." => each(BLEND, |blend| *blend = blend.or(Some(OVER)));
    "off-for-partial-masks: Blending is off where not all channels are written." =>
        each(TARGETS, |target| target.blend = target.blend.filter(|_| target.write_mask == 0xf));
    source "a driver's shortcut";
    "off-for-opaque-sources: Sources of alpha 1 replace the destination." =>
        after(|_, _, input, result| if input.src[3][0] >= 1.0 { *result = input.src.map(|[v]| v) });
    "skipped-for-transparent-sources: Sources of alpha 0 leave the destination." =>
        after(|_, _, input, result| if input.src[3][0] <= 0.0 { *result = input.dst.map(|[v]| v) });
}
