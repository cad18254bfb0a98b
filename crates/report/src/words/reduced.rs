//! A reduced case in words.

use super::reason::message;
use super::story::{judged_by, sentence};
use etalon_diagnose::{Symptom, violated_clause};
use etalon_record::Record;

/// A reduced case and its symptom.
pub struct ReducedCase<'a> {
    /// The record of the reduced case on the driver that fails it.
    pub record: &'a Record,
    /// What is wrong in that record.
    pub symptom: &'a Symptom,
    /// The states of the reduced scene that are not the default.
    pub states: Vec<String>,
}

impl ReducedCase<'_> {
    /// Returns the sentence on the wrong sample or counter.
    pub fn sentence(&self) -> String {
        let sentence = self.record.story.as_ref().and_then(sentence);
        sentence.unwrap_or_else(|| message(self.record))
    }

    /// Returns the violated clause, or the text by which the record was judged.
    pub fn clause(&self) -> Option<String> {
        let story = self.record.story.as_ref()?;
        let clause = violated_clause(self.record).map(str::to_owned);
        clause.or_else(|| judged_by(story))
    }

    /// Returns the states.
    pub fn states(&self) -> String {
        if self.states.is_empty() {
            "none but the defaults".to_owned()
        } else {
            self.states.join(", ")
        }
    }

    /// Returns what the case shows, after a sentence on its origin: the `about` of its file.
    pub fn about(&self, origin: &str) -> String {
        let verdict = self.record.verdict;
        let word = if verdict.is_violation() {
            "Violated".to_owned()
        } else {
            format!("Ends by {verdict}")
        };
        let (states, symptom, sentence) = (self.states(), self.symptom, self.sentence());
        let clause = self.clause().map(|clause| format!(" [{clause}]"));
        let clause = clause.unwrap_or_default();
        format!("{origin} States: {states}. {word}: {symptom}: {sentence}{clause}")
    }
}
