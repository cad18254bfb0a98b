//! `etalon diff`.

use crate::failure::{Failure, IMPROVED, INCOMPLETE, UNEXPECTED};
use crate::flags::OutputFormat;
use crate::named_files::Renewed;
use crate::output::{print, print_json, say, table_options};
use crate::saved_run::UnpackArguments;
use clap::{Args, ValueEnum};
use etalon_record::{Bench, FolderKind, Time};
use etalon_report::runs::{self, RunDiff};
use serde::Serialize;
use std::path::{Path, PathBuf};

/// The time of a bench to compare.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum DiffTime {
    /// From the start of a frame until the device is done.
    Wall,
    /// From the start of a frame until the last call that submits work returns.
    Cpu,
    /// Between the GPU timestamps of a frame.
    Gpu,
    /// Reading a frame back.
    ReadBack,
    /// Preparing the scene.
    Prepare,
    /// The first frame after preparation.
    First,
}

#[derive(Debug, Args)]
pub(crate) struct Arguments {
    /// The run or bench folder to compare with, or a run that the page saved (`*.tar.gz`)
    #[arg(value_name = "BEFORE")]
    pub(crate) before: PathBuf,
    /// The run or bench folder to judge, or a run that the page saved (`*.tar.gz`)
    #[arg(value_name = "AFTER")]
    pub(crate) after: PathBuf,
    /// Runs only: the adapter of the first run. Default: compare adapters with equal names, or the only one
    /// of each run
    #[arg(long, value_name = "NAME", requires = "adapter_after")]
    pub(crate) adapter_before: Option<String>,
    /// Runs only: the adapter of the second run
    #[arg(long, value_name = "NAME", requires = "adapter_before")]
    pub(crate) adapter_after: Option<String>,
    /// Benches only: the time to compare. Default: wall
    #[arg(long, value_enum)]
    pub(crate) time: Option<DiffTime>,
    /// Also write an HTML page to this file
    #[arg(long, value_name = "FILE.html")]
    pub(crate) out: Option<PathBuf>,
    #[command(flatten)]
    pub(crate) unpack: UnpackArguments,
    /// Output format
    #[arg(long, value_enum, default_value = "text")]
    pub(crate) format: OutputFormat,
}

/// Compares two runs or two benches.
pub(crate) fn run(arguments: &Arguments) -> Result<u8, Failure> {
    if let Some(page) = &arguments.out {
        Renewed::Page.check(page)?;
    }
    let unpack = arguments.unpack;
    let [before, after] = [
        unpack.folder(&arguments.before)?,
        unpack.folder(&arguments.after)?,
    ];
    let [before, after] = [before.as_path(), after.as_path()];
    match [before, after].map(FolderKind::of) {
        [Some(FolderKind::Run), Some(FolderKind::Run)] => compare_runs(arguments, [before, after]),
        [Some(FolderKind::Bench), Some(FolderKind::Bench)] => {
            compare_benches(arguments, [before, after])
        }
        [Some(FolderKind::Run), Some(FolderKind::Bench)] => Err(mixed(before, after)),
        [Some(FolderKind::Bench), Some(FolderKind::Run)] => Err(mixed(after, before)),
        [first, _] => {
            let folder = if first.is_none() { before } else { after };
            Err(Failure::usage(format!(
                "{} holds neither run.jsonl nor bench.jsonl; name folders that `etalon run --out` or \
                 `etalon bench --out` wrote",
                folder.display()
            )))
        }
    }
}

fn mixed(run: &Path, bench: &Path) -> Failure {
    Failure::usage(format!(
        "{} holds a run and {} a bench; diff compares two runs or two benches",
        run.display(),
        bench.display()
    ))
}

fn compare_runs(arguments: &Arguments, folders: [&Path; 2]) -> Result<u8, Failure> {
    if arguments.time.is_some() {
        return Err(Failure::usage(
            "--time is for two benches; the times of a run are single samples taken during other work",
        ));
    }
    let adapters = (&arguments.adapter_before, &arguments.adapter_after);
    let adapters = match adapters {
        (Some(before), Some(after)) => Some([before.as_str(), after]),
        _ => None,
    };
    let diff = runs::diff(folders[0], folders[1], adapters).map_err(Failure::usage)?;
    if diff.compared() == 0 && diff.only.is_empty() {
        return Err(Failure::nothing("neither run holds a record"));
    }
    let page = match &arguments.out {
        Some(path) => Some(runs::write_page(path, &diff, folders).map_err(Failure::of)?),
        None => None,
    };
    report(arguments, &diff, page, || {
        runs::table(&diff, table_options())
    })?;
    Ok(code(&diff))
}

/// Returns 1 if anything is worse, 3 if a run is incomplete, 2 if there are only improvements, 0
/// otherwise.
fn code(diff: &RunDiff) -> u8 {
    if diff.worse() {
        UNEXPECTED
    } else if !diff.incomplete.is_empty() {
        say!(
            "{}; what is missing cannot be compared",
            diff.incomplete.join("; ")
        );
        INCOMPLETE
    } else if diff.only_better() {
        IMPROVED
    } else {
        0
    }
}

fn compare_benches(arguments: &Arguments, folders: [&Path; 2]) -> Result<u8, Failure> {
    if arguments.adapter_before.is_some() {
        return Err(Failure::usage(
            "--adapter-before and --adapter-after are for two runs; benches are compared adapter by adapter",
        ));
    }
    let before = Bench::read(folders[0]).map_err(Failure::usage)?;
    let after = Bench::read(folders[1]).map_err(Failure::usage)?;
    let time = arguments.time.map_or(Time::Wall, Time::from);
    let diff = etalon_report::diff(&before, &after, time);
    if diff.changes.is_empty() && diff.gone.is_empty() {
        return Err(Failure::nothing(format!(
            "neither bench has a {} time",
            diff.time
        )));
    }
    let page = match &arguments.out {
        Some(path) => Some(etalon_report::write_diff(path, &diff).map_err(Failure::of)?),
        None => None,
    };
    report(arguments, &diff, page, || {
        etalon_report::diff_table(&diff, table_options())
    })?;
    Ok(if diff.worse() { UNEXPECTED } else { 0 })
}

/// Prints a comparison, and the path of its page.
fn report(
    arguments: &Arguments,
    diff: &impl Serialize,
    page: Option<PathBuf>,
    table: impl FnOnce() -> String,
) -> Result<(), Failure> {
    if arguments.format == OutputFormat::Json {
        return print_json(diff);
    }
    print(&table())?;
    match page {
        Some(page) => print(&format!("\nReport: {}\n", page.display())),
        None => Ok(()),
    }
}

impl From<DiffTime> for Time {
    fn from(time: DiffTime) -> Self {
        match time {
            DiffTime::Wall => Self::Wall,
            DiffTime::Cpu => Self::Cpu,
            DiffTime::Gpu => Self::Gpu,
            DiffTime::ReadBack => Self::ReadBack,
            DiffTime::Prepare => Self::Prepare,
            DiffTime::First => Self::First,
        }
    }
}
