//! Twin of `shaders/sampled_color.wgsl`.

use super::{FragmentInput, FragmentOutput};
use crate::arithmetic::Arithmetic;

pub(super) fn fragment<A: Arithmetic>(
    input: &FragmentInput<'_, A::Real>,
) -> FragmentOutput<A::Real> {
    FragmentOutput {
        color: input.texels[0],
        second: None,
        depth: None,
        kept: None,
    }
}
