//! The questions that methods answer, each with its scenes and methods.

use crate::claim::Claim;
use crate::error::ParameterError;
use crate::lesson::Lesson;
use crate::method_scene::MethodScene;
use crate::order::Order;
use crate::{
    accumulation, anti_aliasing, culling, cut_outs, depth_precision, depth_shown, stencil_effects,
    texture_sampling, transparency, visibility_cost,
};
use schemars::JsonSchema;
use serde::Deserialize;

/// A scene and the method that draws it, by question.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(tag = "question", rename_all = "kebab-case")]
pub enum MethodWire {
    /// Transparency: the composition of surfaces that let light through.
    Transparency(transparency::TransparencyWire),
    /// Cut-outs: holes in a texture.
    CutOuts(cut_outs::Wire),
    /// Anti-aliasing.
    AntiAliasing(anti_aliasing::AntiAliasingWire),
    /// Depth precision.
    DepthPrecision(depth_precision::DepthPrecisionWire),
    /// The cost of visibility.
    VisibilityCost(visibility_cost::VisibilityWire),
    /// Culling.
    Culling(culling::CullingWire),
    /// Stencil effects.
    StencilEffects(stencil_effects::StencilEffectsWire),
    /// The rounding errors of repeated blending.
    Accumulation(accumulation::AccumulationWire),
    /// Depth shown as a colour.
    DepthShown(depth_shown::DepthShownWire),
    /// The sampling of a texture without smaller levels.
    TextureSampling(texture_sampling::Wire),
}

/// The questions, the ones that most people ask first.
pub const QUESTIONS: [&str; 10] = [
    "transparency",
    "anti-aliasing",
    "cut-outs",
    "texture-sampling",
    "depth-precision",
    "stencil-effects",
    "culling",
    "visibility-cost",
    "accumulation",
    "depth-shown",
];

/// Draws a scene by a method.
///
/// # Errors
/// If a parameter is out of its range, or if the method does not support the scene.
pub fn make(wire: &MethodWire) -> Result<MethodScene, ParameterError> {
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
        MethodWire::TextureSampling(wire) => texture_sampling::make(wire),
    }
}

/// Returns every claim of the literature about methods, by question.
pub fn claims() -> impl Iterator<Item = &'static Claim> {
    [
        transparency::CLAIMS,
        anti_aliasing::CLAIMS,
        cut_outs::CLAIMS,
        culling::CLAIMS,
        visibility_cost::CLAIMS,
        depth_precision::CLAIMS,
        stencil_effects::CLAIMS,
        accumulation::CLAIMS,
        texture_sampling::CLAIMS,
    ]
    .into_iter()
    .flatten()
}

/// Returns the part that the order of draws plays for a method, if it plays any.
pub fn order(question: &str, method: &str) -> Option<Order> {
    let lesson = lessons(question)
        .iter()
        .find(|lesson| lesson.method == method);
    lesson?.order
}

/// Returns the explanations of a question's methods; empty for an unknown question.
pub fn lessons(question: &str) -> &'static [Lesson] {
    match question {
        "transparency" => transparency::LESSONS,
        "cut-outs" => cut_outs::LESSONS,
        "anti-aliasing" => anti_aliasing::LESSONS,
        "depth-precision" => depth_precision::LESSONS,
        "visibility-cost" => visibility_cost::LESSONS,
        "culling" => culling::LESSONS,
        "stencil-effects" => stencil_effects::LESSONS,
        "accumulation" => accumulation::LESSONS,
        "depth-shown" => depth_shown::LESSONS,
        "texture-sampling" => texture_sampling::LESSONS,
        _ => &[],
    }
}
