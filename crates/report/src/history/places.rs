//! The runs of a history in order, and the runs of each timeline.

use etalon_history::{AdapterRun, History, Kind, RunId, RunInfo};
use etalon_record::Labels;
use std::collections::HashMap;
use std::rc::Rc;

/// The number of neighbouring runs on each side that are searched for the longest, which gives the size of
/// the suite.
const AROUND: usize = 40;

/// The runs of a history, and its timelines.
pub(super) struct Places<'a> {
    /// The runs by time, without runs that were resumed later.
    pub(super) runs: Vec<&'a RunInfo>,
    /// The timelines by name.
    pub(super) timelines: Vec<Line<'a>>,
    of: HashMap<RunId, usize>,
}

/// A timeline: an adapter over its runs.
pub(super) struct Line<'a> {
    pub(super) name: Rc<str>,
    /// The runs, oldest first; at least one.
    pub(super) runs: Vec<LineRun<'a>>,
}

/// An adapter in one run.
pub(super) struct LineRun<'a> {
    /// The index of the run.
    pub(super) place: usize,
    pub(super) part: &'a AdapterRun,
    /// The kind and the profile, which decide the cases that the run draws.
    pub(super) sort: (Kind, Option<&'a str>),
    /// True if the run covers the whole suite and came to its end, so that a case without a record is
    /// missing.
    pub(super) whole: bool,
}

impl<'a> Places<'a> {
    /// Returns the runs that have all of these labels.
    pub(super) fn new(history: &'a History, only: &Labels) -> Self {
        let runs: Vec<&RunInfo> = history
            .runs()
            .iter()
            .filter(|run| run.resumed.is_none() && run.has_labels(only))
            .collect();
        let numbers: HashMap<RunId, usize> = runs.iter().map(|run| run.id).zip(0..).collect();
        let names = history.timelines();
        let number: HashMap<Rc<str>, usize> = names.iter().cloned().zip(0..).collect();
        let mut timelines: Vec<Line<'a>> = names
            .into_iter()
            .map(|name| Line {
                name,
                runs: Vec::new(),
            })
            .collect();
        for part in history.adapter_runs() {
            let line = number
                .get(&part.timeline)
                .and_then(|n| timelines.get_mut(*n));
            if let (Some(place), Some(line)) = (numbers.get(&part.run), line) {
                let run = runs[*place];
                line.runs.push(LineRun {
                    place: *place,
                    part,
                    sort: (run.kind, run.profile.as_deref()),
                    whole: false,
                });
            }
        }
        timelines.retain(|line| !line.runs.is_empty());
        for line in &mut timelines {
            line.mark_whole(&runs);
        }
        Self {
            runs,
            timelines,
            of: numbers,
        }
    }

    /// Returns the index of a run; `None` if the run was resumed later.
    pub(super) fn of(&self, run: RunId) -> Option<usize> {
        self.of.get(&run).copied()
    }

    /// Returns the day of a run: `2026-11-24`.
    pub(super) fn day(&self, place: usize) -> String {
        self.runs[place].day()
    }
}

impl Line<'_> {
    /// Marks the complete runs: runs that ended and that have at least nine tenths of the records of the
    /// longest run nearby. If no run qualifies, all count as complete. The history does not record which
    /// cases a run should have drawn.
    fn mark_whole(&mut self, runs: &[&RunInfo]) {
        let records: Vec<u64> = self
            .runs
            .iter()
            .map(|run| u64::from(run.part.records))
            .collect();
        for (number, run) in self.runs.iter_mut().enumerate() {
            let near = number.saturating_sub(AROUND)..(number + AROUND + 1).min(records.len());
            let most = records[near].iter().max().copied().unwrap_or(0);
            run.whole = runs[run.place].missing == 0 && records[number] * 10 >= most * 9;
        }
        if self.runs.iter().all(|run| !run.whole) {
            for run in &mut self.runs {
                run.whole = true;
            }
        }
    }

    /// Returns the last run that shows what the driver draws, or the last bench if there is no such run.
    pub(super) fn last(&self, runs: &[&RunInfo]) -> usize {
        let is_run = |run: &LineRun<'_>| runs[run.place].kind != Kind::Bench;
        let last = self.runs.iter().rposition(is_run);
        last.unwrap_or(self.runs.len() - 1)
    }
}
