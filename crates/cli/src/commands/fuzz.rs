//! `etalon fuzz`.
//!
//! Scenes are made, drawn and judged in batches. Failing scenes are reduced in order, so that the groups do
//! not depend on the number of workers.

use crate::cases::library;
use crate::counted::counted;
use crate::discovery::{discover, refuse_absent};
use crate::expectations::ExpectArguments;
use crate::failure::{Failure, INCOMPLETE, UNEXPECTED};
use crate::failure_groups::{FailingScenes, FailureGroup};
use crate::flags::{AdapterFileArguments, OutputFormat, parse_timeout};
use crate::group_text;
use crate::interruption::listen;
use crate::known_look::known_bugs;
use crate::match_text::why;
use crate::out_folder::Out;
use crate::output::{print_json, say, summarize};
use crate::processors::processors;
use crate::progress::progress;
use crate::provenance;
use crate::reducing::TIMEOUT;
use clap::Args;
use etalon_adapters::Query;
use etalon_case::{Case, Library};
use etalon_diagnose::Match;
use etalon_explore::{Fuzzer, RandomScene, Space};
use etalon_frame::Limits;
use etalon_frame::threads::join;
use etalon_record::{
    AdapterRecord, Expectations, FUZZ_FILE, FolderKind, OutputFolder, Record, Verdict,
};
use etalon_runner::{Batches, Launch, Reducer, Worker};
use indicatif::ProgressBar;
use serde_json::{Value, json};
use std::path::PathBuf;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{Mutex, PoisonError, mpsc};
use std::thread::{self, ScopedJoinHandle};
use std::time::{Duration, Instant};

/// The number of scenes of a batch.
const BATCH: usize = 128;
/// The largest number of batches whose failing scenes wait for their reduction.
const WAITING: usize = 8;
/// The number of scenes per adapter if neither their number nor a time is given.
const COUNT: u64 = 1000;
/// The longest part of `--time` that is kept for comparing failures with findings.
const COMPARING: Duration = Duration::from_secs(120);
/// The largest number of groups that are printed: new ones, and those like one finding.
const MOST_NEW: usize = 20;
const MOST_ALIKE: usize = 3;

#[derive(Debug, Args)]
pub(crate) struct Arguments {
    #[command(flatten)]
    pub(crate) file: AdapterFileArguments,
    /// Draw on this adapter; may be repeated. Default: all adapters found
    #[arg(long = "adapter", value_name = "NAME")]
    pub(crate) adapters: Vec<String>,
    /// Seed of the scenes; the same seed gives the same scenes
    #[arg(long, value_name = "S", default_value_t = 0)]
    pub(crate) seed: u64,
    /// Number of scenes for each adapter [default: 1000, without --time]
    #[arg(long, value_name = "N", conflicts_with = "time", value_parser = clap::value_parser!(u64).range(1..))]
    pub(crate) count: Option<u64>,
    /// Time for each adapter, in seconds or as `10m` or `2h`. If scenes fail, half of it, at most two minutes, is for
    /// confirming them in new processes and comparing them with the findings
    #[arg(long, value_name = "T", value_parser = parse_time)]
    pub(crate) time: Option<Duration>,
    /// Folder for fuzz.jsonl and the failing scenes: new ones in `found`, those of known bugs in `known`;
    /// `--cases` accepts both
    #[arg(long, value_name = "DIR", default_value = "reports/fuzz")]
    pub(crate) out: PathBuf,
    /// Replace the results in the folder
    #[arg(long)]
    pub(crate) force: bool,
    #[command(flatten)]
    pub(crate) expected: ExpectArguments,
    /// Number of workers that draw at the same time. Default: one per processor
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub(crate) jobs: Option<u16>,
    /// Time limit of a scene in seconds
    #[arg(long, value_name = "S", default_value = TIMEOUT, value_parser = parse_timeout)]
    pub(crate) timeout: f64,
    /// Format of the summary
    #[arg(long, value_enum, default_value = "text")]
    pub(crate) format: OutputFormat,
}

/// Parses a time: seconds, or a number with `s`, `m` or `h`.
fn parse_time(text: &str) -> Result<Duration, String> {
    let (number, unit) = match text.strip_suffix(['s', 'm', 'h']) {
        Some(number) => (number, &text[number.len()..]),
        None => (text, "s"),
    };
    let seconds = match unit {
        "m" => 60.0,
        "h" => 3600.0,
        _ => 1.0,
    };
    let number: f64 = number.parse().unwrap_or(f64::NAN);
    if (number * seconds).is_finite() && (1.0..=1e7).contains(&(number * seconds)) {
        Ok(Duration::from_secs_f64(number * seconds))
    } else {
        Err("expected a time of at least a second, such as `90`, `10m` or `2h`".to_owned())
    }
}

/// The results of the scenes of one adapter.
struct SceneTally {
    adapter: String,
    scenes: u64,
    failing: u64,
    not_supported: u64,
    pairs: usize,
    states: usize,
    seconds: f64,
    /// The time in seconds for confirming failures in new processes and for comparing them with findings.
    comparing: f64,
    groups: Vec<FailureGroup>,
}

impl SceneTally {
    /// Returns the groups that no finding explains.
    fn unexplained(&self) -> impl Iterator<Item = &FailureGroup> {
        self.groups.iter().filter(|g| !g.is_explained())
    }
}

/// Draws random scenes and keeps one scene for each way to fail.
pub(crate) fn run(arguments: &Arguments) -> Result<u8, Failure> {
    let expectations = arguments.expected.read(&[])?;
    let library = library(None)?;
    let claim = Out {
        folder: &arguments.out,
        kind: FolderKind::Fuzz,
        latest: None,
        cases: None,
        resume: None,
        force: arguments.force,
    }
    .claim()?;
    let adapters = discover(&Query {
        names: &arguments.adapters,
        file: arguments.file.adapter_file.as_deref(),
        ..Query::default()
    })?;
    refuse_absent(&arguments.adapters, &adapters)?;
    if adapters.ready.is_empty() {
        return Err(Failure::nothing("no adapter can be used"));
    }
    let _lock = claim.take()?;
    // Marks the folder as a fuzz folder before scenes are written into it.
    write(arguments, &[], true)?;
    let search = FuzzSearch {
        arguments,
        expectations: &expectations,
        library: &library,
        stop: listen()?,
        jobs: arguments.jobs.map_or_else(processors, usize::from),
        timeout: Duration::from_secs_f64(arguments.timeout),
    };
    let mut tallies = Vec::new();
    for (launch, worker) in adapters.ready {
        if search.is_stopped() {
            break;
        }
        tallies.push(search.on_adapter(launch, worker)?);
        // Results are written now, so that they survive a failure on the next adapter.
        write(arguments, &tallies, search.is_stopped())?;
    }
    let interrupted = search.is_stopped();
    if tallies.iter().all(|t| t.scenes == 0) && !interrupted {
        return Err(Failure::nothing("no scene can be drawn on these adapters"));
    }
    print(arguments, &tallies, interrupted)?;
    if interrupted {
        say!("interrupted: what was found is kept");
        return Ok(INCOMPLETE);
    }
    Ok(
        if tallies.iter().all(|t| t.unexplained().next().is_none()) {
            0
        } else {
            UNEXPECTED
        },
    )
}

fn print(arguments: &Arguments, tallies: &[SceneTally], interrupted: bool) -> Result<(), Failure> {
    let report = arguments.out.join(FUZZ_FILE);
    match arguments.format {
        OutputFormat::Json => print_json(&json!({
            "interrupted": interrupted,
            "adapters": tallies.iter().map(SceneTally::json).collect::<Vec<_>>(),
            "groups": tallies.iter().flat_map(|t| t.groups.iter().map(group_text::json)).collect::<Vec<_>>(),
            "report": report,
        }))?,
        OutputFormat::Text => {
            for tally in tallies {
                summarize(&tally.text());
            }
            summarize(&format!("Report: {}\n", report.display()));
        }
    }
    Ok(())
}

/// The part of a search that all adapters share.
struct FuzzSearch<'a> {
    arguments: &'a Arguments,
    expectations: &'a Expectations,
    library: &'a Library,
    stop: &'a AtomicBool,
    jobs: usize,
    timeout: Duration,
}

impl FuzzSearch<'_> {
    fn is_stopped(&self) -> bool {
        self.stop.load(Ordering::Relaxed)
    }

    /// Draws the scenes of one adapter, groups the failing ones, and compares the groups with findings.
    fn on_adapter(&self, launch: Launch, worker: Worker) -> Result<SceneTally, Failure> {
        let Some(time) = self.arguments.time else {
            return self.until_stopped(launch, worker, None, self.stop);
        };
        let end = Instant::now() + time;
        let [late, done] = [AtomicBool::new(false), AtomicBool::new(false)];
        thread::scope(|scope| {
            scope.spawn(|| {
                while !done.load(Ordering::Relaxed) && !self.is_stopped() && Instant::now() < end {
                    thread::sleep(Duration::from_millis(20));
                }
                late.store(true, Ordering::Relaxed);
            });
            let limit = TimeLimit {
                end,
                comparing: COMPARING.min(time / 2),
            };
            let tally = self.until_stopped(launch, worker, Some(limit), &late);
            done.store(true, Ordering::Relaxed);
            tally
        })
    }

    /// Does the same until the time is up; reductions end once `stop` is set.
    fn until_stopped(
        &self,
        launch: Launch,
        worker: Worker,
        limit: Option<TimeLimit>,
        stop: &AtomicBool,
    ) -> Result<SceneTally, Failure> {
        let Arguments { seed, out, .. } = self.arguments;
        let adapter = AdapterRecord::from(&worker);
        let limits = &worker.hello.limits;
        let reducer = || Reducer::new(launch.clone(), limits.clone(), self.timeout, stop);
        let out = OutputFolder::open(out).map_err(Failure::usage)?;
        let mut failing = FailingScenes::new(reducer(), &out);
        let bug_reducer = reducer();
        let begun = Instant::now();
        let count = match limit {
            Some(_) => u64::MAX,
            None => self.arguments.count.unwrap_or(COUNT),
        };
        let groups = AtomicUsize::new(0);
        let mut maker = SceneMaker {
            fuzzer: Fuzzer::new(*seed, Space::of([limits])),
            limits: limits.clone(),
            left: count,
            limit,
            groups: &groups,
        };
        let bar = progress(if count == u64::MAX { 0 } else { count });
        bar.set_message(launch.adapter.clone());
        let mut tally = SceneTally::new(&launch.adapter);
        let batches = Batches::new(launch, worker, self.jobs, self.timeout);
        self.draw(batches, &mut maker, &mut failing, &mut tally, &bar)?;
        tally.seconds = begun.elapsed().as_secs_f64();
        if failing.groups() > 0 && !self.is_stopped() {
            bar.set_message(format!("{}: comparing with findings", tally.adapter));
            self.compare(&mut failing, &adapter, bug_reducer);
            tally.comparing = begun.elapsed().as_secs_f64() - tally.seconds;
            if stop.load(Ordering::Relaxed) && !self.is_stopped() {
                say!(
                    "{}: the time ended before all failures were compared with the findings, so known bugs can be \
                     among the new ones; a longer --time compares all",
                    tally.adapter
                );
            }
        }
        bar.finish_and_clear();
        tally.groups = failing.finish();
        Ok(tally)
    }

    /// Draws scenes in batches until the maker returns an empty batch.
    fn draw(
        &self,
        mut batches: Batches,
        maker: &mut SceneMaker<'_>,
        failing: &mut FailingScenes<'_>,
        tally: &mut SceneTally,
        bar: &ProgressBar,
    ) -> Result<(), Failure> {
        let groups = maker.groups;
        let (sender, receiver) = mpsc::sync_channel::<Vec<(RandomScene, Record)>>(WAITING);
        let mut next = maker.batch();
        thread::scope(|scope| {
            // Failing scenes are reduced in order, one after another, while other scenes are drawn.
            let added = thread::Builder::new().spawn_scoped(scope, || {
                for scenes in receiver {
                    failing.add(scenes)?;
                    groups.store(failing.groups(), Ordering::Relaxed);
                }
                Ok::<_, Failure>(())
            });
            let added =
                added.map_err(|e| Failure::incomplete(format!("cannot start a thread: {e}")))?;
            let mut drawn = Ok(());
            while !next.is_empty() && !self.is_stopped() {
                let scenes = std::mem::take(&mut next);
                let cases: Vec<&Case> = scenes.iter().map(|s| &s.candidate.case).collect();
                (tally.pairs, tally.states) = (maker.fuzzer.pairs(), maker.fuzzer.states());
                // The next scenes are made while these are drawn.
                let maker = Mutex::new(&mut *maker);
                let make = || {
                    let mut maker = maker.lock().unwrap_or_else(PoisonError::into_inner);
                    maker.batch()
                };
                let (made, records) = join(make, || batches.draw(&cases, self.stop));
                next = made;
                let records = match records {
                    Ok(records) => records,
                    Err(error) => {
                        drawn = Err(Failure::incomplete(error));
                        break;
                    }
                };
                // Fails if the other thread ended with an error; `joined` returns that error.
                if sender.send(tally.count(scenes, records, bar)).is_err() {
                    break;
                }
                let count = groups.load(Ordering::Relaxed);
                bar.set_message(format!("{}: {count} groups", tally.adapter));
            }
            drop(sender);
            joined(added).and(drawn)
        })
    }

    /// Compares groups with the findings about an adapter.
    fn compare(
        &self,
        failing: &mut FailingScenes<'_>,
        adapter: &AdapterRecord,
        reducer: Reducer<'_>,
    ) {
        let name = reducer.launch.adapter.clone();
        failing.confirm(self.jobs);
        let bugs = known_bugs(self.expectations, adapter, self.library, reducer);
        if let Err(failure) = bugs.and_then(|mut bugs| failing.compare(&mut bugs)) {
            say!(
                "{name}: not all groups were compared with findings: {}",
                failure.message
            );
        }
    }
}

/// The limit of `--time`.
#[derive(Clone, Copy)]
struct TimeLimit {
    end: Instant,
    /// The part for comparing failures with findings.
    comparing: Duration,
}

/// Makes the scenes of an adapter.
struct SceneMaker<'a> {
    fuzzer: Fuzzer,
    limits: Limits,
    /// The number of scenes still to make.
    left: u64,
    limit: Option<TimeLimit>,
    /// The number of groups of failing scenes so far.
    groups: &'a AtomicUsize,
}

impl SceneMaker<'_> {
    /// Makes the scenes of a batch; an empty one at the end.
    fn batch(&mut self) -> Vec<RandomScene> {
        if let Some(limit) = self.limit {
            let fails = self.groups.load(Ordering::Relaxed) > 0;
            let reserved = if fails {
                limit.comparing
            } else {
                Duration::ZERO
            };
            if Instant::now() + reserved >= limit.end {
                return Vec::new();
            }
        }
        let can_draw = |case: &Case| self.limits.missing(&case.requirements()).is_none();
        let count = (BATCH as u64).min(self.left);
        self.left -= count;
        let made = (0..count).filter_map(|_| self.fuzzer.scene(&can_draw));
        made.collect()
    }
}

/// Returns the result of a thread, or resumes its panic.
fn joined<T>(thread: ScopedJoinHandle<'_, T>) -> T {
    match thread.join() {
        Ok(result) => result,
        Err(panic) => std::panic::resume_unwind(panic),
    }
}

/// Writes a line about the search, a line about each adapter, then the groups.
fn write(arguments: &Arguments, tallies: &[SceneTally], interrupted: bool) -> Result<(), Failure> {
    let origin = provenance::here();
    let mut lines = vec![json!({
        "fuzz": 1,
        "etalon": origin.etalon,
        "commit": origin.commit,
        "machine": origin.machine,
        "command": origin.command,
        "seed": arguments.seed,
        "interrupted": interrupted,
    })];
    lines.extend(tallies.iter().map(SceneTally::json));
    lines.extend(
        tallies
            .iter()
            .flat_map(|t| t.groups.iter().map(group_text::json)),
    );
    let text: String = lines.iter().map(|line| format!("{line}\n")).collect();
    OutputFolder::open(&arguments.out)
        .and_then(|out| out.write(FUZZ_FILE, text.as_bytes()))
        .map_err(Failure::incomplete)?;
    Ok(())
}

impl SceneTally {
    fn new(adapter: &str) -> Self {
        Self {
            adapter: adapter.to_owned(),
            scenes: 0,
            failing: 0,
            not_supported: 0,
            pairs: 0,
            states: 0,
            seconds: 0.0,
            comparing: 0.0,
            groups: Vec::new(),
        }
    }

    /// Counts the scenes of a batch. Returns the failing scenes.
    fn count(
        &mut self,
        scenes: Vec<RandomScene>,
        records: Vec<Option<Record>>,
        bar: &ProgressBar,
    ) -> Vec<(RandomScene, Record)> {
        let mut failing = Vec::new();
        for (scene, record) in scenes.into_iter().zip(records) {
            let Some(record) = record else { continue };
            self.scenes += 1;
            bar.inc(1);
            if record.verdict == Verdict::NotSupported {
                self.not_supported += 1;
            } else if record.verdict.is_bad() && record.verdict != Verdict::Open {
                self.failing += 1;
                failing.push((scene, record));
            }
        }
        failing
    }

    fn json(&self) -> Value {
        let [new, alike, known] = self.counts();
        json!({
            "adapter": self.adapter,
            "scenes": self.scenes,
            "failing": self.failing,
            "not_supported": self.not_supported,
            "groups": self.groups.len(),
            "new": new,
            "alike": alike,
            "known": known,
            "states": self.states,
            "pairs": self.pairs,
            "seconds": self.seconds,
            "comparing": self.comparing,
        })
    }

    /// Returns the numbers of groups that are new, that resemble a finding, and that a finding explains.
    fn counts(&self) -> [usize; 3] {
        let alike = |g: &&FailureGroup| g.known.is_some();
        let unexplained = self.unexplained().count();
        let alike = self.unexplained().filter(alike).count();
        [unexplained - alike, alike, self.groups.len() - unexplained]
    }

    fn text(&self) -> String {
        let [new, alike, known] = self.counts();
        let mut text = format!(
            "{}: {} scenes in {:.1} s ({:.0} a second), {} fail, in {} groups ({new} new, {alike} like a finding, {known} known); {} states and {} pairs of states covered\n",
            self.adapter,
            self.scenes,
            self.seconds,
            self.scenes as f64 / self.seconds.max(1e-3),
            self.failing,
            self.groups.len(),
            self.states,
            self.pairs
        );
        let new = self.groups.iter().filter(|g| g.known.is_none());
        let new: Vec<&FailureGroup> = new.collect();
        let (shown, left) = new.split_at(new.len().min(MOST_NEW));
        text.extend(shown.iter().map(|group| group_text::text(group)));
        if !left.is_empty() {
            text.push_str(&format!("\n  {}\n", others(left)));
        }
        for (known, groups) in self.by_finding(false) {
            text.push_str(&headed("looks like", known, &groups));
            let (shown, left) = groups.split_at(groups.len().min(MOST_ALIKE));
            text.extend(shown.iter().map(|group| group_text::short(group)));
            if !left.is_empty() {
                text.push_str(&format!("    {}\n", others(left)));
            }
        }
        for (known, groups) in self.by_finding(true) {
            text.push_str(&headed("known", known, &groups));
            text.push_str(&format!("    {}\n", why(known)));
        }
        text
    }

    /// Returns the findings that explain or resemble groups, each with its groups. Findings with the most
    /// scenes come first.
    fn by_finding(&self, explained: bool) -> Vec<(&Match, Vec<&FailureGroup>)> {
        let mut matches: Vec<(&Match, Vec<&FailureGroup>)> = Vec::new();
        for group in &self.groups {
            let Some(known) = group.known.as_ref().filter(|k| k.is_exact() == explained) else {
                continue;
            };
            match matches.iter_mut().find(|(k, _)| k.finding == known.finding) {
                Some((_, groups)) => groups.push(group),
                None => matches.push((known, vec![group])),
            }
        }
        matches.sort_by_key(|(_, groups)| std::cmp::Reverse(scenes(groups)));
        matches
    }
}

/// Returns the line about groups that are not printed.
fn others(groups: &[&FailureGroup]) -> String {
    format!(
        "and {} of {}, in {FUZZ_FILE}",
        counted(groups.len() as u64, "more group"),
        counted(scenes(groups), "scene")
    )
}

/// Returns the number of scenes in groups.
fn scenes(groups: &[&FailureGroup]) -> u64 {
    groups.iter().map(|g| g.count).sum()
}

/// Returns the heading of a finding's groups.
fn headed(word: &str, known: &Match, groups: &[&FailureGroup]) -> String {
    format!(
        "\n  {word}: {}: {}: {} in {}\n",
        known.finding,
        known.title,
        counted(scenes(groups), "scene"),
        counted(groups.len() as u64, "group"),
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn times_have_a_unit_or_are_seconds() {
        for (text, seconds) in [("90", 90), ("90s", 90), ("10m", 600), ("2h", 7200)] {
            assert_eq!(parse_time(text), Ok(Duration::from_secs(seconds)));
        }
        for text in ["", "m", "0", "-1", "1d", "1e9h", "nan"] {
            assert!(parse_time(text).is_err(), "{text}");
        }
    }
}
