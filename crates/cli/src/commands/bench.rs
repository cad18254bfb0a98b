//! `etalon bench`.

use crate::adapters::{Query, cache, discover, refuse_absent};
use crate::cases::chosen;
use crate::failure::{Failure, UNEXPECTED};
use crate::flags::{AdapterFileArguments, CaseArguments, CaseProfile, Format, parse_timeout};
use crate::out_folder::Out;
use crate::output::{say, summarize, summarize_json, table_options};
use crate::progress::progress;
use crate::{expectations, provenance, report_files, shard};
use clap::Args;
use etalon_case::Case;
use etalon_record::{
    BENCH_FORMAT, Bench, BenchHeader, BenchSettings, FolderKind, FolderLock, ShaderCache, Shard,
    cell, selection_digest, shard_of,
};
use etalon_runner::{BenchError, BenchEvent, BenchPlan};
use serde_json::json;
use std::collections::{BTreeSet, HashMap};
use std::path::PathBuf;
use std::time::Duration;

#[derive(Debug, Args)]
pub(crate) struct Arguments {
    #[command(flatten)]
    pub(crate) selection: CaseArguments,
    #[command(flatten)]
    pub(crate) file: AdapterFileArguments,
    /// Measure this adapter; may be repeated. Default: all adapters found
    #[arg(long = "adapter", value_name = "NAME")]
    pub(crate) adapters: Vec<String>,
    /// Folder for samples and reports
    #[arg(long, value_name = "DIR", default_value = "reports/bench-latest")]
    pub(crate) out: PathBuf,
    /// Continue the bench in the folder: measure what is missing
    #[arg(long, conflicts_with = "force")]
    pub(crate) resume: bool,
    /// Replace the run or bench in the folder
    #[arg(long)]
    pub(crate) force: bool,
    /// Measure shard M of N, chosen by a hash of the id; 1/1 is everything. Default: the shard given by the
    /// variables of GitLab, Bazel, Slurm or a Kubernetes indexed job
    #[arg(long, value_name = "M/N", value_parser = crate::shard::parse)]
    pub(crate) shard: Option<Shard>,
    /// Time limit in seconds of a picture, and of each answer of a driver in a round
    #[arg(long, value_name = "S", default_value = "60", value_parser = parse_timeout)]
    pub(crate) timeout: f64,
    /// Number of rounds, each in new processes; fewer than 7 cannot show a difference
    #[arg(long, value_name = "N", default_value = "12", value_parser = clap::value_parser!(u32).range(1..=10_000))]
    pub(crate) rounds: u32,
    /// Approximate time in seconds that the frames of a case take on an adapter in each round
    #[arg(long, value_name = "S", default_value = "0.1", value_parser = parse_seconds)]
    pub(crate) seconds: f64,
    /// Take no more rounds of a case, from the seventh on, when its interval lies within this share, such as 3%: that of
    /// a cell's rate, else that of the time
    #[arg(long, value_name = "SHARE", value_parser = parse_share)]
    pub(crate) within: Option<f64>,
    /// Time nothing more on an adapter when its rounds have taken this many seconds, but for the first round
    #[arg(long, value_name = "S", value_parser = parse_timeout)]
    pub(crate) limit: Option<f64>,
    /// Disable the drivers' shader caches on disk: the first frame of each round compiles every shader
    #[arg(long)]
    pub(crate) cold: bool,
    /// Output format
    #[arg(long, value_enum, default_value = "text")]
    pub(crate) format: Format,
}

/// The folder that each bench without `--out` replaces.
const LATEST: &str = "reports/bench-latest";

/// The cases that are measured by default, all but those of [`MATRIX`].
const DEFAULT: &str = "perf/*";

/// The cells of the performance matrix, which are measured where they are named.
const MATRIX: &str = "perf/matrix/";

/// Judges the pictures of the selected cases, measures the correct ones, writes samples and reports.
pub(crate) fn run(arguments: &Arguments) -> Result<u8, Failure> {
    let mut selection = arguments.selection.clone();
    let by_default = selection.globs.is_empty();
    if by_default {
        selection.globs.push(DEFAULT.to_owned());
    }
    let mut cases = chosen(&selection)?;
    cases.retain(|case| !by_default || !case.id.starts_with(MATRIX));
    beside_each_other(&mut cases);
    let all: Vec<String> = cases.iter().map(|case| case.id.clone()).collect();
    let shard = shard::chosen(arguments.shard)?;
    if let Some(shard) = shard {
        cases.retain(|case| shard_of(&case.id, shard.count) == shard.index);
        say!("shard {shard}: {} of {} cases", cases.len(), all.len());
    }
    let out = Out {
        folder: &arguments.out,
        kind: FolderKind::Bench,
        latest: LATEST,
        resume: arguments.resume,
        force: arguments.force,
    };
    // The samples of a concurrent or an earlier bench must not be lost.
    let lock = || FolderLock::acquire(&arguments.out).map_err(Failure::usage);
    let early = arguments.out.exists().then(lock).transpose()?;
    let resume = out.resumes()?;
    let expectations = expectations::read(None)?;
    let adapters = discover(&Query {
        names: &arguments.adapters,
        file: arguments.file.adapter_file.as_deref(),
        cold: arguments.cold,
        ..Query::default()
    })?;
    refuse_absent(&arguments.adapters, &adapters.absent)?;
    let mut names = BTreeSet::new();
    for (_, worker) in &adapters.ready {
        let name = &worker.hello.info.name;
        if !names.insert(name.clone()) {
            return Err(Failure::usage(format!(
                "two adapters report the name {name}; bench one after the other and compare them with \
                 `etalon diff`"
            )));
        }
    }
    let header = BenchHeader {
        format: BENCH_FORMAT,
        etalon: provenance::VERSION.to_owned(),
        commit: provenance::commit(),
        machine: provenance::machine(),
        started: provenance::now(),
        command: provenance::command(),
        profile: match selection.profile {
            CaseProfile::Quick => "quick".to_owned(),
            CaseProfile::Full => "full".to_owned(),
        },
        cases: cases.len() as u64,
        rounds: arguments.rounds,
        shader_cache: match arguments.cold || cache::is_disabled() {
            true => ShaderCache::Cold,
            false => ShaderCache::Warm,
        },
        ruler: etalon_runner::ruler().to_owned(),
        settings: BenchSettings {
            selection: selection_digest(all.iter().map(String::as_str)),
            shard,
            seconds: Some(arguments.seconds),
            timeout: Some(arguments.timeout),
            within: arguments.within,
            limit: arguments.limit,
        },
        adapters: adapters.ready.iter().map(|(_, w)| w.into()).collect(),
        absent: adapters.absent,
    };
    let _lock = early.map_or_else(lock, Ok)?;
    out.clear_other()?;
    let rounds = u64::from(arguments.rounds);
    // A picture counts as one step, like a round.
    let bar = progress((cases.len() * adapters.ready.len()) as u64 * (1 + rounds));
    let plan = BenchPlan {
        reports: report_files::BENCH,
        cases: &cases,
        adapters: adapters.ready,
        budget: Duration::from_secs_f64(arguments.seconds),
        timeout: Duration::from_secs_f64(arguments.timeout),
        expectations: &expectations,
        resume,
        folder: &arguments.out,
        header,
    };
    let outcome = etalon_runner::bench(plan, &mut |event| match event {
        BenchEvent::Judged {
            picture,
            unexpected,
            known,
        } => {
            bar.set_message(format!("judging {}", picture.adapter));
            bar.inc(1);
            bar.inc(match picture.may_be_timed() {
                true => u64::from(known),
                false => rounds,
            });
            if unexpected {
                let (verdict, adapter) = (picture.verdict, &picture.adapter);
                bar.suspend(|| {
                    say!("{verdict} {adapter} {}: {}", picture.case, picture.message);
                });
            }
        }
        BenchEvent::Timed { adapter, .. } => {
            bar.set_message(format!("timing {adapter}"));
            bar.inc(1);
        }
        BenchEvent::Done { spared, .. } => bar.inc(u64::from(spared)),
        BenchEvent::Ended { ended, missing } => {
            bar.inc(u64::from(missing));
            let (verdict, adapter) = (ended.verdict, &ended.adapter);
            bar.suspend(|| say!("{verdict} {adapter} {}: {}", ended.case, ended.message));
        }
    });
    bar.finish_and_clear();
    let outcome = outcome.map_err(|error| match error {
        BenchError::Folder(error) => Failure::usage(error),
        BenchError::Write(_) => Failure::incomplete(error),
    })?;
    let written = etalon_report::write_bench(&arguments.out).map_err(Failure::incomplete)?;
    if arguments.format == Format::Json {
        summarize_json(&json!({
            "pictures": outcome.pictures,
            "timed": outcome.timed,
            "unexpected": outcome.unexpected,
            "adapters": names,
            "folder": arguments.out,
            "report": written.html,
            "bencher": written.bencher,
            "action": written.action,
            "matrix": written.matrix,
        }))?;
    } else {
        let bench = Bench::read(&arguments.out).map_err(Failure::incomplete)?;
        let options = table_options();
        summarize(&etalon_report::bench_table(&bench, options));
        summarize(&etalon_report::matrix_table(&bench, options));
        summarize(&format!("\nReport: {}\n", written.html.display()));
        for path in written.matrix.iter().flatten() {
            summarize(&format!("Matrix: {}\n", path.display()));
        }
    }
    Ok(if outcome.unexpected > 0 {
        UNEXPECTED
    } else {
        0
    })
}

/// Moves the cases of each cell of the matrix together, so that they are timed one right after the other.
fn beside_each_other(cases: &mut [Case]) {
    let mut places = HashMap::new();
    for (place, case) in cases.iter().enumerate() {
        places.entry(group(case)).or_insert(place);
    }
    cases.sort_by_key(|case| places.get(&group(case)).copied());
}

/// Returns the name of a case's cell, or its own.
fn group(case: &Case) -> String {
    cell(&case.id).unwrap_or_else(|| case.id.clone())
}

fn parse_share(text: &str) -> Result<f64, String> {
    let number = text.strip_suffix('%').unwrap_or_default().trim();
    let percent: f64 = number.parse().unwrap_or(f64::NAN);
    if (0.1..=100.0).contains(&percent) {
        Ok(percent / 100.0)
    } else {
        Err("expected a share from 0.1% to 100%, such as 3%".to_owned())
    }
}

fn parse_seconds(text: &str) -> Result<f64, String> {
    let seconds: f64 = text.parse().unwrap_or(f64::NAN);
    if (0.001..=30.0).contains(&seconds) {
        Ok(seconds)
    } else {
        Err("expected a number of seconds from 0.001 to 30".to_owned())
    }
}
