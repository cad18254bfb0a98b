//! Comparing two runs.

use crate::error::HistoryError;
use crate::history::History;
use crate::ids::{CaseId, OutcomeId, RunId};
use crate::outcome::Outcome;
use crate::runs::AdapterRun;
use etalon_record::Standing;
use std::fmt;
use std::rc::Rc;

/// The changes from one run to another.
#[derive(Clone, Debug)]
pub struct Comparison {
    /// The first run.
    pub before: RunId,
    /// The second run.
    pub after: RunId,
    /// The adapters that both runs have, by timeline.
    pub adapters: Vec<AdapterComparison>,
    /// Timelines that only the first run has.
    pub gone: Vec<Rc<str>>,
    /// Timelines that only the second run has.
    pub appeared: Vec<Rc<str>>,
}

/// The changes on one adapter from one run to another.
#[derive(Clone, Debug)]
pub struct AdapterComparison {
    /// The timeline.
    pub timeline: Rc<str>,
    /// The adapter in the first run.
    pub before: AdapterRun,
    /// The adapter in the second run.
    pub after: AdapterRun,
    /// The number of cases that both runs have a record of.
    pub common: u32,
    /// The common cases whose outcomes differ, by number.
    pub changes: Vec<Change>,
    /// Cases that only the first run has.
    pub gone: Vec<CaseId>,
    /// Cases that only the second run has.
    pub appeared: Vec<CaseId>,
}

impl AdapterComparison {
    /// Returns the changes of one kind.
    pub fn of(&self, kind: ChangeKind) -> impl Iterator<Item = &Change> {
        self.changes.iter().filter(move |c| c.kind == kind)
    }
}

/// A case whose outcome changed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Change {
    /// The case.
    pub case: CaseId,
    /// The kind.
    pub kind: ChangeKind,
    /// The outcome in the first run.
    pub before: OutcomeId,
    /// The outcome in the second run.
    pub after: OutcomeId,
}

/// The kind of a change, worst first.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum ChangeKind {
    /// A case that was right is wrong, or gives different results from time to time.
    Broken,
    /// A case that was wrong is right.
    Fixed,
    /// The verdict differs, but the case was neither broken nor fixed.
    Verdict,
    /// The verdict is the same, but whether or why it is expected differs.
    Expectation,
    /// Only numbers differ.
    Measures,
}

impl ChangeKind {
    /// Every kind, worst first.
    pub const ALL: [Self; 5] = [
        Self::Broken,
        Self::Fixed,
        Self::Verdict,
        Self::Expectation,
        Self::Measures,
    ];

    /// Returns the kind of a change from one outcome to another; `None` if they are equal.
    pub fn between(before: &Outcome, after: &Outcome) -> Option<Self> {
        use Standing::{Bad, Flaky, Good};
        match (before.standing(), after.standing()) {
            (Good, Bad | Flaky) => return Some(Self::Broken),
            (Bad | Flaky, Good) => return Some(Self::Fixed),
            _ => {}
        }
        if before.verdict != after.verdict {
            return Some(Self::Verdict);
        }
        let expectation = |o: &Outcome| (o.expected.clone(), o.improves, o.due_fail);
        if expectation(before) != expectation(after) {
            return Some(Self::Expectation);
        }
        // Inferred outcomes have no numbers.
        let numbers = before.measures != after.measures && before.inferred == after.inferred;
        numbers.then_some(Self::Measures)
    }

    /// Returns the name in exports.
    pub fn name(self) -> &'static str {
        match self {
            Self::Broken => "broken",
            Self::Fixed => "fixed",
            Self::Verdict => "verdict",
            Self::Expectation => "expectation",
            Self::Measures => "measures",
        }
    }
}

impl fmt::Display for ChangeKind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

impl History {
    /// Compares two runs adapter by adapter, over the cases that both have.
    ///
    /// # Errors
    /// If there is no such run, or if the file cannot be read or is damaged.
    pub fn compare(&self, before: RunId, after: RunId) -> Result<Comparison, HistoryError> {
        for id in [before, after] {
            self.run(id).ok_or_else(|| HistoryError::NoSuchRun {
                path: self.path().to_owned(),
                run: id.0,
            })?;
        }
        let (old, new) = (self.adapters(before), self.adapters(after));
        let without = |runs: &[AdapterRun], others: &[AdapterRun]| -> Vec<Rc<str>> {
            let is_alone = |a: &&AdapterRun| others.iter().all(|o| o.timeline != a.timeline);
            let alone = runs.iter().filter(is_alone);
            alone.map(|a| Rc::clone(&a.timeline)).collect()
        };
        let mut adapters = Vec::new();
        for before in old {
            if let Some(after) = new.iter().find(|a| a.timeline == before.timeline) {
                adapters.push(self.compare_adapters(before, after)?);
            }
        }
        Ok(Comparison {
            before,
            after,
            adapters,
            gone: without(old, new),
            appeared: without(new, old),
        })
    }

    /// Compares the records of an adapter in one run with those of an adapter in another.
    ///
    /// # Errors
    /// If the file cannot be read or is damaged.
    pub fn compare_adapters(
        &self,
        before: &AdapterRun,
        after: &AdapterRun,
    ) -> Result<AdapterComparison, HistoryError> {
        let mut found = AdapterComparison {
            timeline: Rc::clone(&after.timeline),
            before: before.clone(),
            after: after.clone(),
            common: 0,
            changes: Vec::new(),
            gone: Vec::new(),
            appeared: Vec::new(),
        };
        if before.is_same(after) {
            found.common = after.records;
            return Ok(found);
        }
        let (old, new) = (self.records(before)?, self.records(after)?);
        let (mut old, mut new) = (old.into_iter().peekable(), new.into_iter().peekable());
        loop {
            match (old.peek().copied(), new.peek().copied()) {
                (None, None) => return Ok(found),
                (Some((a, was)), Some((b, is))) if a == b => {
                    found.common += 1;
                    if was != is {
                        let kind = ChangeKind::between(&*self.outcome(was)?, &*self.outcome(is)?);
                        found.changes.extend(kind.map(|kind| Change {
                            case: a,
                            kind,
                            before: was,
                            after: is,
                        }));
                    }
                    old.next();
                    new.next();
                }
                (Some((a, _)), b) if b.is_none_or(|(b, _)| a < b) => {
                    found.gone.push(a);
                    old.next();
                }
                (_, Some((b, _))) => {
                    found.appeared.push(b);
                    new.next();
                }
                (Some(_), None) => {
                    old.next();
                }
            }
        }
    }
}
