//! Paths: how a scene reaches the driver.
//!
//! A scene is what is drawn, a path is how. A path contains only choices that do not change the legal set, so
//! the judge and the rasterizer ignore it: they accept every value and draw the scene. A backend lists in its
//! limits which values it supports; each value other than the default is a requirement.

use etalon_frame::{
    PathArea, PathClears, PathClip, PathColors, PathCommands, PathDraws, PathEnd, PathLayers,
    PathPass, PathReads, PathResolves, PathResults, PathStart, PathState, PathTarget, PathTests,
    PathValue, PathViewport, PathViews,
};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// One value for each key. Every adapter supports the defaults.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Path {
    /// The source of attachments' initial contents.
    pub start: PathStart,
    /// The API object for a pass.
    pub pass: PathPass,
    /// The way to set state.
    pub state: PathState,
    /// The part of a texture that serves as an attachment.
    pub target: PathTarget,
    /// The command buffers of a submission.
    pub commands: PathCommands,
    /// The kind of draw calls.
    pub draws: PathDraws,
    /// The route by which an attachment reaches the host.
    pub end: PathEnd,
    /// The render areas that cover the attachments: the whole at once, or half after half.
    pub area: PathArea,
    /// The calls that clear within passes.
    pub clears: PathClears,
    /// The number of times that queries are read.
    pub results: PathResults,
    /// The convention of the clip volume.
    pub clip: PathClip,
    /// Viewports and scissor rectangles.
    pub viewport: PathViewport,
    /// The layers of the attachments, and the way in which draws reach them.
    pub layers: PathLayers,
    /// The tests of aspects that a pass does not have.
    pub tests: PathTests,
    /// The colour attachments of passes.
    pub colors: PathColors,
    /// The way to resolve colors.
    pub resolves: PathResolves,
    /// The format of the textures that color attachments are views of.
    pub views: PathViews,
    /// The way in which shaders read attachments of their own pass.
    pub reads: PathReads,
}

impl Path {
    /// Returns the values that are not the default.
    pub fn values(&self) -> Vec<PathValue> {
        // Destructured so that a new key cannot be forgotten here.
        let Self {
            start,
            pass,
            state,
            target,
            commands,
            draws,
            end,
            area,
            clears,
            results,
            clip,
            viewport,
            layers,
            tests,
            colors,
            resolves,
            views,
            reads,
        } = *self;
        let values = [
            PathValue::Start(start),
            PathValue::Pass(pass),
            PathValue::State(state),
            PathValue::Target(target),
            PathValue::Commands(commands),
            PathValue::Draws(draws),
            PathValue::End(end),
            PathValue::Area(area),
            PathValue::Clears(clears),
            PathValue::Results(results),
            PathValue::Clip(clip),
            PathValue::Viewport(viewport),
            PathValue::Layers(layers),
            PathValue::Tests(tests),
            PathValue::Colors(colors),
            PathValue::Resolves(resolves),
            PathValue::Views(views),
            PathValue::Reads(reads),
        ];
        values.into_iter().filter(|v| !v.is_default()).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_path_names_what_differs_from_the_default() {
        assert!(Path::default().values().is_empty());
        let path = Path {
            start: PathStart::LoadOperation,
            viewport: PathViewport::Array,
            ..Path::default()
        };
        let names: Vec<_> = path.values().iter().map(PathValue::to_string).collect();
        assert_eq!(names, ["start=load-operation", "viewport=array"]);
    }
}
