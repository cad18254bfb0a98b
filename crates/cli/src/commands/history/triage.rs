//! `etalon history triage`.

use super::open::{Open, open_steps, open_verdicts};
use super::series::{SeriesTime, series_of, state_text};
use super::show::{known_case, known_timelines, subject};
use super::verdicts::verdicts;
use crate::counted::counted;
use crate::failure::Failure;
use crate::flags::OutputFormat;
use crate::history_file::{DatabaseArguments, OnlyArguments, failure};
use crate::output::{print, print_json, summarize};
use clap::{Args, ValueEnum};
use etalon_history::{
    History, MachineId, RunId, TimeStep, TriageEntry, TriageState, TriageSubject, Writer,
    format_time,
};
use etalon_record::Labels;
use etalon_report::plain;
use serde_json::json;
use std::time::SystemTime;

/// The largest number of entries of each kind that are printed.
const PRINTED: usize = 40;

/// A person's judgement of a change.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum ChangeState {
    /// Not looked at yet.
    New,
    /// The driver changed.
    Real,
    /// The change does not matter.
    Ignored,
    /// The change has been fixed.
    Fixed,
}

#[derive(Debug, Args)]
pub(crate) struct Arguments {
    /// Cases to set the state of. Default: list what is open
    #[arg(value_name = "CASE", requires_all = ["adapters", "state"])]
    pub(crate) cases: Vec<String>,
    /// Adapter of the cases; may be repeated. Without a case, list what is open on it
    #[arg(long = "adapter", value_name = "NAME")]
    pub(crate) adapters: Vec<String>,
    /// State to set: a bad verdict that is real or ignored does not count in `etalon run --history`
    #[arg(long, value_enum, requires = "cases")]
    pub(crate) state: Option<ChangeState>,
    /// Reason for the state; only new needs none
    #[arg(
        long,
        value_name = "TEXT",
        default_value = "",
        hide_default_value = true,
        requires = "state"
    )]
    pub(crate) reason: String,
    /// Author of the entry. Default: the variable USER
    #[arg(long, value_name = "NAME", requires = "state")]
    pub(crate) author: Option<String>,
    /// Set the state of the change of frame times at this run, not of the verdict
    #[arg(long, value_name = "RUN", requires = "cases")]
    pub(crate) step: Option<u32>,
    /// Time of the change, or time whose open changes are listed
    #[arg(long, value_enum, default_value = "wall")]
    time: SeriesTime,
    /// Also list settled verdicts and changes
    #[arg(long, conflicts_with = "cases")]
    pub(crate) all: bool,
    #[command(flatten)]
    pub(crate) labels: OnlyArguments,
    #[command(flatten)]
    pub(crate) database: DatabaseArguments,
    /// Output format
    #[arg(long, value_enum, default_value = "text")]
    pub(crate) format: OutputFormat,
}

/// Lists what is open, or adds entries.
pub(crate) fn run(arguments: &Arguments) -> Result<u8, Failure> {
    let labels = arguments.labels.labels()?;
    let path = arguments.database.path();
    let history = History::open_read(&path).map_err(failure)?;
    let Some(state) = arguments.state else {
        return list(arguments, &history, &labels);
    };
    if state != ChangeState::New && arguments.reason.trim().is_empty() {
        return Err(Failure::usage(
            "a state needs a reason: say why with --reason TEXT",
        ));
    }
    let subjects = subjects(arguments, &history, &labels)?;
    // A reader holds no lock, but its file must not be replaced while it reads.
    drop(history);
    let mut writer = Writer::open(&path).map_err(failure)?;
    let entries = subjects.into_iter().map(|subject| TriageEntry {
        at: now(),
        author: author(arguments),
        subject,
        state: state.into(),
        reason: arguments.reason.trim().to_owned(),
    });
    let entries: Vec<TriageEntry> = entries.collect();
    for entry in &entries {
        writer.triage(entry).map_err(failure)?;
    }
    match arguments.format {
        OutputFormat::Text => {
            let lines = entries.iter().map(|entry| line(entry) + "\n");
            summarize(&lines.collect::<String>());
        }
        OutputFormat::Json => print_json(&entries.iter().map(entry_json).collect::<Vec<_>>())?,
    }
    Ok(0)
}

fn now() -> i64 {
    let since = SystemTime::now().duration_since(SystemTime::UNIX_EPOCH);
    since.map_or(0, |since| since.as_secs().try_into().unwrap_or(i64::MAX))
}

fn author(arguments: &Arguments) -> String {
    let user = || std::env::var("USER").unwrap_or_default();
    arguments.author.clone().unwrap_or_else(user)
}

/// Returns the subjects that the command line names. Looks up everything before anything is written.
fn subjects(
    arguments: &Arguments,
    history: &History,
    labels: &Labels,
) -> Result<Vec<TriageSubject>, Failure> {
    let timelines = known_timelines(history, &arguments.adapters)?;
    let mut subjects = Vec::new();
    for case in &arguments.cases {
        known_case(history, case)?;
        let known = verdicts(history, case, &timelines, labels).map_err(failure)?;
        for timeline in &timelines {
            if !known.iter().any(|verdicts| verdicts.timeline == *timeline) {
                return Err(Failure::usage(format!(
                    "no run has `{}` on {}; `etalon history show` lists the adapters that have it",
                    plain(case, 300),
                    plain(timeline, 100)
                )));
            }
            let mut subject = subject(case, timeline);
            if let Some(run) = arguments.step {
                subject.step = Some(step(arguments, history, &subject, run, labels)?);
            }
            subjects.push(subject);
        }
    }
    Ok(subjects)
}

/// Returns the step at a run.
fn step(
    arguments: &Arguments,
    history: &History,
    subject: &TriageSubject,
    run: u32,
    labels: &Labels,
) -> Result<TimeStep, Failure> {
    let time = arguments.time.into();
    let series_list =
        series_of(history, &subject.case, &subject.timeline, time, labels).map_err(failure)?;
    let found: Option<(MachineId, RunId)> = series_list.iter().find_map(|series| {
        let step = series.step_at(RunId::from(run))?;
        Some((series.machine(), step))
    });
    let Some((machine, run)) = found else {
        let known = series_list.iter().flat_map(|series| {
            let changes = series.changes().iter();
            changes.map(|change| series.first_run(change).to_string())
        });
        let known: Vec<String> = known.collect();
        let known = if known.is_empty() {
            "there is no change".to_owned()
        } else {
            format!("changes are at {}", known.join(", "))
        };
        return Err(Failure::usage(format!(
            "the {} time of `{}` on {} does not change at run {run}: {known}",
            time.name(),
            plain(&subject.case, 300),
            plain(&subject.timeline, 100)
        )));
    };
    Ok(TimeStep { machine, time, run })
}

impl From<ChangeState> for TriageState {
    fn from(state: ChangeState) -> Self {
        match state {
            ChangeState::New => Self::New,
            ChangeState::Real => Self::Real,
            ChangeState::Ignored => Self::Ignored,
            ChangeState::Fixed => Self::Fixed,
        }
    }
}

/// Returns an entry in words.
fn line(entry: &TriageEntry) -> String {
    let TriageSubject {
        case,
        timeline,
        step,
    } = &entry.subject;
    let step_name = step.map_or(String::new(), |step| {
        format!(", {} time from run {} on", step.time.name(), step.run)
    });
    format!(
        "{} on {}{step_name}: {}",
        plain(case, 400),
        plain(timeline, 100),
        state_text(Some(entry))
    )
}

fn entry_json(entry: &TriageEntry) -> serde_json::Value {
    json!({
        "case": entry.subject.case,
        "adapter": entry.subject.timeline,
        "step": entry.subject.step.map(|step| json!({
            "machine": step.machine.number(),
            "time": step.time.name(),
            "run": step.run.number(),
        })),
        "state": entry.state.name(),
        "reason": entry.reason,
        "author": entry.author,
        "at": format_time(entry.at),
    })
}

fn list(arguments: &Arguments, history: &History, labels: &Labels) -> Result<u8, Failure> {
    let timelines = known_timelines(history, &arguments.adapters)?;
    let settled = arguments.all;
    let states = history.triage_states().map_err(failure)?;
    let time = arguments.time.into();
    let bad = open_verdicts(history, &timelines, labels, &states, settled).map_err(failure)?;
    let steps = open_steps(history, &timelines, labels, &states, time, settled).map_err(failure)?;
    if arguments.format == OutputFormat::Json {
        let each = |entries: &[Open]| {
            entries
                .iter()
                .map(|open| open.json.clone())
                .collect::<Vec<_>>()
        };
        print_json(&json!({ "verdicts": each(&bad), "steps": each(&steps) }))?;
        return Ok(0);
    }
    let what = if settled { "" } else { "open " };
    let mut text = String::new();
    for (noun, left, found) in [
        ("bad verdict", "", &bad),
        ("change", " of frame times", &steps),
    ] {
        let title = counted(found.len() as u64, &format!("{what}{noun}"));
        text.push_str(&format!("{title}{left}\n"));
        for open in found.iter().take(PRINTED) {
            text.push_str(&format!("  {}\n", open.line));
        }
        if let Some(more @ 1..) = found.len().checked_sub(PRINTED) {
            text.push_str(&format!("  and {more} more (--format json has all)\n"));
        }
    }
    print(&text)?;
    Ok(0)
}
