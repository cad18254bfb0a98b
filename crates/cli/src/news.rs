//! `--history`: what a run tells that the last run of each adapter did not, and what of it counts.

use crate::failure::Failure;
use crate::history_file::{LabelArguments, failure};
use crate::output::say;
use clap::Args;
use etalon_history::{
    AdapterRun, History, HistoryError, Kind, Labels, Outcome, RunInfo, Subject, TriageEntry,
    TriageState, TriageStates, format_time, parse_time,
};
use etalon_record::{Record, Run, Standing, Verdict};
use etalon_report::{News, NewsEntry, Since, quoted};
use std::borrow::Cow;
use std::cmp::Reverse;
use std::collections::HashMap;
use std::path::{Path, PathBuf};
use std::rc::Rc;

/// The label by which runs follow each other.
const BRANCH: &str = "branch";

#[derive(Clone, Debug, Args)]
pub(crate) struct NewsArguments {
    /// Compare with the last run of each adapter before this one in this history, and tell news first. Bad verdicts that `etalon history
    /// triage` calls real or ignored do not count. A file that is not there is named, and changes nothing
    #[arg(long, value_name = "FILE")]
    pub(crate) history: Option<PathBuf>,
    #[command(flatten)]
    pub(crate) labels: LabelArguments,
}

impl NewsArguments {
    /// Refuses labels and a file that cannot be used, before anything is drawn.
    pub(crate) fn check(&self) -> Result<(), Failure> {
        let labels = self.labels.labels()?;
        let Some(path) = &self.history else {
            return match labels.is_empty() {
                true => Ok(()),
                false => Err(Failure::usage("--label is for --history: name its file")),
            };
        };
        match History::open_read(path) {
            Ok(_) | Err(HistoryError::None { .. } | HistoryError::Busy { .. }) => Ok(()),
            Err(error) => Err(failure(error)),
        }
    }

    /// The news of a run; `None` without a history that can be read, which is told.
    pub(crate) fn news(&self, run: &Run) -> Result<Option<News>, Failure> {
        let Some(path) = &self.history else {
            return Ok(None);
        };
        let labels = self.labels.labels()?;
        Ok(match news(path, run, &labels) {
            Ok(news) => Some(news),
            Err(error) => {
                say!("{error}; the run is judged without a history");
                None
            }
        })
    }

    /// Tells how the run is added, where a history was named.
    pub(crate) fn tell_how_to_add(&self, folder: &Path) {
        if let Some(path) = &self.history {
            let words = ["--db".to_owned(), path.display().to_string()].into_iter();
            let words = words.chain(self.labels.words().map(str::to_owned));
            let words: Vec<String> = words.map(|word| quoted(&word)).collect();
            let folder = quoted(&folder.display().to_string());
            say!(
                "add it with: etalon history add {folder} {}",
                words.join(" ")
            );
        }
    }
}

/// The run as its reports show it.
pub(crate) fn shown<'r>(run: &'r Run, news: Option<&News>) -> Cow<'r, Run> {
    news.map_or(Cow::Borrowed(run), |news| news.settle(run))
}

/// The run that is compared, among those of a history.
struct Now<'r> {
    run: &'r Run,
    /// When it began; the end of time where its header has none.
    started: i64,
}

impl<'r> Now<'r> {
    fn new(run: &'r Run) -> Self {
        Self {
            run,
            started: parse_time(&run.header.started).unwrap_or(i64::MAX),
        }
    }

    /// True if the history's run is this one, also as it was before it was resumed.
    fn is(&self, info: &RunInfo) -> bool {
        let header = &self.run.header;
        format_time(info.started) == header.started
            && info.commit == header.commit
            && info.etalon == header.etalon
    }

    /// True if the history's run came before this one.
    fn follows(&self, info: &RunInfo) -> bool {
        info.started <= self.started && !self.is(info)
    }
}

fn news(path: &Path, run: &Run, labels: &Labels) -> Result<News, HistoryError> {
    let history = History::open_read(path)?;
    let states = history.triage_states()?;
    let now = Now::new(run);
    let mut news = News::default();
    let mut gravity = HashMap::new();
    for adapter in &run.header.adapters {
        let records: Vec<&Record> = run
            .records
            .iter()
            .filter(|r| r.adapter == adapter.name)
            .collect();
        let before = last(&history, &now, &adapter.name, &records, labels)?;
        news.since.push(Since {
            adapter: adapter.name.clone(),
            run: before.map(|(info, part)| told(info, part)),
        });
        let old: HashMap<Rc<str>, Rc<Outcome>> = match before {
            None => HashMap::new(),
            Some((_, part)) => {
                let all = history.records(part)?.into_iter();
                all.map(|(case, outcome)| Ok((history.case_name(case)?, history.outcome(outcome)?)))
                    .collect::<Result<_, HistoryError>>()?
            }
        };
        for record in records {
            let was = old.get(&*record.case);
            let was_bad = was.is_some_and(|was| was.unexpected());
            let entry = |note: String| NewsEntry {
                case: record.case.clone(),
                adapter: record.adapter.clone(),
                verdict: record.verdict.name().to_owned(),
                note,
            };
            if !record.unexpected() {
                if was_bad {
                    let was = was.map_or("", |was| was.verdict.name());
                    news.fixed.push(entry(format!("{was} before")));
                }
                continue;
            }
            gravity.insert(
                (record.case.clone(), record.adapter.clone()),
                record.verdict.severity(),
            );
            if let Some(said) = settled(&history, &states, &now, record)? {
                let note = format!("{}: {}", said.state, said.reason);
                news.triaged.push(entry(note));
                continue;
            }
            match was {
                Some(was) if was_bad => {
                    let note = match was.verdict == record.verdict {
                        true => "as before".to_owned(),
                        false => format!("{} before", was.verdict.name()),
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
                None => news.broken.push(entry("not in the run before".to_owned())),
            }
        }
    }
    for list in [&mut news.broken, &mut news.old, &mut news.triaged] {
        list.sort_by_cached_key(|e| {
            let severity = gravity.get(&(e.case.clone(), e.adapter.clone())).copied();
            (Reverse(severity), e.case.clone(), e.adapter.clone())
        });
    }
    Ok(news)
}

/// The last run of an adapter before this one, on the same branch, that has any of these cases.
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

/// The run before in words.
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

/// Returns the entry for which a bad verdict does not count, if there is one.
///
/// What is ignored stays so until somebody says otherwise. What is real stays so until a later run draws the case right:
/// when it breaks again, that is another change. Both speak of wrong pictures, and of another bad verdict only where the
/// history has that one of this case, too: a Fail that is now a Crash is news. It may have it of this run, if somebody
/// said it since. Later runs say nothing.
fn settled<'s>(
    history: &History,
    states: &'s TriageStates,
    now: &Now<'_>,
    record: &Record,
) -> Result<Option<&'s TriageEntry>, HistoryError> {
    let subject = Subject {
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
