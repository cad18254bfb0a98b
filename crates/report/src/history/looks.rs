//! Looks: the part of an outcome that a page shows, which is the verdict and whether it was expected. Other
//! differences between outcomes do not begin a new span.

use crate::lists::Interner;
use crate::mark::class;
use crate::words::{self, Tone};
use etalon_history::{History, HistoryError, Outcome, OutcomeId};
use etalon_record::{Standing, Verdict};
use serde_json::{Value, json};
use std::collections::HashMap;
use std::rc::Rc;

/// The verdict, the reason why it is expected, the verdict that was expected instead, whether it is due to
/// fail, and whether it was inferred.
type LookKey = (Verdict, Option<String>, Option<Verdict>, bool, bool);

/// All looks of a history, numbered in the order in which they were found.
#[derive(Default)]
pub(super) struct Looks {
    /// The first outcome of each look.
    outcomes: Vec<Rc<Outcome>>,
    numbers: Interner<LookKey>,
    of: HashMap<u32, u32>,
}

impl Looks {
    /// Returns the number of an outcome's look.
    pub(super) fn of(
        &mut self,
        history: &History,
        outcome: OutcomeId,
    ) -> Result<u32, HistoryError> {
        if let Some(known) = self.of.get(&outcome.number()) {
            return Ok(*known);
        }
        let found = history.outcome(outcome)?;
        let expected = found.expected.clone();
        let (improves, due_fail, inferred) = (found.improves, found.due_fail, found.inferred);
        let look = (found.verdict, expected, improves, due_fail, inferred);
        let number = self.numbers.place(look);
        if number == self.outcomes.len() {
            self.outcomes.push(found);
        }
        self.of.insert(outcome.number(), number as u32);
        Ok(number as u32)
    }

    fn outcome(&self, look: u32) -> &Outcome {
        &self.outcomes[look as usize]
    }

    /// Returns the standing of a look.
    pub(super) fn standing(&self, look: u32) -> Standing {
        self.outcome(look).standing()
    }

    /// Returns true if the case was left out because of the run, not because of the driver.
    pub(super) fn is_undecided(&self, look: u32) -> bool {
        self.standing(look) == Standing::Unknown
            && self.outcome(look).verdict != Verdict::NotSupported
    }

    /// Returns true if the verdict counts against a run.
    pub(super) fn is_unexpected(&self, look: u32) -> bool {
        self.outcome(look).unexpected()
    }

    /// Returns the words of a look: `✗ fail (expected)`.
    pub(super) fn text(&self, look: u32) -> String {
        let outcome = self.outcome(look);
        let (symbol, name) = (words::symbol(outcome.verdict), words::name(outcome.verdict));
        format!("{symbol} {name}{}", tone(outcome).suffix())
    }

    /// Returns all looks for the script: words, colour, the reason of the expectation, whether it was
    /// inferred, and whether it counts against a run.
    pub(super) fn data(&self) -> Vec<Value> {
        let data = |(number, outcome): (usize, &Rc<Outcome>)| {
            let reason = match outcome.improves {
                Some(verdict) => {
                    format!("better than expected, which is {}", words::name(verdict))
                }
                None => outcome.expected.clone().unwrap_or_default(),
            };
            json!([
                self.text(number as u32),
                class(outcome.verdict, tone(outcome)),
                reason,
                u8::from(outcome.inferred),
                u8::from(outcome.unexpected())
            ])
        };
        self.outcomes.iter().enumerate().map(data).collect()
    }
}

fn tone(outcome: &Outcome) -> Tone {
    let due = outcome.due_fail && outcome.expected.is_none();
    Tone::new(outcome.verdict, due, outcome.unexpected())
}
