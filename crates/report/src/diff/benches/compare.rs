//! Compares two benches from their recorded samples.

use super::instructions::{self, InstructionChange, InstructionOutcome};
use crate::bench::figures::{self, software};
use crate::numbers::count;
use crate::words::{self, machine};
use etalon_record::{AdapterRecord, Bench, BenchHeader, BenchRecord, Time};
use etalon_stats::{
    Conclusion, LEVEL, MINIMUM, Samples, Why, compare, smallest_visible, summarize,
};
use serde::{Serialize, Serializer};
use std::collections::BTreeSet;

/// The comparison of two benches. `--format json` prints its serialised form.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct BenchDiff {
    /// The time that was compared.
    pub time: Time,
    /// The false positive rate: the highest rate, per comparison, at which two benches without a change are
    /// called different.
    pub level: f64,
    /// Changes up to this ratio are not reported.
    pub minimum: f64,
    /// The first bench.
    pub before: BenchFacts,
    /// The second bench.
    pub after: BenchFacts,
    /// Facts that make the two hard to compare: different machines, drivers, rulers or profiles, and lost
    /// rounds.
    pub notes: Vec<String>,
    /// Cases that were timed in both benches.
    pub changes: Vec<TimeChange>,
    /// Cases that were timed in one bench only.
    pub gone: Vec<Untimed>,
    /// Cases whose instructions were counted in both benches. They do not influence the outcomes of times.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub instructions: Vec<InstructionChange>,
}

/// The identity of one of the benches.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct BenchFacts {
    /// The start, RFC 3339.
    pub started: String,
    /// The suite's version.
    pub etalon: String,
    /// The suite's commit, if it is known.
    pub commit: Option<String>,
    /// The machine, in words.
    pub machine: String,
    /// The command line.
    pub command: String,
}

/// A case on an adapter that was timed in both benches. Times are in seconds; ratios are after over before.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct TimeChange {
    /// The case's id.
    pub case: String,
    /// The adapter's name.
    pub adapter: String,
    /// True if the adapter draws with the processor.
    pub software: bool,
    /// `faster`, `slower` or `cannot tell`.
    #[serde(serialize_with = "by_name")]
    pub outcome: Conclusion,
    /// The reason why the samples decide nothing.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub why: Option<&'static str>,
    /// The median before.
    pub before: f64,
    /// The median after.
    pub after: f64,
    /// Rounds before and after.
    pub rounds: [usize; 2],
    /// The ratio over all pairs of rounds, which differs slightly from the ratio of the medians.
    pub ratio: f64,
    /// The interval of the ratio; `None` with too few rounds.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub interval: Option<[f64; 2]>,
    /// The ratio in units of the ruler; `None` if the rulers differ or the ruler says nothing about the
    /// device.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub ruled: Option<f64>,
    /// The interval of `ruled`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub ruled_interval: Option<[f64; 2]>,
    /// The smallest ratio that this comparison would have found with a probability of 0.9.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub visible: Option<f64>,
}

impl TimeChange {
    /// Returns the outcome's name if the samples decide it, else an empty text.
    pub(super) fn decided(&self) -> &'static str {
        match self.outcome {
            Conclusion::CannotTell(_) => "",
            outcome => outcome.name(),
        }
    }
}

fn by_name<S: Serializer>(outcome: &Conclusion, serializer: S) -> Result<S::Ok, S::Error> {
    serializer.serialize_str(outcome.name())
}

/// A case on an adapter that has times in one bench only.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Untimed {
    /// The case's id.
    pub case: String,
    /// The adapter's name.
    pub adapter: String,
    /// True if the times are missing in the second bench, false if they are missing in the first.
    pub from_after: bool,
    /// The reason.
    pub why: String,
    /// True if this is worse than before: a right picture with a time is now wrong or broken, or its adapter
    /// vanished.
    pub worse: bool,
    /// True if the adapter is in the first bench but not in the second.
    pub vanished: bool,
}

impl BenchDiff {
    /// Returns the numbers of slower, faster and undecided changes.
    pub fn counts(&self) -> [usize; 3] {
        let mut counts = [0; 3];
        for change in &self.changes {
            counts[match change.outcome {
                Conclusion::Slower => 0,
                Conclusion::Faster => 1,
                Conclusion::CannotTell(_) => 2,
            }] += 1;
        }
        counts
    }

    /// Returns true if anything is worse: slower, with more instructions, no longer right, or on an adapter that
    /// vanished.
    pub fn worse(&self) -> bool {
        self.counts()[0] > 0 || self.more() > 0 || self.gone.iter().any(|g| g.worse)
    }

    /// Returns the number of cases that take more instructions.
    fn more(&self) -> usize {
        let more = self.instructions.iter();
        more.filter(|c| c.outcome == InstructionOutcome::More)
            .count()
    }

    /// Returns the number of undecided comparisons, and of cases that only one bench timed.
    pub fn untold(&self) -> [usize; 2] {
        let untold = self.changes.iter().filter(|c| c.why.is_some());
        [
            untold.count(),
            self.gone.iter().filter(|g| !g.worse).count(),
        ]
    }

    /// Returns the changes on software or hardware adapters.
    pub(super) fn of_kind(&self, software: bool) -> Vec<&TimeChange> {
        self.changes
            .iter()
            .filter(|c| c.software == software)
            .collect()
    }

    /// Returns the conclusion's sign, its class on a page and its colour on a terminal.
    pub(super) fn look(&self) -> [&'static str; 3] {
        match (self.worse(), self.untold()) {
            (true, _) => ["✗", "bad", "31"],
            (false, [0, 0]) => ["✓", "good", "32"],
            (false, _) => ["?", "o", "33"],
        }
    }

    /// Returns the conclusion in one line.
    pub(super) fn conclusion(&self) -> String {
        let mut parts = Vec::new();
        if self.worse() {
            parts.push(format!("{} slower", self.counts()[0]));
            if self.more() > 0 {
                parts.push(format!("{} with more instructions", self.more()));
            }
            let wrong = self.gone.iter().filter(|g| g.worse && !g.vanished).count();
            parts.push(format!("{wrong} no longer right"));
        } else {
            parts.push("Nothing is shown to be worse".to_owned());
        }
        let vanished = self.gone.iter().filter(|g| g.vanished);
        let vanished: BTreeSet<&str> = vanished.map(|g| g.adapter.as_str()).collect();
        let vanished: Vec<&str> = vanished.into_iter().collect();
        if !vanished.is_empty() {
            parts.push(format!("vanished: {}", vanished.join(", ")));
        }
        let [undecided, alone] = self.untold();
        if undecided > 0 {
            let pairs = self.changes.len();
            parts.push(format!("{undecided} of {pairs} comparisons cannot tell"));
        }
        if alone > 0 {
            parts.push(format!(
                "{} timed in one bench only",
                count(alone as u64, "case")
            ));
        }
        parts.join("; ")
    }
}

/// Compares the second bench with the first.
pub fn diff(before: &Bench, after: &Bench, time: Time) -> BenchDiff {
    let same_ruler = before.header.ruler == after.header.ruler;
    let mut found = BenchDiff {
        time,
        level: LEVEL,
        minimum: MINIMUM,
        before: side(&before.header),
        after: side(&after.header),
        notes: notes(before, after),
        changes: Vec::new(),
        gone: Vec::new(),
        instructions: Vec::new(),
    };
    let (counted, note) = instructions::compare(before, after);
    found.instructions = counted;
    found.notes.extend(note);
    for old in &before.records {
        let (case, adapter) = (&old.picture.case, &old.picture.adapter);
        let new = after.record(case, adapter);
        let sides = [after, before].map(|bench| bench.header.adapter(adapter));
        let kind = software(sides[0].or(sides[1]));
        // The ruler measures the processor, not other devices.
        let ruled = same_ruler && (kind || time != Time::Gpu);
        let samples_of = |record: &BenchRecord| samples(record, time, ruled);
        match (samples_of(old), new.and_then(samples_of)) {
            (Some(b), Some(a)) => found.changes.push(changed(old, kind, &b, &a)),
            (Some(_), None) => {
                let mut gone = gone(old, new, true, time);
                gone.vanished = after.header.adapter(adapter).is_none();
                gone.worse |= gone.vanished;
                found.gone.push(gone);
            }
            (None, Some(_)) => {
                let new = new.unwrap_or(old);
                found.gone.push(gone(new, Some(old), false, time));
            }
            (None, None) => {}
        }
    }
    for new in &after.records {
        let (case, adapter) = (&new.picture.case, &new.picture.adapter);
        let timed = samples(new, time, false).is_some();
        if timed && before.record(case, adapter).is_none() {
            found.gone.push(gone(new, None, false, time));
        }
    }
    found
}

fn samples(record: &BenchRecord, time: Time, ruled: bool) -> Option<Samples> {
    if ruled {
        figures::samples(record, time)
    } else {
        Samples::new(&record.samples(time)).ok()
    }
}

fn changed(record: &BenchRecord, software: bool, before: &Samples, after: &Samples) -> TimeChange {
    let comparison = compare(before, after);
    let finite = |low: f64, high: f64| (low > 0.0 && high.is_finite()).then_some([low, high]);
    let ratio = comparison.ratio;
    TimeChange {
        case: record.picture.case.clone(),
        adapter: record.picture.adapter.clone(),
        software,
        outcome: comparison.outcome,
        why: match comparison.outcome {
            Conclusion::CannotTell(why) => Some(Why::text(why)),
            Conclusion::Faster | Conclusion::Slower => None,
        },
        before: summarize(before).median,
        after: summarize(after).median,
        rounds: [before.rounds(), after.rounds()],
        ratio: ratio.estimate,
        interval: finite(ratio.low, ratio.high),
        ruled: comparison.ruled.map(|r| r.estimate),
        ruled_interval: comparison.ruled.and_then(|r| finite(r.low, r.high)),
        visible: smallest_visible(before, after),
    }
}

/// Describes times that only one bench has. `there` is the record with the times; `other` is the other
/// bench's record, if any.
fn gone(there: &BenchRecord, other: Option<&BenchRecord>, from_after: bool, time: Time) -> Untimed {
    let (why, bad) = match other {
        None => ("it took no part".to_owned(), false),
        Some(other) => match &other.ended {
            Some(ended) => (
                format!("{}: {}", ended.verdict, words::reasons_text(&ended.reasons)),
                ended.verdict.is_bad(),
            ),
            None if other.rounds.is_empty() => {
                let p = &other.picture;
                let message = match words::reasons_text(&p.reasons).as_str() {
                    "" => String::new(),
                    text => format!(": {text}"),
                };
                (format!("{}{message}", p.verdict), p.verdict.is_bad())
            }
            None => (format!("it has no {time} times"), false),
        },
    };
    Untimed {
        case: there.picture.case.clone(),
        adapter: there.picture.adapter.clone(),
        from_after,
        why,
        worse: from_after && bad,
        vanished: false,
    }
}

fn side(header: &BenchHeader) -> BenchFacts {
    BenchFacts {
        started: header.provenance.started.clone(),
        etalon: header.provenance.etalon.clone(),
        commit: header.provenance.commit.clone(),
        machine: machine(&header.provenance.machine),
        command: header.provenance.command.join(" "),
    }
}

fn notes(before: &Bench, after: &Bench) -> Vec<String> {
    let (b, a) = (&before.header, &after.header);
    let mut notes = Vec::new();
    if b.provenance.machine != a.provenance.machine {
        notes.push(
            "The machines differ, so they can cause changes instead of the driver.".to_owned(),
        );
    }
    if b.ruler != a.ruler {
        notes.push(format!(
            "The rulers differ ({}; {}), so a change of the machine's speed stays unnoticed.",
            b.ruler, a.ruler
        ));
    }
    let mut differs = |what: String, before: &str, after: &str| {
        if before != after {
            notes.push(format!("{what} {before} before, {after} after."));
        }
    };
    differs("Profiles:".to_owned(), &b.profile, &a.profile);
    let caches = [b, a].map(|h| h.shader_cache.name());
    differs("Shader caches:".to_owned(), caches[0], caches[1]);
    for old in &b.adapters {
        let Some(new) = a.adapter(&old.info.name) else {
            continue;
        };
        let facts = |a: &AdapterRecord| {
            [
                a.info.device.clone(),
                a.driver_text(),
                a.info.api_version.clone(),
            ]
        };
        let names = ["device", "driver", "API"].into_iter();
        for (name, (b, a)) in names.zip(facts(old).into_iter().zip(facts(new))) {
            differs(format!("{}: {name}", old.info.name), &b, &a);
        }
    }
    for (bench, name) in [(before, "first"), (after, "second")] {
        if bench.missing() > 0 || bench.truncated {
            let n = bench.missing();
            notes.push(format!(
                "The {name} bench is incomplete: {n} rounds are missing."
            ));
        }
    }
    notes
}
