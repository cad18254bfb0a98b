//! Cases.

use crate::relation::Relation;
use crate::variants::Variant;
use etalon_frame::Requirement;
use etalon_methods::Method;
use etalon_scene::Scene;
use std::collections::BTreeSet;

/// One fully expanded unit of work.
#[derive(Clone, Debug)]
pub struct Case {
    /// The stable id.
    pub id: String,
    /// The purpose, in a sentence.
    pub about: String,
    /// The clauses that bind.
    pub spec: Vec<String>,
    /// The scene that adapters draw.
    pub scene: Scene,
    /// Selftests: the scene that the frame is judged as; a Fail is due.
    pub judged_as: Option<Scene>,
    /// The scene with changes, each drawn too.
    pub variants: Vec<Variant>,
    /// The relation between the frames of scene and variants.
    pub relation: Option<Relation>,
    /// Literal values that must come back.
    pub expect: Vec<Expect>,
    /// The method of a method case, whose distance from the truth is measured.
    pub method: Option<Method>,
}

/// One literal colour that must come back.
#[derive(Clone, Debug, PartialEq)]
pub struct Expect {
    /// Index into the scene's attachments.
    pub attachment: usize,
    /// Column and row.
    pub texel: [u32; 2],
    /// The values, channel by channel.
    pub value: Vec<f64>,
}

impl Case {
    /// Returns the scene that the frame is judged as.
    pub fn judged_scene(&self) -> &Scene {
        self.judged_as.as_ref().unwrap_or(&self.scene)
    }

    /// Returns all scenes that adapters draw for the case: the scene, then its variants.
    pub fn scenes(&self) -> impl Iterator<Item = &Scene> {
        let variants = self.variants.iter().map(|v| &v.scene);
        std::iter::once(&self.scene).chain(variants)
    }

    /// Returns the number of scenes.
    pub fn scene_count(&self) -> usize {
        1 + self.variants.len()
    }

    /// Returns the requirements of the case, without repetition, in ascending order.
    pub fn requirements(&self) -> Vec<Requirement> {
        let all: BTreeSet<_> = self.scenes().flat_map(Scene::requirements).collect();
        all.into_iter().collect()
    }

    /// Returns true if the case draws what a version of an API may require of every adapter. There, an
    /// adapter that denies what its version requires fails.
    pub fn is_requirement(&self) -> bool {
        self.id.starts_with("capabilities/required/")
    }

    /// Returns the first part of the id.
    pub fn area(&self) -> &str {
        self.id.split('/').next().unwrap_or_default()
    }
}
