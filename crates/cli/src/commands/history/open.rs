//! Results without a triage entry: unexplained bad verdicts, and steps of frame times.

use super::place::run_text;
use super::series::{of_key, state_name, state_text};
use super::show::subject;
use super::verdicts::{is_meant, verdicts};
use etalon_history::{
    AdapterRun, CaseNumber, History, HistoryError, OutcomeId, TriageEntry, TriageState,
    TriageStates,
};
use etalon_record::{Labels, Time};
use etalon_report::plain;
use etalon_stats::{Cause, VerdictEvent};
use serde_json::{Value, json};
use std::collections::{BTreeMap, BTreeSet};
use std::rc::Rc;

/// An open verdict or step.
pub(super) struct Open {
    /// The line for people.
    pub(super) line: String,
    /// The JSON for programs.
    pub(super) json: Value,
}

fn is_settled(entry: Option<&TriageEntry>) -> bool {
    entry.is_some_and(|entry| entry.state != TriageState::New)
}

/// Returns the last record of each case on a timeline. Some cases can be drawn more often than others, so
/// this reads the last run of each kind, profile and set of labels, the newest first.
fn last_records(
    history: &History,
    timeline: &str,
    labels: &Labels,
) -> Result<BTreeMap<CaseNumber, OutcomeId>, HistoryError> {
    let parts: Vec<&AdapterRun> = history
        .adapter_runs()
        .iter()
        .filter(|part| *part.timeline == *timeline && is_meant(history, part.run, labels))
        .collect();
    let mut seen = BTreeSet::new();
    let mut last = BTreeMap::new();
    for part in parts.into_iter().rev() {
        let Some(info) = history.run(part.run) else {
            continue;
        };
        if seen.insert((info.kind, &info.profile, &info.labels)) {
            for (case, outcome) in history.records(part)? {
                last.entry(case).or_insert(outcome);
            }
        }
    }
    Ok(last)
}

/// Returns the bad verdicts of the last records that no finding explains.
pub(super) fn open_verdicts(
    history: &History,
    timelines: &[Rc<str>],
    labels: &Labels,
    states: &TriageStates,
    settled: bool,
) -> Result<Vec<Open>, HistoryError> {
    let mut found = Vec::new();
    for timeline in timelines {
        for (case, outcome) in last_records(history, timeline, labels)? {
            let outcome = history.outcome(outcome)?;
            if !outcome.unexpected() {
                continue;
            }
            let case = history.case_name(case)?;
            let entry = states.get(&subject(&case, timeline));
            if is_settled(entry) && !settled {
                continue;
            }
            let by_adapter = verdicts(history, &case, std::slice::from_ref(timeline), labels)?;
            let broken = by_adapter.first().and_then(|of_adapter| {
                let mut events = of_adapter.happenings.iter().rev();
                events.find(|h| matches!(h.event, VerdictEvent::Broken | VerdictEvent::Flaky))
            });
            let first = by_adapter
                .first()
                .and_then(|of_adapter| of_adapter.records.first());
            let since = match (broken, first) {
                (Some(broken), _) => run_text(history, broken.at),
                (None, Some(first)) => format!("{}, its first", run_text(history, first.run)),
                (None, None) => String::new(),
            };
            found.push(Open {
                line: format!(
                    "{} on {}: {} since {since}; {}",
                    plain(&case, 300),
                    plain(timeline, 100),
                    outcome.verdict.name(),
                    state_text(entry)
                ),
                json: json!({
                    "case": &*case,
                    "adapter": &**timeline,
                    "verdict": outcome.verdict.name(),
                    "since": broken.map(|broken| broken.at.number()),
                    "state": state_name(entry),
                    "reason": entry.map(|entry| &entry.reason),
                }),
            });
        }
    }
    Ok(found)
}

/// Returns the steps of frame times that the machine did not cause, the newest first.
pub(super) fn open_steps(
    history: &History,
    timelines: &[Rc<str>],
    labels: &Labels,
    states: &TriageStates,
    time: Time,
    settled: bool,
) -> Result<Vec<Open>, HistoryError> {
    let mut found = Vec::new();
    for key in history.series_keys()? {
        if !timelines.contains(&key.timeline) {
            continue;
        }
        let case = history.case_name(key.case)?;
        for series in of_key(history, &key, &case, time, labels)? {
            for change in series.changes() {
                let entry = series.state(states, change);
                if change.cause == Cause::Machine || is_settled(entry) && !settled {
                    continue;
                }
                let run = series.first_run(change);
                let line = format!(
                    "{} on {}: {}",
                    plain(&case, 300),
                    plain(&key.timeline, 100),
                    series.change_line(history, states, change)
                );
                let json = json!({
                    "case": &*case,
                    "adapter": &*key.timeline,
                    "machine": key.machine.number(),
                    "time": time.name(),
                    "run": run.number(),
                    "ratio": change.ratio.estimate,
                    "low": change.ratio.low,
                    "high": change.ratio.high,
                    "visible": change.visible,
                    "state": state_name(entry),
                    "reason": entry.map(|entry| &entry.reason),
                });
                found.push((history.place(run), Open { line, json }));
            }
        }
    }
    found.sort_by_key(|(place, _)| std::cmp::Reverse(*place));
    Ok(found.into_iter().map(|(_, open)| open).collect())
}
