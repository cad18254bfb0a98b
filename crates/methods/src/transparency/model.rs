//! A scene of one's own as glass.

use super::scenes::{GlassScene, Object};
use crate::seen_model::SeenModel;
use crate::truth::TexelCoverage;

impl GlassScene {
    /// Returns the scene that a model's camera sees.
    pub(super) fn of_model(seen: &SeenModel) -> Self {
        let object = |polygons: &Vec<_>| Object {
            polygons: polygons.clone(),
        };
        Self {
            size: seen.size,
            background: seen.background,
            opaque: seen.opaque.clone(),
            objects: seen.transparent.iter().map(object).collect(),
            coverage: TexelCoverage::Center,
        }
    }
}
