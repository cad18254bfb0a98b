//! Series of frame times with their change points and triage.

use super::places::Places;
use crate::threads::on_threads;
use etalon_history::{
    History, HistoryError, MachineId, SeriesKey, TimePoint, TriageEntry, TriageStates,
    TriageSubject,
};
use etalon_record::Time;
use etalon_stats::{ChangePoint, Changes, TimedRun, change_points};

/// The times that are shown as series.
const TIMES: [Time; 4] = [Time::Wall, Time::Gpu, Time::Cpu, Time::ReadBack];
/// The number of most recent runs in which a change can count as newly found.
const RECENT: usize = 40;

/// The times of one case on one adapter, one machine and one ruler.
pub(super) struct CaseTimes {
    /// The case's number minus one.
    pub(super) case: usize,
    /// The index of the timeline.
    pub(super) line: usize,
    pub(super) machine: MachineId,
    /// The description of the ruler; `None` if no ruler was timed.
    pub(super) ruler: Option<String>,
    pub(super) times: Vec<Timed>,
}

/// One kind of time of a series.
pub(super) struct Timed {
    pub(super) time: Time,
    /// The indices of the runs.
    pub(super) runs: Vec<usize>,
    pub(super) points: Vec<TimedRun>,
    pub(super) changes: Changes,
    /// The last entry of triage of each change.
    pub(super) states: Vec<Option<TriageEntry>>,
    /// True for each change that was found only with the last run.
    pub(super) fresh: Vec<bool>,
}

/// Reads all series, sorted by case.
pub(super) fn read(
    history: &History,
    places: &Places<'_>,
    states: &TriageStates,
) -> Result<Vec<CaseTimes>, HistoryError> {
    let mut series_list: Vec<CaseTimes> = Vec::new();
    let mut measured = Vec::new();
    for key in history.series_keys()? {
        let line = places.timelines.iter().position(|l| l.name == key.timeline);
        let Some(line) = line else { continue };
        let said = said(history, &key, places, states)?;
        for (ruler, points) in history.series_by_ruler(&key)? {
            for time in TIMES {
                let point = |p: &TimePoint| Some((places.of(p.run)?, p.times.point(time)?));
                let (runs, points): (Vec<_>, Vec<_>) = points.iter().filter_map(point).unzip();
                let said = said.iter().filter(|(kind, ..)| *kind == time);
                if !points.is_empty() {
                    measured.push(MeasuredTime {
                        series: series_list.len(),
                        time,
                        runs,
                        points,
                        said: said.map(|(_, place, entry)| (*place, *entry)).collect(),
                    });
                }
            }
            series_list.push(CaseTimes {
                case: key.case.number() as usize - 1,
                line,
                machine: key.machine,
                ruler: ruler.map(str::to_owned),
                times: Vec::new(),
            });
        }
    }
    // Finding the changes takes nearly all of the time. All points were checked, so no error can occur.
    let found = on_threads(&measured, MeasuredTime::timed);
    for (key, timed) in measured.iter().zip(found) {
        series_list[key.series].times.extend(timed);
    }
    series_list.retain(|series| !series.times.is_empty());
    Ok(series_list)
}

/// One kind of time of a series.
struct MeasuredTime<'a> {
    /// The index of the series.
    series: usize,
    time: Time,
    /// The indices of the runs.
    runs: Vec<usize>,
    points: Vec<TimedRun>,
    /// Triage of the series' steps, by the index of the run.
    said: Vec<(usize, &'a TriageEntry)>,
}

impl MeasuredTime<'_> {
    fn timed(&self) -> Option<Timed> {
        let changes = change_points(&self.points).ok()?;
        Some(Timed {
            time: self.time,
            runs: self.runs.clone(),
            points: self.points.clone(),
            states: changes.points.iter().map(|c| self.state(c)).collect(),
            fresh: fresh(&self.points, &changes),
            changes,
        })
    }

    /// Returns the entry about the first run after a change, else the entry about the last run within its
    /// bounds.
    fn state(&self, change: &ChangePoint) -> Option<TriageEntry> {
        let [after, by] = change.between.map(|index| self.runs.get(index).copied());
        let first = self.runs.get(change.index).copied();
        let ranked = self.said.iter().filter_map(|(place, entry)| {
            let is_first = first == Some(*place);
            let within =
                after.is_some_and(|after| *place > after) && by.is_some_and(|by| *place <= by);
            (is_first || within).then_some(((is_first, *place), *entry))
        });
        let (_, entry) = ranked.max_by_key(|(rank, _)| *rank)?;
        Some(entry.clone())
    }
}

/// Returns the triage entries about the steps of a series, each with its time and the index of its run.
fn said<'a>(
    history: &History,
    key: &SeriesKey,
    places: &Places<'_>,
    states: &'a TriageStates,
) -> Result<Vec<(Time, usize, &'a TriageEntry)>, HistoryError> {
    if states.is_empty() {
        return Ok(Vec::new());
    }
    let case = history.case_name(key.case)?;
    let is_subject =
        |subject: &TriageSubject| *subject.case == *case && *subject.timeline == *key.timeline;
    let entries = states.iter().filter(|(subject, _)| is_subject(subject));
    let entries = entries.filter_map(|(subject, entry)| {
        let step = subject.step.filter(|step| step.machine == key.machine)?;
        Some((step.time, places.of(step.run)?, entry))
    });
    Ok(entries.collect())
}

impl Timed {
    /// Returns the changes, each with its triage and whether it was found only with the last run.
    pub(super) fn told(&self) -> impl Iterator<Item = (&ChangePoint, Option<&TriageEntry>, bool)> {
        let points = self.changes.points.iter().zip(&self.states);
        points
            .zip(&self.fresh)
            .map(|((change, state), fresh)| (change, state.as_ref(), *fresh))
    }
}

/// Returns whether each change was found only with the last run.
fn fresh(points: &[TimedRun], changes: &Changes) -> Vec<bool> {
    let recent = |change: &&ChangePoint| change.index + RECENT >= points.len();
    let before = match changes.points.last().filter(recent) {
        Some(_) => change_points(&points[..points.len() - 1]).ok(),
        None => None,
    };
    let each = changes.points.iter().map(|change| {
        let same = |other: &ChangePoint| {
            let [from, to] = change.between;
            (from..=to).contains(&other.index)
                || (other.between[0]..=other.between[1]).contains(&change.index)
        };
        let known = before
            .as_ref()
            .map(|changes| changes.points.iter().any(same));
        recent(&change) && known == Some(false)
    });
    each.collect()
}
