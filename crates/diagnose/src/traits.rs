//! Traits: what distinguishes failing scenes, and how two of them are compared.
//!
//! Scenes with the same states and the same violation form one group of a search. States leave out words,
//! since a bug shows with many of them. A failure matches a known one only if more agrees: the same words,
//! and values on the same side of 0 and 1.

use crate::signature::Signature;
use crate::symptom::{Direction, Symptom, WrongPart, names};
use etalon_frame::{Aspect, Operation};
use etalon_record::Verdict;
use serde_json::Value;
use std::fmt;

/// The traits of a failing scene.
#[derive(Clone, Debug)]
pub struct Traits {
    /// The violation.
    pub way: Violation,
    /// The states of the failing scene.
    pub states: Signature,
    /// The states of the failing scene, with their values.
    pub words: Signature,
    /// The facts of each draw.
    pub draws: Vec<Vec<String>>,
}

/// The wrong part of a result, without names of attachments and earlier contents.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Violation {
    subject: WrongPart,
    /// For a picture, the deciding operations of draws, sorted by name.
    operations: Vec<Operation>,
    /// For a counter, whether it is too high or too low.
    direction: Option<Direction>,
    /// The verdict, if nothing else is known.
    verdict: Option<Verdict>,
}

impl Violation {
    pub(crate) fn of(symptom: &Symptom) -> Self {
        let mut operations = match symptom.subject {
            WrongPart::Picture(_) => symptom.of_draws(),
            _ => Vec::new(),
        };
        operations.sort_unstable_by_key(|operation| operation.name());
        let counter = matches!(symptom.subject, WrongPart::Counter(_));
        let unknown = symptom.subject == WrongPart::Unknown;
        Self {
            subject: symptom.subject.clone(),
            operations,
            direction: symptom.direction.filter(|_| counter),
            verdict: unknown.then_some(symptom.verdict),
        }
    }

    fn may_be_left_of(&self, larger: &Self) -> bool {
        let has = |operation: &Operation| larger.operations.contains(operation);
        self.subject == larger.subject && self.operations.iter().all(has)
    }
}

/// Displays the subject and the deciding operations: `color (blend, store color)`.
impl fmt::Display for Violation {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match (&self.subject, self.direction, self.verdict) {
            (WrongPart::Picture(aspect), ..) => {
                write!(f, "{} ({})", aspect.name(), names(&self.operations))
            }
            (WrongPart::Counter(_), Some(direction), _) => {
                write!(f, "{} counts too {}", self.subject, direction.amount())
            }
            (_, _, Some(verdict)) => f.write_str(verdict.name()),
            (subject, ..) => subject.fmt(f),
        }
    }
}

/// The similarity of a failure to a known one.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Similarity {
    /// The same violation, states and words.
    Same,
    /// The known failure's violation and all its groups of states, possibly with further states.
    Alike,
    /// Several of the known failure's groups of states, but another violation.
    Elsewhere,
}

impl Traits {
    /// Returns the traits of a document that fails with a symptom. `draws` are the facts of each of its draws.
    pub fn of(document: &Value, symptom: &Symptom, draws: Vec<Vec<String>>) -> Self {
        Self {
            way: Violation::of(symptom),
            states: Signature::of(document),
            words: Signature::exact(document),
            draws,
        }
    }

    /// Returns how similar this failure is to a known one; `None` if it lacks a part of the known failure.
    pub fn similarity(&self, known: &Self) -> Option<Similarity> {
        // If this failure does not depend on its vertices, those of the known failure are ignored.
        let own_vertices = self.words != self.words.without_vertices();
        let as_here = |signature: &Signature| {
            if own_vertices {
                signature.clone()
            } else {
                signature.without_vertices()
            }
        };
        if self.way == known.way && self.words == as_here(&known.words) {
            return Some(Similarity::Same);
        }
        let mut states = as_here(&known.states).coarse();
        let several = states.without_formats().without_vertices().len() > 1;
        // A bug with a single state can depend on the format that it was seen in; several states are
        // specific enough.
        if several {
            states = states.without_formats();
        }
        if !states.is_within(&self.states.coarse()) {
            return None;
        }
        let same = if self.aspect().is_some() {
            known.way.may_be_left_of(&self.way)
        } else {
            self.way == known.way
        };
        let pictures = self.aspect().is_some() && known.aspect().is_some();
        if same {
            Some(Similarity::Alike)
        } else {
            (pictures && states.without_formats().len() > 1).then_some(Similarity::Elsewhere)
        }
    }

    /// Returns the aspect of a picture that is wrong.
    pub fn aspect(&self) -> Option<Aspect> {
        match self.way.subject {
            WrongPart::Picture(aspect) => Some(aspect),
            _ => None,
        }
    }

    /// Returns true if reducing the larger failure could give a failure with these traits.
    pub fn may_be_left_of(&self, larger: &Self) -> bool {
        self.way.may_be_left_of(&larger.way)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    fn traits(aspect: Aspect, operations: &[&str], draw: Value) -> Traits {
        let symptom = Symptom {
            verdict: Verdict::Fail,
            subject: WrongPart::Picture(aspect),
            attachment: Some("target".to_owned()),
            operations: operations.iter().map(named).collect(),
            last: None,
            direction: None,
        };
        let document = json!({ "scene": {
            "attachments": { "target": { "format": "rgba8unorm", "size": [1, 1] } },
            "passes": [{ "color": ["target"], "draws": [draw] }], "read": ["target"]
        } });
        Traits::of(&document, &symptom, Vec::new())
    }

    fn named(name: &&str) -> Operation {
        let mut operations = Operation::ALL.iter();
        *operations.find(|o| o.name() == *name).unwrap()
    }

    fn logic(operation: &str) -> Value {
        json!({ "mesh": { "kind": "full" }, "shader": "uniform_color", "logic": operation })
    }

    #[test]
    fn failures_with_the_same_words_and_violation_are_the_same() {
        let logics = ["logic operation", "store color"];
        let xor = traits(Aspect::Color, &logics, logic("xor"));
        assert_eq!(xor.way.to_string(), "color (logic operation, store color)");
        assert_eq!(xor.similarity(&xor), Some(Similarity::Same));
        let other = traits(Aspect::Color, &logics, logic("nor"));
        assert_eq!(xor.similarity(&other), Some(Similarity::Alike));
    }

    #[test]
    fn another_violation_is_similar_if_several_states_are_the_same() {
        let signature = |aspect, operations: &[&str], points: bool| {
            let mut draw = logic("xor");
            if points {
                draw["topology"] = json!("point-list");
            }
            traits(aspect, operations, draw)
        };
        let drawn = |points| signature(Aspect::Color, &["logic operation"], points);
        for (aspect, operation) in [(Aspect::Color, "clear"), (Aspect::Depth, "store depth")] {
            let other = |points| signature(aspect, &[operation], points);
            assert_eq!(other(false).similarity(&drawn(false)), None);
            let similarity = other(true).similarity(&drawn(true));
            assert_eq!(similarity, Some(Similarity::Elsewhere));
        }
    }

    #[test]
    fn vertices_count_only_if_the_failure_needs_its_own() {
        let mut draw = logic("xor");
        let simple = traits(Aspect::Color, &["store color"], draw.clone());
        draw["mesh"] = json!({ "kind": "vertices", "positions": [[0.5, 0.5, 0]] });
        let stored = traits(Aspect::Color, &["store color"], draw);
        assert_eq!(simple.similarity(&stored), Some(Similarity::Same));
        assert_eq!(stored.similarity(&simple), Some(Similarity::Alike));
    }

    #[test]
    fn more_states_are_alike_and_fewer_are_not() {
        let known = traits(Aspect::Color, &["store color"], logic("xor"));
        let mut draw = logic("nor");
        draw["cull"] = json!("back");
        let more = traits(Aspect::Color, &["stencil test", "store color"], draw);
        assert_eq!(more.similarity(&known), Some(Similarity::Alike));
        assert_eq!(known.similarity(&more), None);
        assert!(known.may_be_left_of(&more) && !more.may_be_left_of(&known));
        // Otherwise everything would resemble a failure without states.
        let bare = json!({ "mesh": { "kind": "full" }, "shader": "uniform_color" });
        let bare = traits(Aspect::Color, &["store color"], bare);
        assert_eq!(more.similarity(&bare), None);
        assert_eq!(bare.similarity(&bare), Some(Similarity::Same));
    }
}
