//! `etalon bench`.

use crate::adapters::{Wanted, cache, discover};
use crate::args::{BenchArguments, CaseProfile, Format};
use crate::commands::run::{expectations, machine, progress};
use crate::commands::{chosen, refuse_absent};
use crate::failure::{Failure, UNEXPECTED};
use crate::output::{print, print_json, table_options};
use etalon_record::{BENCH_FORMAT, Bench, BenchHeader, ReportFiles, ShaderCache};
use etalon_runner::{BenchError, BenchEvent, BenchPlan};
use serde_json::json;
use std::collections::BTreeSet;
use std::time::{Duration, SystemTime};

/// What is timed where nothing is named.
const DEFAULT: &str = "perf/*";

/// Judges the chosen cases' pictures, times those that are right, records and reports.
pub(crate) fn run(arguments: &BenchArguments) -> Result<u8, Failure> {
    let mut selection = arguments.selection.clone();
    if selection.globs.is_empty() {
        selection.globs.push(DEFAULT.to_owned());
    }
    let cases = chosen(&selection)?;
    let expectations = expectations(None)?;
    let adapters = discover(&Wanted {
        names: &arguments.adapters,
        file: arguments.file.adapter_file.as_deref(),
        cold: arguments.cold,
        ..Wanted::default()
    })?;
    refuse_absent(&arguments.adapters, &adapters.absent)?;
    let mut names = BTreeSet::new();
    for (_, worker) in &adapters.ready {
        let name = &worker.hello.info.name;
        if !names.insert(name.clone()) {
            return Err(Failure::usage(format!(
                "two of the adapters answer as {name}; bench one after the other and compare them with \
                 `etalon diff`"
            )));
        }
    }
    let header = BenchHeader {
        format: BENCH_FORMAT,
        etalon: env!("CARGO_PKG_VERSION").to_owned(),
        commit: option_env!("ETALON_COMMIT").map(str::to_owned),
        machine: machine(),
        started: humantime::format_rfc3339_seconds(SystemTime::now()).to_string(),
        command: std::iter::once("etalon".to_owned())
            .chain(std::env::args().skip(1))
            .collect(),
        profile: match selection.profile {
            CaseProfile::Quick => "quick".to_owned(),
            CaseProfile::Full => "full".to_owned(),
        },
        cases: cases.len() as u64,
        rounds: arguments.rounds,
        shader_cache: match arguments.cold || cache::is_off() {
            true => ShaderCache::Cold,
            false => ShaderCache::Warm,
        },
        ruler: etalon_runner::ruler().to_owned(),
        adapters: adapters.ready.iter().map(|(_, w)| w.into()).collect(),
        absent: adapters.absent,
    };
    let rounds = u64::from(arguments.rounds);
    // A picture counts as much as a round.
    let bar = progress((cases.len() * adapters.ready.len()) as u64 * (1 + rounds));
    let plan = BenchPlan {
        cases: &cases,
        adapters: adapters.ready,
        budget: Duration::from_secs_f64(arguments.seconds),
        expectations: &expectations,
        folder: &arguments.out,
        reports: ReportFiles {
            files: &etalon_report::BENCH_FILES,
            folders: &[],
        },
        header,
    };
    let outcome = etalon_runner::bench(plan, &mut |event| match event {
        BenchEvent::Judged {
            picture,
            unexpected,
        } => {
            bar.set_message(format!("judging {}", picture.adapter));
            bar.inc(1);
            if !picture.may_be_timed() {
                bar.inc(rounds);
            }
            if unexpected {
                let (verdict, adapter) = (picture.verdict, &picture.adapter);
                bar.suspend(|| {
                    eprintln!("{verdict} {adapter} {}: {}", picture.case, picture.message);
                });
            }
        }
        BenchEvent::Timed { adapter, .. } => {
            bar.set_message(format!("timing {adapter}"));
            bar.inc(1);
        }
        BenchEvent::Ended { ended, missing } => {
            bar.inc(u64::from(missing));
            let (verdict, adapter) = (ended.verdict, &ended.adapter);
            bar.suspend(|| eprintln!("{verdict} {adapter} {}: {}", ended.case, ended.message));
        }
    });
    bar.finish_and_clear();
    let outcome = outcome.map_err(|error| match error {
        BenchError::Folder(error) => Failure::usage(error),
        BenchError::Write(_) => Failure::incomplete(error),
    })?;
    let written = etalon_report::write_bench(&arguments.out).map_err(Failure::incomplete)?;
    if arguments.format == Format::Json {
        print_json(&json!({
            "pictures": outcome.pictures,
            "timed": outcome.timed,
            "unexpected": outcome.unexpected,
            "adapters": names,
            "folder": arguments.out,
            "report": written.html,
            "bencher": written.bencher,
            "action": written.action,
        }))?;
    } else {
        let bench = Bench::read(&arguments.out).map_err(Failure::incomplete)?;
        let options = table_options();
        print(&etalon_report::bench_table(&bench, options))?;
        print(&format!("\nReport: {}\n", written.html.display()))?;
    }
    Ok(if outcome.unexpected > 0 {
        UNEXPECTED
    } else {
        0
    })
}
