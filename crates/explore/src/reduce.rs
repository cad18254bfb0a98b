//! The reduction: passes over a document, each a list of edits, until none of them is left that keeps the
//! failure.
//!
//! Every edit takes something away or puts something simpler in its place, so the passes end; their order is
//! fixed, so the same oracle gives the same result. Before a candidate is drawn it must be a case, by the
//! checks of case files, and one that differs from all that were drawn. A candidate of which drivers and judge
//! would see the same scenes is taken without being drawn.

use crate::passes::PASSES;
use etalon_case::{Case, build};
use serde_json::Value;
use std::collections::HashSet;

/// The most candidates that a reduction draws.
pub const MOST_DRAWS: usize = 1000;

/// A smaller case that may still fail.
#[derive(Clone, Debug)]
pub struct Candidate {
    /// The document.
    pub document: Value,
    /// The case that it holds; its id is the path of a case file.
    pub case: Case,
}

/// Something that tells whether a case still fails in the same way.
pub trait Oracle {
    /// Returns the first of the candidates that fails in the same way; `None` if none does. A candidate that
    /// was taken from the iterator counts as drawn.
    fn first(&mut self, candidates: &mut dyn Iterator<Item = Candidate>) -> Option<Candidate>;

    /// Returns column and row of a wrong texel of the candidate that was last returned, or of the case before
    /// all of them.
    fn texel(&self) -> Option<[u32; 2]>;
}

/// The outcome of a reduction.
#[derive(Clone, Debug)]
pub struct Reduction {
    /// The smallest document, and its case.
    pub smallest: Candidate,
    /// The number of candidates that were drawn.
    pub draws: usize,
    /// True if nothing smaller was left to try; false if it ended at the limit.
    pub finished: bool,
}

/// Reduces a case that fails by the oracle, with `most` draws at most. Cases that cannot be drawn are not asked
/// about.
pub fn reduce(
    failing: Candidate,
    most: usize,
    can_draw: &dyn Fn(&Case) -> bool,
    oracle: &mut dyn Oracle,
) -> Reduction {
    let mut state = State {
        can_draw,
        id: failing.case.id.clone(),
        current: failing,
        seen: HashSet::new(),
        draws: 0,
        most,
    };
    state.seen.insert(state.current.document.to_string());
    loop {
        let before = state.current.document.clone();
        for pass in PASSES {
            state.exhaust(*pass, oracle);
        }
        if state.draws >= most || state.current.document == before {
            break;
        }
    }
    Reduction {
        finished: state.draws < most,
        smallest: state.current,
        draws: state.draws,
    }
}

struct State<'a> {
    can_draw: &'a dyn Fn(&Case) -> bool,
    id: String,
    current: Candidate,
    /// The documents that were tried.
    seen: HashSet<String>,
    draws: usize,
    most: usize,
}

impl State<'_> {
    /// Tries all edits of a pass. After one that is kept, it goes on at the same place of the list of the new
    /// document: what stood before was tried.
    fn exhaust(&mut self, pass: crate::passes::Pass, oracle: &mut dyn Oracle) {
        let mut start = 0;
        loop {
            let edits = pass(&self.current.document, oracle.texel());
            // Of each candidate, the edit that made it.
            let mut drawn: Vec<usize> = Vec::new();
            let mut same = None;
            let Self {
                can_draw,
                id,
                current,
                seen,
                draws,
                most,
            } = self;
            let mut at = start;
            let mut candidates = std::iter::from_fn(|| {
                while same.is_none() && *draws < *most {
                    let edit = edits.get(at)?;
                    at += 1;
                    let Some(document) = edit.apply(&current.document) else {
                        continue;
                    };
                    if !seen.insert(document.to_string()) {
                        continue;
                    }
                    let Ok(case) = build(id, &document) else {
                        continue;
                    };
                    let candidate = Candidate { document, case };
                    if is_same(&candidate.case, &current.case) {
                        same = Some((at - 1, candidate));
                        return None;
                    }
                    if !can_draw(&candidate.case) {
                        continue;
                    }
                    *draws += 1;
                    drawn.push(at - 1);
                    return Some(candidate);
                }
                None
            });
            let found = oracle.first(&mut candidates);
            let kept = match (found, same) {
                (Some(candidate), _) => {
                    let made = |i: &usize| edits[*i].apply(&self.current.document);
                    let due = Some(&candidate.document);
                    let edit = drawn.iter().find(|i| made(i).as_ref() == due);
                    edit.map(|edit| (*edit, candidate))
                }
                (None, same) => same,
            };
            let Some((edit, candidate)) = kept else {
                return;
            };
            self.current = candidate;
            start = edit;
        }
    }
}

/// True if drivers and judge see the same.
fn is_same(a: &Case, b: &Case) -> bool {
    a.scene == b.scene
        && a.judged_as == b.judged_as
        && a.variants == b.variants
        && a.relation == b.relation
        && a.expect == b.expect
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    /// An oracle that is a condition on the document, and notes every candidate.
    struct Condition<F> {
        holds: F,
        asked: Vec<Value>,
    }

    impl<F: FnMut(&Value) -> bool> Oracle for Condition<F> {
        fn first(&mut self, candidates: &mut dyn Iterator<Item = Candidate>) -> Option<Candidate> {
            for candidate in candidates {
                self.asked.push(candidate.document.clone());
                if (self.holds)(&candidate.document) {
                    return Some(candidate);
                }
            }
            None
        }

        fn texel(&self) -> Option<[u32; 2]> {
            Some([5, 3])
        }
    }

    /// The random scene of a seed.
    fn random(flavor: &str, seed: u64) -> Candidate {
        let library = etalon_case::Library::built_in().unwrap();
        let id = format!("combined/{flavor}/seed={seed}");
        let all = etalon_case::Profile::Full;
        let case = library.cases(all).find(|c| c.id() == id).unwrap();
        let document = case.document().unwrap();
        let case = build("t", &document).unwrap();
        Candidate { document, case }
    }

    fn reduced(
        failing: &Candidate,
        most: usize,
        holds: impl FnMut(&Value) -> bool,
    ) -> (Reduction, Vec<Value>) {
        let asked = Vec::new();
        let mut oracle = Condition { holds, asked };
        let reduction = reduce(failing.clone(), most, &|_| true, &mut oracle);
        assert_eq!(reduction.draws, oracle.asked.len());
        (reduction, oracle.asked)
    }

    fn draws(document: &Value) -> Vec<&Value> {
        let passes = document["scene"]["passes"].as_array().into_iter().flatten();
        passes
            .flat_map(|p| p["draws"].as_array().into_iter().flatten())
            .collect()
    }

    #[test]
    fn what_the_oracle_does_not_ask_for_goes() {
        let failing = random("extended", 16);
        assert!(
            draws(&failing.document)
                .iter()
                .any(|d| d.get("logic").is_some())
        );
        let holds = |d: &Value| {
            let read = d["scene"]["read"].as_array();
            read.is_some_and(|r| r.contains(&json!("color")))
                && draws(d).iter().any(|d| d["logic"].is_string())
        };
        let (reduction, _) = reduced(&failing, MOST_DRAWS, holds);
        assert!(reduction.finished);
        let due = json!({
            "attachments": { "color": { "format": "rgba8unorm", "size": [1, 1] } },
            "passes": [{ "color": ["color"], "draws": [
                { "mesh": { "kind": "full" }, "shader": "uniform_color", "logic": "copy" }
            ] }],
            "read": ["color"]
        });
        assert_eq!(reduction.smallest.document["scene"], due);
    }

    #[test]
    fn a_nested_state_keeps_its_value_and_loses_its_neighbours() {
        let failing = random("common", 3);
        let op = |d: &Value| d["stencil"]["front"]["pass_op"].clone();
        let due = draws(&failing.document)
            .into_iter()
            .map(op)
            .find(|v| *v != "keep");
        let due = due.unwrap();
        let holds = |d: &Value| {
            let read = d["scene"]["read"]
                .as_array()
                .is_some_and(|r| r.contains(&json!("depth")));
            read && draws(d).iter().any(|d| op(d) == due)
        };
        let (reduction, _) = reduced(&failing, MOST_DRAWS, holds);
        let document = &reduction.smallest.document;
        let all = draws(document);
        assert_eq!(all.len(), 1);
        let due = json!({ "front": { "compare": "always", "pass_op": due } });
        assert_eq!(all[0]["stencil"], due);
        assert_eq!(all[0].as_object().unwrap().len(), 3);
        assert_eq!(document["scene"]["read"], json!(["depth"]));
        assert_eq!(
            document["scene"]["attachments"]["depth"]["format"],
            "stencil8"
        );
    }

    #[test]
    fn a_reduction_is_the_same_every_time_and_asks_nothing_twice() {
        let failing = random("multisample", 7);
        let holds = |d: &Value| d.to_string().contains("alpha_to_") && draws(d).len() > 1;
        let (one, asked) = reduced(&failing, MOST_DRAWS, holds);
        let (other, again) = reduced(&failing, MOST_DRAWS, holds);
        assert_eq!(one.smallest.document, other.smallest.document);
        assert_eq!(asked, again);
        let texts: HashSet<String> = asked.iter().map(Value::to_string).collect();
        assert_eq!(texts.len(), asked.len());
    }

    #[test]
    fn every_candidate_is_a_case_and_the_limit_holds() {
        let failing = random("common", 0);
        let mut count = 0;
        let (reduction, asked) = reduced(&failing, 40, |_| {
            count += 1;
            count % 3 == 0
        });
        assert_eq!((reduction.draws, reduction.finished), (40, false));
        assert!(asked.iter().all(|document| build("t", document).is_ok()));
        let (nothing, _) = reduced(&failing, MOST_DRAWS, |_| false);
        assert_eq!(nothing.smallest.case.scene, failing.case.scene);
    }

    #[test]
    fn what_cannot_be_drawn_is_not_asked_about() {
        let failing = random("common", 1);
        let mut oracle = Condition {
            holds: |_: &Value| true,
            asked: Vec::new(),
        };
        let can_draw = |case: &Case| case.scene.passes.iter().any(|p| p.draws.len() > 1);
        let reduction = reduce(failing, MOST_DRAWS, &can_draw, &mut oracle);
        assert_eq!(draws(&reduction.smallest.document).len(), 2);
        assert!(oracle.asked.iter().all(|d| draws(d).len() > 1));
    }
}
