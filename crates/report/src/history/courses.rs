//! The history of each case on one timeline: spans of equal looks, runs without a record, and events.

use super::looks::Looks;
use super::places::Line;
use crate::lists::Interner;
use etalon_history::{History, HistoryError};
use etalon_stats::{Happening, Standing, happenings};
use std::collections::{HashMap, HashSet};

/// The history of one case on one timeline. Runs are indices into the timeline.
#[derive(Default)]
pub(super) struct Course {
    /// The first run with a record of the case.
    pub(super) first: u32,
    /// The last run with a record of the case.
    pub(super) last: u32,
    /// The first run of each span, and the span's look.
    pub(super) spans: Vec<(u32, u32)>,
    /// The number of the list in [`Gaps`] with the runs in between that have no record; 0 for none.
    pub(super) gaps: u32,
    /// True if all complete runs have a record.
    pub(super) is_common: bool,
    pub(super) events: Vec<Happening<u32>>,
}

impl Course {
    /// Returns the look in a run with a record of the case.
    pub(super) fn look(&self, run: u32) -> u32 {
        let next = self.spans.partition_point(|(from, _)| *from <= run);
        self.spans[next.saturating_sub(1)].1
    }

    /// Returns the spans: first run, the run after the last, and look.
    pub(super) fn ended(&self) -> impl Iterator<Item = (u32, u32, u32)> {
        let ends = self.spans.iter().skip(1).map(|(from, _)| *from);
        let ends = ends.chain([self.last + 1]);
        self.spans
            .iter()
            .zip(ends)
            .map(|((from, look), end)| (*from, end, *look))
    }
}

/// Lists of runs without a record. Cases share lists: a run that left an area out gives the same list to
/// many.
#[derive(Default)]
pub(super) struct Gaps {
    /// The number of the list that this one extends, then the first run and the number of runs added. List 0
    /// is empty.
    all: Interner<(u32, u32, u32)>,
}

impl Gaps {
    fn longer(&mut self, than: u32, from: u32, runs: u32) -> u32 {
        self.all.place((than, from, runs)) as u32 + 1
    }

    /// Returns the gaps of a list, each the first run and the number of runs, in order.
    pub(super) fn list(&self, mut number: u32) -> Vec<(u32, u32)> {
        let mut list = Vec::new();
        while let Some((before, from, runs)) = number
            .checked_sub(1)
            .and_then(|index| self.all.values.get(index as usize))
        {
            list.push((*from, *runs));
            number = *before;
        }
        list.reverse();
        list
    }
}

/// The histories of all cases on a timeline.
pub(super) struct Courses {
    /// The history of each case, by the case's number minus one; `None` without a record.
    pub(super) of: Vec<Option<Course>>,
    pub(super) gaps: Gaps,
}

impl Courses {
    /// Reads all records of a timeline and finds the events of each case. Calls `each` with the run, the
    /// case's number minus one, and the look.
    pub(super) fn read(
        history: &History,
        line: &Line<'_>,
        cases: usize,
        looks: &mut Looks,
        mut each: impl FnMut(usize, usize, u32, &Looks),
    ) -> Result<Self, HistoryError> {
        let mut course_of: Vec<Option<Course>> = (0..cases).map(|_| None).collect();
        let mut gaps = Gaps::default();
        for (index, run) in line.runs.iter().enumerate() {
            let here = index as u32;
            for (case, outcome) in history.records(run.part)? {
                let look = looks.of(history, outcome)?;
                let case = case.number() as usize - 1;
                each(index, case, look, looks);
                match &mut course_of[case] {
                    Some(course) => {
                        let missed = here - course.last - 1;
                        if missed > 0 {
                            course.gaps = gaps.longer(course.gaps, course.last + 1, missed);
                        }
                        if course.spans.last().is_none_or(|(_, last)| *last != look) {
                            course.spans.push((here, look));
                        }
                        course.last = here;
                    }
                    none => {
                        *none = Some(Course {
                            first: here,
                            last: here,
                            spans: vec![(here, look)],
                            ..Course::default()
                        });
                    }
                }
            }
        }
        // For each list of gaps, whether the list contains a complete run.
        let mut holed: HashMap<u32, bool> = HashMap::new();
        let is_complete = |run: &u32| line.runs[*run as usize].whole;
        let runs = line.runs.len() as u32;
        let first = (0..runs).find(is_complete).unwrap_or(0);
        let last = (0..runs).rfind(is_complete).unwrap_or(0);
        for course in course_of.iter_mut().flatten() {
            let holed = *holed.entry(course.gaps).or_insert_with(|| {
                let mut list = gaps.list(course.gaps).into_iter();
                list.any(|(from, runs)| (from..from + runs).any(|run| is_complete(&run)))
            });
            course.is_common = !holed && course.first <= first && course.last >= last;
            if course.spans.len() > 1 || !course.is_common {
                course.events = happenings(&course.standings(&gaps, line, looks));
            }
        }
        Ok(Self {
            of: course_of,
            gaps,
        })
    }
}

impl Course {
    /// Returns the standings of a case by run, without undecided ones. A run without a record counts only if runs of its
    /// kind and profile have drawn the case: benches draw others than runs.
    fn standings(&self, gaps: &Gaps, line: &Line<'_>, looks: &Looks) -> Vec<(u32, Standing)> {
        let mut looks_by_run: Vec<Option<u32>> = vec![None; line.runs.len()];
        for (from, end, look) in self.ended() {
            looks_by_run[from as usize..end as usize].fill(Some(look));
        }
        for (from, runs) in gaps.list(self.gaps) {
            looks_by_run[from as usize..(from + runs) as usize].fill(None);
        }
        let drawn = looks_by_run.iter().zip(&line.runs);
        let drawn = drawn.filter_map(|(look, run)| look.map(|_| run.sort));
        let sorts: HashSet<_> = drawn.collect();
        let each = looks_by_run.iter().zip(&line.runs).zip(0..);
        each.filter_map(|((look, run), index)| match look {
            Some(look) if looks.is_undecided(*look) => None,
            Some(look) => Some((index, looks.standing(*look))),
            None => (run.whole && sorts.contains(&run.sort)).then_some((index, Standing::Unknown)),
        })
        .collect()
    }
}
