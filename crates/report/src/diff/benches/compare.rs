//! Compares two benches from their recorded samples.

use super::instructions::{self, InstructionChange, InstructionOutcome};
use super::notes::notes;
use crate::bench::figures::{self, software};
use crate::words::{self, machine};
use etalon_record::{Bench, BenchHeader, BenchRecord, Time};
use etalon_stats::{
    Conclusion, LEVEL, MINIMUM, Samples, Why, compare, smallest_visible, summarize,
};
use serde::{Serialize, Serializer};

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
    /// The first bench, the base of every ratio.
    pub before: BenchIdentity,
    /// The second bench.
    pub after: BenchIdentity,
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
pub struct BenchIdentity {
    /// The start, RFC 3339.
    pub started: String,
    /// The suite's version.
    pub etalon: String,
    /// The suite's commit, if it is known.
    pub commit: Option<String>,
    /// System, processor and number of cores, in words.
    pub machine: String,
    /// The command line that recorded it, with a space between its arguments.
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
    /// The median of the rounds of the first bench.
    pub before: f64,
    /// The median of the rounds of the second bench.
    pub after: f64,
    /// The number of rounds in the first and in the second bench.
    pub rounds: [usize; 2],
    /// The median ratio of all pairs of rounds, which differs slightly from the ratio of the medians.
    pub ratio: f64,
    /// The interval of the ratio; `None` with too few rounds.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub interval: Option<[f64; 2]>,
    /// The ratio in units of the ruler; `None` if the rulers differ or the ruler says nothing about the
    /// device.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub ruled: Option<f64>,
    /// The interval of `ruled`, with the confidence of `interval`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub ruled_interval: Option<[f64; 2]>,
    /// The smallest ratio that this comparison would have found with a probability of 0.9.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub visible: Option<f64>,
}

impl TimeChange {
    /// Returns the outcome's name if the samples decide it.
    pub(super) fn decided(&self) -> Option<&'static str> {
        match self.outcome {
            Conclusion::CannotTell(_) => None,
            outcome => Some(outcome.name()),
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
    #[serde(rename = "from_after")]
    pub is_missing_after: bool,
    /// The reason why the other bench has no times.
    pub why: String,
    /// True if this is worse than before: a right picture with a time is now wrong or broken, or its adapter
    /// vanished.
    pub worse: bool,
    /// True if the adapter is in the first bench but not in the second.
    pub vanished: bool,
}

/// The numbers of changes by outcome.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct OutcomeCounts {
    /// Slower in the second bench.
    pub slower: usize,
    /// Faster in the second bench.
    pub faster: usize,
    /// Neither: the rounds are too few, or differ too little for their noise.
    pub undecided: usize,
}

impl BenchDiff {
    /// Returns the numbers of slower, faster and undecided changes.
    pub fn counts(&self) -> OutcomeCounts {
        let mut counts = OutcomeCounts::default();
        for change in &self.changes {
            *match change.outcome {
                Conclusion::Slower => &mut counts.slower,
                Conclusion::Faster => &mut counts.faster,
                Conclusion::CannotTell(_) => &mut counts.undecided,
            } += 1;
        }
        counts
    }

    /// Returns true if anything is worse: slower, with more instructions, no longer right, or on an adapter that
    /// vanished.
    pub fn worse(&self) -> bool {
        self.counts().slower > 0
            || self.with_more_instructions() > 0
            || self.gone.iter().any(|g| g.worse)
    }

    /// Returns the number of cases that take more instructions.
    pub(super) fn with_more_instructions(&self) -> usize {
        let changes = self.instructions.iter();
        changes
            .filter(|c| c.outcome == InstructionOutcome::More)
            .count()
    }

    /// Returns the number of cases that only one bench timed, without being worse.
    pub(super) fn timed_in_one(&self) -> usize {
        self.gone.iter().filter(|g| !g.worse).count()
    }

    /// Returns the changes on software or hardware adapters.
    pub(super) fn of_kind(&self, software: bool) -> Vec<&TimeChange> {
        self.changes
            .iter()
            .filter(|c| c.software == software)
            .collect()
    }
}

/// Compares the second bench with the first.
pub fn diff(before: &Bench, after: &Bench, time: Time) -> BenchDiff {
    let same_ruler = before.header.ruler == after.header.ruler;
    let mut diff = BenchDiff {
        time,
        level: LEVEL,
        minimum: MINIMUM,
        before: identity(&before.header),
        after: identity(&after.header),
        notes: notes(before, after),
        changes: Vec::new(),
        gone: Vec::new(),
        instructions: Vec::new(),
    };
    let (instructions, note) = instructions::compare(before, after);
    diff.instructions = instructions;
    diff.notes.extend(note);
    for old in &before.records {
        let (case, adapter) = (&old.picture.case, &old.picture.adapter);
        let new = after.record(case, adapter);
        let new_adapter = after.header.adapter(adapter);
        let is_software = software(new_adapter.or_else(|| before.header.adapter(adapter)));
        // The ruler measures the processor, not other devices.
        let ruled = same_ruler && (is_software || time != Time::Gpu);
        let timed = |record| samples(record, time, ruled).map(|samples| (record, samples));
        match (timed(old), new.and_then(timed)) {
            (Some((_, b)), Some((_, a))) => {
                diff.changes.push(time_change(old, is_software, &b, &a));
            }
            (Some(_), None) => {
                let mut untimed = untimed(old, new, true, time);
                untimed.vanished = new_adapter.is_none();
                untimed.worse |= untimed.vanished;
                diff.gone.push(untimed);
            }
            (None, Some((new, _))) => diff.gone.push(untimed(new, Some(old), false, time)),
            (None, None) => {}
        }
    }
    for new in &after.records {
        let (case, adapter) = (&new.picture.case, &new.picture.adapter);
        let timed = samples(new, time, false).is_some();
        if timed && before.record(case, adapter).is_none() {
            diff.gone.push(untimed(new, None, false, time));
        }
    }
    diff
}

fn samples(record: &BenchRecord, time: Time, ruled: bool) -> Option<Samples> {
    if ruled {
        figures::samples(record, time)
    } else {
        Samples::new(&record.samples(time)).ok()
    }
}

fn time_change(
    record: &BenchRecord,
    software: bool,
    before: &Samples,
    after: &Samples,
) -> TimeChange {
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

/// Describes times that only one bench has. `timed` is the record with the times; `other` is the other
/// bench's record, if any.
fn untimed(
    timed: &BenchRecord,
    other: Option<&BenchRecord>,
    is_missing_after: bool,
    time: Time,
) -> Untimed {
    let (why, is_bad) = match other {
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
        case: timed.picture.case.clone(),
        adapter: timed.picture.adapter.clone(),
        is_missing_after,
        why,
        worse: is_missing_after && is_bad,
        vanished: false,
    }
}

fn identity(header: &BenchHeader) -> BenchIdentity {
    BenchIdentity {
        started: header.provenance.started.clone(),
        etalon: header.provenance.etalon.clone(),
        commit: header.provenance.commit.clone(),
        machine: machine(&header.provenance.machine),
        command: header.provenance.command.join(" "),
    }
}
