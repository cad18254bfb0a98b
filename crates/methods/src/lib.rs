//! Method cases: what each rendering method draws of a scene, and what should be seen.
//!
//! Methods are written once, over the scene model; every backend draws what comes out. A module per
//! question holds its scenes, its methods and the truth.

mod accumulation;
mod anti_aliasing;
mod culling;
mod cut_outs;
mod depth_precision;
mod depth_shown;
mod error;
mod picture;
mod stage;
mod stencil_effects;
#[cfg(test)]
mod tests;
mod transparency;
mod view;
mod visibility_cost;

pub use error::ParameterError;
pub use picture::{Coverage, Method, Paint, Parameter, Surface, Texture, Truth};

use etalon_scene::Scene;
use schemars::JsonSchema;
use serde::Deserialize;

/// Width and height of a method's picture in texels, where a scene does not ask for another.
pub(crate) const SIZE: [u32; 2] = [128, 128];

/// A scene drawn by a method, by question.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(tag = "question", rename_all = "kebab-case")]
pub enum MethodWire {
    /// How see-through surfaces are put together.
    Transparency(transparency::Wire),
    /// How holes in a texture are drawn.
    CutOuts(cut_outs::Wire),
    /// How edges are smoothed.
    AntiAliasing(anti_aliasing::Wire),
    /// Which depths can be told apart.
    DepthPrecision(depth_precision::Wire),
    /// What it costs to find out what is in front.
    VisibilityCost(visibility_cost::Wire),
    /// What culling leaves out.
    Culling(culling::Wire),
    /// What is done with a stencil.
    StencilEffects(stencil_effects::Wire),
    /// What blending many times adds up to.
    Accumulation(accumulation::Wire),
    /// How depth is shown.
    DepthShown(depth_shown::Wire),
}

/// A scene and what should be seen of it.
pub struct Made {
    /// What adapters draw; the first attachment that is read back is the picture.
    pub scene: Scene,
    /// What should be seen.
    pub truth: Truth,
}

/// Draws a scene by a method.
///
/// # Errors
/// When a parameter is out of its range, or a method does not know the scene.
pub fn make(wire: &MethodWire) -> Result<Made, ParameterError> {
    match wire {
        MethodWire::Transparency(wire) => transparency::make(wire),
        MethodWire::CutOuts(wire) => cut_outs::make(wire),
        MethodWire::AntiAliasing(wire) => anti_aliasing::make(wire),
        MethodWire::DepthPrecision(wire) => depth_precision::make(wire),
        MethodWire::VisibilityCost(wire) => visibility_cost::make(wire),
        MethodWire::Culling(wire) => culling::make(wire),
        MethodWire::StencilEffects(wire) => stencil_effects::make(wire),
        MethodWire::Accumulation(wire) => accumulation::make(wire),
        MethodWire::DepthShown(wire) => depth_shown::make(wire),
    }
}

/// Refuses a parameter outside of its range.
pub(crate) fn within(
    key: &str,
    value: f64,
    range: std::ops::RangeInclusive<f64>,
) -> Result<f64, ParameterError> {
    if range.contains(&value) {
        return Ok(value);
    }
    let message = format!("{} to {} is possible", range.start(), range.end());
    Err(ParameterError::new(key, message))
}
