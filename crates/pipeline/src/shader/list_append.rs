//! Twin of `shaders/list_append.wgsl`. The caller adds the node to the pool.

use super::interface::{FragmentInput, FragmentOutput, Node};
use crate::arithmetic::Arithmetic;

pub(super) fn fragment<A: Arithmetic>(
    a: &mut A,
    input: &FragmentInput<'_, A::Real>,
) -> FragmentOutput<A::Real> {
    FragmentOutput {
        node: Some(Node {
            color: input.color,
            depth: input.depth,
        }),
        ..FragmentOutput::of([a.constant(0.0); 4])
    }
}
