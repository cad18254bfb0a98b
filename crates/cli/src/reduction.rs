//! Reductions on a driver: the judge as oracle, and the sentences on what is left.

use etalon_case::Case;
use etalon_explore::{Candidate, Oracle, states};
use etalon_frame::{Frame, Limits};
use etalon_record::{Record, Subject, Symptom};
use etalon_runner::{Judge, Launch, Trials, Worker};
use serde_json::{Value, json};

/// Returns the name of the case file, which is also the id of its case: letters and digits, as ids have them.
pub(crate) fn file_name(case: &str, adapter: &str) -> String {
    let word = |text: &str| -> String {
        let letters = text.chars();
        letters
            .map(|c| {
                if c.is_ascii_alphanumeric() || "-_.+".contains(c) {
                    c
                } else {
                    '-'
                }
            })
            .collect()
    };
    format!("{}.{}", word(case), word(adapter))
}

/// Draws a reduced case in a fresh process.
pub(crate) fn confirm(
    launch: &Launch,
    case: &Case,
    limits: &Limits,
    symptom: &Symptom,
) -> Result<(), String> {
    let mut worker = Worker::start(launch).map_err(|e| e.to_string())?;
    let frames = worker.draw(case).map_err(|e| e.to_string())?;
    let record = judged(case, limits, &frames);
    match symptom.covers(&Symptom::of(&record)) {
        true => Ok(()),
        false => Err(format!(
            "fails only after others in the same process: drawn alone it is {}",
            record.verdict
        )),
    }
}

/// Judges frames by themselves: legal sets of candidates are of no use to others.
pub(crate) fn judged(case: &Case, limits: &Limits, frames: &[Frame]) -> Record {
    Judge::default().judge(0, case, "", limits, frames).record
}

/// The judge as oracle, with a driver's frames.
pub(crate) struct DriverOracle {
    pub(crate) trials: Trials,
    pub(crate) limits: Limits,
    /// The symptom of the smallest case so far, and its record.
    pub(crate) symptom: Symptom,
    pub(crate) record: Record,
    pub(crate) error: Option<String>,
}

impl Oracle for DriverOracle {
    fn first(&mut self, candidates: &mut dyn Iterator<Item = Candidate>) -> Option<Candidate> {
        let Self {
            trials,
            limits,
            symptom,
            record,
            error,
        } = self;
        if error.is_some() {
            return None;
        }
        let mut next = || candidates.next();
        let mut found = |candidate: &Candidate, frames: &[Frame]| {
            let judged = judged(&candidate.case, limits, frames);
            let seen = Symptom::of(&judged);
            if !symptom.covers(&seen) {
                return false;
            }
            *symptom = seen;
            *record = judged;
            true
        };
        match trials.first(&mut next, |c| &c.case, &mut found) {
            Ok(found) => found,
            Err(failed) => {
                *error = Some(failed.to_string());
                None
            }
        }
    }

    fn texel(&self) -> Option<[u32; 2]> {
        self.record.wrong.first().map(|w| [w.x, w.y])
    }
}

/// A reduced case, and what is wrong with it.
pub(crate) struct Shown<'a> {
    /// Its document.
    pub(crate) document: &'a Value,
    /// Its record.
    pub(crate) record: &'a Record,
    /// Its symptom.
    pub(crate) symptom: &'a Symptom,
}

impl Shown<'_> {
    /// Returns the sentence on the wrong sample or counter.
    pub(crate) fn sentence(&self) -> String {
        let sentence = self.record.story.as_ref().and_then(|s| s.sentence());
        sentence.unwrap_or_else(|| self.record.message.clone())
    }

    /// Returns the clause that is violated: that of the last operation that cites one. Coverage cites one for
    /// primitives that lie elsewhere, and so is the last to be named.
    pub(crate) fn clause(&self) -> Option<&str> {
        let story = self.record.story.as_ref()?;
        let cited = |coverage: bool| {
            let mut lines = story.operations().iter().rev();
            lines.find_map(|line| {
                let own = (line.operation == "coverage") == coverage;
                line.citation.as_deref().filter(|_| own)
            })
        };
        let verdict = || story.verdict()?.citation.as_deref();
        if matches!(self.symptom.subject, Subject::Relation(_)) {
            return verdict();
        }
        cited(false).or_else(|| cited(true)).or_else(verdict)
    }

    /// Returns the states that are not the default.
    pub(crate) fn states(&self) -> String {
        match states(&self.document["scene"]) {
            all if all.is_empty() => "none but the defaults".to_owned(),
            all => all.join(", "),
        }
    }

    /// Returns the document with what it shows, behind a sentence on its origin.
    pub(crate) fn described(&self, origin: &str) -> Value {
        let mut about = format!(
            "{origin} States: {}. Violated: {}: {}",
            self.states(),
            self.symptom,
            self.sentence()
        );
        if let Some(clause) = self.clause() {
            about.push_str(&format!(" [{clause}]"));
        }
        let mut document = self.document.clone();
        document["about"] = json!(about);
        document
    }
}
