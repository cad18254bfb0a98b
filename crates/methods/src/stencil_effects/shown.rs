//! The draws of an effect, and the stencil states that effects share.

use crate::polygon::{self, Polygon};
use crate::stage::{self, SIZE};
use crate::truth::FlatSurface;
use etalon_scene::{CompareFunction, Draw, Shader, StencilFace, StencilOperation, StencilState};

/// The draws of an effect and the surfaces that should be seen.
pub(super) struct ShownEffect {
    pub(super) background: [f64; 3],
    pub(super) draws: Vec<Draw>,
    pub(super) surfaces: Vec<FlatSurface>,
}

/// Returns a draw of opaque triangles with a depth test.
pub(super) fn opaque(polygons: &[Polygon]) -> Draw {
    let mut draw = stage::draw(Shader::FlatColor, polygon::mesh(SIZE, polygons));
    draw.depth = stage::depth(CompareFunction::Less, true);
    draw
}

/// Returns a stencil test that does not change the stencil.
pub(super) fn test(compare: CompareFunction, reference: u8) -> StencilFace {
    StencilFace {
        compare,
        fail_op: StencilOperation::Keep,
        depth_fail_op: StencilOperation::Keep,
        pass_op: StencilOperation::Keep,
        read_mask: 0xff,
        write_mask: 0xff,
        reference,
    }
}

/// Returns the state with the same test for both faces.
fn both(face: StencilFace) -> Option<StencilState> {
    Some(StencilState {
        front: face,
        back: face,
    })
}

/// Returns a state that stores the reference wherever something is drawn.
pub(super) fn mark(reference: u8) -> Option<StencilState> {
    both(StencilFace {
        pass_op: StencilOperation::Replace,
        ..test(CompareFunction::Always, reference)
    })
}

/// Returns a state that draws only where the stencil equals the reference.
pub(super) fn only(reference: u8) -> Option<StencilState> {
    both(test(CompareFunction::Equal, reference))
}

/// Returns a state that draws only where the stencil differs from the reference.
pub(super) fn except(reference: u8) -> Option<StencilState> {
    both(test(CompareFunction::NotEqual, reference))
}
