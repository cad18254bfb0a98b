//! `etalon history show`.

use super::place::run_text;
use super::series::{RulerSeries, SeriesTime, series_of, state_name, state_text};
use super::sparkline;
use super::verdicts::{Verdicts, verdicts};
use crate::counted::counted;
use crate::failure::Failure;
use crate::flags::OutputFormat;
use crate::history_file::{DatabaseArguments, OnlyArguments, failure};
use crate::output::{print, print_json};
use clap::Args;
use etalon_glob::did_you_mean;
use etalon_history::{
    History, HistoryError, RunId, TriageEntry, TriageStates, TriageSubject, format_time,
};
use etalon_record::{Labels, Standing};
use etalon_report::plain;
use serde_json::json;
use std::rc::Rc;

#[derive(Debug, Args)]
pub(crate) struct Arguments {
    /// Id of the case. Default: list the runs
    #[arg(value_name = "CASE")]
    pub(crate) case: Option<String>,
    /// Show this adapter; may be repeated. Default: all adapters that have the case. The releases of a line
    /// share the name before the `@`
    #[arg(long = "adapter", value_name = "NAME")]
    pub(crate) adapters: Vec<String>,
    /// Time whose changes are shown
    #[arg(long, value_enum, default_value = "wall")]
    time: SeriesTime,
    #[command(flatten)]
    pub(crate) labels: OnlyArguments,
    #[command(flatten)]
    pub(crate) database: DatabaseArguments,
    /// Output format
    #[arg(long, value_enum, default_value = "text")]
    pub(crate) format: OutputFormat,
}

/// Shows one case over all runs, or the runs.
pub(crate) fn run(arguments: &Arguments) -> Result<u8, Failure> {
    let labels = arguments.labels.labels()?;
    let history = History::open_read(&arguments.database.path()).map_err(failure)?;
    let timelines = known_timelines(&history, &arguments.adapters)?;
    let Some(case) = &arguments.case else {
        return list(&history, &timelines, &labels, arguments.format);
    };
    known_case(&history, case)?;
    let read = || -> Result<_, HistoryError> {
        let states = history.triage_states()?;
        let mut lines = Vec::new();
        for of_adapter in verdicts(&history, case, &timelines, &labels)? {
            let (timeline, time) = (&of_adapter.timeline, arguments.time.into());
            let series = series_of(&history, case, timeline, time, &labels)?;
            lines.push((of_adapter, series));
        }
        Ok((states, lines))
    };
    let (states, lines) = read().map_err(failure)?;
    if lines.is_empty() {
        return Err(Failure::nothing(format!(
            "no run with these labels has {} on these adapters",
            plain(case, 300)
        )));
    }
    match arguments.format {
        OutputFormat::Text => {
            let is_shown = |(of_adapter, _): &(Verdicts, _)| {
                !arguments.adapters.is_empty() || of_adapter.is_drawn()
            };
            let (shown, undrawn): (Vec<_>, Vec<_>) = lines.into_iter().partition(is_shown);
            let mut text = text(&history, case, &states, &shown);
            if !undrawn.is_empty() {
                let names = undrawn
                    .iter()
                    .map(|(of_adapter, _)| plain(&of_adapter.timeline, 60));
                let names = names.collect::<Vec<_>>().join(", ");
                text += &format!("\nnever drawn on {names}; --adapter shows why\n");
            }
            print(&text)?;
        }
        OutputFormat::Json => {
            let adapters = lines.iter().map(|(of_adapter, series)| {
                let entry = states.get(&subject(case, &of_adapter.timeline));
                let mut value = of_adapter.json(&history);
                value["state"] = json!(state_name(entry));
                value["reason"] = json!(entry.map(|entry| &entry.reason));
                let series = series.iter().map(|s| s.json(&history, &states));
                value["series"] = series.collect();
                value
            });
            let adapters: Vec<_> = adapters.collect();
            print_json(&json!({ "case": case, "adapters": adapters }))?;
        }
    }
    Ok(0)
}

/// Lists the runs, oldest first.
fn list(
    history: &History,
    timelines: &[Rc<str>],
    labels: &Labels,
    format: OutputFormat,
) -> Result<u8, Failure> {
    let mut text = String::new();
    let mut values = Vec::new();
    for run in history.runs() {
        let of_run = history.adapters(run.id).iter();
        let parts: Vec<_> = of_run.filter(|p| timelines.contains(&p.timeline)).collect();
        if parts.is_empty() || !run.has_labels(labels) {
            continue;
        }
        if format == OutputFormat::Json {
            values.push(json!({
                "run": run.id.number(),
                "digest": run.digest_text(),
                "kind": run.kind.name(),
                "time": format_time(run.time()),
                "commit": run.commit,
                "profile": run.profile,
                "missing": run.missing,
                "resumed": run.resumed.map(RunId::number),
                "labels": run.labels,
                "adapters": parts.iter().map(|p| &*p.timeline).collect::<Vec<_>>(),
            }));
            continue;
        }
        let names: Vec<String> = parts.iter().map(|p| plain(&p.timeline, 60)).collect();
        let mut notes: Vec<String> = run
            .labels
            .iter()
            .map(|(key, value)| format!("{}={}", plain(key, 60), plain(value, 60)))
            .collect();
        if run.missing > 0 {
            notes.push(format!("{} missing", run.missing));
        }
        notes.extend(run.resumed.map(|later| format!("resumed as run {later}")));
        text.push_str(&format!(
            "{}  {}  {}  {}  {}\n",
            run.id,
            format_time(run.time()),
            run.kind,
            names.join(", "),
            notes.join(", ")
        ));
    }
    match format {
        OutputFormat::Text => print(&text)?,
        OutputFormat::Json => print_json(&values)?,
    }
    Ok(0)
}

/// Refuses a case that is not in the history.
pub(super) fn known_case(history: &History, case: &str) -> Result<(), Failure> {
    if history.case_id(case).map_err(failure)?.is_some() {
        return Ok(());
    }
    let cases = history.cases().map_err(failure)?;
    let near = did_you_mean(case, cases.iter().map(|case| &**case));
    Err(Failure::usage(format!(
        "{} has no case `{}`{near}",
        history.path().display(),
        plain(case, 300)
    )))
}

/// Returns the timelines of these names; all if no name is given.
pub(super) fn known_timelines(
    history: &History,
    names: &[String],
) -> Result<Vec<Rc<str>>, Failure> {
    let timelines = history.timelines();
    if names.is_empty() {
        return Ok(timelines);
    }
    let mut found = Vec::new();
    for name in names {
        let known = timelines.iter().find(|timeline| ***timeline == **name);
        let Some(known) = known else {
            let near = did_you_mean(name, timelines.iter().map(|timeline| &**timeline));
            return Err(Failure::usage(format!(
                "{} has no adapter `{}`{near}",
                history.path().display(),
                plain(name, 100)
            )));
        };
        found.push(Rc::clone(known));
    }
    Ok(found)
}

/// Returns the verdict of a case on an adapter, as a subject of triage.
pub(super) fn subject(case: &str, timeline: &str) -> TriageSubject {
    TriageSubject {
        case: case.to_owned(),
        timeline: timeline.to_owned(),
        step: None,
    }
}

fn text(
    history: &History,
    case: &str,
    states: &TriageStates,
    by_adapter: &[(Verdicts, Vec<RulerSeries>)],
) -> String {
    let mut lines = vec![plain(case, 400)];
    for (of_adapter, series) in by_adapter {
        lines.push(String::new());
        let entry = states.get(&subject(case, &of_adapter.timeline));
        lines.extend(verdict_lines(history, of_adapter, entry));
        for times in series {
            let indented = times.lines(history, states).into_iter();
            lines.extend(indented.map(|line| format!("  {line}")));
        }
    }
    lines.join("\n") + "\n"
}

fn verdict_lines(
    history: &History,
    of_adapter: &Verdicts,
    entry: Option<&TriageEntry>,
) -> Vec<String> {
    let records = &of_adapter.records;
    let standings: Vec<Standing> = records.iter().map(|d| d.outcome.standing()).collect();
    let ends = [records.first(), records.last()]
        .map(|drawn| drawn.map_or(String::new(), |drawn| run_text(history, drawn.run)));
    let mut lines = vec![format!(
        "{}  {}, {} to {}",
        plain(&of_adapter.timeline, 100),
        counted(records.len() as u64, "run"),
        ends[0],
        ends[1]
    )];
    let each = match sparkline::size(records.len()) {
        1 => String::new(),
        n => format!("  (each sign: the worst of {n} runs)"),
    };
    lines.push(format!("  {}{each}", sparkline::of_standings(&standings)));
    let happened = of_adapter.lines(history);
    if happened.is_empty() {
        lines.push("  nothing happened".to_owned());
    }
    lines.extend(happened.into_iter().map(|line| format!("  {line}")));
    if let Some(drawn) = of_adapter.last() {
        let mut now = format!("  now {}", drawn.outcome.verdict.name());
        if drawn.outcome.inferred {
            now.push_str(" (not drawn: the releases on both sides have this verdict)");
        }
        if let Some(reason) = &drawn.outcome.expected {
            now.push_str(&format!(", expected: {}", plain(reason, 300)));
        }
        if drawn.outcome.unexpected() || entry.is_some() {
            now.push_str(&format!("; triage {}", state_text(entry)));
        }
        lines.push(now);
    }
    lines
}
