//! `etalon fuzz`.
//!
//! Scenes are made, drawn and judged in batches. What fails is looked at in the order of the scenes, so that the groups do
//! not depend on the number of workers.

use crate::adapters::{Query, discover, refuse_absent};
use crate::cases::library;
use crate::counted::counted;
use crate::expectations::{self, today};
use crate::failure::{Failure, INCOMPLETE, UNEXPECTED};
use crate::failure_groups::{Folders, Group, Groups};
use crate::flags::{AdapterFileArguments, Format, parse_timeout};
use crate::interruption::listen;
use crate::known_bugs::{KnownBugs, Match};
use crate::output::{say, summarize, summarize_json};
use crate::processors::processors;
use crate::progress::progress;
use crate::provenance;
use crate::reduction::TIMEOUT;
use clap::Args;
use etalon_case::{Case, Library};
use etalon_explore::{Fuzzer, RandomScene, Space};
use etalon_frame::Limits;
use etalon_record::{AdapterRecord, Expectations, FolderLock, Record, Verdict};
use etalon_runner::{Batches, Launch, Worker};
use serde_json::{Value, json};
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::mpsc;
use std::thread::{self, ScopedJoinHandle};
use std::time::{Duration, Instant};

/// The scenes of a batch.
const BATCH: usize = 128;
/// The most batches whose failing scenes wait to be reduced.
const WAITING: usize = 8;
/// The scenes of each adapter where neither their number nor a time is given.
const COUNT: u64 = 1000;
/// The file of groups.
const GROUPS: &str = "fuzz.jsonl";
/// The most groups that the terminal tells: new ones, and those like one finding.
const MOST_NEW: usize = 20;
const MOST_ALIKE: usize = 3;
/// The folder of the scenes that fail.
const FOUND: &str = "found";
/// The folder of those that a finding explains.
const KNOWN: &str = "known";

#[derive(Debug, Args)]
pub(crate) struct Arguments {
    #[command(flatten)]
    pub(crate) file: AdapterFileArguments,
    /// Adapter to draw on; may be repeated. Default: all that can be used
    #[arg(long = "adapter", value_name = "NAME")]
    pub(crate) adapters: Vec<String>,
    /// Seed of the scenes; the same seed gives the same scenes
    #[arg(long, value_name = "S", default_value_t = 0)]
    pub(crate) seed: u64,
    /// Number of scenes for each adapter [default: 1000, without --time]
    #[arg(long, value_name = "N", conflicts_with = "time")]
    pub(crate) count: Option<u64>,
    /// Time for each adapter, in seconds or as `10m` or `2h`; drawing what was found in processes of its own and comparing
    /// it with the findings comes on top
    #[arg(long, value_name = "T", value_parser = parse_time)]
    pub(crate) time: Option<Duration>,
    /// Folder for fuzz.jsonl and the scenes that fail, in `found`, those of known bugs in `known`; `--cases` takes both
    #[arg(long, value_name = "DIR", default_value = "reports/fuzz")]
    pub(crate) out: PathBuf,
    /// Replace the results in the folder
    #[arg(long)]
    pub(crate) force: bool,
    /// Compare with these expectations instead of the built-in findings: a list, a finding, or a folder of findings
    #[arg(long, value_name = "PATH")]
    pub(crate) expect: Option<PathBuf>,
    /// Number of workers that draw at the same time. Default: one per processor
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub(crate) jobs: Option<u16>,
    /// Seconds that a scene may take
    #[arg(long, value_name = "S", default_value = TIMEOUT, value_parser = parse_timeout)]
    pub(crate) timeout: f64,
    /// Form of the summary
    #[arg(long, value_enum, default_value = "text")]
    pub(crate) format: Format,
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
    match (number * seconds).is_finite() && (1.0..=1e7).contains(&(number * seconds)) {
        true => Ok(Duration::from_secs_f64(number * seconds)),
        false => Err("expected a time from a second on, such as `90`, `10m` or `2h`".to_owned()),
    }
}

/// The scenes of one adapter.
struct Tally {
    adapter: String,
    scenes: u64,
    failing: u64,
    not_supported: u64,
    pairs: usize,
    states: usize,
    seconds: f64,
    /// The time of the drawings in processes of their own and of the comparison with findings, in seconds.
    comparing: f64,
    groups: Vec<Group>,
}

impl Tally {
    /// The groups that no finding explains.
    fn unexplained(&self) -> impl Iterator<Item = &Group> {
        let explained = |g: &&Group| g.known().is_some_and(Match::is_exact);
        self.groups.iter().filter(move |g| !explained(g))
    }
}

/// Draws random scenes and keeps one of each way to fail.
pub(crate) fn run(arguments: &Arguments) -> Result<u8, Failure> {
    let expectations = expectations::read(arguments.expect.as_deref())?.on(&today());
    let library = library(None)?;
    fs::create_dir_all(&arguments.out)
        .map_err(|e| Failure::usage(format!("cannot make {}: {e}", arguments.out.display())))?;
    let _lock = FolderLock::acquire(&arguments.out).map_err(Failure::usage)?;
    free(arguments)?;
    let adapters = discover(&Query {
        names: &arguments.adapters,
        file: arguments.file.adapter_file.as_deref(),
        ..Query::default()
    })?;
    refuse_absent(&arguments.adapters, &adapters.absent)?;
    if adapters.ready.is_empty() {
        return Err(Failure::nothing("no adapter can be used"));
    }
    let stop = listen()?;
    let mut all = Vec::new();
    for (launch, worker) in adapters.ready {
        if stop.load(Ordering::Relaxed) {
            break;
        }
        all.push(fuzz(
            arguments,
            launch,
            worker,
            &expectations,
            &library,
            stop,
        )?);
        // What was found is kept, whatever happens to the next adapter.
        write(arguments, &all, stop)?;
    }
    let interrupted = stop.load(Ordering::Relaxed);
    if all.iter().all(|t| t.scenes == 0) && !interrupted {
        return Err(Failure::nothing("no scene can be drawn on these adapters"));
    }
    match arguments.format {
        Format::Json => summarize_json(&json!({
            "interrupted": interrupted,
            "adapters": all.iter().map(Tally::json).collect::<Vec<_>>(),
            "groups": all.iter().flat_map(|t| t.groups.iter().map(Group::json)).collect::<Vec<_>>(),
            "report": arguments.out.join(GROUPS),
        }))?,
        Format::Text => {
            for tally in &all {
                summarize(&tally.text());
            }
            let path = arguments.out.join(GROUPS);
            summarize(&format!("Report: {}\n", path.display()));
        }
    }
    if interrupted {
        say!("interrupted: what was found is kept");
        return Ok(INCOMPLETE);
    }
    Ok(match all.iter().all(|t| t.unexplained().next().is_none()) {
        true => 0,
        false => UNEXPECTED,
    })
}

/// Refuses to replace what a folder holds without `--force`, with which it is removed.
fn free(arguments: &Arguments) -> Result<(), Failure> {
    let file = arguments.out.join(GROUPS);
    let folders = [FOUND, KNOWN].map(|name| arguments.out.join(name));
    if !file.exists() && !folders.iter().any(|f| f.exists()) {
        return Ok(());
    }
    if !arguments.force {
        return Err(Failure::usage(format!(
            "{} holds the results of an earlier search; replace them with --force, or choose another folder with --out",
            arguments.out.display()
        )));
    }
    let failed = |path: &Path| {
        let path = path.display().to_string();
        move |e| Failure::incomplete(format!("cannot remove {path}: {e}"))
    };
    if file.exists() {
        fs::remove_file(&file).map_err(failed(&file))?;
    }
    for folder in folders.iter().filter(|f| f.exists()) {
        fs::remove_dir_all(folder).map_err(failed(folder))?;
    }
    Ok(())
}

/// Draws the scenes of one adapter.
fn fuzz(
    arguments: &Arguments,
    launch: Launch,
    worker: Worker,
    expectations: &Expectations,
    library: &Library,
    stop: &AtomicBool,
) -> Result<Tally, Failure> {
    let adapter = AdapterRecord::from(&worker);
    let name = launch.adapter.clone();
    let limits = worker.hello.limits.clone();
    let jobs = arguments.jobs.map_or_else(processors, usize::from);
    let count = match arguments.time {
        Some(_) => u64::MAX,
        None => arguments.count.unwrap_or(COUNT),
    };
    let begun = Instant::now();
    let mut fuzzer = Fuzzer::new(arguments.seed, Space::of([&limits]));
    let timeout = Duration::from_secs_f64(arguments.timeout);
    let mut batches = Batches::new(launch.clone(), worker, jobs, timeout);
    let folders = Folders {
        found: arguments.out.join(FOUND),
        known: arguments.out.join(KNOWN),
    };
    let mut groups = Groups::new(launch.clone(), limits.clone(), folders, timeout);
    let bar = progress(if count == u64::MAX { 0 } else { count });
    bar.set_message(name.clone());
    let mut tally = Tally {
        adapter: name,
        scenes: 0,
        failing: 0,
        not_supported: 0,
        pairs: 0,
        states: 0,
        seconds: 0.0,
        comparing: 0.0,
        groups: Vec::new(),
    };
    let mut left = count;
    let mut next = make(&mut fuzzer, &limits, &mut left);
    let found = AtomicUsize::new(0);
    let (failing, received) = mpsc::sync_channel::<Vec<(RandomScene, Record)>>(WAITING);
    thread::scope(|scope| {
        // What failed is reduced one after the other, in the order of the scenes, while others are drawn.
        let added = scope.spawn(|| {
            for scenes in received {
                groups.add(scenes, stop)?;
                found.store(groups.len(), Ordering::Relaxed);
            }
            Ok::<_, Failure>(())
        });
        let mut drawn = Ok(());
        while !next.is_empty() && !stop.load(Ordering::Relaxed) {
            let scenes = std::mem::take(&mut next);
            let cases: Vec<&Case> = scenes.iter().map(|s| &s.candidate.case).collect();
            let late = arguments.time.is_some_and(|t| begun.elapsed() >= t);
            (tally.pairs, tally.states) = (fuzzer.pairs(), fuzzer.states());
            // While these are drawn, the next scenes are made.
            let records = thread::scope(|scope| {
                let made = scope.spawn(|| match late {
                    true => Vec::new(),
                    false => make(&mut fuzzer, &limits, &mut left),
                });
                let records = batches.draw(&cases, stop);
                next = joined(made);
                records
            });
            let records = match records {
                Ok(records) => records,
                Err(error) => {
                    drawn = Err(Failure::incomplete(error));
                    break;
                }
            };
            let mut bad = Vec::new();
            for (scene, record) in scenes.into_iter().zip(records) {
                let Some(record) = record else { continue };
                tally.scenes += 1;
                bar.inc(1);
                if record.verdict == Verdict::NotSupported {
                    tally.not_supported += 1;
                } else if record.verdict.is_bad() && record.verdict != Verdict::Open {
                    tally.failing += 1;
                    bad.push((scene, record));
                }
            }
            // Fails where the other thread ended with an error, which it returns.
            if failing.send(bad).is_err() {
                break;
            }
            let count = found.load(Ordering::Relaxed);
            bar.set_message(format!("{}: {count} groups", tally.adapter));
        }
        drop(failing);
        joined(added).and(drawn)
    })?;
    tally.seconds = begun.elapsed().as_secs_f64();
    if groups.len() > 0 && !stop.load(Ordering::Relaxed) {
        bar.set_message(format!("{}: comparing with findings", tally.adapter));
        groups.confirm(jobs, stop);
        let mut bugs = KnownBugs::new(expectations, &adapter, library, launch, timeout, stop);
        let compared = groups.compare(&mut bugs);
        if let Err(failure) = compared {
            say!(
                "{}: not all groups were compared with findings: {}",
                tally.adapter,
                failure.message
            );
        }
        tally.comparing = begun.elapsed().as_secs_f64() - tally.seconds;
    }
    bar.finish_and_clear();
    tally.groups = groups.finish();
    Ok(tally)
}

/// Returns the result of a thread, or passes its panic on.
fn joined<T>(thread: ScopedJoinHandle<'_, T>) -> T {
    match thread.join() {
        Ok(result) => result,
        Err(panic) => std::panic::resume_unwind(panic),
    }
}

/// Makes the scenes of a batch.
fn make(fuzzer: &mut Fuzzer, limits: &Limits, left: &mut u64) -> Vec<RandomScene> {
    let can_draw = |case: &Case| limits.missing(&case.requirements()).is_none();
    let count = (BATCH as u64).min(*left);
    *left -= count;
    let made = (0..count).filter_map(|_| fuzzer.scene(&can_draw));
    made.collect()
}

/// Writes the groups, behind a line about the search and one about each adapter.
fn write(arguments: &Arguments, all: &[Tally], stop: &AtomicBool) -> Result<(), Failure> {
    let mut lines = vec![json!({
        "fuzz": 1,
        "etalon": provenance::VERSION,
        "commit": provenance::commit(),
        "machine": provenance::machine(),
        "command": provenance::command(),
        "seed": arguments.seed,
        "interrupted": stop.load(Ordering::Relaxed),
    })];
    lines.extend(all.iter().map(Tally::json));
    lines.extend(all.iter().flat_map(|t| t.groups.iter().map(Group::json)));
    let text: String = lines.iter().map(|line| format!("{line}\n")).collect();
    let path = arguments.out.join(GROUPS);
    fs::write(&path, text)
        .map_err(|e| Failure::incomplete(format!("cannot write {}: {e}", path.display())))
}

impl Tally {
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

    /// Returns the numbers of groups that are new, that look like a finding, and that a finding explains.
    fn counts(&self) -> [usize; 3] {
        let alike = |g: &&Group| g.known().is_some();
        let unexplained = self.unexplained().count();
        let alike = self.unexplained().filter(alike).count();
        [unexplained - alike, alike, self.groups.len() - unexplained]
    }

    fn text(&self) -> String {
        let [new, alike, known] = self.counts();
        let mut text = format!(
            "{}: {} scenes in {:.1} s ({:.0} a second), {} fail, in {} groups ({new} new, {alike} like a finding, {known} known); {} states and {} pairs of them met\n",
            self.adapter,
            self.scenes,
            self.seconds,
            self.scenes as f64 / self.seconds.max(1e-3),
            self.failing,
            self.groups.len(),
            self.states,
            self.pairs
        );
        let new = self.groups.iter().filter(|g| g.known().is_none());
        let new: Vec<&Group> = new.collect();
        let (shown, rest) = new.split_at(new.len().min(MOST_NEW));
        text.extend(shown.iter().map(|group| group.text()));
        if !rest.is_empty() {
            text.push_str(&format!("\n  {}\n", others(rest)));
        }
        for (known, groups) in self.by_finding(false) {
            text.push_str(&headed("looks like", known, &groups));
            let (shown, rest) = groups.split_at(groups.len().min(MOST_ALIKE));
            text.extend(shown.iter().map(|group| group.short()));
            if !rest.is_empty() {
                text.push_str(&format!("    {}\n", others(rest)));
            }
        }
        for (known, groups) in self.by_finding(true) {
            text.push_str(&headed("known", known, &groups));
            text.push_str(&format!("    {}\n", known.why()));
        }
        text
    }

    /// Returns the groups of each finding, which explains them or not, those of most scenes first.
    fn by_finding(&self, explained: bool) -> Vec<(&Match, Vec<&Group>)> {
        let mut all: Vec<(&Match, Vec<&Group>)> = Vec::new();
        for group in &self.groups {
            let Some(known) = group.known().filter(|k| k.is_exact() == explained) else {
                continue;
            };
            match all.iter_mut().find(|(k, _)| k.finding == known.finding) {
                Some((_, groups)) => groups.push(group),
                None => all.push((known, vec![group])),
            }
        }
        all.sort_by_key(|(_, groups)| std::cmp::Reverse(scenes(groups)));
        all
    }
}

/// Returns the line on groups that are not told.
fn others(groups: &[&Group]) -> String {
    format!(
        "and {} of {}, in {GROUPS}",
        counted(groups.len() as u64, "more group"),
        counted(scenes(groups), "scene")
    )
}

/// Returns the number of scenes in groups.
fn scenes(groups: &[&Group]) -> u64 {
    groups.iter().map(|g| g.count()).sum()
}

/// Returns the line on the groups of a finding.
fn headed(word: &str, known: &Match, groups: &[&Group]) -> String {
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
