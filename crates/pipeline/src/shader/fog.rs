//! Twin of `shaders/fog.wgsl`.

use super::arithmetic::{clamp_to_unit, distance_behind, share_between};
use super::interface::{FragmentInput, FragmentOutput};
use crate::arithmetic::Arithmetic;

pub(super) fn fragment<A: Arithmetic>(
    a: &mut A,
    input: &FragmentInput<'_, A::Real>,
) -> FragmentOutput<A::Real> {
    let [near, far] = [0, 1].map(|c| a.constant(input.params.color[c]));
    let distance = distance_behind(a, input.depth, near, far);
    let share = share_between(a, distance, near, far);
    let fade = clamp_to_unit(a, share);
    let one = a.constant(1.0);
    let left = a.sub(one, fade);
    let left = a.rounded(left);
    let mixed = |a: &mut A, c: usize| {
        let unfogged = a.mul(input.color[c], left);
        let unfogged = a.rounded(unfogged);
        let fog = a.constant(input.params.back_color[c]);
        let fog = a.mul(fog, fade);
        let fog = a.rounded(fog);
        let sum = a.add(unfogged, fog);
        a.rounded(sum)
    };
    FragmentOutput::of([mixed(a, 0), mixed(a, 1), mixed(a, 2), input.color[3]])
}
