//! `etalon run`.

use crate::adapters::{Adapters, discover};
use crate::args::{Format, RunArguments};
use crate::commands::{chosen, is_measuring, refuse_absent};
use crate::failure::{Failure, IMPROVED, UNEXPECTED};
use crate::output::{print, print_json, table_options};
use etalon_case::Case;
use etalon_record::{Expectations, Header, Machine, Run};
use etalon_runner::{Event, Outcome, Plan, RunError};
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use serde_json::json;
use std::path::Path;
use std::time::SystemTime;

/// Draws the chosen cases on the chosen adapters, judges, records and reports.
pub(crate) fn run(arguments: &RunArguments) -> Result<u8, Failure> {
    let mut cases = chosen(&arguments.selection)?;
    if arguments.selection.globs.is_empty() {
        // A folder that holds nothing else means them.
        let measuring_alone = cases.iter().all(is_measuring);
        cases.retain(|case| measuring_alone || !is_measuring(case));
    }
    let expectations = expectations(arguments.expect.as_deref())?;
    let adapters = discover(&arguments.adapters)?;
    refuse_absent(&arguments.adapters, &adapters.absent)?;
    let names: Vec<String> = adapters
        .ready
        .iter()
        .map(|(l, _)| l.adapter.clone())
        .collect();
    let bar = progress(cases.len() as u64 * names.len() as u64);
    let outcome = execute(arguments, &cases, adapters, &expectations, &bar);
    bar.finish_and_clear();
    let outcome = outcome.map_err(|error| match error {
        RunError::Folder(error) => Failure::usage(error),
        RunError::Write(_) => Failure::incomplete(error),
    })?;
    let written = etalon_report::write(&arguments.out).map_err(Failure::incomplete)?;
    if arguments.format == Format::Json {
        print_json(&json!({
            "records": outcome.records,
            "unexpected": outcome.unexpected,
            "improvements": outcome.improvements,
            "adapters": names,
            "folder": arguments.out,
            "report": written.html,
        }))?;
    } else {
        let run = Run::read(&arguments.out).map_err(Failure::incomplete)?;
        let options = table_options();
        print(&etalon_report::table(&run, options))?;
        print(&format!("\nReport: {}\n", written.html.display()))?;
    }
    Ok(match outcome {
        Outcome {
            unexpected: 1.., ..
        } => UNEXPECTED,
        Outcome {
            improvements: 1.., ..
        } => IMPROVED,
        _ => 0,
    })
}

pub(crate) fn expectations(file: Option<&Path>) -> Result<Expectations, Failure> {
    match file {
        Some(file) => Expectations::read(file),
        None => Expectations::parse(
            include_str!("../../../../ci/expectations.json"),
            Path::new("ci/expectations.json"),
        ),
    }
    .map_err(Failure::usage)
}

fn execute(
    arguments: &RunArguments,
    cases: &[Case],
    adapters: Adapters,
    expectations: &Expectations,
    bar: &ProgressBar,
) -> Result<Outcome, RunError> {
    let header = Header {
        format: etalon_record::FORMAT,
        etalon: env!("CARGO_PKG_VERSION").to_owned(),
        commit: option_env!("ETALON_COMMIT").map(str::to_owned),
        machine: machine(),
        started: humantime::format_rfc3339_seconds(SystemTime::now()).to_string(),
        command: std::iter::once("etalon".to_owned())
            .chain(std::env::args().skip(1))
            .collect(),
        cases: cases.len() as u64,
        settings: Default::default(),
        adapters: adapters.ready.iter().map(|(_, w)| w.into()).collect(),
        absent: adapters.absent,
    };
    let plan = Plan {
        cases,
        adapters: adapters.ready,
        jobs: std::thread::available_parallelism().map_or(1, usize::from),
        expectations,
        folder: &arguments.out,
        header,
    };
    etalon_runner::run(plan, &|event| match event {
        Event::AdapterStarted { adapter, .. } => bar.set_message(adapter),
        Event::Recorded(record) => {
            if record.unexpected() {
                bar.suspend(|| {
                    eprintln!("{} {} {}", record.verdict, record.adapter, record.case);
                });
            }
            bar.inc(1);
        }
        Event::AdapterFinished { adapter, wall } => bar.suspend(|| {
            eprintln!("{adapter} done in {:.1} s", wall.as_secs_f64());
        }),
    })
}

pub(crate) fn progress(total: u64) -> ProgressBar {
    let bar = ProgressBar::with_draw_target(Some(total), ProgressDrawTarget::stderr());
    let style = ProgressStyle::with_template("{bar:40} {pos}/{len} {per_sec} {eta} {msg}");
    if let Ok(style) = style {
        bar.set_style(style);
    }
    bar
}

/// The machine as it names itself, without its owner's names for it.
pub(crate) fn machine() -> Machine {
    let field = |path: &str, key: &str, separator: char| {
        let text = std::fs::read_to_string(path).ok()?;
        let value = text.lines().find_map(|line| {
            let (name, value) = line.split_once(separator)?;
            (name.trim() == key).then(|| value.trim().trim_matches('"').to_owned())
        })?;
        (!value.is_empty()).then_some(value)
    };
    Machine {
        os: field("/etc/os-release", "PRETTY_NAME", '=')
            .unwrap_or_else(|| std::env::consts::OS.to_owned()),
        cpu: field("/proc/cpuinfo", "model name", ':')
            .unwrap_or_else(|| std::env::consts::ARCH.to_owned()),
        cores: std::thread::available_parallelism().map_or(1, |n| n.get() as u32),
    }
}
