//! One case on one adapter over runs: its verdicts and events.

use super::place::{range_text, run_json, run_text};
use etalon_history::{AdapterRun, CaseHistory, History, HistoryError, Outcome, RunId};
use etalon_record::Labels;
use etalon_stats::{Happening, Standing, happenings};
use serde_json::{Value, json};
use std::collections::{BTreeMap, HashMap};
use std::rc::Rc;

/// A record of the case.
pub(super) struct DrawnRecord {
    /// The run.
    pub(super) run: RunId,
    /// The outcome.
    pub(super) outcome: Rc<Outcome>,
}

/// One case on one adapter over runs.
pub(super) struct Verdicts {
    /// The timeline of the adapter.
    pub(super) timeline: Rc<str>,
    /// The records, oldest first; at least one.
    pub(super) records: Vec<DrawnRecord>,
    /// The events, oldest first.
    pub(super) happenings: Vec<Happening<RunId>>,
}

/// Returns true if a run has all of these labels and was not resumed later.
pub(super) fn is_meant(history: &History, run: RunId, labels: &Labels) -> bool {
    let info = history.run(run);
    info.is_some_and(|info| info.resumed.is_none() && info.has_labels(labels))
}

/// Returns one case on these timelines, over the runs with these labels.
pub(super) fn verdicts(
    history: &History,
    case: &str,
    timelines: &[Rc<str>],
    labels: &Labels,
) -> Result<Vec<Verdicts>, HistoryError> {
    let mut found = Vec::new();
    for of_case in history.case_history(case, None)? {
        if timelines.contains(&of_case.timeline) {
            found.extend(Verdicts::new(history, &of_case, labels)?);
        }
    }
    Ok(found)
}

impl Verdicts {
    fn new(
        history: &History,
        of_case: &CaseHistory,
        labels: &Labels,
    ) -> Result<Option<Self>, HistoryError> {
        let mut records = Vec::new();
        for point in &of_case.points {
            if is_meant(history, point.run, labels) {
                records.push(DrawnRecord {
                    run: point.run,
                    outcome: history.outcome(point.outcome)?,
                });
            }
        }
        if records.is_empty() {
            return Ok(None);
        }
        let by_run: HashMap<RunId, &DrawnRecord> = records.iter().map(|d| (d.run, d)).collect();
        let parts = history.adapter_runs().iter();
        let parts = parts.filter(|part| {
            part.timeline == of_case.timeline && is_meant(history, part.run, labels)
        });
        let standings = standings(history, parts, &by_run);
        Ok(Some(Self {
            timeline: Rc::clone(&of_case.timeline),
            happenings: happenings(&standings),
            records,
        }))
    }

    /// Returns true if any run drew the case.
    pub(super) fn is_drawn(&self) -> bool {
        let mut records = self.records.iter();
        records.any(|drawn| drawn.outcome.standing() != Standing::Unknown)
    }

    /// Returns the last record.
    pub(super) fn last(&self) -> Option<&DrawnRecord> {
        self.records.last()
    }

    /// Returns the verdict of the case in a run.
    fn verdict(&self, run: RunId) -> Option<&'static str> {
        let drawn = self.records.iter().find(|drawn| drawn.run == run)?;
        Some(drawn.outcome.verdict.name())
    }

    /// Returns the events in words, one line each.
    pub(super) fn lines(&self, history: &History) -> Vec<String> {
        let line = |happening: &Happening<RunId>| {
            let Happening { event, after, at } = happening;
            let change = match [*after, *at].map(|run| self.verdict(run)) {
                [Some(before), Some(now)] => format!(", {before} before and {now} then"),
                _ => String::new(),
            };
            format!(
                "{} {}, after {}{change}; {}",
                event.name(),
                run_text(history, *at),
                run_text(history, *after),
                range_text(history, &self.timeline, [*after, *at])
            )
        };
        self.happenings.iter().map(line).collect()
    }

    /// Returns records and events as JSON.
    pub(super) fn json(&self, history: &History) -> Value {
        let records = self.records.iter().map(|drawn| {
            let mut value = run_json(history, drawn.run, &self.timeline);
            value["verdict"] = json!(drawn.outcome.verdict.name());
            value["expected"] = json!(drawn.outcome.expected);
            value["unexpected"] = json!(drawn.outcome.unexpected());
            value["inferred"] = json!(drawn.outcome.inferred);
            value
        });
        let events = self.happenings.iter().map(|happening| {
            json!({
                "event": format!("{:?}", happening.event).to_lowercase(),
                "after": happening.after.number(),
                "at": happening.at.number(),
            })
        });
        json!({
            "adapter": &*self.timeline,
            "records": records.collect::<Vec<_>>(),
            "events": events.collect::<Vec<_>>(),
        })
    }
}

/// Returns the standing of a case in each run that says something about it. A run without a record shows that
/// the case is missing only if the run is complete and at least half as large as the last run of its kind
/// that has the case: smaller runs had not selected it.
fn standings<'h>(
    history: &History,
    parts: impl Iterator<Item = &'h AdapterRun>,
    by_run: &HashMap<RunId, &DrawnRecord>,
) -> Vec<(RunId, Standing)> {
    let mut sizes = BTreeMap::new();
    let mut standings = Vec::new();
    for part in parts {
        let Some(info) = history.run(part.run) else {
            continue;
        };
        let kind = (info.kind, info.profile.clone());
        let standing = match by_run.get(&part.run) {
            Some(drawn) => {
                sizes.insert(kind, part.records);
                match drawn.outcome.standing() {
                    Standing::Unknown => continue,
                    standing => standing,
                }
            }
            None => {
                let size = sizes.get(&kind).copied();
                let is_complete = size.is_some_and(|size| part.records >= size / 2);
                if !is_complete || info.missing > 0 {
                    continue;
                }
                Standing::Unknown
            }
        };
        standings.push((part.run, standing));
    }
    standings
}
