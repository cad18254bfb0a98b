//! `etalon run`.

use crate::blessing::{bless, to_bless};
use crate::cases::{chosen, leave_measured, left_out, library, library_of, round_trips};
use crate::catalogue::{CataloguePictures, catalogue};
use crate::discovery::{discover, refuse_absent};
use crate::expectations::{ExpectArguments, counting};
use crate::failure::{Failure, IMPROVED, INCOMPLETE, UNEXPECTED};
use crate::flags::{AdapterFileArguments, CaseArguments, OutputFormat, parse_timeout};
use crate::interruption::{how_to_resume, listen};
use crate::known_look::{self, LookInputs};
use crate::news::{NewsArguments, shown};
use crate::out_folder::Out;
use crate::output::{print_json, say, summarize, table_options};
use crate::processors::processors;
use crate::progress::progress;
use crate::sizes::{SizeList, frame_sizes};
use crate::worth::sort_by_worth;
use crate::{dead, idle, provenance, shard, sizes, timed};
use clap::{Args, FromArgMatches, ValueEnum};
use etalon_adapters::{Adapters, Query, cache, take_unstarted};
use etalon_case::Case;
use etalon_record::{
    AdapterRecord, Dead, Expectations, FolderKind, Header, Run, Settings, Shard, Times, Verdict,
    selection_digest,
};
use etalon_report::{RunNews, RunReport};
use etalon_runner::{
    KeptFrames, Launch, Plan, Rechecks, RunError, RunEvent, RunOptions, RunSummary,
};
use indicatif::ProgressBar;
use serde_json::json;
use std::collections::BTreeMap;
use std::ffi::OsStr;
use std::mem::ManuallyDrop;
use std::path::{Path, PathBuf};
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

/// The folder of each run without `--out`.
pub(crate) const LATEST: &str = "reports/latest";

/// The number of workers beyond one per processor while processors are idle. Each holds a device's memory.
const SPARE_WORKERS: usize = 6;

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
    #[arg(long, value_name = "DIR", default_value = LATEST)]
    pub(crate) out: PathBuf,
    /// Continue the run in the folder: draw what is missing. With `--out` alone, the other flags are those of the
    /// interrupted command
    #[arg(long, conflicts_with = "force")]
    pub(crate) resume: bool,
    /// Replace the run or bench in the folder
    #[arg(long)]
    pub(crate) force: bool,
    #[command(flatten)]
    pub(crate) expected: ExpectArguments,
    /// Exit with 1 if expectations are dead: a glob matches no case or no adapter, another expectation covers
    /// them, or all their cases were drawn and none had the verdict
    #[arg(long)]
    pub(crate) strict_expectations: bool,
    /// Exit with 1 if less than this share of the records asserts something; measured records (methods and
    /// perf) do not count
    #[arg(long, value_name = "PERCENT", value_parser = parse_percent)]
    pub(crate) min_asserted: Option<f64>,
    /// Update the expectations (default: ci/findings) from this run: add unexpected verdicts, with the grade
    /// unread, and remove improved ones. Refused if the variable CI is set
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
    /// Number of workers that draw at the same time. Default: one per processor, and up to six more while
    /// processors are idle
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub(crate) jobs: Option<u16>,
    /// Check unexpected bad verdicts again in a new process, until N of each kind are confirmed on each
    /// adapter. Kinds differ in verdict, aspect, operation and direction. `off` checks none, so that no case
    /// is found to be flaky
    #[arg(long, value_name = "N|off", default_value = "4", value_parser = parse_recheck)]
    pub(crate) recheck: Recheck,
    /// Draw each case N times, each time in a new process; a case whose verdicts differ is flaky
    #[arg(long, value_name = "N", default_value = "1", value_parser = clap::value_parser!(u32).range(1..=1000))]
    pub(crate) repeat: u32,
    /// Draw the cases in a random order with this seed, to find cases that fail only after others; the record
    /// of such a case names these
    #[arg(long, value_name = "SEED")]
    pub(crate) shuffle: Option<u64>,
    /// Begin no case after this many seconds; adapters share the time. Cases that catch the most planted bugs per
    /// second come first, then one case of each file in turn. Cases left out get the verdict `skipped`
    #[arg(long, value_name = "S", value_parser = parse_timeout, conflicts_with_all = ["shuffle", "resume"])]
    pub(crate) within: Option<f64>,
    /// The time that a driver may take to start, if less than usual.
    #[arg(skip)]
    pub(crate) start_timeout: Option<Duration>,
    /// Sizes of frames at which methods are timed as well, such as 720p,1080p,4k or 2560x1440, or `none`. Default: these
    /// three on hardware, 720p where the processor draws
    #[arg(long, value_name = "SIZES", value_parser = crate::sizes::parse)]
    pub(crate) sizes: Option<SizeList>,
    /// Also time a frame of each kind of work (fill, blending, depth, resolve, ...) on every adapter, for about 5 s each,
    /// and chart it against its error. The samples are a bench in DIR/timed
    #[arg(long)]
    pub(crate) timed: bool,
    /// State of the drivers' shader caches on disk
    #[arg(long, value_enum, default_value = "warm")]
    pub(crate) shader_cache: CacheState,
    /// Compare unexpected failures with the findings about the driver, by reducing both on it. A failure that
    /// reduces to the same states and violation as a finding's case is known by its look and counts as
    /// expected, if both have the facts that the finding needs and another record of this adapter shows the
    /// finding. For your own cases
    #[arg(long, conflicts_with = "history")]
    pub(crate) known_by_look: bool,
    /// Failures whose complete frames are kept. Except with `all`, one case per finding and adapter keeps the story
    /// and the wrong texels of a known failure; other records name that case
    #[arg(long, value_enum, default_value = "examples")]
    pub(crate) keep_frames: KeepFrames,
    /// Enable validation layers and GL debug output; a case that causes messages is an error
    #[arg(long)]
    pub(crate) validate: bool,
    /// Output format
    #[arg(long, value_enum, default_value = "text")]
    pub(crate) format: OutputFormat,
}

/// Failures whose frames are kept.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum KeepFrames {
    /// All of them
    All,
    /// Unexpected ones, and one per finding and adapter
    Examples,
    /// Only unexpected ones
    New,
    /// None
    None,
}

/// Returns the number of records of each verdict on each adapter.
pub(crate) fn verdicts(run: &Run) -> BTreeMap<&str, BTreeMap<&str, u64>> {
    let mut counts: BTreeMap<&str, BTreeMap<&str, u64>> = BTreeMap::new();
    for adapter in &run.header.adapters {
        counts.entry(&adapter.info.name).or_default();
    }
    for record in &run.records {
        let of_adapter = counts.entry(&record.adapter).or_default();
        *of_adapter.entry(record.verdict.name()).or_default() += 1;
    }
    counts
}

/// The number of bad verdicts of each kind that must be confirmed; 0 is off.
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
    match interrupted(arguments)? {
        Some(interrupted) => drawn(&interrupted),
        None => drawn(arguments),
    }
}

/// Returns the flags of the interrupted command, if the folder to resume is the only one given.
fn interrupted(arguments: &Arguments) -> Result<Option<Arguments>, Failure> {
    let given = provenance::command();
    let mut given = given.iter().skip(2).filter(|word| *word != "--resume");
    let is_out = |word: &String| word == "--out" || word.starts_with("--out=");
    let out = given
        .next()
        .is_none_or(|word| is_out(word) && (word != "--out" || given.next().is_some()));
    if !arguments.resume
        || !out
        || given.next().is_some()
        || FolderKind::of(&arguments.out) != Some(FolderKind::Run)
    {
        return Ok(None);
    }
    let header = Run::read(&arguments.out).map_err(Failure::usage)?.header;
    let [_, command, words @ ..] = &header.provenance.command[..] else {
        return Ok(None);
    };
    let Some(recorded) = of_words(words).filter(|_| command == "run") else {
        return Ok(None);
    };
    Ok(Some(Arguments {
        out: arguments.out.clone(),
        resume: true,
        force: false,
        ..recorded
    }))
}

/// Returns the arguments of a command line, without the program and the command.
pub(crate) fn of_words<S: AsRef<OsStr>>(words: &[S]) -> Option<Arguments> {
    let flags = Arguments::augment_args(clap::Command::new("run").no_binary_name(true));
    let read = flags.try_get_matches_from(words.iter().map(AsRef::as_ref));
    read.and_then(|m| Arguments::from_arg_matches(&m)).ok()
}

fn drawn(arguments: &Arguments) -> Result<u8, Failure> {
    if arguments.news.history.is_some() {
        arguments.news.check()?;
    } else {
        // Without a history, labels limit expectations.
        arguments.news.labels.labels()?;
    }
    let selected = RunCases::new(arguments)?;
    let to_bless = file_to_bless(arguments)?;
    // Many take long to free, and the process ends after the run.
    let expectations = ManuallyDrop::new(expectations(arguments, to_bless.as_deref())?);
    let blessed = blessed(arguments, to_bless.as_deref())?;
    // Claims the folder first, so that the records of a concurrent or an earlier run are not lost.
    let claim = Out {
        folder: &arguments.out,
        kind: FolderKind::Run,
        latest: Some(LATEST),
        cases: arguments.selection.cases.as_deref(),
        resume: Some(arguments.resume),
        force: arguments.force,
    }
    .claim()?;
    let stop = listen()?;
    let started = StartedAdapters::start(arguments)?;
    let launches: Vec<Launch> = started.launches().cloned().collect();
    let resume = claim.resume;
    let _lock = claim.take()?;
    if !resume {
        timed::forget(&arguments.out)?;
    }
    let pictures = CataloguePictures::default();
    let plan = Plan {
        resume,
        drawn: &|adapter, case, frame| pictures.take(adapter, case, frame),
        ..started.plan(arguments, &selected, &expectations, stop)
    };
    let adapters = plan.header.adapters.iter();
    let adapter_names = adapters.map(|a| a.info.name.clone()).collect();
    let mut summary = draw(plan)?;
    if arguments.known_by_look && !summary.interrupted {
        summary.unexpected = known_by_look(arguments, &expectations, &launches, stop)?;
    }
    let timed = if arguments.timed && !summary.interrupted {
        let cold = arguments.shader_cache == CacheState::Cold;
        let Arguments {
            out,
            adapters,
            file,
            timeout,
            ..
        } = arguments;
        timed::time(out, adapters, file, *timeout, cold, resume, stop).map(Some)
    } else {
        Ok(None)
    };
    // Without frame times the records still have their reports.
    let mut results = Results::write(
        arguments,
        &selected,
        &expectations,
        &pictures,
        summary,
        adapter_names,
    )?;
    if let Ok(Some(timed)) = &timed {
        results.timed = Some(timed.written.html.clone());
    }
    results.print()?;
    let timed = timed?.map_or(0, |timed| timed.summary.unexpected);
    let run = &results.run;
    if run.missing() > 0 {
        return Err(incomplete(run, summary.interrupted));
    }
    if arguments.timed && stop.load(Ordering::Relaxed) {
        return Err(Failure::incomplete(format!(
            "interrupted while frames were timed; {}",
            how_to_resume()
        )));
    }
    arguments.news.tell_how_to_add(&arguments.out);
    if let Some(path) = &to_bless {
        let all_adapters = arguments.adapters.is_empty();
        let cases = arguments.selection.cases.as_ref();
        bless(path, run, &blessed, cases, all_adapters)?;
        return Ok(0);
    }
    Ok(results.exit_code(timed))
}

/// Returns the list or folder to update with `--bless`, if any.
fn file_to_bless(arguments: &Arguments) -> Result<Option<PathBuf>, Failure> {
    let Arguments {
        bless, expected, ..
    } = arguments;
    bless.then(|| to_bless(&expected.expect)).transpose()
}

/// Compares unexpected failures with findings. Returns the number of records that stay unexpected.
fn known_by_look(
    arguments: &Arguments,
    expectations: &Expectations,
    launches: &[Launch],
    stop: &AtomicBool,
) -> Result<u64, Failure> {
    let looks = LookInputs {
        library: &library_of(&arguments.selection)?,
        expectations,
        launches,
        timeout: options(arguments).timeout,
        stop,
    };
    looks.mark(&arguments.out)
}

/// The cases of a run.
pub(crate) struct RunCases {
    /// The cases to draw, in order.
    pub(crate) cases: Vec<Case>,
    /// The ids of all selected cases; a shard draws a part of them.
    ids: Vec<String>,
    round_trips: Vec<Case>,
    shard: Option<Shard>,
    /// The number of cases that the profile leaves out.
    left_out: u64,
}

impl RunCases {
    pub(crate) fn new(arguments: &Arguments) -> Result<Self, Failure> {
        let Arguments { selection, .. } = arguments;
        let mut cases = chosen(selection)?;
        leave_measured(&mut cases, selection, |case| case.measured);
        let ids: Vec<String> = cases.iter().map(|case| case.id.clone()).collect();
        let round_trips = round_trips(selection.cases.as_ref(), &cases)?;
        let shard = shard::retain_shard(arguments.shard, &mut cases)?;
        if let Some(seed) = arguments.shuffle {
            shuffle(&mut cases, seed);
        }
        if arguments.within.is_some() {
            sort_by_worth(&mut cases);
        }
        Ok(Self {
            left_out: left_out(selection, &ids)?,
            cases,
            ids,
            round_trips,
            shard,
        })
    }
}

/// The adapters of a command.
pub(crate) struct StartedAdapters {
    adapters: Adapters,
    /// Drivers that are installed but do not start, with the reason: their cases get records too.
    dead: Vec<(AdapterRecord, String)>,
}

impl StartedAdapters {
    /// Starts the adapters.
    pub(crate) fn start(arguments: &Arguments) -> Result<Self, Failure> {
        let mut adapters = discover(&Query {
            names: &arguments.adapters,
            file: arguments.file.adapter_file.as_deref(),
            validate: arguments.validate,
            cold: arguments.shader_cache == CacheState::Cold,
            start_timeout: arguments.start_timeout,
            ..Query::default()
        })?;
        let dead = take_unstarted(&mut adapters);
        for (adapter, how) in &dead {
            say!("{} does not start: {how}", adapter.info.name);
        }
        refuse_absent(&arguments.adapters, &adapters)?;
        if adapters.ready.is_empty() && dead.is_empty() {
            return Err(Failure::nothing(
                "no adapter can be used; `etalon adapters` says why",
            ));
        }
        Ok(Self { adapters, dead })
    }

    /// Returns the commands of the workers that started.
    pub(crate) fn launches(&self) -> impl Iterator<Item = &Launch> {
        self.adapters.ready.iter().map(|(launch, _)| launch)
    }

    /// Returns the plan of a new run into the folder of a command.
    pub(crate) fn plan<'a>(
        self,
        arguments: &'a Arguments,
        selected: &'a RunCases,
        expectations: &'a Expectations,
        stop: &'a AtomicBool,
    ) -> Plan<'a> {
        let header = self.header(arguments, selected);
        Plan {
            cases: &selected.cases,
            round_trips: &selected.round_trips,
            selection: Some(&selected.ids),
            adapters: self.adapters.ready,
            dead: self.dead,
            options: options(arguments),
            expectations,
            folder: &arguments.out,
            header,
            resume: false,
            stop,
            drawn: &|_, _, _| (),
        }
    }

    fn header(&self, arguments: &Arguments, selected: &RunCases) -> Header {
        Header {
            format: etalon_record::FORMAT,
            provenance: provenance::here(),
            cases: selected.cases.len() as u64,
            settings: Settings {
                selection: selection_digest(selected.ids.iter().map(String::as_str)),
                shard: selected.shard,
                profile: Some(arguments.selection.profile.name().to_owned()),
                left_out: Some(selected.left_out),
                shuffle: arguments.shuffle,
                repeat: (arguments.repeat > 1).then_some(arguments.repeat),
                shader_cache: Some(cache::state(arguments.shader_cache == CacheState::Cold)),
                validate: arguments.validate,
                timeout: Some(arguments.timeout),
                memory: Some(arguments.memory),
                gltf: arguments
                    .selection
                    .gltf
                    .as_ref()
                    .map(|scene| scene.file.clone()),
                sizes: if selected.cases.iter().any(|case| case.method.is_some()) {
                    sizes::recorded(arguments.sizes.as_ref())
                } else {
                    Vec::new()
                },
            },
            adapters: {
                let up = self.adapters.ready.iter().map(|(_, w)| w.into());
                up.chain(self.dead.iter().map(|(a, _)| a.clone())).collect()
            },
            absent: self.adapters.absent.clone(),
        }
    }
}

/// Returns the expectations of a run; `to_bless` is the file to update, which need not exist yet.
fn expectations(arguments: &Arguments, to_bless: Option<&Path>) -> Result<Expectations, Failure> {
    let mut expected = arguments.expected.clone();
    if let Some(path) = to_bless {
        // The default folder is the source of the built-in findings, so these are not added again.
        expected.expect_only |= expected.expect.is_empty();
        expected.expect = if path.exists() {
            vec![path.to_owned()]
        } else {
            Vec::new()
        };
    }
    expected.read(&labels(arguments))
}

/// Returns the expectations of the list to update only, without the other expectations of the run.
fn blessed(arguments: &Arguments, to_bless: Option<&Path>) -> Result<Expectations, Failure> {
    match to_bless {
        Some(path) if path.exists() => {
            let read = Expectations::read(path).map_err(Failure::usage)?;
            Ok(counting(read, &labels(arguments)))
        }
        _ => Ok(Expectations::default()),
    }
}

/// Returns the labels of a run, as `key=value`.
fn labels(arguments: &Arguments) -> Vec<String> {
    arguments.news.labels.given().to_vec()
}

fn options(arguments: &Arguments) -> RunOptions {
    let (jobs, most_jobs) = match arguments.jobs {
        Some(jobs) => (usize::from(jobs), usize::from(jobs)),
        None => (processors(), processors() + SPARE_WORKERS),
    };
    RunOptions {
        jobs,
        most_jobs,
        timeout: Duration::from_secs_f64(arguments.timeout),
        memory: Some(arguments.memory),
        repeat: arguments.repeat,
        recheck: arguments.recheck.0,
        frames: match arguments.keep_frames {
            KeepFrames::All => KeptFrames::All,
            KeepFrames::Examples => KeptFrames::Examples,
            KeepFrames::New => KeptFrames::New,
            KeepFrames::None => KeptFrames::None,
        },
        within: arguments.within.map(Duration::from_secs_f64),
        sizes: frame_sizes(arguments.sizes.as_ref()),
    }
}

/// Draws with a progress bar.
pub(crate) fn draw(plan: Plan<'_>) -> Result<RunSummary, Failure> {
    let bar = progress(plan.cases.len() as u64 * plan.header.adapters.len() as u64);
    let outcome = execute(plan, &bar);
    bar.finish_and_clear();
    outcome.map_err(|error| match error {
        RunError::Folder(error) => Failure::of(error),
        RunError::Write(_) => Failure::incomplete(format!("{error}; {}", how_to_resume())),
    })
}

/// A drawn run, and everything that is written next to its records.
struct Results<'a> {
    arguments: &'a Arguments,
    summary: RunSummary,
    adapter_names: Vec<String>,
    run: Run,
    dead: Vec<Dead>,
    news: Option<RunNews>,
    report: PathBuf,
    /// The page of frame times.
    timed: Option<PathBuf>,
}

impl<'a> Results<'a> {
    /// Reads the records back, and writes pages and lists next to them.
    fn write(
        arguments: &'a Arguments,
        selected: &RunCases,
        expectations: &Expectations,
        pictures: &CataloguePictures,
        summary: RunSummary,
        adapter_names: Vec<String>,
    ) -> Result<Self, Failure> {
        let folder = &arguments.out;
        let run = Run::read(folder).map_err(Failure::incomplete)?;
        let cases = arguments.selection.cases.as_ref();
        let library = library(cases)?;
        let adapter_file = arguments.file.adapter_file.as_deref();
        let dead = dead::of_run(&run, expectations, &library, cases.is_some(), adapter_file)?;
        Dead::write(folder, &dead).map_err(Failure::incomplete)?;
        let catalogue = catalogue(&library, &selected.cases, pictures);
        let news = arguments.news.news(&run)?;
        let shown = shown(&run, news.as_ref());
        let written = RunReport {
            folder,
            run: &shown,
            catalogue: Some(&catalogue),
            news: news.as_ref(),
            deqp: false,
        }
        .write()
        .map_err(Failure::incomplete)?;
        drop(shown);
        Ok(Self {
            arguments,
            summary,
            adapter_names,
            run,
            dead,
            news,
            report: written.html,
            timed: None,
        })
    }

    fn print(&self) -> Result<(), Failure> {
        if self.arguments.format == OutputFormat::Json {
            return print_json(&json!({
                "records": self.summary.records,
                "missing": self.run.missing(),
                "unexpected": self.summary.unexpected,
                "improvements": self.summary.improvements,
                "known_by_look": self.run.records.iter().filter(|r| r.look.is_some()).count(),
                "rechecked": self.summary.rechecks.done,
                "not_rechecked": self.summary.rechecks.left,
                "interrupted": self.summary.interrupted,
                "dead_expectations": self.dead,
                "beside": self.run.beside,
                "adapters": self.adapter_names,
                "verdicts": verdicts(&self.run),
                "news": self.news,
                "points": etalon_report::method_points(&self.run),
                "folder": self.arguments.out,
                "report": self.report,
                "timed": self.timed,
            }));
        }
        if let Some(news) = &self.news {
            summarize(&etalon_report::news_table(news, table_options()));
        }
        let shown = shown(&self.run, self.news.as_ref());
        summarize(&etalon_report::table(&shown, table_options()));
        summarize(&known_look::lines(&self.run));
        summarize(&rechecked(self.arguments.recheck, self.summary.rechecks));
        summarize(&format!("\nReport: {}\n", self.report.display()));
        if let Some(page) = &self.timed {
            summarize(&format!("Frame times: {}\n", page.display()));
        }
        summarize(&format!("{}\n", etalon_report::conclusion(&shown)));
        Ok(())
    }

    /// Returns the exit code, and prints its reasons other than verdicts. Pictures of the timed set can be wrong too.
    fn exit_code(&self, wrongly_timed: u64) -> u8 {
        let strict = self.arguments.strict_expectations;
        if !self.dead.is_empty() {
            say!("{}", etalon_report::dead_lines(&self.dead));
            if !strict {
                say!("--strict-expectations exits with 1 for them");
            }
        }
        let asserted = self.arguments.min_asserted.is_none_or(|percent| {
            let (enough, line) = asserted(&self.run, percent);
            if !enough {
                say!("{line}");
            }
            enough
        });
        let news = self.news.as_ref();
        let unexpected = news.map_or(self.summary.unexpected, |news| news.counted(&self.run));
        let unexpected = unexpected + wrongly_timed;
        let idle = idle::report(&self.run);
        if unexpected > 0 || !asserted || strict && !self.dead.is_empty() {
            UNEXPECTED
        } else if idle {
            INCOMPLETE
        } else if self.summary.improvements > 0 {
            IMPROVED
        } else {
            0
        }
    }
}

/// Returns the error for a run that lacks records.
fn incomplete(run: &Run, interrupted: bool) -> Failure {
    let interrupted = if interrupted { "interrupted: " } else { "" };
    let names = run.header.adapters.iter().map(|a| a.info.name.as_str());
    let undrawn = names.filter(|name| run.records.iter().all(|r| r.adapter != *name));
    let undrawn: String = undrawn
        .map(|name| format!("{name} has no record; "))
        .collect();
    Failure::incomplete(format!(
        "{interrupted}{undrawn}{} of {} records are missing; {}",
        run.missing(),
        run.header.expected_records(),
        how_to_resume()
    ))
}

/// Returns a line about the bad verdicts that were checked again; empty without bad verdicts.
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

/// Returns true if enough records assert something, and a line with their share. Records of measured cases do
/// not count.
fn asserted(run: &Run, percent: f64) -> (bool, String) {
    let counted = run
        .records
        .iter()
        .filter(|r| !Times::AREAS.contains(&r.parts().area()));
    let total = counted.clone().count();
    if total == 0 {
        let line = "nothing was asserted: no selected case is judged (--min-asserted)";
        return (false, line.to_owned());
    }
    let asserted = counted.filter(|r| r.asserts()).count();
    let share = 100.0 * asserted as f64 / total as f64;
    // Rounded down, so that too little never reads as enough.
    let shown = (share * 10.0).floor() / 10.0;
    let line = format!(
        "{asserted} of {total} records asserted something: {shown} %, but --min-asserted requires {percent} %"
    );
    (share >= percent, line)
}

/// Shuffles cases by the Fisher-Yates algorithm.
fn shuffle(cases: &mut [Case], seed: u64) {
    let mut random = oorandom::Rand64::new(u128::from(seed));
    for last in (1..cases.len()).rev() {
        let other = random.rand_range(0..last as u64 + 1);
        cases.swap(last, other as usize);
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
    // Bad verdicts are printed with their reasons after the run; until then the bar counts them.
    let bad: Mutex<BTreeMap<Verdict, u64>> = Mutex::default();
    etalon_runner::run(plan, &|event| match event {
        RunEvent::AdapterStarted { .. } => {}
        RunEvent::Recorded(record) => {
            if record.unexpected()
                && let Ok(mut bad) = bad.lock()
            {
                *bad.entry(record.verdict).or_default() += 1;
                let counts = bad.iter().map(|(verdict, n)| format!("{n} {verdict}"));
                bar.set_message(counts.collect::<Vec<_>>().join(", "));
            }
            bar.inc(1);
        }
        RunEvent::AdapterFinished { adapter, wall } => bar.suspend(|| {
            say!("{adapter} done in {:.1} s", wall.as_secs_f64());
        }),
    })
}
