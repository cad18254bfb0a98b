//! The figures of a bench.

use crate::lists::grouped;
use crate::numbers::{count, duration, instructions, percent, round_duration};
use crate::words;
use etalon_record::{AdapterRecord, Bench, BenchRecord, BenchSettings, Time, Verdict};
use etalon_stats::{Conclusion, Samples, Summary, compare, summarize};
use maud::{Markup, html};
use std::collections::BTreeMap;

/// Software and hardware adapters, which are ranked separately: the value of [`software`], and its name.
pub(crate) const KINDS: [(bool, &str); 2] = [(true, "Software"), (false, "Hardware")];

/// Returns true if the adapter draws with the processor. An adapter that no header names counts as hardware,
/// which is compared without the ruler.
pub(crate) fn software(adapter: Option<&AdapterRecord>) -> bool {
    adapter.is_some_and(|a| a.info.software)
}

/// The figures of one case.
pub(crate) struct CaseFigures<'a> {
    pub(crate) case: &'a str,
    /// The adapters with times: software adapters, then hardware adapters, both from the fastest to the
    /// slowest.
    pub(crate) timed: [Vec<TimedCase<'a>>; 2],
    /// The adapters without times: the picture is wrong, could not be drawn, or has no round yet.
    pub(crate) untimed: Vec<&'a BenchRecord>,
}

impl<'a> CaseFigures<'a> {
    /// Returns the timed adapters of a kind.
    pub(crate) fn of_kind(&self, software: bool) -> &[TimedCase<'a>] {
        &self.timed[usize::from(!software)]
    }
}

/// A case on an adapter.
pub(crate) struct TimedCase<'a> {
    pub(crate) record: &'a BenchRecord,
    /// The rank among adapters of its kind, from 1. Adapters without a proven difference share a rank.
    pub(crate) rank: usize,
    pub(crate) wall: Summary,
    /// The medians of the other measured times.
    pub(crate) others: BTreeMap<Time, Summary>,
    samples: Samples,
}

impl TimedCase<'_> {
    pub(crate) fn adapter(&self) -> &str {
        &self.record.picture.adapter
    }

    /// Returns the median of another time, if it was measured.
    pub(crate) fn other(&self, time: Time) -> Option<String> {
        self.others
            .get(&time)
            .map(|summary| duration(summary.median))
    }

    /// Returns the instructions of a frame, if they were counted.
    pub(crate) fn instructions(&self) -> Option<String> {
        let counted = self.record.counted.as_ref()?;
        Some(instructions(counted.per_frame()?))
    }

    /// Returns the number of rounds and of frames in each.
    pub(crate) fn counted(&self, times: &str) -> String {
        let s = &self.wall;
        format!("{}{times}{}", s.rounds, s.samples / s.rounds.max(1))
    }

    /// Returns the median wall time of each round.
    pub(crate) fn medians(&self) -> Vec<f64> {
        self.samples.medians()
    }
}

/// Returns the figures of a bench by case, in the bench's order.
pub(crate) fn figures(bench: &Bench) -> Vec<CaseFigures<'_>> {
    let records = bench.records.iter();
    let cases = grouped(records.map(|r| (r.picture.case.as_str(), r)));
    let cases = cases.into_iter().map(|(case, records)| {
        let (mut timed, mut untimed) = ([Vec::new(), Vec::new()], Vec::new());
        for record in records {
            let adapter = bench.header.adapter(&record.picture.adapter);
            match self::timed(record) {
                Some(times) => timed[usize::from(!software(adapter))].push(times),
                None => untimed.push(record),
            }
        }
        timed.iter_mut().for_each(|times| rank(times));
        CaseFigures {
            case,
            timed,
            untimed,
        }
    });
    cases.collect()
}

/// Returns the verdict and the reasons of a record's end, or of its picture if it did not end early.
pub(crate) fn end(record: &BenchRecord) -> (Verdict, String) {
    let (verdict, reasons) = match &record.ended {
        Some(ended) => (ended.verdict, &ended.reasons),
        None => (record.picture.verdict, &record.picture.reasons),
    };
    (verdict, words::reasons_text(reasons))
}

/// Returns the samples of one time, with their ruler, or `None` if it was not measured.
pub(crate) fn samples(record: &BenchRecord, time: Time) -> Option<Samples> {
    // Reading a bench rejects records whose times are not valid samples.
    let samples = Samples::new(&record.samples(time)).ok()?;
    samples.with_ruler(&record.rulers(time)).ok()
}

fn timed(record: &BenchRecord) -> Option<TimedCase<'_>> {
    let wall = samples(record, Time::Wall)?;
    let others = Time::ALL.into_iter().filter(|t| *t != Time::Wall);
    let others = others.filter_map(|t| Some((t, summarize(&samples(record, t)?))));
    Some(TimedCase {
        record,
        rank: 0,
        wall: summarize(&wall),
        others: others.collect(),
        samples: wall,
    })
}

/// Returns the note on a bench that lacks rounds, for its pages.
pub(crate) fn incomplete(bench: &Bench) -> Markup {
    let missing = bench.missing();
    html! {
        @if bench.truncated || missing > 0 {
            p.state.bad { b { "! Incomplete. " } (count(missing, "round")) " missing." }
        }
    }
}

/// Returns the limits that end a bench, as facts for its pages.
pub(crate) fn limits(settings: &BenchSettings) -> Markup {
    html! {
        @if let Some(share) = settings.within { dt { "Enough" } dd { "intervals within " (percent(share, 1)) } }
        @if let Some(limit) = settings.limit { dt { "Time limit" } dd { (round_duration(limit)) " of rounds on each adapter" } }
    }
}

/// Sorts by median and ranks the rows. A row gets a new rank only if a comparison of samples finds it slower
/// than the first row of the current rank.
fn rank(times: &mut [TimedCase<'_>]) {
    times.sort_by(|a, b| a.wall.median.total_cmp(&b.wall.median));
    let mut leader = 0;
    for index in 0..times.len() {
        let same = index > 0 && {
            let outcome = compare(&times[leader].samples, &times[index].samples).outcome;
            outcome != Conclusion::Slower
        };
        if !same {
            leader = index;
        }
        times[index].rank = leader + 1;
    }
}
