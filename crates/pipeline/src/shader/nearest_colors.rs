//! Twin of `shaders/nearest_colors.wgsl`. The caller stores the colour in a node of the fragment's depth.

use super::arithmetic::{premultiplied, product};
use super::interface::{FragmentInput, FragmentOutput, List, Node};
use crate::arithmetic::Arithmetic;

pub(super) fn fragment<A: Arithmetic>(
    a: &mut A,
    input: &FragmentInput<'_, A::Real>,
) -> FragmentOutput<A::Real> {
    let zero = a.constant(0.0);
    // The share of the fragment that belongs to the tail: 1, unless a node without a colour has its depth.
    let tail = match input.list {
        List::Unknown => a.div(zero, zero),
        List::Known(nodes) => {
            let one = a.constant(1.0);
            nodes.iter().fold(one, |tail, node| {
                let nearer = a.select_less(input.depth, node.depth, tail, zero);
                a.select_less(node.depth, input.depth, tail, nearer)
            })
        }
    };
    let sum = std::array::from_fn(|c| {
        let source = premultiplied(a, input.color, c);
        product(a, source, tail)
    });
    let alpha = product(a, input.color[3], tail);
    FragmentOutput {
        others: Some([[alpha; 4], [zero; 4]]),
        node: Some(Node {
            color: input.color,
            depth: input.depth,
        }),
        ..FragmentOutput::of(sum)
    }
}
