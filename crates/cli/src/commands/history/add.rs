//! `etalon history add`.

use crate::counted::counted;
use crate::failure::{Failure, INCOMPLETE, USAGE};
use crate::flags::OutputFormat;
use crate::history_file::{DatabaseArguments, failure};
use crate::labels::LabelArguments;
use crate::output::{print_json, say, summarize};
use crate::saved_run::UnpackArguments;
use clap::Args;
use etalon_history::{Added, HistoryError, Kind, NewRun, ReleaseDates, RunId, Writer, read_runs};
use etalon_report::{plain, quoted};
use serde_json::{Value, json};
use std::fs;
use std::path::{Path, PathBuf};

/// The release dates that are compiled in.
const DATES: &str = include_str!("../../../data/releases.json");
/// The name that messages use for the built-in file of dates.
const DATES_NAME: &str = "ci/history/releases.json";

#[derive(Debug, Args)]
pub(crate) struct Arguments {
    /// Folders that `etalon run`, `bench` or `bisect` wrote, or their run.jsonl, bench.jsonl or
    /// versions.jsonl, optionally compressed with gzip; or runs that the page saved (`*.tar.gz`)
    #[arg(value_name = "RUN", required = true)]
    pub(crate) runs: Vec<PathBuf>,
    #[command(flatten)]
    pub(crate) database: DatabaseArguments,
    #[command(flatten)]
    pub(crate) labels: LabelArguments,
    /// Use these release dates instead of the built-in ones, a JSON file: {"line": {"version": "2026-01-31"}}
    #[arg(long, value_name = "FILE")]
    pub(crate) dates: Option<PathBuf>,
    /// Also add runs that lack records
    #[arg(long)]
    pub(crate) incomplete: bool,
    #[command(flatten)]
    pub(crate) unpack: UnpackArguments,
    /// Output format
    #[arg(long, value_enum, default_value = "text")]
    pub(crate) format: OutputFormat,
}

/// A run, and whether it was added.
struct AddedRun<'a> {
    path: &'a Path,
    run: &'a NewRun,
    id: RunId,
    is_new: bool,
}

/// Adds runs to a history. Reports a run that cannot be added, and adds the others.
pub(crate) fn run(arguments: &Arguments) -> Result<u8, Failure> {
    let labels = arguments.labels.labels()?;
    let dates = dates(arguments.dates.as_deref())?;
    let mut writer = Writer::open(&arguments.database.path()).map_err(failure)?;
    let mut codes = Vec::new();
    let mut added = Vec::new();
    for path in &arguments.runs {
        let mut runs = match read_complete_runs(path, &dates, arguments) {
            Ok(runs) => runs,
            Err(Failure { code, message }) => {
                say!("etalon: {message}");
                codes.push(code);
                continue;
            }
        };
        let undated = place_undated(&mut runs);
        if !undated.is_empty() {
            warn_undated(path, &runs, &undated);
        }
        for run in &mut runs {
            run.labels = labels.clone();
        }
        for run in &runs {
            let (id, is_new) = match writer.add(run) {
                Ok(Added::New(id)) => (id, true),
                Ok(Added::Already(id)) => (id, false),
                Err(error @ HistoryError::Twice { .. }) => {
                    say!("etalon: {}: {error}", path.display());
                    codes.push(USAGE);
                    continue;
                }
                Err(error) => return Err(failure(error)),
            };
            let added_run = AddedRun {
                path,
                run,
                id,
                is_new,
            };
            match arguments.format {
                OutputFormat::Text => summarize(&added_run.summary()),
                OutputFormat::Json => added.push(added_run.json()),
            }
        }
    }
    if arguments.format == OutputFormat::Json {
        print_json(&added)?;
    }
    // A usage error outweighs an incomplete run.
    Ok([USAGE, INCOMPLETE]
        .into_iter()
        .find(|code| codes.contains(code))
        .unwrap_or(0))
}

fn dates(path: Option<&Path>) -> Result<ReleaseDates, Failure> {
    match path {
        None => ReleaseDates::parse(Path::new(DATES_NAME), DATES),
        Some(path) => {
            let text = fs::read_to_string(path)
                .map_err(|e| Failure::usage(format!("cannot read {}: {e}", path.display())))?;
            ReleaseDates::parse(path, &text)
        }
    }
    .map_err(Failure::usage)
}

/// Reads the runs to add, and refuses runs that lack records if the arguments do not allow them.
fn read_complete_runs(
    path: &Path,
    dates: &ReleaseDates,
    arguments: &Arguments,
) -> Result<Vec<NewRun>, Failure> {
    let folder = arguments.unpack.folder(path)?;
    let runs = read_runs(&folder, dates).map_err(failure)?;
    match runs.iter().find(|run| run.missing > 0) {
        Some(run) if !arguments.incomplete => Err(Failure::incomplete(lacks_text(path, run))),
        _ => Ok(runs),
    }
}

/// Warns of releases without a date. `undated` has their versions.
fn warn_undated(path: &Path, runs: &[NewRun], undated: &[String]) {
    let adapter = runs.first().and_then(|run| run.adapters.first());
    let line = adapter.map_or("", |adapter| adapter.adapter.line.as_str());
    say!(
        "{}: no release date is known for {} {}; each comes after the release before it, or at its drawing time if \
         it is the last; --dates FILE gives dates",
        path.display(),
        plain(line, 60),
        plain(&undated.join(", "), 400),
    );
}

fn lacks_text(path: &Path, run: &NewRun) -> String {
    let (what, command) = match run.kind {
        Kind::Bench => ("round", "bench"),
        _ => ("record", "run"),
    };
    let folder = if path.is_dir() {
        path
    } else {
        path.parent().unwrap_or(path)
    };
    format!(
        "{} lacks {}; draw what is missing with `etalon {command} … --resume --out {}`, or add it as it is with --incomplete",
        path.display(),
        counted(run.missing, what),
        quoted(&folder.display().to_string())
    )
}

/// Gives each undated release the date of the release before it, or of the one after it for the first ones.
/// Releases after the last date get none, and are ordered by the time at which they were drawn. Returns the
/// versions of the undated releases.
fn place_undated(runs: &mut [NewRun]) -> Vec<String> {
    let dates: Vec<Option<i64>> = runs.iter().map(|run| run.released).collect();
    let mut undated = Vec::new();
    for (index, run) in runs.iter_mut().enumerate() {
        if run.kind != Kind::Release || run.released.is_some() {
            continue;
        }
        undated.extend(run.adapters.first().map(|a| a.adapter.version.clone()));
        let later = dates[index..].iter().flatten().next();
        let earlier = dates[..index].iter().rev().flatten().next();
        // Among equal times, the release that was added first comes first.
        run.released = later.map(|later| *earlier.unwrap_or(later));
    }
    undated
}

impl AddedRun<'_> {
    fn records(&self) -> usize {
        self.run.adapters.iter().map(|a| a.outcomes.len()).sum()
    }

    fn summary(&self) -> String {
        let Self { path, run, id, .. } = self;
        let path = plain(&path.display().to_string(), 400);
        if !self.is_new {
            return format!("{path} is run {id} already\n");
        }
        let names = run.adapters.iter().map(|a| plain(&a.adapter.info.name, 60));
        let names: Vec<String> = names.take(20).collect();
        let more = match run.adapters.len().saturating_sub(names.len()) {
            0 => String::new(),
            n => format!(" and {n} more"),
        };
        let missing = match run.missing {
            0 => String::new(),
            n => format!(", {n} missing"),
        };
        format!(
            "{path} is run {id}: {} with {}{missing} of {}{more}\n",
            run.kind,
            counted(self.records() as u64, "record"),
            names.join(", ")
        )
    }

    fn json(&self) -> Value {
        let names = self.run.adapters.iter().map(|a| &a.adapter.info.name);
        json!({
            "path": self.path,
            "run": self.id.number(),
            "added": self.is_new,
            "kind": self.run.kind.name(),
            "records": self.records(),
            "missing": self.run.missing,
            "adapters": names.collect::<Vec<_>>(),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use etalon_frame::AdapterInfo;
    use etalon_history::{Adapter, NewAdapter};
    use etalon_record::Labels;
    use etalon_record::Machine;

    fn release(version: &str, released: Option<i64>) -> NewRun {
        NewRun {
            digest: [0; 32],
            header: [0; 32],
            kind: Kind::Release,
            etalon: String::new(),
            commit: None,
            machine: Machine::default(),
            started: 100,
            released,
            profile: None,
            ruler: None,
            missing: 0,
            labels: Labels::new(),
            adapters: vec![NewAdapter::new(Adapter {
                info: AdapterInfo {
                    name: format!("a@{version}"),
                    software: true,
                    ..AdapterInfo::default()
                },
                line: "a".to_owned(),
                version: version.to_owned(),
            })],
        }
    }

    #[test]
    fn an_undated_release_takes_the_date_before_it() {
        let dates = [None, Some(10), None, Some(20), None];
        let mut runs: Vec<NewRun> = ["1", "2", "3", "4", "5"]
            .iter()
            .zip(dates)
            .map(|(version, date)| release(version, date))
            .collect();
        assert_eq!(place_undated(&mut runs), ["1", "3", "5"]);
        let placed: Vec<Option<i64>> = runs.iter().map(|run| run.released).collect();
        assert_eq!(placed, [Some(10), Some(10), Some(10), Some(20), None]);
    }

    #[test]
    fn built_in_dates_parse_and_ascend() {
        let dates = dates(None).unwrap();
        let date = |version| dates.of("swiftshader", version).unwrap();
        assert!(date("106.0.2") < date("118.0.0") && date("118.0.0") < date("153.0.0"));
        assert_eq!(dates.of("lavapipe", "26.2.6"), None);
    }
}
