//! Finds what changed since the last run of each adapter, and which changes count.

use super::{NewsEntry, RunNews, Since};
use etalon_history::{
    AdapterRun, History, HistoryError, Kind, Outcome, RunInfo, TriageEntry, TriageState,
    TriageStates, TriageSubject, format_time, parse_time,
};
use etalon_record::{Change, Labels, Record, Run, Standing, Verdict};
use std::cmp::Reverse;
use std::collections::HashMap;
use std::rc::Rc;

/// The label that runs must share to be compared.
const BRANCH: &str = "branch";

/// The run to compare with the runs of a history.
struct Now<'r> {
    run: &'r Run,
    /// The start; `i64::MAX` if the header has none.
    started: i64,
}

impl<'r> Now<'r> {
    fn new(run: &'r Run) -> Self {
        Self {
            run,
            started: parse_time(&run.header.provenance.started).unwrap_or(i64::MAX),
        }
    }

    /// True if the history's run is this run, or an earlier state of it, before it was resumed.
    fn is(&self, info: &RunInfo) -> bool {
        let header = &self.run.header;
        format_time(info.started) == header.provenance.started
            && info.commit == header.provenance.commit
            && info.etalon == header.provenance.etalon
    }

    /// True if the history's run came before this one.
    fn follows(&self, info: &RunInfo) -> bool {
        info.started <= self.started && !self.is(info)
    }
}

impl RunNews {
    /// Compares a run with the last run of each of its adapters in a history, among those with the same label `branch`.
    ///
    /// # Errors
    /// When the history cannot be read.
    pub fn of(history: &History, run: &Run, labels: &Labels) -> Result<Self, HistoryError> {
        let states = history.triage_states()?;
        let now = Now::new(run);
        let mut news = Self::default();
        let mut gravity = HashMap::new();
        for adapter in &run.header.adapters {
            let records: Vec<&Record> = run
                .records
                .iter()
                .filter(|r| r.adapter == adapter.info.name)
                .collect();
            let before = last(history, &now, &adapter.info.name, &records, labels)?;
            news.since.push(Since {
                adapter: adapter.info.name.clone(),
                run: before.map(|(info, part)| told(info, part)),
            });
            let old: HashMap<Rc<str>, Rc<Outcome>> = match before {
                None => HashMap::new(),
                Some((_, part)) => {
                    let records = history.records(part)?.into_iter();
                    records
                        .map(|(case, outcome)| {
                            Ok((history.case_name(case)?, history.outcome(outcome)?))
                        })
                        .collect::<Result<_, HistoryError>>()?
                }
            };
            for record in records {
                let was = old.get(&*record.case);
                let entry = |note: String| NewsEntry {
                    case: record.case.clone(),
                    adapter: record.adapter.clone(),
                    verdict: record.verdict,
                    note,
                };
                if !record.unexpected() {
                    if let Some(was) = was.filter(|was| was.unexpected()) {
                        let entry = entry(format!("{} before", was.verdict.name()));
                        match Change::between(&**was, record) {
                            Change::Better => news.fixed.push(entry),
                            _ => news.undecided.push(entry),
                        }
                    }
                    continue;
                }
                gravity.insert(
                    (record.case.clone(), record.adapter.clone()),
                    record.verdict.severity(),
                );
                if let Some(said) = settled(history, &states, &now, record)? {
                    let note = format!("{}: {}", said.state, said.reason);
                    news.triaged.push(entry(note));
                    continue;
                }
                match was {
                    Some(was) if Change::between(&**was, record) != Change::Worse => {
                        let note = if was.verdict == record.verdict {
                            "as before".to_owned()
                        } else {
                            format!("{} before", was.verdict.name())
                        };
                        news.old.push(entry(note));
                    }
                    Some(was) => {
                        let expected = if was.expected.is_some() {
                            ", expected then"
                        } else {
                            ""
                        };
                        news.broken
                            .push(entry(format!("{} before{expected}", was.verdict.name())));
                    }
                    None if before.is_none() => {
                        news.uncompared.push(entry("no earlier run".to_owned()));
                    }
                    None => news.broken.push(entry("not in the run before".to_owned())),
                }
            }
        }
        for list in [
            &mut news.broken,
            &mut news.uncompared,
            &mut news.old,
            &mut news.triaged,
        ] {
            list.sort_by_cached_key(|e| {
                let severity = gravity.get(&(e.case.clone(), e.adapter.clone())).copied();
                (Reverse(severity), e.case.clone(), e.adapter.clone())
            });
        }
        Ok(news)
    }
}

/// Returns the last run of an adapter before this one, on the same branch, that has any of these cases.
fn last<'h>(
    history: &'h History,
    now: &Now<'_>,
    adapter: &str,
    records: &[&Record],
    labels: &Labels,
) -> Result<Option<(&'h RunInfo, &'h AdapterRun)>, HistoryError> {
    for part in history.adapter_runs().iter().rev() {
        let Some(info) = history.run(part.run) else {
            continue;
        };
        let meant = info.kind == Kind::Run
            && info.resumed.is_none()
            && *part.timeline == *adapter
            && info.labels.get(BRANCH) == labels.get(BRANCH);
        if !meant || !now.follows(info) {
            continue;
        }
        for record in records {
            if let Some(case) = history.case_id(&record.case)?
                && history.has_record(part, case)?
            {
                return Ok(Some((info, part)));
            }
        }
    }
    Ok(None)
}

/// Returns a text for the previous run.
fn told(info: &RunInfo, part: &AdapterRun) -> String {
    let commit = info.commit.as_deref().map_or(String::new(), |commit| {
        format!(", suite {}", commit.chars().take(12).collect::<String>())
    });
    format!(
        "run {} of {}, driver {}{commit}",
        info.id,
        format_time(info.time()),
        part.adapter.shown_version()
    )
}

/// Returns the triage entry that keeps a bad verdict from counting, if any.
///
/// An ignored case stays settled until triage changes it. A case that triage called real stays settled until
/// a later run draws it right. If it breaks again after that, that is another change. Both settle wrong
/// pictures. They settle another bad verdict only if the history has it for this case too, so a Fail that is
/// now a Crash is news. The history's record of this run counts if the entry is newer than the run's start.
/// Later runs do not count.
fn settled<'s>(
    history: &History,
    states: &'s TriageStates,
    now: &Now<'_>,
    record: &Record,
) -> Result<Option<&'s TriageEntry>, HistoryError> {
    let subject = TriageSubject {
        case: record.case.clone(),
        timeline: record.adapter.clone(),
        step: None,
    };
    let said = states.get(&subject);
    let said = said.filter(|e| matches!(e.state, TriageState::Real | TriageState::Ignored));
    let Some(said) = said else {
        return Ok(None);
    };
    let mut seen = record.verdict.is_violation();
    seen |= said.state == TriageState::Ignored && record.verdict == Verdict::Flaky;
    for of_case in history.case_history(&record.case, Some(&record.adapter))? {
        for point in &of_case.points {
            let Some(info) = history.run(point.run) else {
                continue;
            };
            let of_now = now.is(info) && said.at >= info.started;
            if !of_now && !now.follows(info) {
                continue;
            }
            let outcome = history.outcome(point.outcome)?;
            seen |= outcome.verdict == record.verdict;
            let later = info.started > said.at;
            if later && said.state == TriageState::Real && outcome.standing() == Standing::Good {
                return Ok(None);
            }
        }
    }
    Ok(seen.then_some(said))
}
