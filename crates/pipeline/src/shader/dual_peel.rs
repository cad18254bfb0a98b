//! Twin of `shaders/dual_peel.wgsl`.

use super::arithmetic::premultiplied;
use super::interface::{FragmentInput, FragmentOutput};
use crate::arithmetic::Arithmetic;

pub(super) fn fragment<A: Arithmetic>(
    a: &mut A,
    input: &FragmentInput<'_, A::Real>,
) -> FragmentOutput<A::Real> {
    let [range, before] = input.texels;
    let (depth, color) = (input.depth, input.color);
    let (zero, one) = (a.constant(0.0), a.constant(1.0));
    let nothing = a.constant(-1.0);
    let nearest = a.sub(zero, range[0]);
    let farthest = range[1];
    // A depth strictly between the two ends is left for the next pass.
    let between = |a: &mut A, value: A::Real| {
        let inside = a.select_less(depth, farthest, value, nothing);
        a.select_less(nearest, depth, inside, nothing)
    };
    let negative = a.sub(zero, depth);
    let depths = [between(a, negative), between(a, depth), zero, one];
    let left = a.sub(one, before[3]);
    let left = a.rounded(left);
    let front = std::array::from_fn(|c| {
        let source = premultiplied(a, color, c);
        let share = a.mul(source, left);
        let share = a.rounded(share);
        let sum = a.add(before[c], share);
        let sum = a.rounded(sum);
        // The depth is neither nearer than the nearest, nor behind it, nor behind the farthest.
        let same = a.select_less(nearest, depth, before[c], sum);
        let same = a.select_less(farthest, depth, before[c], same);
        a.select_less(depth, nearest, before[c], same)
    });
    let back = std::array::from_fn(|c| {
        let same = a.select_less(depth, farthest, zero, color[c]);
        let same = a.select_less(farthest, depth, zero, same);
        a.select_less(nearest, depth, same, zero)
    });
    FragmentOutput {
        others: Some([front, back]),
        ..FragmentOutput::of(depths)
    }
}
