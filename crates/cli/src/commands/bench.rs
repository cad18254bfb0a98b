//! `etalon bench`.

use crate::cases::chosen;
use crate::discovery::{discover, refuse_absent};
use crate::failure::{Failure, UNEXPECTED};
use crate::flags::{AdapterFileArguments, CaseArguments, OutputFormat, parse_timeout};
use crate::out_folder::Out;
use crate::output::{print_json, say, summarize, table_options};
use crate::progress::progress;
use crate::{expectations, provenance, shard};
use clap::Args;
use etalon_adapters::{Adapters, Query, cache};
use etalon_case::Case;
use etalon_record::{
    BENCH_FORMAT, Bench, BenchHeader, BenchSettings, FolderKind, ProcessorLimits, Reason, Shard,
    Verdict, beside, cell, selection_digest,
};
use etalon_report::{WrittenBench, message, reasons_text};
use etalon_runner::{BenchError, BenchEvent, BenchPlan, BenchSummary, instruction_counter};
use indicatif::ProgressBar;
use serde_json::json;
use std::collections::{BTreeSet, HashMap};
use std::path::PathBuf;
use std::sync::atomic::AtomicBool;
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
    #[arg(long, value_name = "DIR", default_value = LATEST)]
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
    /// Time limit in seconds for a picture, and for each answer of a driver in a round
    #[arg(long, value_name = "S", default_value = "60", value_parser = parse_timeout)]
    pub(crate) timeout: f64,
    /// Number of rounds, each in new processes; fewer than 7 cannot show a difference
    #[arg(long, value_name = "N", default_value = "12", value_parser = clap::value_parser!(u32).range(1..=10_000))]
    pub(crate) rounds: u32,
    /// Approximate time in seconds to spend on the frames of a case, per adapter and round
    #[arg(long, value_name = "S", default_value = "0.1", value_parser = parse_seconds)]
    pub(crate) seconds: f64,
    /// Stop timing a case, after seven rounds or more, once its interval is within this share, such as 3%:
    /// the interval of a cell's rate, otherwise of the time
    #[arg(long, value_name = "SHARE", value_parser = parse_share)]
    pub(crate) within: Option<f64>,
    /// Stop timing on an adapter once its rounds have taken this many seconds; the first round is always
    /// completed
    #[arg(long, value_name = "S", value_parser = parse_timeout)]
    pub(crate) limit: Option<f64>,
    /// Also count the instructions of a frame on adapters that draw with the processor, with perf or Valgrind:
    /// a second clock, which a busy machine does not disturb
    #[arg(long)]
    pub(crate) instructions: bool,
    /// Disable the drivers' shader caches on disk: the first frame of each round compiles every shader
    #[arg(long)]
    pub(crate) cold: bool,
    /// Output format
    #[arg(long, value_enum, default_value = "text")]
    pub(crate) format: OutputFormat,
}

/// The folder that each bench without `--out` replaces; other folders need `--force`.
const LATEST: &str = "reports/bench-latest";

/// The glob of the cases that are measured by default; see [`MATRIX`].
const DEFAULT: &str = "perf/*";

/// The cells of the performance matrix, which are measured only if globs name them.
const MATRIX: &str = "perf/matrix/";

/// Judges the pictures of the selected cases, measures the correct ones, writes samples and reports.
pub(crate) fn run(arguments: &Arguments) -> Result<u8, Failure> {
    // An interruption ends a bench at once; its samples can be continued.
    let done = timed(arguments, &AtomicBool::new(false))?;
    print(arguments, &done)?;
    for end in beside::read(&arguments.out).map_err(Failure::incomplete)? {
        say!(
            "{} {} {}: {}",
            end.verdict,
            end.adapter,
            end.case,
            message(&end)
        );
    }
    Ok(if done.summary.unexpected > 0 {
        UNEXPECTED
    } else {
        0
    })
}

/// A bench whose samples and reports are in its folder.
pub(crate) struct DoneBench {
    pub(crate) summary: BenchSummary,
    names: BTreeSet<String>,
    pub(crate) written: WrittenBench,
}

/// Measures until `stop` is true, and writes samples and reports.
pub(crate) fn timed(arguments: &Arguments, stop: &AtomicBool) -> Result<DoneBench, Failure> {
    let selected = BenchCases::new(arguments)?;
    let counter = arguments.instructions.then(instruction_counter).transpose();
    let counter = counter.map_err(Failure::usage)?;
    // The samples of a concurrent or an earlier bench must not be lost.
    let claim = Out {
        folder: &arguments.out,
        kind: FolderKind::Bench,
        latest: Some(LATEST),
        cases: arguments.selection.cases.as_deref(),
        resume: Some(arguments.resume),
        force: arguments.force,
    }
    .claim()?;
    let expectations = expectations::built_in()?;
    let adapters = discover(&Query {
        names: &arguments.adapters,
        file: arguments.file.adapter_file.as_deref(),
        cold: arguments.cold,
        ..Query::default()
    })?;
    refuse_absent(&arguments.adapters, &adapters)?;
    let names = adapter_names(&adapters)?;
    let header = bench_header(arguments, &selected, &adapters);
    let resume = claim.resume;
    let _lock = claim.take()?;
    let summary = measure(BenchPlan {
        cases: &selected.cases,
        adapters: adapters.ready,
        budget: Duration::from_secs_f64(arguments.seconds),
        timeout: Duration::from_secs_f64(arguments.timeout),
        counter,
        expectations: &expectations,
        resume,
        folder: &arguments.out,
        header,
        stop,
    })?;
    let written = etalon_report::write_bench(&arguments.out).map_err(Failure::incomplete)?;
    Ok(DoneBench {
        summary,
        names,
        written,
    })
}

/// The cases of a bench.
struct BenchCases {
    /// The cases to measure, in order.
    cases: Vec<Case>,
    /// The digest of all selected cases; a shard measures a part of them.
    digest: String,
    shard: Option<Shard>,
}

impl BenchCases {
    fn new(arguments: &Arguments) -> Result<Self, Failure> {
        let mut selection = arguments.selection.clone();
        let by_default = selection.globs.is_empty();
        if by_default {
            selection.globs.push(DEFAULT.to_owned());
        }
        let mut cases = chosen(&selection)?;
        cases.retain(|case| !by_default || !case.id.starts_with(MATRIX));
        group_by_cell(&mut cases);
        Ok(Self {
            digest: selection_digest(cases.iter().map(|case| case.id.as_str())),
            shard: shard::retain_shard(arguments.shard, &mut cases)?,
            cases,
        })
    }
}

/// Returns the names that adapters report. Fails if two are equal.
fn adapter_names(adapters: &Adapters) -> Result<BTreeSet<String>, Failure> {
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
    Ok(names)
}

fn bench_header(arguments: &Arguments, selected: &BenchCases, adapters: &Adapters) -> BenchHeader {
    BenchHeader {
        format: BENCH_FORMAT,
        provenance: provenance::here(),
        profile: arguments.selection.profile.name().to_owned(),
        cases: selected.cases.len() as u64,
        rounds: arguments.rounds,
        shader_cache: cache::state(arguments.cold),
        ruler: etalon_runner::ruler().to_owned(),
        limits: limits(selected),
        settings: BenchSettings {
            selection: selected.digest.clone(),
            shard: selected.shard,
            seconds: Some(arguments.seconds),
            timeout: Some(arguments.timeout),
            within: arguments.within,
            limit: arguments.limit,
        },
        adapters: adapters.ready.iter().map(|(_, w)| w.into()).collect(),
        absent: adapters.absent.clone(),
    }
}

/// Returns the processor's limits, if a case belongs to the performance matrix, whose rates are compared with
/// them.
fn limits(selected: &BenchCases) -> Vec<ProcessorLimits> {
    if !selected.cases.iter().any(|case| cell(&case.id).is_some()) {
        return Vec::new();
    }
    let measured = etalon_cpu::limits().into_iter();
    let limits = measured.map(|limit| ProcessorLimits {
        threads: limit.threads as u32,
        bytes: limit.bytes,
        operations: limit.operations,
    });
    limits.collect()
}

/// Measures with a progress bar, on which a picture counts as one step, like a round.
fn measure(plan: BenchPlan<'_>) -> Result<BenchSummary, Failure> {
    let rounds = u64::from(plan.header.rounds);
    let bar = progress((plan.cases.len() * plan.adapters.len()) as u64 * (1 + rounds));
    let outcome = etalon_runner::bench(plan, &mut |event| show(&bar, rounds, event));
    bar.finish_and_clear();
    outcome.map_err(|error| match error {
        BenchError::Folder(error) => Failure::of(error),
        BenchError::Write(_) => Failure::incomplete(error),
    })
}

fn show(bar: &ProgressBar, rounds: u64, event: BenchEvent) {
    match event {
        BenchEvent::Judged {
            picture,
            unexpected,
            rounds_done,
        } => {
            bar.set_message(format!("judging {}", picture.adapter));
            let rounds_not_timed = if picture.may_be_timed() {
                u64::from(rounds_done)
            } else {
                rounds
            };
            bar.inc(1 + rounds_not_timed);
            if unexpected {
                let (adapter, case) = (&picture.adapter, &picture.case);
                report_bad(bar, picture.verdict, adapter, case, &picture.reasons);
            }
        }
        BenchEvent::Counted {
            case,
            adapter,
            failed,
        } => {
            bar.set_message(format!("counting the instructions of {adapter}"));
            if let Some(reason) = failed {
                bar.suspend(|| say!("instructions not counted: {adapter} {case}: {reason}"));
            }
        }
        BenchEvent::Timed { adapter, .. } => {
            bar.set_message(format!("timing {adapter}"));
            bar.inc(1);
        }
        BenchEvent::Done { spared, .. } => bar.inc(u64::from(spared)),
        BenchEvent::Ended { ended, missing } => {
            bar.inc(u64::from(missing));
            let (adapter, case) = (&ended.adapter, &ended.case);
            report_bad(bar, ended.verdict, adapter, case, &ended.reasons);
        }
    }
}

fn report_bad(bar: &ProgressBar, verdict: Verdict, adapter: &str, case: &str, reasons: &[Reason]) {
    bar.suspend(|| say!("{verdict} {adapter} {case}: {}", reasons_text(reasons)));
}

fn print(arguments: &Arguments, done: &DoneBench) -> Result<(), Failure> {
    let DoneBench {
        summary,
        names,
        written,
    } = done;
    if arguments.format == OutputFormat::Json {
        return print_json(&json!({
            "pictures": summary.pictures,
            "timed": summary.timed,
            "unexpected": summary.unexpected,
            "adapters": names,
            "folder": arguments.out,
            "report": written.html,
            "bencher": written.bencher,
            "action": written.action,
            "matrix": written.matrix,
        }));
    }
    let bench = Bench::read(&arguments.out).map_err(Failure::incomplete)?;
    let options = table_options();
    summarize(&etalon_report::bench_table(&bench, options));
    summarize(&etalon_report::matrix_table(&bench, options));
    summarize(&format!("\nReport: {}\n", written.html.display()));
    for path in written.matrix.iter().flatten() {
        summarize(&format!("Matrix: {}\n", path.display()));
    }
    Ok(())
}

/// Moves the cases of each cell of the matrix together, so that they are timed directly after one another.
fn group_by_cell(cases: &mut [Case]) {
    let mut places = HashMap::new();
    for (place, case) in cases.iter().enumerate() {
        places.entry(group(case)).or_insert(place);
    }
    cases.sort_by_key(|case| places.get(&group(case)).copied());
}

/// Returns the name of a case's cell, or the case's id.
fn group(case: &Case) -> String {
    cell(&case.id).unwrap_or_else(|| case.id.clone())
}

fn parse_share(text: &str) -> Result<f64, String> {
    let number = text.strip_suffix('%');
    match number.and_then(|number| number.trim().parse::<f64>().ok()) {
        Some(percent) if (0.1..=100.0).contains(&percent) => Ok(percent / 100.0),
        _ => Err("expected a share from 0.1% to 100%, such as 3%".to_owned()),
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
