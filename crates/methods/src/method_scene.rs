//! Scenes of methods.

use crate::truth::Truth;
use etalon_scene::Scene;

/// A scene and its truth.
pub struct MethodScene {
    /// The scene; the first attachment that is read back is the picture.
    pub scene: Scene,
    /// The picture that should be seen.
    pub truth: Truth,
}
