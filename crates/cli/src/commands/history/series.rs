//! Frame times of one case on one adapter and machine over runs, and their changes.

use super::place::{range_text, run_json, run_text};
use super::sparkline;
use super::verdicts::is_meant;
use crate::counted::counted;
use clap::ValueEnum;
use etalon_history::{
    History, HistoryError, MachineId, RunId, SeriesKey, TimeStep, TriageEntry, TriageState,
    TriageStates, TriageSubject,
};
use etalon_record::{Labels, Time};
use etalon_report::plain;
use etalon_stats::{Cause, ChangePoint, Changes, Drift, Ratio, TimedRun, change_points};
use serde_json::{Value, json};

/// The number of runs after a change for which the smallest visible change is given.
const AFTER: usize = 10;

/// A time that the history has series for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(super) enum SeriesTime {
    /// From the start of a frame until the device is done.
    Wall,
    /// From the start of a frame until the last call that submits work returns.
    Cpu,
    /// Between the GPU timestamps of a frame.
    Gpu,
    /// Reading a frame back.
    ReadBack,
}

impl From<SeriesTime> for Time {
    fn from(time: SeriesTime) -> Self {
        match time {
            SeriesTime::Wall => Self::Wall,
            SeriesTime::Cpu => Self::Cpu,
            SeriesTime::Gpu => Self::Gpu,
            SeriesTime::ReadBack => Self::ReadBack,
        }
    }
}

/// Frame times over runs that have the same ruler.
pub(super) struct RulerSeries {
    /// The case, the timeline and the machine.
    pub(super) key: SeriesKey,
    /// The case's id.
    case: String,
    /// The time.
    time: Time,
    /// The runs, oldest first; at least one.
    runs: Vec<RunId>,
    /// The times of the runs.
    points: Vec<TimedRun>,
    /// The change points.
    changes: Changes,
}

/// Returns the series of a case, one for each machine and ruler.
pub(super) fn series_of(
    history: &History,
    case: &str,
    timeline: &str,
    time: Time,
    labels: &Labels,
) -> Result<Vec<RulerSeries>, HistoryError> {
    let Some(id) = history.case_id(case)? else {
        return Ok(Vec::new());
    };
    let mut keys: Vec<SeriesKey> = history
        .adapter_runs()
        .iter()
        .filter(|part| *part.timeline == *timeline)
        .map(|part| SeriesKey {
            case: id,
            timeline: part.timeline.clone(),
            machine: part.machine,
        })
        .collect();
    keys.sort_unstable();
    keys.dedup();
    let mut found = Vec::new();
    for key in keys {
        found.extend(of_key(history, &key, case, time, labels)?);
    }
    Ok(found)
}

/// Returns the series of a key, one for each ruler: times with different rulers do not compare.
pub(super) fn of_key(
    history: &History,
    key: &SeriesKey,
    case: &str,
    time: Time,
    labels: &Labels,
) -> Result<Vec<RulerSeries>, HistoryError> {
    let mut found = Vec::new();
    for timed in history.series_by_ruler(key)?.into_values() {
        let meant = timed
            .into_iter()
            .filter(|timed| is_meant(history, timed.run, labels))
            .filter_map(|timed| Some((timed.run, timed.times.point(time)?)));
        let (runs, points): (Vec<RunId>, Vec<TimedRun>) = meant.unzip();
        if points.is_empty() {
            continue;
        }
        let changes = change_points(&points).map_err(|error| {
            let path = history.path().to_owned();
            let message = format!("the times of {case}: {error}");
            HistoryError::Damaged { path, message }
        })?;
        found.push(RulerSeries {
            key: key.clone(),
            case: case.to_owned(),
            time,
            runs,
            points,
            changes,
        });
    }
    Ok(found)
}

/// Returns the change that a ratio means in percent, with its sign.
fn percent(ratio: f64) -> String {
    format!("{:+.1} %", (ratio - 1.0) * 100.0)
}

fn range(ratio: &Ratio) -> String {
    format!(
        "{} ({} to {})",
        percent(ratio.estimate),
        percent(ratio.low),
        percent(ratio.high)
    )
}

fn milliseconds(seconds: f64) -> String {
    let ms = seconds * 1000.0;
    let digits = if ms < 10.0 { 3 } else { 1 };
    format!("{ms:.digits$} ms")
}

impl RulerSeries {
    /// Returns the change points.
    pub(super) fn changes(&self) -> &[ChangePoint] {
        &self.changes.points
    }

    /// Returns the first run after a change.
    pub(super) fn first_run(&self, change: &ChangePoint) -> RunId {
        self.runs[change.index]
    }

    /// Returns the first run after the step whose ends enclose this run; `None` if there is no such step.
    pub(super) fn step_at(&self, run: RunId) -> Option<RunId> {
        let holds = |change: &&ChangePoint| self.holds(change, run);
        let mut changes = self.changes.points.iter();
        // Neighbouring steps can share an end; the step that begins with the run is preferred.
        let exact = changes.clone().find(|c| self.first_run(c) == run);
        exact
            .or_else(|| changes.find(holds))
            .map(|c| self.first_run(c))
    }

    /// Returns true if the change might be directly before this run.
    fn holds(&self, change: &ChangePoint, run: RunId) -> bool {
        let [after, first] = change.between;
        self.runs[after + 1..=first].contains(&run)
    }

    /// Returns the machine of the series.
    pub(super) fn machine(&self) -> MachineId {
        self.key.machine
    }

    /// Returns the last entry about a change. Further runs can move a change within its ends, so an entry
    /// about another run between them counts too.
    pub(super) fn state<'s>(
        &self,
        states: &'s TriageStates,
        change: &ChangePoint,
    ) -> Option<&'s TriageEntry> {
        let entry = |run: RunId| {
            states.get(&TriageSubject {
                case: self.case.clone(),
                timeline: self.key.timeline.to_string(),
                step: Some(TimeStep {
                    machine: self.key.machine,
                    time: self.time,
                    run,
                }),
            })
        };
        entry(self.first_run(change)).or_else(|| {
            let [after, first] = change.between;
            let runs = self.runs[after + 1..=first].iter();
            runs.rev().find_map(|run| entry(*run))
        })
    }

    /// Returns a change in words.
    pub(super) fn change_line(
        &self,
        history: &History,
        states: &TriageStates,
        change: &ChangePoint,
    ) -> String {
        let [after, first] = change.between.map(|index| self.runs[index]);
        let state = self.state(states, change);
        let returns = if change.returns {
            ", which goes back and forth"
        } else {
            ""
        };
        let ruler = change.ruler.map_or(String::new(), |ruler| {
            format!(", ruler {}", percent(ruler.estimate))
        });
        format!(
            "{} at {}: {} to {}{returns}; between runs {after} and {first}: {}; smallest visible change {}; {}{ruler}; {}",
            range(&change.ratio),
            run_text(history, self.first_run(change)),
            milliseconds(change.before),
            milliseconds(change.after),
            range_text(history, &self.key.timeline, [after, first]),
            percent(change.visible),
            change.cause.text(),
            state_text(state)
        )
    }

    /// Returns the series in words, as lines for a terminal.
    pub(super) fn lines(&self, history: &History, states: &TriageStates) -> Vec<String> {
        let machine = history.machine(self.key.machine);
        let machine = machine.map_or(String::new(), |m| {
            let cores = counted(u64::from(m.cores), "core");
            format!(" ({}, {cores})", plain(&m.cpu, 80))
        });
        let times: Vec<f64> = self.points.iter().map(|p| p.median).collect();
        let last = times.last().copied().map_or(String::new(), milliseconds);
        let mut lines = vec![
            format!(
                "{} time on machine {}{machine}, {}, last {last}",
                self.time.name(),
                self.key.machine,
                counted(times.len() as u64, "run")
            ),
            format!("  times  {}", sparkline::of_times(&times)),
        ];
        let rulers: Vec<f64> = self.points.iter().filter_map(|p| p.ruler).collect();
        if rulers.len() == times.len() {
            lines.push(format!("  ruler  {}", sparkline::of_times(&rulers)));
        }
        for change in &self.changes.points {
            lines.push(format!("  {}", self.change_line(history, states, change)));
        }
        for Drift {
            from,
            to,
            ratio,
            machine,
        } in &self.changes.drifts
        {
            let whose = if *machine {
                "the ruler drifts along"
            } else {
                "the ruler does not"
            };
            lines.push(format!(
                "  drift of {} from {} to {}; {whose}",
                range(ratio),
                run_text(history, self.runs[*from]),
                run_text(history, self.runs[to - 1])
            ));
        }
        lines.push(format!("  {}", self.outlook()));
        lines
    }

    /// Returns the smallest future change that would be visible, in words.
    fn outlook(&self) -> String {
        match self.changes.visible(AFTER) {
            Some(visible) => format!(
                "noise {:.1} %; a step of {} would be seen {AFTER} runs later",
                self.changes.noise * 100.0,
                percent(visible)
            ),
            None => "too few runs since to see a change".to_owned(),
        }
    }

    /// Returns the series as JSON.
    pub(super) fn json(&self, history: &History, states: &TriageStates) -> Value {
        let points = self.runs.iter().zip(&self.points).map(|(run, point)| {
            json!({ "run": run.number(), "seconds": point.median, "ruler": point.ruler })
        });
        let ratio = |r: &Ratio| json!({"estimate": r.estimate, "low": r.low, "high": r.high});
        let changes = self.changes.points.iter().map(|change| {
            let state = self.state(states, change);
            json!({
                "run": self.first_run(change).number(),
                "between": change.between.map(|index| run_json(history, self.runs[index], &self.key.timeline)),
                "before": change.before,
                "after": change.after,
                "ratio": ratio(&change.ratio),
                "ruler": change.ruler.as_ref().map(ratio),
                "ruled": change.ruled.as_ref().map(ratio),
                "p": change.p,
                "visible": change.visible,
                "cause": cause_name(change.cause),
                "returns": change.returns,
                "state": state_name(state),
                "reason": state.map(|entry| &entry.reason),
            })
        });
        let drifts = self.changes.drifts.iter().map(|drift| {
            json!({
                "from": self.runs[drift.from].number(),
                "to": self.runs[drift.to - 1].number(),
                "ratio": ratio(&drift.ratio),
                "machine": drift.machine,
            })
        });
        json!({
            "time": self.time.name(),
            "machine": self.key.machine.number(),
            "noise": self.changes.noise,
            "visible": self.changes.visible(AFTER),
            "points": points.collect::<Vec<_>>(),
            "changes": changes.collect::<Vec<_>>(),
            "drifts": drifts.collect::<Vec<_>>(),
        })
    }
}

fn cause_name(cause: Cause) -> &'static str {
    match cause {
        Cause::Driver => "driver",
        Cause::Machine => "machine",
        Cause::Unclear => "unclear",
        Cause::NoRuler => "no-ruler",
    }
}

/// Returns the name of an entry's state; new without an entry.
pub(super) fn state_name(entry: Option<&TriageEntry>) -> &'static str {
    entry.map_or(TriageState::New, |entry| entry.state).name()
}

/// Returns an entry's state with its reason; new without an entry.
pub(super) fn state_text(entry: Option<&TriageEntry>) -> String {
    let reason = entry.map_or("", |entry| entry.reason.as_str());
    match reason {
        "" => state_name(entry).to_owned(),
        reason => format!("{}: {}", state_name(entry), plain(reason, 300)),
    }
}
