//! `etalon run`.

use crate::adapters::{
    Adapters, Query, cache, described_names, discover, refuse_absent, take_unstarted,
};
use crate::blessing::{bless, to_bless};
use crate::cases::{all_ids, chosen, left_out, library, round_trips};
use crate::catalogue::catalogue;
use crate::expectations::{self, today};
use crate::failure::{Failure, IMPROVED, UNEXPECTED};
use crate::flags::{AdapterFileArguments, CaseArguments, Format, parse_timeout};
use crate::interruption::{how_to_resume, listen};
use crate::news::{NewsArguments, shown};
use crate::out_folder::Out;
use crate::output::{say, summarize, summarize_json, table_options};
use crate::processors::processors;
use crate::progress::progress;
use crate::{provenance, report_files, shard};
use clap::{Args, ValueEnum};
use etalon_case::Case;
use etalon_history::FrameTimes;
use etalon_record::{
    AdapterRecord, Dead, Expectations, FolderKind, FolderLock, Header, Run, Settings, ShaderCache,
    Shard, Verdict, selection_digest, shard_of,
};
use etalon_runner::{Event, Options, Plan, Rechecks, RunError, RunSummary};
use indicatif::ProgressBar;
use serde_json::json;
use std::collections::BTreeMap;
use std::path::PathBuf;
use std::sync::Mutex;
use std::time::Duration;

/// The folder that each run without `--out` replaces.
const LATEST: &str = "reports/latest";

/// The state of the drivers' shader caches on disk.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum CacheState {
    /// Disabled: every process compiles every shader.
    Cold,
    /// Enabled.
    Warm,
}

#[derive(Debug, Args)]
pub(crate) struct Arguments {
    #[command(flatten)]
    pub(crate) selection: CaseArguments,
    /// Run on this adapter; may be repeated. Default: all adapters found
    #[arg(long = "adapter", value_name = "NAME")]
    pub(crate) adapters: Vec<String>,
    #[command(flatten)]
    pub(crate) file: AdapterFileArguments,
    /// Folder for records and reports
    #[arg(long, value_name = "DIR", default_value = "reports/latest")]
    pub(crate) out: PathBuf,
    /// Continue the run in the folder: draw what is missing
    #[arg(long, conflicts_with = "force")]
    pub(crate) resume: bool,
    /// Replace the run or bench in the folder
    #[arg(long)]
    pub(crate) force: bool,
    /// Use these expectations instead of the built-in findings: a list, a finding, or a folder of findings
    #[arg(long, value_name = "PATH")]
    pub(crate) expect: Option<PathBuf>,
    /// Exit with 1 if expectations are dead: a glob matches no case or no adapter, another one covers them, or
    /// all their cases were drawn and none had the verdict
    #[arg(long)]
    pub(crate) strict_expectations: bool,
    /// Exit with 1 if less than this share of the records asserted something; records of methods and perf,
    /// which are measured, do not count
    #[arg(long, value_name = "PERCENT", value_parser = parse_percent)]
    pub(crate) min_asserted: Option<f64>,
    /// Update the expectations (default: ci/findings) from this run: add unexpected verdicts, of grade unread,
    /// and remove improved ones. Refused if the variable CI is set
    #[arg(long)]
    pub(crate) bless: bool,
    #[command(flatten)]
    pub(crate) news: NewsArguments,
    /// Draw shard M of N, chosen by a hash of the id; 1/1 is everything. Default: the shard given by the
    /// variables of GitLab, Bazel, Slurm or a Kubernetes indexed job
    #[arg(long, value_name = "M/N", value_parser = crate::shard::parse)]
    pub(crate) shard: Option<Shard>,
    /// Time limit of a case in seconds (methods and perf: four times as long)
    #[arg(long, value_name = "S", default_value = "60", value_parser = parse_timeout)]
    pub(crate) timeout: f64,
    /// Memory limit of a worker in MiB
    #[arg(long, value_name = "MIB", default_value = "4096", value_parser = clap::value_parser!(u64).range(64..=1 << 20))]
    pub(crate) memory: u64,
    /// Number of workers that draw at the same time. Default: one per processor
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub(crate) jobs: Option<u16>,
    /// Check again in a new process: unexpected bad verdicts, of each kind on each adapter until N are confirmed.
    /// Kinds differ in verdict, aspect, operation and direction. `off`: none, so that nothing is found to be flaky
    #[arg(long, value_name = "N|off", default_value = "4", value_parser = parse_recheck)]
    pub(crate) recheck: Recheck,
    /// Draw each case N times, each time in a new process; a case whose verdicts differ is flaky
    #[arg(long, value_name = "N", default_value = "1", value_parser = clap::value_parser!(u32).range(1..=1000))]
    pub(crate) repeat: u32,
    /// Draw the cases in a random order with this seed; a case that fails only after others names them
    #[arg(long, value_name = "SEED")]
    pub(crate) shuffle: Option<u64>,
    /// State of the drivers' shader caches on disk
    #[arg(long, value_enum, default_value = "warm")]
    pub(crate) shader_cache: CacheState,
    /// Enable validation layers and GL debug output; a case that causes messages is an error
    #[arg(long)]
    pub(crate) validate: bool,
    /// Output format
    #[arg(long, value_enum, default_value = "text")]
    pub(crate) format: Format,
}

/// The number of records of each verdict on each adapter.
fn verdicts(run: &Run) -> BTreeMap<&str, BTreeMap<&str, u64>> {
    let mut counts: BTreeMap<&str, BTreeMap<&str, u64>> = BTreeMap::new();
    for adapter in &run.header.adapters {
        counts.entry(&adapter.name).or_default();
    }
    for record in &run.records {
        let of_adapter = counts.entry(&record.adapter).or_default();
        *of_adapter.entry(record.verdict.name()).or_default() += 1;
    }
    counts
}

/// The number of confirmations of each kind of bad verdict; 0 is off.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Recheck(u32);

fn parse_recheck(text: &str) -> Result<Recheck, String> {
    let number = match text {
        "off" => Some(0),
        text => text.parse().ok().filter(|n| (1..=256).contains(n)),
    };
    let wrong = || "expected a number from 1 to 256, or `off`".to_owned();
    number.map(Recheck).ok_or_else(wrong)
}

fn parse_percent(text: &str) -> Result<f64, String> {
    let percent: f64 = text.trim_end_matches('%').parse().unwrap_or(f64::NAN);
    if (0.0..=100.0).contains(&percent) {
        Ok(percent)
    } else {
        Err("expected a number of percent from 0 to 100".to_owned())
    }
}

/// Draws the selected cases on the selected adapters, judges them, writes records and reports.
pub(crate) fn run(arguments: &Arguments) -> Result<u8, Failure> {
    arguments.news.check()?;
    let mut cases = chosen(&arguments.selection)?;
    if arguments.selection.globs.is_empty() {
        // One measured picture takes as long as hundreds of cases. A folder with nothing else in it means them.
        let measured_alone = cases.iter().all(|case| case.measured);
        cases.retain(|case| measured_alone || !case.measured);
    }
    let selection: Vec<String> = cases.iter().map(|case| case.id.clone()).collect();
    let round_trips = round_trips(arguments.selection.cases.as_ref(), &cases)?;
    let shard = shard::chosen(arguments.shard)?;
    if let Some(shard) = shard {
        cases.retain(|case| shard_of(&case.id, shard.count) == shard.index);
        say!(
            "shard {shard}: {} of {} cases",
            cases.len(),
            selection.len()
        );
    }
    if let Some(seed) = arguments.shuffle {
        shuffle(&mut cases, seed);
    }
    let blessed = match arguments.bless {
        true => Some(to_bless(arguments.expect.as_deref())?),
        false => None,
    };
    let expectations = match &blessed {
        // The file to write need not exist yet.
        Some(path) if !path.exists() => Expectations::default(),
        Some(path) => Expectations::read(path).map_err(Failure::usage)?,
        None => expectations::read(arguments.expect.as_deref())?,
    }
    .on(&today());
    // The records of a concurrent or an earlier run must not be lost.
    let lock = || FolderLock::acquire(&arguments.out).map_err(Failure::usage);
    let early = arguments.out.exists().then(lock).transpose()?;
    let out = Out {
        folder: &arguments.out,
        kind: FolderKind::Run,
        latest: LATEST,
        resume: arguments.resume,
        force: arguments.force,
    };
    let resume = out.resumes()?;
    let stop = listen()?;
    let mut adapters = discover(&Query {
        names: &arguments.adapters,
        file: arguments.file.adapter_file.as_deref(),
        validate: arguments.validate,
        cold: arguments.shader_cache == CacheState::Cold,
        ..Query::default()
    })?;
    // A driver that is installed and does not start has a record for each case like any other.
    let dead = take_unstarted(&mut adapters);
    for (adapter, how) in &dead {
        say!("{} does not start: {how}", adapter.name);
    }
    refuse_absent(&arguments.adapters, &adapters.absent)?;
    // A new folder is created only once there is something to write.
    let _lock = early.map_or_else(lock, Ok)?;
    out.clear_other()?;
    let mut header = header(arguments, &cases, &selection, shard, &adapters, &dead);
    header.settings.left_out = Some(left_out(&arguments.selection, &selection)?);
    let names: Vec<String> = header.adapters.iter().map(|a| a.name.clone()).collect();
    let plan = Plan {
        reports: report_files::RUN,
        cases: &cases,
        round_trips: &round_trips,
        selection: Some(&selection),
        adapters: adapters.ready,
        dead,
        options: Options {
            jobs: arguments.jobs.map_or_else(processors, usize::from),
            timeout: Duration::from_secs_f64(arguments.timeout),
            memory: Some(arguments.memory),
            repeat: arguments.repeat,
            recheck: arguments.recheck.0,
        },
        expectations: &expectations,
        folder: &arguments.out,
        header,
        resume,
        stop,
    };
    let bar = progress(cases.len() as u64 * names.len() as u64);
    let outcome = execute(plan, &bar);
    bar.finish_and_clear();
    let outcome = outcome.map_err(|error| match error {
        RunError::Folder(error) => Failure::usage(error),
        RunError::Write(_) => Failure::incomplete(format!("{error}; {}", how_to_resume())),
    })?;
    let run = Run::read(&arguments.out).map_err(Failure::incomplete)?;
    let dead = match (&arguments.expect, &arguments.selection.cases) {
        // The built-in findings are about the built-in cases.
        (None, Some(_)) => Vec::new(),
        _ => dead_expectations(arguments, &expectations, &run)?,
    };
    Dead::write(&arguments.out, &dead).map_err(Failure::incomplete)?;
    let library = library(arguments.selection.cases.as_ref())?;
    etalon_report::write_catalogue(&arguments.out, &catalogue(&library, &cases))
        .map_err(Failure::incomplete)?;
    let news = arguments.news.news(&run)?;
    let shown = shown(&run, news.as_ref());
    let written = etalon_report::write_run_with_news(&arguments.out, &shown, news.as_ref())
        .map_err(Failure::incomplete)?;
    if arguments.format == Format::Json {
        summarize_json(&json!({
            "records": outcome.records,
            "missing": run.missing(),
            "unexpected": outcome.unexpected,
            "improvements": outcome.improvements,
            "rechecked": outcome.rechecks.done,
            "not_rechecked": outcome.rechecks.left,
            "interrupted": outcome.interrupted,
            "dead_expectations": dead,
            "adapters": names,
            "verdicts": verdicts(&run),
            "news": news,
            "folder": arguments.out,
            "report": written.html,
        }))?;
    } else {
        if let Some(news) = &news {
            summarize(&etalon_report::news_table(news, table_options()));
        }
        summarize(&etalon_report::table(&shown, table_options()));
        summarize(&rechecked(arguments.recheck, outcome.rechecks));
        summarize(&format!("\nReport: {}\n", written.html.display()));
    }
    if run.missing() > 0 {
        let interrupted = if outcome.interrupted {
            "interrupted: "
        } else {
            ""
        };
        return Err(Failure::incomplete(format!(
            "{interrupted}{} of {} records are missing; {}",
            run.missing(),
            run.header.expected_records(),
            how_to_resume()
        )));
    }
    arguments.news.tell_how_to_add(&arguments.out);
    if let Some(path) = &blessed {
        let all_adapters = arguments.adapters.is_empty();
        let cases = arguments.selection.cases.as_ref();
        bless(path, &run, &expectations, cases, all_adapters)?;
        return Ok(0);
    }
    if !dead.is_empty() {
        say!("{}", etalon_report::dead_lines(&dead));
        if !arguments.strict_expectations {
            say!("--strict-expectations exits with 1 for them");
        }
    }
    let asserted = arguments.min_asserted.is_none_or(|percent| {
        let (enough, line) = asserted(&run, percent);
        if !enough {
            say!("{line}");
        }
        enough
    });
    let unexpected = news.map_or(outcome.unexpected, |news| news.counted());
    Ok(match outcome {
        _ if unexpected > 0 => UNEXPECTED,
        _ if !asserted || arguments.strict_expectations && !dead.is_empty() => UNEXPECTED,
        RunSummary {
            improvements: 1.., ..
        } => IMPROVED,
        _ => 0,
    })
}

fn dead_expectations(
    arguments: &Arguments,
    expectations: &Expectations,
    run: &Run,
) -> Result<Vec<Dead>, Failure> {
    if expectations.all().is_empty() {
        return Ok(Vec::new());
    }
    let ids = all_ids(arguments.selection.cases.as_ref())?;
    let described = described_names(arguments.file.adapter_file.as_deref())?;
    Ok(expectations.dead(run, &ids, &described))
}

/// Returns a line on the bad verdicts that were checked again; nothing where there were none.
fn rechecked(recheck: Recheck, Rechecks { done, left }: Rechecks) -> String {
    match (recheck.0, done, left) {
        (_, 0, 0) => String::new(),
        (0, ..) => "Not rechecked (--recheck off): no bad verdict was drawn again.\n".to_owned(),
        (n, done, 0) => format!("Rechecked: all {done} unexpected bad verdicts (--recheck {n}).\n"),
        (n, done, left) => format!(
            "Rechecked: {done} of {} unexpected bad verdicts, until {n} of a kind were confirmed on an adapter (--recheck N|off).\n",
            done + left
        ),
    }
}

/// Returns true if enough was asserted, and a line that says how much was: the share of the records of cases that
/// are judged, not measured, whose frame was held against something.
fn asserted(run: &Run, percent: f64) -> (bool, String) {
    let counted = run
        .records
        .iter()
        .filter(|r| !FrameTimes::AREAS.contains(&r.area()));
    let all = counted.clone().count();
    if all == 0 {
        let line = "nothing was asserted: no selected case is judged (--min-asserted)";
        return (false, line.to_owned());
    }
    let asserted = counted.filter(|r| r.asserts()).count();
    let share = 100.0 * asserted as f64 / all as f64;
    // Rounded down, so that too little never reads as enough.
    let shown = (share * 10.0).floor() / 10.0;
    let line = format!(
        "{asserted} of {all} records asserted something: {shown} % where --min-asserted demands {percent} %"
    );
    (share >= percent, line)
}

/// Fisher and Yates' shuffle.
fn shuffle(cases: &mut [Case], seed: u64) {
    let mut random = oorandom::Rand64::new(u128::from(seed));
    for last in (1..cases.len()).rev() {
        let other = random.rand_range(0..last as u64 + 1);
        cases.swap(last, other as usize);
    }
}

fn header(
    arguments: &Arguments,
    cases: &[Case],
    selection: &[String],
    shard: Option<Shard>,
    adapters: &Adapters,
    dead: &[(AdapterRecord, String)],
) -> Header {
    Header {
        format: etalon_record::FORMAT,
        etalon: provenance::VERSION.to_owned(),
        commit: provenance::commit(),
        machine: provenance::machine(),
        started: provenance::now(),
        command: provenance::command(),
        cases: cases.len() as u64,
        settings: Settings {
            selection: selection_digest(selection.iter().map(String::as_str)),
            shard,
            profile: Some(arguments.selection.profile.name().to_owned()),
            left_out: None,
            shuffle: arguments.shuffle,
            repeat: (arguments.repeat > 1).then_some(arguments.repeat),
            shader_cache: Some(
                match arguments.shader_cache == CacheState::Cold || cache::is_disabled() {
                    true => ShaderCache::Cold,
                    false => ShaderCache::Warm,
                },
            ),
            validate: arguments.validate,
            timeout: Some(arguments.timeout),
            memory: Some(arguments.memory),
        },
        adapters: {
            let up = adapters.ready.iter().map(|(_, w)| w.into());
            up.chain(dead.iter().map(|(a, _)| a.clone())).collect()
        },
        absent: adapters.absent.clone(),
    }
}

fn execute(plan: Plan<'_>, bar: &ProgressBar) -> Result<RunSummary, RunError> {
    let before = if plan.resume {
        Run::read(plan.folder).map_or(0, |run| run.records.len() as u64)
    } else {
        0
    };
    bar.inc(before);
    bar.reset_eta();
    // Each is told once, with its reason, when the run has ended; until then the bar counts them.
    let bad: Mutex<BTreeMap<Verdict, u64>> = Mutex::default();
    etalon_runner::run(plan, &|event| match event {
        Event::AdapterStarted { .. } => {}
        Event::Recorded(record) => {
            if record.unexpected()
                && let Ok(mut bad) = bad.lock()
            {
                *bad.entry(record.verdict).or_default() += 1;
                let counts = bad.iter().map(|(verdict, n)| format!("{n} {verdict}"));
                bar.set_message(counts.collect::<Vec<_>>().join(", "));
            }
            bar.inc(1);
        }
        Event::AdapterFinished { adapter, wall } => bar.suspend(|| {
            say!("{adapter} done in {:.1} s", wall.as_secs_f64());
        }),
    })
}
