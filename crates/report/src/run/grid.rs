//! A run, sorted by area, case file, case and adapter.

use crate::words::Tone;
use etalon_record::{Record, Run, Verdict};
use std::collections::{BTreeMap, HashMap};

/// The maximum number of columns: one per adapter, and the last one for all others. A damaged run can name as
/// many adapters as it has records.
const MAX_COLUMNS: usize = 1000;
const LAST_COLUMN: usize = MAX_COLUMNS - 1;
/// The name of the column for all other adapters.
const OTHERS: &str = "(more adapters)";

/// A run, sorted. Records are named by their position in the run.
pub(crate) struct RunGrid<'a> {
    pub(crate) run: &'a Run,
    /// Adapter names: the header's, then any that only records name.
    pub(crate) adapters: Vec<&'a str>,
    /// Areas by name, selftests last.
    pub(crate) areas: Vec<AreaFiles<'a>>,
}

/// All case files of an area.
pub(crate) struct AreaFiles<'a> {
    pub(crate) name: &'a str,
    pub(crate) files: Vec<GridFile<'a>>,
}

/// All cases that share their id up to the first axis value.
pub(crate) struct GridFile<'a> {
    pub(crate) name: &'a str,
    pub(crate) cases: Vec<CaseRow<'a>>,
}

/// One case on all adapters.
pub(crate) struct CaseRow<'a> {
    pub(crate) id: &'a str,
    /// The record on each adapter of [`RunGrid::adapters`], if there is one.
    pub(crate) records: Vec<Option<usize>>,
}

impl<'a> RunGrid<'a> {
    pub(crate) fn new(run: &'a Run) -> Self {
        let mut adapters: Vec<&str> = Vec::new();
        let mut column: HashMap<&str, usize> = HashMap::new();
        let from_header = run.header.adapters.iter().map(|a| a.info.name.as_str());
        for name in from_header.chain(run.records.iter().map(|r| r.adapter.as_str())) {
            column.entry(name).or_insert_with(|| {
                match adapters.len() {
                    MAX_COLUMNS => {}
                    LAST_COLUMN => adapters.push(OTHERS),
                    _ => adapters.push(name),
                }
                adapters.len() - 1
            });
        }
        type Rows<'a> = BTreeMap<&'a str, Vec<Option<usize>>>;
        let mut sorted: BTreeMap<&str, BTreeMap<&str, Rows<'_>>> = BTreeMap::new();
        for (index, record) in run.records.iter().enumerate() {
            let row = sorted
                .entry(record.parts().area())
                .or_default()
                .entry(record.parts().file())
                .or_default()
                .entry(&record.case)
                .or_insert_with(|| vec![None; adapters.len()]);
            let place = &mut row[column[record.adapter.as_str()]];
            // A run has one record per case and adapter; if a damaged run has two, the worse record counts.
            let rank = |i: usize| {
                let r: &Record = &run.records[i];
                (r.unexpected(), r.verdict.severity())
            };
            if place.is_none_or(|other| rank(other) < rank(index)) {
                *place = Some(index);
            }
        }
        let mut areas: Vec<AreaFiles<'_>> = sorted
            .into_iter()
            .map(|(name, files)| AreaFiles {
                name,
                files: files
                    .into_iter()
                    .map(|(name, rows)| GridFile {
                        name,
                        cases: rows
                            .into_iter()
                            .map(|(id, records)| CaseRow { id, records })
                            .collect(),
                    })
                    .collect(),
            })
            .collect();
        // Selftests say nothing about a driver.
        areas.sort_by_key(|area| area.is_selftest(run));
        Self {
            run,
            adapters,
            areas,
        }
    }

    pub(crate) fn record(&self, index: usize) -> &'a Record {
        &self.run.records[index]
    }

    /// Returns all case files.
    pub(crate) fn files(&self) -> impl Iterator<Item = &GridFile<'a>> {
        self.areas.iter().flat_map(|area| &area.files)
    }

    /// Returns all cases.
    pub(crate) fn cases(&self) -> impl Iterator<Item = &CaseRow<'a>> {
        self.files().flat_map(|file| &file.cases)
    }

    /// Returns the records on one adapter, by area, case file and case.
    pub(crate) fn on(&self, adapter: usize) -> impl Iterator<Item = &'a Record> {
        let indices = self.areas.iter().flat_map(move |area| area.on(adapter));
        indices.map(|index| self.record(index))
    }
}

impl AreaFiles<'_> {
    /// Returns true if most drawn cases of the area are selftests.
    pub(crate) fn is_selftest(&self, run: &Run) -> bool {
        let cases = self.files.iter().flat_map(|file| &file.cases);
        let records = cases.flat_map(|case| case.records.iter().flatten());
        let records = records.map(|index| &run.records[*index]);
        let (due, others): (Vec<&Record>, Vec<&Record>) =
            records.filter(|r| r.is_drawn()).partition(|r| r.due_fail);
        due.len() > others.len()
    }

    /// Returns the records on one adapter, in the order of case files and cases.
    pub(crate) fn on(&self, adapter: usize) -> impl Iterator<Item = usize> {
        self.files.iter().flat_map(move |f| f.on(adapter))
    }
}

impl GridFile<'_> {
    /// Returns the records on one adapter, in the order of cases.
    pub(crate) fn on(&self, adapter: usize) -> impl Iterator<Item = usize> {
        self.cases.iter().filter_map(move |c| c.records[adapter])
    }
}

/// Records per second of drawing and judging.
pub(crate) fn rate(records: &[&Record]) -> Option<f64> {
    let seconds = records.iter().map(|r| r.seconds.draw + r.seconds.judge);
    let seconds: f64 = seconds.sum();
    (seconds > 0.0).then(|| records.len() as f64 / seconds)
}

/// Counts of records by verdict.
#[derive(Default)]
pub(crate) struct VerdictTally {
    /// Counts, the most serious first: unexpected verdicts before expected ones.
    counts: BTreeMap<(bool, u8, Verdict, Tone), u64>,
    /// The number of unexpected records.
    pub(crate) unexpected: u64,
    /// The worst unexpected verdict. A missed selftest counts as a Fail.
    pub(crate) worst: Option<Verdict>,
    /// Bad verdicts that were expected.
    pub(crate) known: u64,
    /// Selftests that failed, as they are due to.
    pub(crate) due: u64,
    /// Records that say that the driver, or the selftest, does what it should.
    pub(crate) right: u64,
    /// Records in all.
    pub(crate) total: u64,
}

impl VerdictTally {
    pub(crate) fn of<'r>(records: impl IntoIterator<Item = &'r Record>) -> Self {
        let mut tally = Self::default();
        for record in records {
            tally.total += 1;
            let tone = Tone::of(record);
            tally.due += u64::from(tone == Tone::Due);
            tally.known += u64::from(tone == Tone::Excused);
            tally.right += u64::from(tone.is_right(record.verdict));
            let weight = match tone {
                Tone::Missed => Verdict::Fail,
                _ => record.verdict,
            };
            let excused = matches!(tone, Tone::Excused | Tone::Due);
            let key = (excused, u8::MAX - weight.severity(), record.verdict, tone);
            *tally.counts.entry(key).or_default() += 1;
            if record.unexpected() {
                tally.unexpected += 1;
                let worse = tally.worst.is_none_or(|w| w.severity() < weight.severity());
                if worse {
                    tally.worst = Some(weight);
                }
            }
        }
        tally
    }

    /// Returns verdict, tone and count, the most serious first.
    pub(crate) fn entries(&self) -> impl Iterator<Item = (Verdict, Tone, u64)> {
        self.counts.iter().map(|((_, _, v, t), n)| (*v, *t, *n))
    }

    /// Returns the number of records of one verdict that were neither expected nor due.
    pub(crate) fn plain(&self, verdict: Verdict) -> u64 {
        self.entries()
            .filter(|(v, t, _)| *v == verdict && !matches!(t, Tone::Excused | Tone::Due))
            .map(|(_, _, n)| n)
            .sum()
    }
}
