//! The conclusion of a comparison of two benches, in words.

use super::compare::BenchDiff;
use crate::numbers::count;
use std::collections::BTreeSet;

/// How a conclusion looks.
pub(super) struct ConclusionLook {
    /// The sign before the conclusion.
    pub(super) sign: &'static str,
    /// The class on a page.
    pub(super) class: &'static str,
    /// The colour on a terminal.
    pub(super) color: &'static str,
}

impl BenchDiff {
    /// Returns how the conclusion looks.
    pub(super) fn look(&self) -> ConclusionLook {
        let (sign, class, color) = if self.worse() {
            ("✗", "bad", "31")
        } else if self.counts().undecided == 0 && self.timed_in_one() == 0 {
            ("✓", "good", "32")
        } else {
            ("?", "o", "33")
        };
        ConclusionLook { sign, class, color }
    }

    /// Returns the conclusion in one line.
    pub(super) fn conclusion(&self) -> String {
        let mut parts = Vec::new();
        if self.worse() {
            let wrong = self.gone.iter().filter(|g| g.worse && !g.vanished).count();
            let numbers = [
                (self.counts().slower, "slower"),
                (self.with_more_instructions(), "with more instructions"),
                (wrong, "no longer right"),
            ];
            let numbers = numbers.into_iter().filter(|(n, _)| *n > 0);
            parts.extend(numbers.map(|(n, text)| format!("{n} {text}")));
        } else {
            parts.push("Nothing is shown to be worse".to_owned());
        }
        let vanished = self.gone.iter().filter(|g| g.vanished);
        let vanished: BTreeSet<&str> = vanished.map(|g| g.adapter.as_str()).collect();
        let vanished: Vec<&str> = vanished.into_iter().collect();
        if !vanished.is_empty() {
            parts.push(format!("vanished: {}", vanished.join(", ")));
        }
        let undecided = self.counts().undecided;
        if undecided > 0 {
            let pairs = self.changes.len();
            parts.push(format!("{undecided} of {pairs} comparisons cannot tell"));
        }
        let alone = self.timed_in_one();
        if alone > 0 {
            parts.push(format!(
                "{} timed in one bench only",
                count(alone as u64, "case")
            ));
        }
        parts.join("; ")
    }
}
