//! The data from which all pages of a history are made.

use super::courses::Courses;
use super::families::Families;
use super::looks::Looks;
use super::places::{Line, Places};
use super::scores::Scores;
use super::times::{self, CaseTimes};
use etalon_history::{History, HistoryError, TriageStates};
use std::rc::Rc;

/// The data from which all pages of a history are made.
pub(super) struct Model<'a> {
    pub(super) history: &'a History,
    pub(super) places: &'a Places<'a>,
    pub(super) cases: &'a [Rc<str>],
    pub(super) families: Families,
    pub(super) looks: Looks,
    pub(super) timelines: Vec<Timeline<'a>>,
    pub(super) series: Vec<CaseTimes>,
    pub(super) states: TriageStates,
}

/// A timeline, with the histories and scores of its cases.
pub(super) struct Timeline<'a> {
    pub(super) line: &'a Line<'a>,
    pub(super) courses: Courses,
    pub(super) scores: Scores,
    /// The index of the timeline's last run.
    pub(super) last: usize,
}

impl<'a> Model<'a> {
    /// Reads all records of the runs.
    pub(super) fn read(history: &'a History, places: &'a Places<'a>) -> Result<Self, HistoryError> {
        let cases = history.cases()?;
        let families = Families::new(cases);
        let mut looks = Looks::default();
        let mut timelines = Vec::new();
        for line in &places.timelines {
            let mut scores = Scores::new(families.names.len(), line.runs.len());
            let take = |run, case: usize, look, looks: &Looks| {
                scores.take(families.of[case], run, looks.standing(look));
            };
            let courses = Courses::read(history, line, cases.len(), &mut looks, take)?;
            scores.compare(&courses, line, &families, &looks);
            timelines.push(Timeline {
                line,
                courses,
                scores,
                last: line.last(&places.runs),
            });
        }
        let states = history.triage_states()?;
        Ok(Self {
            history,
            places,
            cases,
            families,
            looks,
            timelines,
            series: times::read(history, places, &states)?,
            states,
        })
    }

    /// Returns the name of a timeline.
    pub(super) fn name(&self, line: usize) -> &str {
        &self.timelines[line].line.name
    }
}
