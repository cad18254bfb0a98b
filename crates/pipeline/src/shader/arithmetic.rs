//! Arithmetic that several shaders share.

use crate::arithmetic::Arithmetic;

/// Returns a colour channel multiplied by alpha; alpha is returned unchanged.
pub(super) fn premultiplied<A: Arithmetic>(a: &mut A, color: [A::Real; 4], c: usize) -> A::Real {
    if c == 3 {
        return color[3];
    }
    let product = a.mul(color[c], color[3]);
    a.rounded(product)
}

/// Returns a value clamped to 0..1.
pub(super) fn clamp_to_unit<A: Arithmetic>(a: &mut A, value: A::Real) -> A::Real {
    let (zero, one) = (a.constant(0.0), a.constant(1.0));
    let value = a.max(value, zero);
    a.min(value, one)
}

/// Returns the position of a value between two others: 0 at the first, 1 at the second.
pub(super) fn share_between<A: Arithmetic>(
    a: &mut A,
    value: A::Real,
    from: A::Real,
    to: A::Real,
) -> A::Real {
    let way = a.sub(value, from);
    let way = a.rounded(way);
    let span = a.sub(to, from);
    let span = a.rounded(span);
    let share = a.div(way, span);
    a.rounded(share)
}

/// Returns the distance from the eye of a window depth under a perspective projection.
pub(super) fn distance_behind<A: Arithmetic>(
    a: &mut A,
    depth: A::Real,
    near: A::Real,
    far: A::Real,
) -> A::Real {
    let range = a.sub(far, near);
    let range = a.rounded(range);
    let part = a.mul(depth, range);
    let part = a.rounded(part);
    let below = a.sub(far, part);
    let below = a.rounded(below);
    let product = a.mul(near, far);
    let product = a.rounded(product);
    let distance = a.div(product, below);
    a.rounded(distance)
}

/// Returns a sum at the precision of shaders.
pub(super) fn sum<A: Arithmetic>(a: &mut A, left: A::Real, right: A::Real) -> A::Real {
    let sum = a.add(left, right);
    a.rounded(sum)
}

/// Returns a difference at the precision of shaders.
pub(super) fn difference<A: Arithmetic>(a: &mut A, left: A::Real, right: A::Real) -> A::Real {
    let difference = a.sub(left, right);
    a.rounded(difference)
}

/// Returns a product at the precision of shaders.
pub(super) fn product<A: Arithmetic>(a: &mut A, left: A::Real, right: A::Real) -> A::Real {
    let product = a.mul(left, right);
    a.rounded(product)
}

/// Returns a quotient at the precision of shaders.
pub(super) fn quotient<A: Arithmetic>(a: &mut A, left: A::Real, right: A::Real) -> A::Real {
    let quotient = a.div(left, right);
    a.rounded(quotient)
}

/// Returns a value times a constant, at the precision of shaders.
pub(super) fn scaled<A: Arithmetic>(a: &mut A, value: A::Real, by: f32) -> A::Real {
    let by = a.constant(by);
    product(a, value, by)
}

/// Returns a value without its sign.
pub(super) fn magnitude<A: Arithmetic>(a: &mut A, value: A::Real) -> A::Real {
    let zero = a.constant(0.0);
    let turned = a.sub(zero, value);
    a.max(value, turned)
}

/// The maximum number of steps that [`stepped`] distinguishes.
const STEPS: u8 = 8;

/// Returns the whole steps of two values as colours: the first as three bits, in Gray code; the second as
/// alpha, odd or even.
pub(super) fn stepped<A: Arithmetic>(a: &mut A, [first, second]: [A::Real; 2]) -> [A::Real; 4] {
    [0, 1, 2, 3].map(|channel| {
        let (value, bits): (_, fn(u8) -> u8) = match channel {
            3 => (second, |step| step << 3),
            _ => (first, |step| step ^ (step >> 1)),
        };
        let bit = |step: u8| f32::from(bits(step) >> channel & 1);
        let last = a.constant(bit(STEPS - 1));
        (1..STEPS).rev().fold(last, |above, step| {
            let (limit, below) = (a.constant(f32::from(step)), a.constant(bit(step - 1)));
            a.select_less(value, limit, below, above)
        })
    })
}
