//! Stencil effects: outlines, a mirror, shadow volumes.

mod claims;
mod lessons;
mod mirror;
mod outlines;
mod shadows;
mod shown;

pub(crate) use claims::CLAIMS;
pub(crate) use lessons::LESSONS;

use crate::error::{ParameterError, within};
use crate::method_scene::MethodScene;
use crate::stage::{SIZE, Stage};
use crate::truth::{TexelCoverage, Truth};
use etalon_frame::TextureFormat;
use schemars::JsonSchema;
use serde::Deserialize;

/// An effect, and the method that draws it.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(tag = "scene", rename_all = "kebab-case", deny_unknown_fields)]
pub enum StencilEffectsWire {
    /// Overlapping objects with outlines.
    Outlines {
        /// The method.
        method: outlines::OutlineMethod,
        /// The width of the outlines in texels, 0.5 to 24.
        width: f64,
    },
    /// Boxes above a mirror on the ground.
    Mirror {
        /// The method for the reflection.
        method: mirror::MirrorMethod,
        /// The sideways distance of the boxes from the mirror's middle, 0 to 3; the mirror is 2.4 wide.
        shift: f64,
    },
    /// Cards in parallel rays of light, which cast shadows on each other and on a wall.
    ShadowVolume {
        /// The sides of volumes that are counted.
        method: shadows::ShadowMethod,
        /// The distance of the near plane behind the picture's plane, -1 to 0.8. Cards are at 0.1, 0.3 and
        /// 0.5, and the wall is at 0.9.
        eye: f64,
    },
}

pub(crate) fn make(wire: &StencilEffectsWire) -> Result<MethodScene, ParameterError> {
    let shown = match *wire {
        StencilEffectsWire::Outlines { method, width } => {
            within("width", width, 0.5..=24.0)?;
            outlines::show(method, width)
        }
        StencilEffectsWire::Mirror { method, shift } => {
            within("shift", shift, 0.0..=3.0)?;
            mirror::show(method, shift)
        }
        StencilEffectsWire::ShadowVolume { method, eye } => {
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
        coverage: TexelCoverage::Center,
        surfaces: shown.surfaces,
    };
    Ok(MethodScene {
        scene: stage.read(&[picture]),
        truth,
    })
}
