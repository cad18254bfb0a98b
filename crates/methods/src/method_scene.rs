//! Scenes of methods.

use crate::truth::Truth;
use etalon_scene::Scene;

/// A scene and what should be seen of it.
pub struct MethodScene {
    /// The scene; the first attachment that is read back is the picture.
    pub scene: Scene,
    /// Returns the truth.
    pub truth: Truth,
}
