//! The sequence of scenes of a seed.
//!
//! Several random scenes are made, and the one with the most new pairs of states is drawn. The scenes
//! therefore depend on the seed, their number and what the adapters support, but never on what a driver
//! does.

use crate::choices::Choices;
use crate::pairs::Pairs;
use crate::reduce::Candidate;
use crate::scenes::{self, Made};
use crate::space::Space;
use etalon_case::{Case, build};
use etalon_frame::mix;
use serde_json::{Value, json};
use std::cmp::Reverse;

/// The number of scenes that are made per drawn scene.
const CANDIDATES: usize = 3;
/// The maximum number of scenes that are made before giving up.
const MAX_CANDIDATES: u64 = 24;

/// A random scene.
#[derive(Clone, Debug)]
pub struct RandomScene {
    /// The scene's index, from 0.
    pub index: u64,
    /// The case and its document.
    pub candidate: Candidate,
}

/// Makes random scenes.
#[derive(Clone, Debug)]
pub struct Fuzzer {
    seed: u64,
    next: u64,
    space: Space,
    pairs: Pairs,
    /// The number of scenes from which the best one is taken.
    made: usize,
}

impl Fuzzer {
    /// Creates the sequence of scenes of a seed in a space.
    pub fn new(seed: u64, space: Space) -> Self {
        Self {
            seed,
            next: 0,
            space,
            pairs: Pairs::default(),
            made: CANDIDATES,
        }
    }

    /// Returns the next scene that can be drawn; `None` if no attempt gave one.
    pub fn scene(&mut self, can_draw: &dyn Fn(&Case) -> bool) -> Option<RandomScene> {
        let index = self.next;
        self.next += 1;
        let mut attempts = 0..MAX_CANDIDATES;
        loop {
            let attempts = attempts.by_ref().take(self.made);
            let mut candidates: Vec<(usize, Made)> = attempts
                .map(|attempt| {
                    let choices = Choices::by_seed(mixed([self.seed, index, attempt]));
                    let made = scenes::scene(choices, &self.space);
                    (self.pairs.new_in(&made.scopes), made)
                })
                .collect();
            if candidates.is_empty() {
                return None;
            }
            // Checking a scene takes longer than making it, so the best scene is checked first.
            candidates.sort_by_key(|(pairs, _)| Reverse(*pairs));
            for (_, made) in candidates {
                let candidate = self.candidate(index, &made);
                if let Some(candidate) = candidate.filter(|c| can_draw(&c.case)) {
                    self.pairs.add(&made.scopes);
                    return Some(RandomScene { index, candidate });
                }
            }
        }
    }

    /// Returns the number of pairs of states that the scenes have covered.
    pub fn pairs(&self) -> usize {
        self.pairs.met()
    }

    /// Returns the number of states that the scenes have covered.
    pub fn states(&self) -> usize {
        self.pairs.states()
    }

    fn candidate(&self, index: u64, made: &Made) -> Option<Candidate> {
        let mut document = document(self.seed, index, made);
        let id = format!("found/seed-{}.{index}", self.seed);
        let mut case = build(&id, &document);
        // The path can be one that this scene cannot take.
        let scene = document["scene"].as_object_mut();
        if case.is_err() && scene.is_some_and(|scene| scene.remove("path").is_some()) {
            case = build(&id, &document);
        }
        let case = case.ok()?;
        Some(Candidate { document, case })
    }
}

fn document(seed: u64, index: u64, made: &Made) -> Value {
    let mut document = json!({
        "about": format!("Random scene {index} of seed {seed}."),
        "spec": [],
        "scene": made.scene
    });
    if !made.submissions.is_empty() {
        document["submissions"] = json!(made.submissions);
    }
    document
}

/// Mixes several numbers into one, so that neighbours give unrelated results.
fn mixed(parts: [u64; 3]) -> u64 {
    parts.into_iter().fold(0, |seed, part| {
        mix(seed ^ part.wrapping_add(0x9e37_79b9_7f4a_7c15))
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use etalon_frame::{
        Api, ApiVersion, ChannelEncoding, Feature, FormatSupport, Limits, PathValue, Property,
        ReadPath, TextureFormat,
    };
    use std::collections::{BTreeMap, BTreeSet};

    /// Returns the limits of an adapter that supports everything.
    fn everything() -> Limits {
        let support = |format: &TextureFormat| FormatSupport {
            samples: vec![1, 2, 4, 8],
            blendable: format.is_color() && !format.is_integer(),
            depth: vec![ChannelEncoding::Float32],
            read: ReadPath::Copy,
        };
        Limits {
            api: Api::Vulkan,
            version: ApiVersion::new(1, 4),
            properties: Property::ALL.into_iter().collect(),
            sub_pixel_bits: 8,
            viewport_bits: Some(8),
            texel_bits: None,
            max_size: 4096,
            max_storage: None,
            max_color_attachments: 8,
            formats: TextureFormat::ALL
                .iter()
                .map(|f| (*f, support(f)))
                .collect(),
            features: Feature::ALL.into_iter().collect(),
            paths: PathValue::all().into_iter().collect(),
            exempt: BTreeSet::new(),
            sample_positions: BTreeMap::new(),
        }
    }

    #[test]
    fn nearly_all_choices_make_a_valid_scene() {
        let space = Space::of([&everything()]);
        let mut wrong: BTreeMap<String, usize> = BTreeMap::new();
        for seed in 0..2000 {
            let made = scenes::scene(Choices::by_seed(seed), &space);
            let mut document = document(0, seed, &made);
            document["scene"]["path"] = json!({});
            if let Err(error) = build("t", &document) {
                *wrong.entry(error.message).or_default() += 1;
            }
        }
        let count: usize = wrong.values().sum();
        assert!(count < 20, "{wrong:#?}");
    }

    #[test]
    fn the_scenes_of_a_seed_are_the_same_every_time() {
        let scenes = |seed| -> Vec<Value> {
            let mut fuzzer = Fuzzer::new(seed, Space::of([&everything()]));
            let next = std::iter::from_fn(|| fuzzer.scene(&|_| true));
            next.take(20).map(|s| s.candidate.document).collect()
        };
        assert_eq!(scenes(1), scenes(1));
        assert_ne!(scenes(1)[1]["scene"], scenes(2)[1]["scene"]);
    }

    #[test]
    fn weighed_scenes_meet_more_pairs_than_blind_ones() {
        let met = |made: usize| {
            let space = Space::of([&everything()]);
            let mut fuzzer = Fuzzer {
                made,
                ..Fuzzer::new(0, space)
            };
            (0..100).for_each(|_| drop(fuzzer.scene(&|_| true)));
            fuzzer.pairs()
        };
        let (weighed, blind) = (met(CANDIDATES), met(1));
        assert!(weighed > blind + blind / 20, "{weighed} and {blind}");
    }

    #[test]
    fn scenes_ask_only_for_what_an_adapter_has() {
        let mut few = everything();
        few.features.clear();
        few.paths.clear();
        let kept = [
            TextureFormat::Rgba8Unorm,
            TextureFormat::Rgba32Float,
            TextureFormat::Depth32Float,
        ];
        few.formats.retain(|f, _| kept.contains(f));
        let mut fuzzer = Fuzzer::new(0, Space::of([&few]));
        let fits = |case: &Case| few.missing(&case.requirements()).is_none();
        let mut refused = 0;
        for _ in 0..200 {
            let scene = fuzzer.scene(&|_| true).unwrap();
            refused += usize::from(!fits(&scene.candidate.case));
            assert!(fuzzer.scene(&fits).is_some_and(|s| fits(&s.candidate.case)));
        }
        assert!(refused < 30, "{refused} of 200");
    }
}
