//! Looks: the part of an outcome that a page shows, the verdict, and whether it was expected. Numbers do not begin a new
//! span.

use crate::mark::class;
use crate::words::{self, Tone};
use etalon_history::{History, HistoryError, Outcome, OutcomeId};
use etalon_record::{Expected, Record, Standing, Verdict};
use etalon_stats::Class;
use serde_json::{Value, json};
use std::collections::HashMap;

#[derive(Clone, Debug, PartialEq, Eq, Hash)]
struct Look {
    verdict: Verdict,
    expected: Option<String>,
    improves: Option<Verdict>,
    due_fail: bool,
    inferred: bool,
}

/// All looks of a history, by number in the order in which they were met.
#[derive(Default)]
pub(super) struct Looks {
    all: Vec<Look>,
    tones: Vec<Tone>,
    classes: Vec<Class>,
    numbers: HashMap<Look, u32>,
    of: HashMap<u32, u32>,
}

impl Looks {
    /// The number of an outcome's look.
    pub(super) fn of(
        &mut self,
        history: &History,
        outcome: OutcomeId,
    ) -> Result<u32, HistoryError> {
        if let Some(known) = self.of.get(&outcome.number()) {
            return Ok(*known);
        }
        let found = history.outcome(outcome)?;
        let look = Look {
            verdict: found.verdict,
            expected: found.expected.clone(),
            improves: found.improves,
            due_fail: found.due_fail,
            inferred: found.inferred,
        };
        let number = match self.numbers.get(&look) {
            Some(number) => *number,
            None => {
                let number = self.all.len() as u32;
                self.numbers.insert(look.clone(), number);
                self.tones.push(tone(&look));
                self.classes.push(class_of(&found));
                self.all.push(look);
                number
            }
        };
        self.of.insert(outcome.number(), number);
        Ok(number)
    }

    /// Returns the class of a look.
    pub(super) fn class(&self, look: u32) -> Class {
        self.classes[look as usize]
    }

    /// True if the case was left out for a reason of the run, so that the driver is not the matter.
    pub(super) fn is_undecided(&self, look: u32) -> bool {
        self.class(look) == Class::Missing
            && self.all[look as usize].verdict != Verdict::NotSupported
    }

    /// True if the verdict counts against a run.
    pub(super) fn is_unexpected(&self, look: u32) -> bool {
        let (look, tone) = (&self.all[look as usize], self.tones[look as usize]);
        tone == Tone::Missed || tone == Tone::Plain && look.verdict.is_bad()
    }

    /// The words of a look: `✗ fail (expected)`.
    pub(super) fn text(&self, look: u32) -> String {
        let (look, tone) = (&self.all[look as usize], self.tones[look as usize]);
        let (symbol, name) = (words::symbol(look.verdict), words::name(look.verdict));
        format!("{symbol} {name}{}", tone.suffix())
    }

    /// The class that colours a look.
    pub(super) fn colour(&self, look: u32) -> &'static str {
        class(self.all[look as usize].verdict, self.tones[look as usize])
    }

    /// All looks for the script: words, colour, the reason of the expectation, whether it was inferred.
    pub(super) fn data(&self) -> Vec<Value> {
        let one = |number: u32| {
            let look = &self.all[number as usize];
            let mut reason = look.expected.clone().unwrap_or_default();
            if let Some(verdict) = look.improves {
                reason = format!("better than expected, which is {}", words::name(verdict));
            }
            json!([
                self.text(number),
                self.colour(number),
                reason,
                u8::from(look.inferred),
                u8::from(self.is_unexpected(number))
            ])
        };
        (0..self.all.len() as u32).map(one).collect()
    }
}

fn tone(look: &Look) -> Tone {
    let mut record = Record::new("", "", look.verdict);
    record.due_fail = look.due_fail;
    record.expected = look.expected.clone().map(|reason| Expected { reason });
    Tone::of(&record)
}

fn class_of(outcome: &Outcome) -> Class {
    match outcome.standing() {
        Standing::Good => Class::Good,
        Standing::Bad => Class::Bad,
        Standing::Flaky => Class::Flaky,
        Standing::Unknown => Class::Missing,
    }
}
