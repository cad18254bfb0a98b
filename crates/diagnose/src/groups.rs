//! Failing scenes in groups: those of one group leave the same states and the same violation when they are reduced.
//!
//! A reduction takes hundreds of drawings, and a driver's commonest bug is in every tenth scene. So a scene that
//! has all states of a group and its violation is counted there, unless the number of its scenes is a power of
//! four: those are reduced, and show what hides behind.

use crate::matching::Match;
use crate::signature::Signature;
use crate::symptom::Symptom;
use crate::traits::{Traits, Violation};
use etalon_record::Verdict;
use serde_json::Value;

/// The traits that tell a group from others.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Key {
    way: Violation,
    /// The reason why the scene was not reduced.
    unreduced: Option<Unreduced>,
    /// The states that are left; `None` if the scene was not reduced.
    states: Option<Signature>,
}

/// A reason why a scene was not reduced.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Unreduced {
    /// The command was stopped before.
    Stopped,
    /// It does not fail by itself.
    Unsteady,
}

impl Key {
    /// Returns the key of a scene that was reduced to a document.
    pub fn reduced(document: &Value, symptom: &Symptom) -> Self {
        let Traits { way, states, .. } = Traits::of(document, symptom);
        Self {
            way,
            unreduced: None,
            states: Some(states),
        }
    }

    /// Returns the key of a scene that was not reduced, with the reason.
    pub fn whole(document: &Value, symptom: &Symptom, why: Unreduced) -> Self {
        Self {
            way: Traits::of(document, symptom).way,
            unreduced: Some(why),
            states: None,
        }
    }
}

/// One way to fail, with what its first scene left.
pub struct Group<S> {
    /// Its first scene, reduced.
    pub scene: S,
    /// The number of scenes.
    pub count: u64,
    /// The number of those that were reduced to it.
    pub reduced: u64,
    /// The verdict.
    pub verdict: Verdict,
    /// The symptom of what is left.
    pub symptom: Symptom,
    /// The traits of what is left.
    pub traits: Traits,
    /// True if it fails by itself, in a new process; before that was tried, if its reduction was one.
    pub steady: bool,
    /// The finding that explains it, or that it is like.
    pub known: Option<Match>,
    key: Key,
    /// The states that other scenes of the group have too: a reduction replaces formats of depth and stencil.
    common: Option<Signature>,
}

impl<S> Group<S> {
    /// Returns the group of a first scene, of which this document is left.
    pub fn new(scene: S, document: &Value, symptom: Symptom, key: Key) -> Self {
        Self {
            scene,
            count: 1,
            reduced: 1,
            verdict: symptom.verdict,
            traits: Traits::of(document, &symptom),
            steady: key.states.is_some(),
            known: None,
            common: key.states.as_ref().map(Signature::without_depth_formats),
            key,
            symptom,
        }
    }

    /// The violation in words, and why the scene was not reduced.
    pub fn way(&self) -> String {
        let Key { way, unreduced, .. } = &self.key;
        match unreduced {
            Some(Unreduced::Stopped) => format!("{way}, not reduced"),
            Some(Unreduced::Unsteady) => format!("{way}, only behind other scenes"),
            None => way.to_string(),
        }
    }

    /// True if all that is left of its first scene belongs to the failure: nearly everything is left of a scene that was
    /// not reduced.
    pub fn can_be_compared(&self) -> bool {
        self.key.states.is_some() || !self.verdict.is_violation()
    }

    /// True if a finding explains it.
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

    /// True if there are none.
    pub fn is_empty(&self) -> bool {
        self.all.is_empty()
    }

    /// Returns the groups.
    pub fn iter_mut(&mut self) -> impl Iterator<Item = &mut Group<S>> {
        self.all.iter_mut()
    }

    /// Counts a scene in a group by its states. Returns the group's number; `None` if it is to be reduced first; that of a
    /// search that is being stopped never is.
    pub fn count(&mut self, document: &Value, symptom: &Symptom, stopped: bool) -> Option<usize> {
        let states = Signature::of(document);
        // Each reduction of a scene that ends its worker costs processes: its states are not asked for.
        let ends = !symptom.verdict.is_violation();
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

    /// Counts a scene that was looked at in the group of its key. Returns the group's number; `None` if there is none.
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
