//! Twin of `shaders/list_compose.wgsl`.

use super::arithmetic::{difference, product, sum};
use super::interface::{FragmentInput, FragmentOutput, List, Node};
use crate::arithmetic::Arithmetic;

pub(super) fn fragment<A: Arithmetic>(
    a: &mut A,
    input: &FragmentInput<'_, A::Real>,
) -> FragmentOutput<A::Real> {
    let List::Known(list) = input.list else {
        let zero = a.constant(0.0);
        return FragmentOutput::of([a.div(zero, zero); 4]);
    };
    let mut nodes = list.to_vec();
    sort(a, &mut nodes);
    let ([red, green, blue], left) = composed(a, &nodes);
    FragmentOutput::of([red, green, blue, left])
}

/// Returns the premultiplied colour of nodes, nearest first, and their transmittance.
pub(super) fn composed<A: Arithmetic>(
    a: &mut A,
    nodes: &[Node<A::Real>],
) -> ([A::Real; 3], A::Real) {
    let (zero, one) = (a.constant(0.0), a.constant(1.0));
    let (mut color, mut left) = ([zero; 3], one);
    for node in nodes {
        let alpha = node.color[3];
        let share = product(a, alpha, left);
        for (sum_of, channel) in color.iter_mut().zip(node.color) {
            let weighted = product(a, channel, share);
            *sum_of = sum(a, *sum_of, weighted);
        }
        let through = difference(a, one, alpha);
        left = product(a, left, through);
    }
    (color, left)
}

/// Sorts nodes by depth, nearest first; nodes at equal depth stay in order. Lanes can differ in their order,
/// so neighbours are compared as often as the worst order requires.
fn sort<A: Arithmetic>(a: &mut A, nodes: &mut [Node<A::Real>]) {
    for end in (1..nodes.len()).rev() {
        for i in 0..end {
            let [this, next] = [nodes[i], nodes[i + 1]];
            let mut choose = |if_nearer: A::Real, otherwise: A::Real| {
                a.select_less(next.depth, this.depth, if_nearer, otherwise)
            };
            let depths = [
                choose(next.depth, this.depth),
                choose(this.depth, next.depth),
            ];
            let colors = [0, 1, 2, 3].map(|c| {
                [
                    choose(next.color[c], this.color[c]),
                    choose(this.color[c], next.color[c]),
                ]
            });
            for (place, depth) in depths.into_iter().enumerate() {
                let color = colors.map(|both| both[place]);
                nodes[i + place] = Node { color, depth };
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::interface::{InputMask, Taps};
    use super::*;
    use crate::plain::Plain;
    use etalon_scene::Params;

    /// Returns the colour, and the transmittance as alpha, of nodes in the order of the list.
    fn composed(list: &[(f32, [f32; 4])]) -> [f32; 4] {
        let nodes: Vec<Node<[f32; 1]>> = list
            .iter()
            .map(|(depth, color)| Node {
                color: color.map(|v| [v]),
                depth: [*depth],
            })
            .collect();
        let input = FragmentInput {
            color: [[0.0]; 4],
            front: true,
            depth: [0.0],
            sample: 0,
            mask: InputMask::NONE,
            position: [[0.5]; 2],
            texels: [[[0.0]; 4]; 2],
            neighbours: None,
            taps: Taps::NONE,
            list: List::Known(&nodes),
            reciprocal_w: [1.0],
            uv: [[0.0]; 2],
            params: &Params::default(),
        };
        fragment(&mut Plain::<1>, &input).color.map(|[v]| v)
    }

    #[test]
    fn nodes_are_composed_nearest_first_whatever_their_order() {
        let near = (0.25, [1.0, 0.0, 0.0, 0.5]);
        let middle = (0.5, [0.0, 1.0, 0.0, 0.5]);
        let far = (0.75, [0.0, 0.0, 1.0, 1.0]);
        for list in [
            [near, middle, far],
            [far, middle, near],
            [middle, far, near],
            [middle, near, far],
        ] {
            assert_eq!(composed(&list), [0.5, 0.25, 0.25, 0.0], "{list:?}");
        }
        assert_eq!(composed(&[]), [0.0, 0.0, 0.0, 1.0]);
    }

    #[test]
    fn of_two_at_one_depth_the_later_is_in_front() {
        let (red, green) = ((0.5, [1.0, 0.0, 0.0, 0.5]), (0.5, [0.0, 1.0, 0.0, 0.5]));
        assert_eq!(composed(&[red, green]), [0.5, 0.25, 0.0, 0.25]);
        assert_eq!(composed(&[green, red]), [0.25, 0.5, 0.0, 0.25]);
    }
}
