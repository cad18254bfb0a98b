//! Cases.

use crate::relation::Relation;
use crate::variants::Variant;
use etalon_frame::CaseId;
use etalon_frame::Requirement;
use etalon_methods::Method;
use etalon_scene::Scene;
use std::collections::BTreeSet;
use std::num::NonZeroU32;

/// A fully expanded case.
#[derive(Clone, Debug)]
pub struct Case {
    /// The file's path without its ending, then each axis with its value: `cull/lines/mode=back`.
    pub id: String,
    /// The purpose, in a sentence, as the case file states it.
    pub about: String,
    /// The clauses that bind the cases.
    pub spec: Vec<String>,
    /// The scene that adapters draw.
    pub scene: Scene,
    /// For selftests, the scene that the frame is judged as; a Fail is expected.
    pub judged_as: Option<Scene>,
    /// Changed copies of the scene, all of them drawn too.
    pub variants: Vec<Variant>,
    /// The relation between the frames of scene and variants.
    pub relation: Option<Relation>,
    /// Values that texels of the frame must have.
    pub expect: Vec<ExpectedTexel>,
    /// True if the case exists to be measured. Its picture can be large, so only a sample of its texels is
    /// judged.
    pub measured: bool,
    /// The method of a method case, whose distance from the truth is measured.
    pub method: Option<Method>,
}

/// A colour that a texel of the frame must have.
#[derive(Clone, Debug, PartialEq)]
pub struct ExpectedTexel {
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

    /// Returns the scenes that are prepared, each with the numbers of submissions before each reading of its
    /// frame. The frames are read in the order of [`Case::scenes`].
    pub fn preparations(&self) -> impl Iterator<Item = (&Scene, Vec<u32>)> {
        let again = self.variants.iter().filter_map(|v| v.submissions);
        let submissions = std::iter::once(1).chain(again.map(NonZeroU32::get));
        let others = self.variants.iter().filter(|v| v.submissions.is_none());
        std::iter::once((&self.scene, submissions.collect()))
            .chain(others.map(|v| (&v.scene, vec![1])))
    }

    /// Returns the index of the scene by which a frame is judged: 0 for the case's own scene, even if it is
    /// read again, otherwise the variant's index plus 1.
    pub fn judged_index(&self, frame: usize) -> usize {
        let variant = frame.checked_sub(1).and_then(|v| self.variants.get(v));
        match variant {
            Some(variant) if variant.submissions.is_none() => frame,
            _ => 0,
        }
    }

    /// Returns the requirements of the case, in ascending order and without duplicates.
    pub fn requirements(&self) -> Vec<Requirement> {
        let requirements: BTreeSet<_> = self.scenes().flat_map(Scene::requirements).collect();
        requirements.into_iter().collect()
    }

    /// The start of the ids of cases for which [`is_requirement`](Self::is_requirement) is true.
    pub const REQUIREMENTS: &str = "capabilities/required/";

    /// Returns true if the case draws what some version of an API requires of every adapter. An adapter that
    /// denies what its version requires then fails.
    pub fn is_requirement(&self) -> bool {
        self.id.starts_with(Self::REQUIREMENTS)
    }

    /// Returns the parts of the id.
    pub fn parts(&self) -> CaseId<'_> {
        CaseId::new(&self.id)
    }
}
