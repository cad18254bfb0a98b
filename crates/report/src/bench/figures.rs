//! The figures of a bench.

use super::kind::software;
use etalon_record::{Bench, BenchRecord, Time};
use etalon_stats::{Conclusion, Samples, Summary, compare, summarize};
use std::collections::BTreeMap;

/// The figures of a whole bench.
pub(crate) struct Figures<'a> {
    /// By case, in the bench's order.
    pub(crate) cases: Vec<CaseFigures<'a>>,
}

/// The figures of one case.
pub(crate) struct CaseFigures<'a> {
    pub(crate) case: &'a str,
    /// Timed on the processor, fastest first.
    pub(crate) software: Vec<Timed<'a>>,
    /// Timed on other devices, fastest first.
    pub(crate) hardware: Vec<Timed<'a>>,
    /// Not timed: the picture is wrong, or could not be drawn, or there is no round yet.
    pub(crate) untimed: Vec<&'a BenchRecord>,
}

impl<'a> CaseFigures<'a> {
    /// The adapters of a kind.
    pub(crate) fn of_kind(&self, software: bool) -> &[Timed<'a>] {
        if software {
            &self.software
        } else {
            &self.hardware
        }
    }
}

/// One case on one adapter.
pub(crate) struct Timed<'a> {
    pub(crate) record: &'a BenchRecord,
    /// Among adapters of its kind, from 1; adapters that do not differ provably share one.
    pub(crate) rank: usize,
    pub(crate) wall: Summary,
    /// Other times, as far as they were measured.
    pub(crate) others: BTreeMap<Time, Summary>,
    samples: Samples,
}

impl Timed<'_> {
    pub(crate) fn adapter(&self) -> &str {
        &self.record.picture.adapter
    }

    /// The median wall time of each round.
    pub(crate) fn medians(&self) -> Vec<f64> {
        self.samples.medians()
    }
}

impl<'a> Figures<'a> {
    pub(crate) fn new(bench: &'a Bench) -> Self {
        let mut cases: Vec<CaseFigures<'a>> = Vec::new();
        let mut places: BTreeMap<&str, usize> = BTreeMap::new();
        for record in &bench.records {
            let name = record.picture.case.as_str();
            let place = *places.entry(name).or_insert_with(|| {
                cases.push(CaseFigures {
                    case: name,
                    software: Vec::new(),
                    hardware: Vec::new(),
                    untimed: Vec::new(),
                });
                cases.len() - 1
            });
            let case = &mut cases[place];
            let kind = software(bench.header.adapter(&record.picture.adapter));
            match timed(record) {
                Some(timed) if kind => case.software.push(timed),
                Some(timed) => case.hardware.push(timed),
                None => case.untimed.push(record),
            }
        }
        for case in &mut cases {
            rank(&mut case.software);
            rank(&mut case.hardware);
        }
        Self { cases }
    }

    /// Everything that was timed.
    pub(crate) fn timed(&self) -> impl Iterator<Item = (&'a str, &Timed<'a>)> {
        let both = |c: &'_ CaseFigures<'a>| c.case;
        self.cases.iter().flat_map(move |c| {
            let name = both(c);
            c.software.iter().chain(&c.hardware).map(move |t| (name, t))
        })
    }
}

/// The samples of one time, with their ruler; `None` where it was not measured.
pub(crate) fn samples(record: &BenchRecord, time: Time) -> Option<Samples> {
    // The reader lets no record through whose times are no samples.
    let samples = Samples::new(&record.samples(time)).ok()?;
    samples.with_ruler(&record.rulers(time)).ok()
}

fn timed(record: &BenchRecord) -> Option<Timed<'_>> {
    let wall = samples(record, Time::Wall)?;
    let others = Time::ALL.into_iter().filter(|t| *t != Time::Wall);
    let others = others.filter_map(|t| Some((t, summarize(&samples(record, t)?))));
    Some(Timed {
        record,
        rank: 0,
        wall: summarize(&wall),
        others: others.collect(),
        samples: wall,
    })
}

/// Sorts by median, and gives a rank of its own only to what is slower than the first of the rank
/// before by a comparison of their samples.
fn rank(all: &mut [Timed<'_>]) {
    all.sort_by(|a, b| a.wall.median.total_cmp(&b.wall.median));
    let mut leader = 0;
    for at in 0..all.len() {
        let same = at > 0 && {
            let outcome = compare(&all[leader].samples, &all[at].samples).outcome;
            outcome != Conclusion::Slower
        };
        if !same {
            leader = at;
        }
        all[at].rank = leader + 1;
    }
}
