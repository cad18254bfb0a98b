//! What is done with a stencil: outlines, a mirror, shadow volumes.

mod mirror;
mod outlines;
mod shadows;

use super::stage::{self, Polygon, Stage};
use super::{Made, SIZE, within};
use crate::error::ParameterError;
use crate::picture::{Coverage, Surface, Truth};
use etalon_frame::TextureFormat;
use etalon_scene::{CompareFunction, Draw, Shader, StencilFace, StencilOperation, StencilState};
use schemars::JsonSchema;
use serde::Deserialize;

/// An effect, and how it is drawn.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(tag = "scene", rename_all = "kebab-case", deny_unknown_fields)]
pub enum Wire {
    /// Overlapping objects with outlines.
    Outlines {
        /// How they are drawn.
        method: outlines::MethodName,
        /// Of the outlines, in texels, 0.5 to 24.
        width: f64,
    },
    /// Boxes above a mirror that lies on the ground.
    Mirror {
        /// How the reflection is drawn.
        method: mirror::MethodName,
        /// How far to the side of the mirror's middle the boxes are, 0 to 3; the mirror is 2.4 wide.
        shift: f64,
    },
    /// Cards in parallel rays of light, which cast shadows on each other and on a wall.
    ShadowVolume {
        /// What is counted.
        method: shadows::MethodName,
        /// How far behind the picture's plane the near plane lies, -1 to 0.8: cards stand at 0.1, 0.3
        /// and 0.5, the wall at 0.9.
        eye: f64,
    },
}

pub(crate) fn make(wire: &Wire) -> Result<Made, ParameterError> {
    let shown = match *wire {
        Wire::Outlines { method, width } => {
            within("width", width, 0.5..=24.0)?;
            outlines::show(method, width)
        }
        Wire::Mirror { method, shift } => {
            within("shift", shift, 0.0..=3.0)?;
            mirror::show(method, shift)
        }
        Wire::ShadowVolume { method, eye } => {
            within("eye", eye, -1.0..=0.8)?;
            shadows::show(method, eye)
        }
    };
    let mut stage = Stage::new();
    let [r, g, b] = shown.background;
    let format = TextureFormat::Rgba8Unorm;
    let picture = stage.color("picture", format, SIZE, [r, g, b, 1.0]);
    let depth = stage.depth("depth", TextureFormat::Depth24PlusStencil8, SIZE, 1, 1.0);
    stage.pass(&[picture], Some(depth), shown.draws);
    let truth = Truth {
        size: SIZE,
        background: shown.background,
        coverage: Coverage::Center,
        surfaces: shown.surfaces,
    };
    Ok(Made {
        scene: stage.read(&[picture]),
        truth,
    })
}

/// What an effect looks like.
struct Shown {
    background: [f64; 3],
    draws: Vec<Draw>,
    surfaces: Vec<Surface>,
}

/// A draw of opaque triangles with a depth test.
fn opaque(polygons: &[Polygon]) -> Draw {
    let mut draw = stage::draw(Shader::FlatColor, stage::mesh(SIZE, polygons));
    draw.depth = stage::depth(CompareFunction::Less, true);
    draw
}

/// A stencil test that changes nothing.
fn test(compare: CompareFunction, reference: u8) -> StencilFace {
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

/// The same for both faces.
fn both(face: StencilFace) -> Option<StencilState> {
    Some(StencilState {
        front: face,
        back: face,
    })
}

/// Leaves a reference wherever something is drawn.
fn mark(reference: u8) -> Option<StencilState> {
    both(StencilFace {
        pass_op: StencilOperation::Replace,
        ..test(CompareFunction::Always, reference)
    })
}

/// Draws only where there is the reference.
fn only(reference: u8) -> Option<StencilState> {
    both(test(CompareFunction::Equal, reference))
}

/// Draws only where there is something else.
fn except(reference: u8) -> Option<StencilState> {
    both(test(CompareFunction::NotEqual, reference))
}
