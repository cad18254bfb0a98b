//! Groups of failing scenes. The scenes of a group have the same states and the same violation after
//! reduction.
//!
//! A reduction takes hundreds of drawings, and a driver's commonest bug is in every tenth scene. A scene
//! that has all states of a group and its violation is therefore only counted in that group, unless the
//! group's number of scenes is a power of four: such scenes are reduced, and show whether another bug hides
//! in the group.

use crate::matching::Match;
use crate::signature::Signature;
use crate::symptom::Symptom;
use crate::traits::{Traits, Violation};
use etalon_record::Verdict;
use serde_json::Value;

/// The traits that identify a group.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Key {
    way: Violation,
    /// The reason why the scene was not reduced.
    unreduced: Option<Unreduced>,
    /// The states after reduction; `None` if the scene was not reduced.
    states: Option<Signature>,
}

/// The reason why a scene was not reduced.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Unreduced {
    /// The command was stopped earlier.
    Stopped,
    /// The scene does not fail alone.
    Unsteady,
}

impl Key {
    /// Returns the key of a scene that was reduced to a document.
    pub fn reduced(document: &Value, symptom: &Symptom) -> Self {
        Self {
            way: Violation::of(symptom),
            unreduced: None,
            states: Some(Signature::of(document)),
        }
    }

    /// Returns true if the scene was reduced.
    pub fn is_reduced(&self) -> bool {
        self.states.is_some()
    }

    /// Returns the key of a scene that was not reduced, with the reason.
    pub fn whole(symptom: &Symptom, why: Unreduced) -> Self {
        Self {
            way: Violation::of(symptom),
            unreduced: Some(why),
            states: None,
        }
    }
}

/// A way to fail, with the reduced form of its first scene.
pub struct Group<S> {
    /// The group's first scene, reduced.
    pub scene: S,
    /// The number of scenes.
    pub count: u64,
    /// The number of scenes that were reduced to the group's key.
    pub reduced: u64,
    /// The verdict.
    pub verdict: Verdict,
    /// The symptom of the reduced scene.
    pub symptom: Symptom,
    /// The traits of the reduced scene.
    pub traits: Traits,
    /// True if the scene fails alone, in a new process. Until that was tried, true if it was reduced.
    pub steady: bool,
    /// The finding that explains the group, or resembles it.
    pub known: Option<Match>,
    key: Key,
    /// The states that other scenes of the group must have, without depth and stencil formats: a reduction
    /// replaces these.
    common: Option<Signature>,
}

impl<S> Group<S> {
    /// Creates a group from its first scene, given the traits of the reduced scene.
    pub fn new(scene: S, traits: Traits, symptom: Symptom, key: Key) -> Self {
        Self {
            scene,
            count: 1,
            reduced: 1,
            verdict: symptom.verdict,
            traits,
            steady: key.is_reduced(),
            known: None,
            common: key.states.as_ref().map(Signature::without_depth_formats),
            key,
            symptom,
        }
    }

    /// Returns the violation in words, and why the scene was not reduced.
    pub fn way(&self) -> String {
        let Key { way, unreduced, .. } = &self.key;
        match unreduced {
            Some(Unreduced::Stopped) => format!("{way}, not reduced"),
            Some(Unreduced::Unsteady) => format!("{way}, only behind other scenes"),
            None => way.to_string(),
        }
    }

    /// Returns true if all states of the group's first scene belong to the failure. A scene that was not
    /// reduced still has nearly all its states.
    pub fn can_be_compared(&self) -> bool {
        self.key.is_reduced() || !self.symptom.keeps_worker()
    }

    /// Returns true if a finding explains the group.
    pub fn is_explained(&self) -> bool {
        self.known.as_ref().is_some_and(Match::is_exact)
    }
}

/// The groups of one adapter.
pub struct Groups<S> {
    all: Vec<Group<S>>,
}

impl<S> Default for Groups<S> {
    fn default() -> Self {
        Self { all: Vec::new() }
    }
}

impl<S> Groups<S> {
    /// Returns the number of groups.
    pub fn len(&self) -> usize {
        self.all.len()
    }

    /// Returns true if there is no group.
    pub fn is_empty(&self) -> bool {
        self.all.is_empty()
    }

    /// Returns the groups.
    pub fn iter_mut(&mut self) -> impl Iterator<Item = &mut Group<S>> {
        self.all.iter_mut()
    }

    /// Counts a scene in a group by its states, and returns the group's number. Returns `None` if the scene
    /// must be reduced first: if no group has its states or, unless the search is being stopped, if its
    /// group's count becomes a power of four.
    pub fn count(&mut self, document: &Value, symptom: &Symptom, stopped: bool) -> Option<usize> {
        let states = Signature::of(document);
        // Each reduction of a scene that ends its worker costs processes, so the states are not compared.
        let ends = !symptom.keeps_worker();
        let number = self.all.iter().position(|group| {
            let left = group.common.as_ref().filter(|_| group.steady);
            symptom.covers_elsewhere(&group.symptom)
                && (ends || left.is_some_and(|left| left.is_within(&states)))
        })?;
        let group = &mut self.all[number];
        let count = group.count + 1;
        let to_reduce = count.is_power_of_two() && count.trailing_zeros().is_multiple_of(2);
        let counted = stopped || !to_reduce;
        group.count += u64::from(counted);
        counted.then_some(number)
    }

    /// Counts a reduced scene in the group of its key, and returns the group's number; `None` if no group
    /// has this key.
    pub fn count_reduced(&mut self, key: &Key) -> Option<usize> {
        let number = self.all.iter().position(|g| g.key == *key)?;
        let group = &mut self.all[number];
        group.count += 1;
        group.reduced += 1;
        Some(number)
    }

    /// Adds a group, and returns its number.
    pub fn push(&mut self, group: Group<S>) -> usize {
        self.all.push(group);
        self.all.len() - 1
    }

    /// Returns the groups, the commonest first.
    pub fn finish(mut self) -> Vec<Group<S>> {
        self.all.sort_by_key(|g| std::cmp::Reverse(g.count));
        self.all
    }
}
