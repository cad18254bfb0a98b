//! The reduction: applies passes to a document, each a list of edits, until no edit is left that keeps the
//! failure.
//!
//! Every edit removes something or replaces it by something simpler, so the passes end. Their order is
//! fixed, so the same oracle gives the same result. Before a candidate is drawn, it must be a valid case,
//! by the checks of case files, and differ from all candidates drawn so far. A candidate whose scenes are
//! equal for drivers and judge is accepted without being drawn.

use crate::passes::PASSES;
use etalon_case::{Case, build};
use serde_json::Value;
use std::collections::HashSet;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

/// The maximum number of candidates that a reduction draws.
pub const MOST_DRAWS: usize = 1000;
/// The maximum number of candidates and the time limit for all of them, if each candidate can cost a process.
const MOST_LOST: usize = 200;
const LOST_TIME: Duration = Duration::from_secs(60);

/// The limits of a reduction.
#[derive(Clone, Copy, Debug)]
pub struct ReductionLimits<'a> {
    /// The maximum number of candidates that are drawn.
    pub draws: usize,
    /// The time after which no candidate is tried.
    pub until: Option<Instant>,
    /// Set when the search must stop.
    pub stop: Option<&'a AtomicBool>,
}

impl<'a> ReductionLimits<'a> {
    /// Limits how often scenes are drawn, but not the time.
    pub fn draws(draws: usize) -> Self {
        Self {
            draws,
            until: None,
            stop: None,
        }
    }

    /// Returns the budget for a case that ends its process.
    pub fn of_processes() -> Self {
        Self {
            until: Some(Instant::now() + LOST_TIME),
            ..Self::draws(MOST_LOST)
        }
    }

    /// Sets the flag that stops the search.
    #[must_use]
    pub fn with_stop(self, stop: Option<&'a AtomicBool>) -> Self {
        Self { stop, ..self }
    }

    fn is_over(&self) -> bool {
        self.until.is_some_and(|until| Instant::now() >= until)
            || self.stop.is_some_and(|stop| stop.load(Ordering::Relaxed))
    }
}

/// A smaller case that may still fail.
#[derive(Clone, Debug)]
pub struct Candidate {
    /// The document.
    pub document: Value,
    /// The case in the document; its id is the path of a case file.
    pub case: Case,
}

/// Decides whether a case still fails in the same way.
pub trait Oracle {
    /// Returns the first candidate that fails in the same way; `None` if none does. A candidate that was
    /// taken from the iterator counts as drawn.
    fn first(&mut self, candidates: &mut dyn Iterator<Item = Candidate>) -> Option<Candidate>;

    /// Returns column and row of a wrong texel of the last returned candidate, or of the original case
    /// before the first.
    fn texel(&self) -> Option<[u32; 2]>;
}

/// The result of a reduction.
#[derive(Clone, Debug)]
pub struct Reduction {
    /// The smallest document, and its case.
    pub smallest: Candidate,
    /// The number of candidates that were drawn.
    pub draws: usize,
    /// True if no smaller candidate was left to try; false if the budget ended the reduction.
    pub finished: bool,
}

/// Reduces a case that fails according to the oracle. Cases that cannot be drawn are not passed to the
/// oracle.
pub fn reduce(
    failing: Candidate,
    budget: ReductionLimits<'_>,
    can_draw: &dyn Fn(&Case) -> bool,
    oracle: &mut dyn Oracle,
) -> Reduction {
    let mut state = ReductionState {
        can_draw,
        id: failing.case.id.clone(),
        current: failing,
        seen: HashSet::new(),
        draws: 0,
        budget,
        is_over: false,
    };
    state.seen.insert(state.current.document.to_string());
    loop {
        let before = state.current.document.clone();
        for pass in PASSES {
            state.exhaust(*pass, oracle);
        }
        if state.draws >= budget.draws || state.current.document == before {
            break;
        }
    }
    Reduction {
        finished: state.draws < budget.draws && !state.is_over,
        smallest: state.current,
        draws: state.draws,
    }
}

struct ReductionState<'a> {
    can_draw: &'a dyn Fn(&Case) -> bool,
    id: String,
    current: Candidate,
    /// The documents that were already tried.
    seen: HashSet<String>,
    draws: usize,
    budget: ReductionLimits<'a>,
    /// True if candidates were left when the budget was used up.
    is_over: bool,
}

impl ReductionState<'_> {
    /// Tries all edits of a pass. After an edit is kept, continues at the same index in the list of the new
    /// document, since the edits before that index were tried.
    fn exhaust(&mut self, pass: crate::passes::EditPass, oracle: &mut dyn Oracle) {
        let mut start = 0;
        loop {
            let edits = pass(&self.current.document, oracle.texel());
            // The edit that made each candidate.
            let mut drawn: Vec<usize> = Vec::new();
            let mut same = None;
            let Self {
                can_draw,
                id,
                current,
                seen,
                draws,
                budget,
                is_over,
            } = self;
            let mut index = start;
            let mut candidates = std::iter::from_fn(|| {
                while same.is_none() && *draws < budget.draws {
                    let edit = edits.get(index)?;
                    *is_over |= budget.is_over();
                    if *is_over {
                        return None;
                    }
                    index += 1;
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
                        same = Some((index - 1, candidate));
                        return None;
                    }
                    if !can_draw(&candidate.case) {
                        continue;
                    }
                    *draws += 1;
                    drawn.push(index - 1);
                    return Some(candidate);
                }
                None
            });
            let found = oracle.first(&mut candidates);
            let kept = match (found, same) {
                (Some(candidate), _) => {
                    let made = |i: &usize| edits[*i].apply(&self.current.document);
                    let kept = Some(&candidate.document);
                    let edit = drawn.iter().find(|i| made(i).as_ref() == kept);
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

/// Returns true if drivers and judge see the same case.
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

    /// An oracle that tests a condition on the document, and records every candidate.
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

    /// Returns the random scene of a seed.
    fn random(flavor: &str, seed: u64) -> Candidate {
        let library = etalon_case::Library::built_in();
        let id = format!("combined/{flavor}/seed={seed}");
        let profile = etalon_case::Profile::Full;
        let case = library.cases(profile).find(|c| c.id() == id).unwrap();
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
        let reduction = reduce(
            failing.clone(),
            ReductionLimits::draws(most),
            &|_| true,
            &mut oracle,
        );
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
    fn a_reduction_removes_all_that_the_oracle_does_not_need() {
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
        let expected = json!({
            "attachments": { "color": { "format": "rgba8unorm", "size": [1, 1] } },
            "passes": [{ "color": ["color"], "draws": [
                { "mesh": { "kind": "full" }, "shader": "uniform_color", "logic": "copy" }
            ] }],
            "read": ["color"]
        });
        assert_eq!(reduction.smallest.document["scene"], expected);
    }

    #[test]
    fn a_nested_state_keeps_its_value_and_loses_its_neighbours() {
        let failing = random("common", 3);
        let op = |d: &Value| d["stencil"]["front"]["pass_op"].clone();
        let operation = draws(&failing.document)
            .into_iter()
            .map(op)
            .find(|v| *v != "keep");
        let operation = operation.unwrap();
        let holds = |d: &Value| {
            let read = d["scene"]["read"]
                .as_array()
                .is_some_and(|r| r.contains(&json!("depth")));
            read && draws(d).iter().any(|d| op(d) == operation)
        };
        let (reduction, _) = reduced(&failing, MOST_DRAWS, holds);
        let document = &reduction.smallest.document;
        let drawn = draws(document);
        assert_eq!(drawn.len(), 1);
        let expected = json!({ "front": { "compare": "always", "pass_op": operation } });
        assert_eq!(drawn[0]["stencil"], expected);
        assert_eq!(drawn[0].as_object().unwrap().len(), 3);
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
        let (first, asked) = reduced(&failing, MOST_DRAWS, holds);
        let (other, again) = reduced(&failing, MOST_DRAWS, holds);
        assert_eq!(first.smallest.document, other.smallest.document);
        assert_eq!(asked, again);
        let texts: HashSet<String> = asked.iter().map(Value::to_string).collect();
        assert_eq!(texts.len(), asked.len());
    }

    #[test]
    fn every_candidate_is_a_valid_case_and_the_limit_of_draws_holds() {
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
    fn the_oracle_is_not_asked_about_cases_that_cannot_be_drawn() {
        let failing = random("common", 1);
        let mut oracle = Condition {
            holds: |_: &Value| true,
            asked: Vec::new(),
        };
        let can_draw = |case: &Case| case.scene.passes.iter().any(|p| p.draws.len() > 1);
        let reduction = reduce(
            failing,
            ReductionLimits::draws(MOST_DRAWS),
            &can_draw,
            &mut oracle,
        );
        assert_eq!(draws(&reduction.smallest.document).len(), 2);
        assert!(oracle.asked.iter().all(|d| draws(d).len() > 1));
    }
}
