//! Series of frame times with their change points, and what people said of these.

use super::places::Places;
use crate::threads::on_threads;
use etalon_history::{
    History, HistoryError, MachineId, RunId, SeriesKey, Subject, TimePoint, TriageEntry,
    TriageStates,
};
use etalon_record::Time;
use etalon_stats::{ChangePoint, Changes, Point, change_points};

/// The times of which series are shown.
const TIMES: [Time; 4] = [Time::Wall, Time::Gpu, Time::Cpu, Time::ReadBack];
/// A change so many runs ago or less may have been found with the last run.
const RECENT: usize = 40;

/// The times of one case on one adapter and one machine, all beside the same ruler.
pub(super) struct Series {
    /// The case's number less one.
    pub(super) case: usize,
    /// The place of the timeline.
    pub(super) line: usize,
    pub(super) machine: MachineId,
    /// The description of the ruler; `None` where no ruler was timed.
    pub(super) ruler: Option<String>,
    pub(super) times: Vec<Timed>,
}

/// One time of a series.
pub(super) struct Timed {
    pub(super) time: Time,
    /// The places of the runs.
    pub(super) runs: Vec<usize>,
    pub(super) points: Vec<Point>,
    pub(super) changes: Changes,
    /// The last entry of triage, by change.
    pub(super) states: Vec<Option<TriageEntry>>,
    /// True by change if the last run showed it.
    pub(super) fresh: Vec<bool>,
}

/// Reads all series, sorted by case.
pub(super) fn read(
    history: &History,
    places: &Places<'_>,
    states: &TriageStates,
) -> Result<Vec<Series>, HistoryError> {
    let mut all = Vec::new();
    let mut measured = Vec::new();
    for key in history.series_keys()? {
        let line = places.timelines.iter().position(|l| l.name == key.timeline);
        let Some(line) = line else { continue };
        let of_case = Said::of(history, &key, states)?;
        for (ruler, points) in history.series_by_ruler(&key)? {
            let times = TIMES.into_iter();
            let times = times.filter_map(|time| Measured::new(time, &points, places, &of_case));
            measured.extend(times.map(|one| (all.len(), one)));
            all.push(Series {
                case: key.case.number() as usize - 1,
                line,
                machine: key.machine,
                ruler: ruler.map(str::to_owned),
                times: Vec::new(),
            });
        }
    }
    // Changes take nearly all of the time.
    let found = on_threads(&measured, |(_, one)| Found::of(&one.points));
    for ((series, one), found) in measured.into_iter().zip(found) {
        let timed = found.map(|found| Timed::new(one, found, places));
        all[series].times.extend(timed);
    }
    all.retain(|series| !series.times.is_empty());
    Ok(all)
}

/// One time of a series, and what people said of it.
struct Measured<'a> {
    time: Time,
    /// The places of the runs.
    runs: Vec<usize>,
    points: Vec<Point>,
    said: Vec<(RunId, &'a TriageEntry)>,
}

impl<'a> Measured<'a> {
    /// `None` where no run measured it.
    fn new(time: Time, points: &[TimePoint], places: &Places<'_>, said: &Said<'a>) -> Option<Self> {
        let usable = points.iter().filter_map(|point| {
            let place = places.of(point.run)?;
            Some((place, point.times.point(time)?))
        });
        let (runs, points): (Vec<usize>, Vec<Point>) = usable.unzip();
        let said = said.entries.iter().filter(|(of, ..)| *of == time);
        (!points.is_empty()).then(|| Self {
            time,
            runs,
            points,
            said: said.map(|(_, run, entry)| (*run, *entry)).collect(),
        })
    }
}

/// The changes of one time.
struct Found {
    changes: Changes,
    /// True by change if the last run showed it.
    fresh: Vec<bool>,
}

impl Found {
    fn of(points: &[Point]) -> Option<Self> {
        // All points were checked, so there is no error.
        let changes = change_points(points).ok()?;
        let fresh = fresh(points, &changes);
        Some(Self { changes, fresh })
    }
}

/// The entries about the steps of one series: the time, the place of the run, the entry.
struct Said<'a> {
    entries: Vec<(Time, RunId, &'a TriageEntry)>,
}

impl<'a> Said<'a> {
    fn of(
        history: &History,
        key: &SeriesKey,
        states: &'a TriageStates,
    ) -> Result<Self, HistoryError> {
        if states.is_empty() {
            return Ok(Self {
                entries: Vec::new(),
            });
        }
        let case = history.case_name(key.case)?;
        let of = |subject: &Subject| *subject.case == *case && *subject.timeline == *key.timeline;
        let entries = states.iter().filter(|(subject, _)| of(subject));
        let entries = entries.filter_map(|(subject, entry)| {
            let step = subject.step.filter(|step| step.machine == key.machine)?;
            Some((step.time, step.run, entry))
        });
        Ok(Self {
            entries: entries.collect(),
        })
    }
}

impl Timed {
    fn new(measured: Measured<'_>, found: Found, places: &Places<'_>) -> Self {
        let Measured {
            time,
            runs,
            points,
            said,
        } = measured;
        let Found { changes, fresh } = found;
        let states = changes.points.iter().map(|change| {
            let [after, by] = change.between.map(|at| runs.get(at).copied());
            let first = runs.get(change.index).copied();
            // An entry about the first run behind the change, else about the last run within its ends.
            let rank = |place: usize| {
                let is_first = first == Some(place);
                let within =
                    after.is_some_and(|after| place > after) && by.is_some_and(|by| place <= by);
                (is_first || within).then_some((is_first, place))
            };
            let entries = said.iter();
            let ranked = entries.filter_map(|(run, entry)| Some((rank(places.of(*run)?)?, *entry)));
            ranked
                .max_by_key(|(rank, _)| *rank)
                .map(|(_, entry)| entry.clone())
        });
        let states = states.collect();
        Self {
            time,
            runs,
            points,
            changes,
            states,
            fresh,
        }
    }

    /// The changes with what people said of each, and whether the last run showed them.
    pub(super) fn told(&self) -> impl Iterator<Item = (&ChangePoint, Option<&TriageEntry>, bool)> {
        let told = self.changes.points.iter().zip(&self.states);
        told.zip(&self.fresh)
            .map(|((change, state), fresh)| (change, state.as_ref(), *fresh))
    }
}

/// True by change if it was not found without the last run.
fn fresh(points: &[Point], changes: &Changes) -> Vec<bool> {
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
        let known = before.as_ref().map(|all| all.points.iter().any(same));
        recent(&change) && known == Some(false)
    });
    each.collect()
}
