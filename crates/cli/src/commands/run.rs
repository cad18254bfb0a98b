//! `etalon run`.

use crate::adapters::{Adapters, BackendName, Wanted, cache, discover};
use crate::args::{CacheState, Format, RunArguments};
use crate::commands::expectations::{bless, to_bless};
use crate::commands::{chosen, is_measuring, refuse_absent};
use crate::failure::{Failure, IMPROVED, INCOMPLETE, UNEXPECTED};
use crate::output::{print, print_json, table_options};
use crate::shard;
use etalon_case::Case;
use etalon_frame::{Api, Limits};
use etalon_record::{
    AbsentAdapter, AdapterRecord, Expectations, FolderKind, FolderLock, Header, Machine,
    RecordError, ReportFiles, Run, Settings, ShaderCache, Shard, selection_digest, shard_of,
};
use etalon_report::quoted;
use etalon_runner::{Event, Options, Plan, RunError, RunSummary};
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use serde_json::json;
use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, SystemTime};

/// The reports that a run replaces with the run.
pub(crate) const RUN_REPORTS: ReportFiles = ReportFiles {
    files: &etalon_report::RUN_FILES,
    folders: &etalon_report::RUN_FOLDERS,
};
/// The folder that each run without `--out` replaces.
const LATEST: &str = "reports/latest";

/// Draws the chosen cases on the chosen adapters, judges, records and reports.
pub(crate) fn run(arguments: &RunArguments) -> Result<u8, Failure> {
    let mut cases = chosen(&arguments.selection)?;
    if arguments.selection.globs.is_empty() {
        // A folder that holds nothing else means them.
        let measuring_alone = cases.iter().all(is_measuring);
        cases.retain(|case| measuring_alone || !is_measuring(case));
    }
    let selection: Vec<String> = cases.iter().map(|case| case.id.clone()).collect();
    let shard = shard(arguments)?;
    if let Some(shard) = shard {
        cases.retain(|case| shard_of(&case.id, shard.count) == shard.index);
        eprintln!(
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
        // What is to be written need not be there yet.
        Some(path) if !path.exists() => Expectations::default(),
        Some(path) => Expectations::read(path).map_err(Failure::usage)?,
        None => expectations(arguments.expect.as_deref())?,
    }
    .on(&today());
    // Nothing may be lost that another run, or one before, has written.
    let lock = || FolderLock::acquire(&arguments.out).map_err(Failure::usage);
    let early = arguments.out.exists().then(lock).transpose()?;
    let resume = resumes(arguments)?;
    let stop = interrupts()?;
    let mut adapters = discover(&Wanted {
        names: &arguments.adapters,
        file: arguments.file.adapter_file.as_deref(),
        validate: arguments.validate,
        cold: arguments.shader_cache == CacheState::Cold,
    })?;
    // A driver that is there and does not start has its records like any other.
    let dead = dead(&mut adapters);
    for (adapter, how) in &dead {
        eprintln!("{} does not start: {how}", adapter.name);
    }
    refuse_absent(&arguments.adapters, &adapters.absent)?;
    // A folder is not made before it is clear that there is something to put into it.
    let _lock = early.map_or_else(lock, Ok)?;
    let header = header(arguments, &cases, &selection, shard, &adapters, &dead);
    let names: Vec<String> = header.adapters.iter().map(|a| a.name.clone()).collect();
    let plan = Plan {
        cases: &cases,
        selection: Some(&selection),
        adapters: adapters.ready,
        dead,
        options: Options {
            jobs: arguments.jobs.map_or_else(processors, usize::from),
            timeout: Duration::from_secs_f64(arguments.timeout),
            memory: Some(arguments.memory),
            repeat: arguments.repeat,
            look_again: true,
        },
        expectations: &expectations,
        folder: &arguments.out,
        reports: RUN_REPORTS,
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
    let written = etalon_report::write(&arguments.out).map_err(Failure::incomplete)?;
    let run = Run::read(&arguments.out).map_err(Failure::incomplete)?;
    if arguments.format == Format::Json {
        print_json(&json!({
            "records": outcome.records,
            "missing": run.missing(),
            "unexpected": outcome.unexpected,
            "improvements": outcome.improvements,
            "interrupted": outcome.interrupted,
            "adapters": names,
            "folder": arguments.out,
            "report": written.html,
        }))?;
    } else {
        print(&etalon_report::table(&run, table_options()))?;
        print(&format!("\nReport: {}\n", written.html.display()))?;
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
    if let Some(path) = &blessed {
        let all_adapters = arguments.adapters.is_empty();
        let cases = arguments.selection.cases.as_ref();
        bless(path, &run, &expectations, cases, all_adapters)?;
        return Ok(0);
    }
    Ok(match outcome {
        RunSummary {
            unexpected: 1.., ..
        } => UNEXPECTED,
        RunSummary {
            improvements: 1.., ..
        } => IMPROVED,
        _ => 0,
    })
}

/// The part of the cases that the flag or the environment asks for.
fn shard(arguments: &RunArguments) -> Result<Option<Shard>, Failure> {
    if let Some(shard) = arguments.shard {
        return Ok((shard.count > 1).then_some(shard));
    }
    let asked = shard::asked(|name| std::env::var(name).ok())?;
    if let Some(path) = asked.status_file {
        // Bazel wants to see that the process knows of shards.
        fs::write(&path, "").map_err(|e| {
            Failure::usage(format!(
                "cannot write {}, which TEST_SHARD_STATUS_FILE names: {e}",
                path.display()
            ))
        })?;
    }
    Ok(asked.shard)
}

/// Fisher and Yates' shuffle.
fn shuffle(cases: &mut [Case], seed: u64) {
    let mut random = oorandom::Rand64::new(u128::from(seed));
    for last in (1..cases.len()).rev() {
        let other = random.rand_range(0..last as u64 + 1);
        cases.swap(last, other as usize);
    }
}

/// Whether to go on with the run in the folder; refuses to replace one without being told.
fn resumes(arguments: &RunArguments) -> Result<bool, Failure> {
    let folder = &arguments.out;
    if FolderKind::of(folder) != Some(FolderKind::Run) {
        return Ok(false);
    }
    let replaced = arguments.force || folder == Path::new(LATEST);
    if arguments.resume || replaced {
        return Ok(arguments.resume);
    }
    let run = Run::read(folder).map_err(|e| {
        Failure::usage(format!(
            "{e}; or replace the run in {} by --force",
            folder.display()
        ))
    })?;
    Err(Failure::usage(RecordError::Occupied {
        path: folder.clone(),
        records: run.records.len() as u64,
        expected: run.header.expected_records(),
    }))
}

/// The command that goes on with this run.
fn how_to_resume() -> String {
    let own = std::env::args()
        .skip(1)
        .filter(|a| a != "--force" && a != "--resume");
    let words = std::iter::once("etalon".to_owned())
        .chain(own)
        .chain(["--resume".to_owned()]);
    let quoted: Vec<String> = words.map(|w| quoted(&w)).collect();
    format!("go on with: {}", quoted.join(" "))
}

/// Set at the first Ctrl-C, or when the process is asked to terminate; a second one ends it at once.
fn interrupts() -> Result<&'static AtomicBool, Failure> {
    static STOP: AtomicBool = AtomicBool::new(false);
    ctrlc::set_handler(|| {
        if STOP.swap(true, Ordering::Relaxed) {
            std::process::exit(i32::from(INCOMPLETE));
        }
        eprintln!("\nstopping; once more to stop at once");
    })
    .map_err(|e| Failure::incomplete(format!("cannot listen for interrupts: {e}")))?;
    Ok(&STOP)
}

fn processors() -> usize {
    std::thread::available_parallelism().map_or(1, usize::from)
}

/// The day, in UTC, as `2027-01-31`.
pub(crate) fn today() -> String {
    let now = humantime::format_rfc3339_seconds(SystemTime::now()).to_string();
    now.chars().take(10).collect()
}

fn header(
    arguments: &RunArguments,
    cases: &[Case],
    selection: &[String],
    shard: Option<Shard>,
    adapters: &Adapters,
    dead: &[(AdapterRecord, String)],
) -> Header {
    Header {
        format: etalon_record::FORMAT,
        etalon: env!("CARGO_PKG_VERSION").to_owned(),
        commit: option_env!("ETALON_COMMIT").map(str::to_owned),
        machine: machine(),
        started: humantime::format_rfc3339_seconds(SystemTime::now()).to_string(),
        command: std::iter::once("etalon".to_owned())
            .chain(std::env::args().skip(1))
            .collect(),
        cases: cases.len() as u64,
        settings: Settings {
            selection: selection_digest(selection.iter().map(String::as_str)),
            shard,
            shuffle: arguments.shuffle,
            repeat: (arguments.repeat > 1).then_some(arguments.repeat),
            shader_cache: Some(
                match arguments.shader_cache == CacheState::Cold || cache::is_off() {
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

/// The adapters whose drivers do not start, as far as they are known, and how that showed; they are absent
/// no longer.
fn dead(adapters: &mut Adapters) -> Vec<(AdapterRecord, String)> {
    let record = |(backend, absent): (BackendName, AbsentAdapter)| {
        let (backend, api) = match backend {
            BackendName::Cpu => ("cpu", Api::Vulkan),
            BackendName::Vulkan => ("vulkan", Api::Vulkan),
            BackendName::Gl => ("gl", Api::OpenGl),
            BackendName::GlEs => ("gl", Api::OpenGlEs),
            BackendName::WgpuVulkan | BackendName::WgpuGl => ("wgpu", Api::WebGpu),
        };
        let adapter = AdapterRecord {
            name: absent.name,
            backend: backend.to_owned(),
            device: String::new(),
            driver: String::new(),
            driver_version: String::new(),
            driver_id: String::new(),
            api_version: String::new(),
            software: false,
            limits: Limits {
                api,
                sub_pixel_bits: 0,
                max_size: 0,
                max_color_attachments: 0,
                formats: BTreeMap::new(),
                features: BTreeSet::new(),
                sample_positions: BTreeMap::new(),
            },
        };
        (adapter, absent.reason)
    };
    let dead: Vec<(AdapterRecord, String)> = adapters.dead.drain(..).map(record).collect();
    let is_dead = |name: &str| dead.iter().any(|(adapter, _)| adapter.name == name);
    adapters.absent.retain(|absent| !is_dead(&absent.name));
    dead
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

fn execute(plan: Plan<'_>, bar: &ProgressBar) -> Result<RunSummary, RunError> {
    let before = if plan.resume {
        Run::read(plan.folder).map_or(0, |run| run.records.len() as u64)
    } else {
        0
    };
    bar.inc(before);
    bar.reset_eta();
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
