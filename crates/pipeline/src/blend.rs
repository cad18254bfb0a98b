//! Blending (Vulkan, Blending; OpenGL 4.6, 17.3.6; WebGPU, blend state).

use crate::arithmetic::Arithmetic;
use etalon_frame::ChannelEncoding;
use etalon_scene::{BlendComponent, BlendFactor, BlendOperation, BlendState};

/// The inputs of a blend, with channels in the order red, green, blue, alpha.
#[derive(Clone, Copy, Debug)]
pub struct BlendInput<R> {
    /// The fragment's colour.
    pub src: [R; 4],
    /// The fragment's second source.
    pub src1: [R; 4],
    /// The stored colour.
    pub dst: [R; 4],
    /// The blend constant.
    pub constant: [R; 4],
}

/// A factor before it is multiplied. Zero and one need no arithmetic: `0 * x = 0` is exact for finite `x`, and
/// `1 * x = x` for every `x`, in every specification.
enum UnmultipliedFactor<R> {
    Zero,
    One,
    Value(R),
}

/// Blends one colour. `encodings` are those of the destination's four channels.
#[inline(always)]
pub fn blend<A: Arithmetic>(
    a: &mut A,
    state: &BlendState,
    encodings: [ChannelEncoding; 4],
    input: &BlendInput<A::Real>,
) -> [A::Real; 4] {
    let second = reads(state, BlendFactor::is_second_source);
    let constant = reads(state, BlendFactor::is_constant);
    // Converts the operands to blending precision once, so that all uses agree.
    let mut operands = *input;
    for (c, encoding) in encodings.into_iter().enumerate() {
        operands.src[c] = a.blend_operand(encoding, input.src[c]);
        operands.dst[c] = a.blend_operand(encoding, input.dst[c]);
        if second {
            operands.src1[c] = a.blend_operand(encoding, input.src1[c]);
        }
        if constant {
            operands.constant[c] = a.blend_operand(encoding, input.constant[c]);
        }
    }
    // A loop, because closures over arrays are not always inlined.
    let alphas = [operands.src[3], operands.src1[3], operands.constant[3]];
    let mut result = operands.src;
    for (c, encoding) in encodings.into_iter().enumerate() {
        let component = if c == 3 { &state.alpha } else { &state.color };
        if c < 3 && encoding != encodings[3] {
            let pair = [encoding, encodings[3]];
            operands.src[3] = a.blend_weight(pair, input.src[3], alphas[0]);
            operands.src1[3] = a.blend_weight(pair, input.src1[3], alphas[1]);
            operands.constant[3] = a.blend_weight(pair, input.constant[3], alphas[2]);
        } else {
            [operands.src[3], operands.src1[3], operands.constant[3]] = alphas;
        }
        result[c] = channel(a, component, encoding, &operands, c);
    }
    result
}

/// Returns true if a factor of the state is of a kind.
#[inline(always)]
fn reads(state: &BlendState, kind: impl Fn(BlendFactor) -> bool) -> bool {
    [&state.color, &state.alpha]
        .into_iter()
        .any(|component| kind(component.src_factor) || kind(component.dst_factor))
}

#[inline(always)]
fn channel<A: Arithmetic>(
    a: &mut A,
    component: &BlendComponent,
    encoding: ChannelEncoding,
    input: &BlendInput<A::Real>,
    c: usize,
) -> A::Real {
    let (src, dst) = (input.src[c], input.dst[c]);
    match component.operation {
        BlendOperation::Min => a.min(src, dst),
        BlendOperation::Max => a.max(src, dst),
        BlendOperation::Add | BlendOperation::Subtract | BlendOperation::ReverseSubtract => {
            let src_factor = factor(a, component.src_factor, encoding, input, c);
            let dst_factor = factor(a, component.dst_factor, encoding, input, c);
            let s = side(a, encoding, src, src_factor);
            let d = side(a, encoding, dst, dst_factor);
            match component.operation {
                BlendOperation::Subtract => a.blend_sum(encoding, s, d, true),
                BlendOperation::ReverseSubtract => a.blend_sum(encoding, d, s, true),
                _ => {
                    let sum = a.blend_sum(encoding, s, d, false);
                    let factors = [component.src_factor, component.dst_factor];
                    let (weight, near, far) = match factors.map(complement) {
                        [_, Some(of)] if of == factors[0] => (factors[0], src, dst),
                        [Some(of), _] if of == factors[1] => (factors[1], dst, src),
                        _ => return sum,
                    };
                    a.blend_mix(encoding, sum, |a| {
                        let weight = factor(a, weight, encoding, input, c);
                        let difference = a.blend_sum(encoding, near, far, true);
                        let weighed = side(a, encoding, difference, weight);
                        a.blend_sum(encoding, far, weighed, false)
                    })
                }
            }
        }
    }
}

/// Returns the factor that this one is the complement of, if it is one.
#[inline(always)]
fn complement(factor: BlendFactor) -> Option<BlendFactor> {
    Some(match factor {
        BlendFactor::OneMinusSrc => BlendFactor::Src,
        BlendFactor::OneMinusSrcAlpha => BlendFactor::SrcAlpha,
        BlendFactor::OneMinusDst => BlendFactor::Dst,
        BlendFactor::OneMinusDstAlpha => BlendFactor::DstAlpha,
        BlendFactor::OneMinusSrc1 => BlendFactor::Src1,
        BlendFactor::OneMinusSrc1Alpha => BlendFactor::Src1Alpha,
        BlendFactor::OneMinusConstant => BlendFactor::Constant,
        BlendFactor::OneMinusConstantAlpha => BlendFactor::ConstantAlpha,
        _ => return None,
    })
}

#[inline(always)]
fn side<A: Arithmetic>(
    a: &mut A,
    encoding: ChannelEncoding,
    operand: A::Real,
    factor: UnmultipliedFactor<A::Real>,
) -> A::Real {
    match factor {
        UnmultipliedFactor::Zero => a.blend_zero(operand),
        UnmultipliedFactor::One => operand,
        UnmultipliedFactor::Value(value) => a.blend_product(encoding, operand, value),
    }
}

#[inline(always)]
fn factor<A: Arithmetic>(
    a: &mut A,
    factor: BlendFactor,
    encoding: ChannelEncoding,
    input: &BlendInput<A::Real>,
    c: usize,
) -> UnmultipliedFactor<A::Real> {
    let value = match factor {
        BlendFactor::Zero => return UnmultipliedFactor::Zero,
        BlendFactor::One => return UnmultipliedFactor::One,
        BlendFactor::SrcAlphaSaturated if c == 3 => return UnmultipliedFactor::One,
        BlendFactor::SrcAlphaSaturated => {
            let rest = a.blend_complement(encoding, input.dst[3]);
            a.min(input.src[3], rest)
        }
        BlendFactor::Src | BlendFactor::OneMinusSrc => input.src[c],
        BlendFactor::SrcAlpha | BlendFactor::OneMinusSrcAlpha => input.src[3],
        BlendFactor::Dst | BlendFactor::OneMinusDst => input.dst[c],
        BlendFactor::DstAlpha | BlendFactor::OneMinusDstAlpha => input.dst[3],
        BlendFactor::Src1 | BlendFactor::OneMinusSrc1 => input.src1[c],
        BlendFactor::Src1Alpha | BlendFactor::OneMinusSrc1Alpha => input.src1[3],
        BlendFactor::Constant | BlendFactor::OneMinusConstant => input.constant[c],
        BlendFactor::ConstantAlpha | BlendFactor::OneMinusConstantAlpha => input.constant[3],
    };
    let value = match factor {
        BlendFactor::OneMinusSrc1
        | BlendFactor::OneMinusSrc1Alpha
        | BlendFactor::OneMinusSrc
        | BlendFactor::OneMinusSrcAlpha
        | BlendFactor::OneMinusDst
        | BlendFactor::OneMinusDstAlpha
        | BlendFactor::OneMinusConstant
        | BlendFactor::OneMinusConstantAlpha => a.blend_complement(encoding, value),
        _ => value,
    };
    UnmultipliedFactor::Value(a.blend_factor(encoding, value))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plain::Plain;

    fn over(operation: BlendOperation) -> BlendState {
        let component = BlendComponent {
            operation,
            src_factor: BlendFactor::SrcAlpha,
            dst_factor: BlendFactor::OneMinusSrcAlpha,
        };
        BlendState {
            color: component,
            alpha: component,
        }
    }

    fn run(state: &BlendState, src: [f32; 4], dst: [f32; 4]) -> [f32; 4] {
        let input = BlendInput {
            src: src.map(|v| [v]),
            src1: [[0.0]; 4],
            dst: dst.map(|v| [v]),
            constant: [[0.0]; 4],
        };
        blend(
            &mut Plain::<1>,
            state,
            [ChannelEncoding::Unorm(8); 4],
            &input,
        )
        .map(|v| v[0])
    }

    #[test]
    fn over_gives_the_textbook_colour() {
        let state = over(BlendOperation::Add);
        let result = run(&state, [0.0, 0.0, 1.0, 0.6], [1.0, 0.0, 0.0, 1.0]);
        for (value, expected) in result.into_iter().zip([0.4, 0.0, 0.6, 0.76]) {
            assert!((value - expected).abs() < 1e-6, "{value} for {expected}");
        }
    }

    #[test]
    fn min_and_max_ignore_factors() {
        let (src, dst) = ([0.2, 0.8, 0.5, 0.0], [0.4, 0.4, 0.5, 1.0]);
        assert_eq!(
            run(&over(BlendOperation::Min), src, dst),
            [0.2, 0.4, 0.5, 0.0]
        );
        assert_eq!(
            run(&over(BlendOperation::Max), src, dst),
            [0.4, 0.8, 0.5, 1.0]
        );
    }

    #[test]
    fn saturate_is_one_for_alpha() {
        let component = BlendComponent {
            operation: BlendOperation::Add,
            src_factor: BlendFactor::SrcAlphaSaturated,
            dst_factor: BlendFactor::Zero,
        };
        let state = BlendState {
            color: component,
            alpha: component,
        };
        let result = run(&state, [1.0, 0.5, 0.0, 0.75], [0.0, 0.0, 0.0, 0.5]);
        assert_eq!(result, [0.5, 0.25, 0.0, 0.75]);
    }
}
