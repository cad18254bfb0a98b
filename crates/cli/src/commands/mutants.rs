//! `etalon mutants`.

use crate::cases::{build, library};
use crate::failure::{Failure, UNEXPECTED};
use crate::flags::{CaseProfile, OutputFormat};
use crate::named_files::{Renewed, replace};
use crate::out_folder::{ClaimedFolder, Out};
use crate::output::{print, print_json, summarize, table_options};
use crate::processors::processors;
use crate::progress::progress;
use crate::provenance;
use crate::quick_choice::QuickChoice;
use crate::worth::order;
use clap::Args;
use etalon_backend::Backend;
use etalon_case::{Case, Globs, Library, Profile};
use etalon_cpu::CpuBackend;
use etalon_explore::{Fuzzer, Space};
use etalon_frame::Limits;
use etalon_frame::threads::each;
use etalon_judge::Judge;
use etalon_mutants::{Innocent, Mutant, MutantBackend, innocents, mutants, specifications};
use etalon_record::{
    Catch, FolderKind, HUNT_FORMAT, Hunt, InnocentInfo, InnocentRecord, InnocentTally, MutantInfo,
    MutantRecord, OutputFolder, Provenance,
};
use etalon_reference::Rules;
use etalon_runner::{HuntPlan, InnocentPlan, PlannedInnocent};
use serde::Serialize;
use std::collections::BTreeMap;
use std::path::PathBuf;
use std::time::Instant;

/// The default folder.
const LATEST: &str = "reports/mutants-latest";
/// The table of a hunt with random scenes.
const RECALL: &str = "recall.txt";

#[derive(Debug, Args)]
pub(crate) struct Arguments {
    /// Globs over the names of planted bugs and innocents, such as `blend/*`. Default: all
    #[arg(value_name = "GLOB")]
    pub(crate) globs: Vec<String>,
    /// Only print names and descriptions
    #[arg(long)]
    pub(crate) list: bool,
    /// Draw with the innocents alone: behaviours that some specification permits, and that no case may fail there
    #[arg(long, conflicts_with_all = ["full", "order", "redundant", "fuzz"])]
    pub(crate) innocents: bool,
    /// Hunt only with the cases that match this glob; may be repeated
    #[arg(long = "case", value_name = "GLOB")]
    pub(crate) case_globs: Vec<String>,
    /// Share of each family of cases
    #[arg(long, value_enum, default_value = "quick")]
    pub(crate) profile: CaseProfile,
    /// Read case files from this folder instead of the built-in ones
    #[arg(long, value_name = "DIR")]
    pub(crate) cases: Option<PathBuf>,
    /// Draw every case with every bug, instead of skipping the rest of an area after a bug's first Fail
    #[arg(long)]
    pub(crate) full: bool,
    /// Also write this file: the cases that together catch every bug, in the order in which `etalon run --within`
    /// draws them
    #[arg(long, value_name = "FILE", requires = "full")]
    pub(crate) order: Option<PathBuf>,
    /// Hunt with all candidates of the quick profile, and write this file: the candidates that others make
    /// superfluous, which catch the same bugs and have the same pairs of states
    #[arg(
        long,
        value_name = "FILE",
        requires = "full",
        conflicts_with_all = ["globs", "case_globs", "profile"]
    )]
    pub(crate) redundant: Option<PathBuf>,
    /// Hunt with this many random scenes instead of cases; each bug is drawn until its first Fail
    #[arg(long, value_name = "N", conflicts_with_all = ["case_globs", "profile", "cases", "full", "order", "redundant"])]
    pub(crate) fuzz: Option<u64>,
    /// Seed of the random scenes
    #[arg(long, value_name = "S", default_value_t = 0, requires = "fuzz")]
    pub(crate) seed: u64,
    /// Folder for mutants.json and mutants.html; with --fuzz also recall.txt
    #[arg(long, value_name = "DIR", default_value = LATEST)]
    pub(crate) out: PathBuf,
    /// Replace what etalon wrote into the folder; the default folder is always replaced
    #[arg(long)]
    pub(crate) force: bool,
    /// Output format
    #[arg(long, value_enum, default_value = "text")]
    pub(crate) format: OutputFormat,
}

/// Hunts the selected bugs and draws with the selected innocents, or lists them.
pub(crate) fn run(arguments: &Arguments) -> Result<u8, Failure> {
    let chosen = Chosen::new(arguments)?;
    if arguments.list {
        return chosen.list(arguments.format);
    }
    let renewed = [
        (&arguments.order, Renewed::Order),
        (&arguments.redundant, Renewed::Redundant),
    ];
    for (path, kind) in renewed {
        path.as_ref().map_or(Ok(()), |path| kind.check(path))?;
    }
    let claim = Out {
        folder: &arguments.out,
        kind: FolderKind::Hunt,
        latest: Some(LATEST),
        cases: arguments.cases.as_deref(),
        resume: None,
        force: arguments.force,
    }
    .claim()?;
    if let Some(scenes) = arguments.fuzz {
        return fuzz(arguments, scenes, &chosen.bugs, claim);
    }
    let library = library(arguments.cases.as_ref())?;
    let named = !arguments.case_globs.is_empty();
    let profile = match arguments.redundant {
        Some(_) => Profile::Candidates,
        None => arguments.profile.into(),
    };
    let cases: Vec<Case> = build(&library, profile, &arguments.case_globs)?
        .into_iter()
        .filter(|c| c.judged_as.is_none())
        .filter(|c| named || !c.measured)
        .collect();
    if cases.is_empty() {
        return Err(Failure::nothing(format!(
            "no case matches {}; selftests are excluded",
            arguments.case_globs.join(" ")
        )));
    }
    let hunt = hunt(arguments, &library, &cases, &chosen)?;
    let _lock = claim.take()?;
    let written = etalon_report::write_hunt(&arguments.out, &hunt).map_err(Failure::incomplete)?;
    if arguments.format == OutputFormat::Json {
        print_json(&hunt)?;
    } else {
        let options = table_options();
        summarize(&etalon_report::hunt_table(&hunt, options));
        summarize(&format!("\nReport: {}\n", written.html.display()));
    }
    let is_wrong =
        hunt.complaints().next().is_some() || hunt.innocent_complaints().next().is_some();
    Ok(if is_wrong { UNEXPECTED } else { 0 })
}

/// The bugs and innocents whose names match.
struct Chosen {
    bugs: Vec<MutantInfo>,
    innocents: Vec<&'static Innocent>,
}

impl Chosen {
    fn new(arguments: &Arguments) -> Result<Self, Failure> {
        let set = Globs::new(&arguments.globs).map_err(Failure::usage)?;
        let bugs = mutants().iter().filter(|m| set.matches(&m.name));
        let chosen = Self {
            bugs: bugs
                .filter(|_| !arguments.innocents)
                .map(|m| bug(m))
                .collect(),
            // Random scenes are drawn with bugs alone.
            innocents: innocents()
                .iter()
                .filter(|i| arguments.fuzz.is_none() && set.matches(&i.name))
                .collect(),
        };
        if chosen.bugs.is_empty() && chosen.innocents.is_empty() {
            let (kind, flag) = if arguments.innocents {
                ("innocent", " --innocents")
            } else {
                ("planted bug", "")
            };
            return Err(Failure::nothing(format!(
                "no {kind} matches {}; `etalon mutants{flag} --list` lists all",
                arguments.globs.join(" ")
            )));
        }
        Ok(chosen)
    }

    /// Prints the bugs, or the innocents if there are no bugs.
    fn list(&self, format: OutputFormat) -> Result<u8, Failure> {
        if self.bugs.is_empty() {
            let innocents: Vec<InnocentInfo> = self.innocents.iter().map(|i| innocent(i)).collect();
            list(&innocents, |i| (&i.name, &i.about), format)
        } else {
            list(&self.bugs, |m| (&m.name, &m.about), format)
        }
    }

    /// Returns the innocents with the specifications that judge them.
    fn planned(&self) -> Vec<PlannedInnocent> {
        let specifications = specifications();
        let plan = |chosen: &&Innocent| {
            let limits: Vec<Limits> = specifications.iter().map(|s| chosen.limits(s)).collect();
            let tally = |specification: &Limits| InnocentTally {
                specification: Rules::of(specification).text.to_owned(),
                forbidden: chosen.forbidden_by(specification),
                imprecise: 0,
                violations: 0,
                shared: None,
                worst: None,
            };
            PlannedInnocent {
                record: InnocentRecord {
                    innocent: innocent(chosen),
                    changed: 0,
                    specifications: specifications.iter().map(tally).collect(),
                },
                backends: specifications.iter().map(|s| chosen.backend(s)).collect(),
                limits,
            }
        };
        self.innocents.iter().map(plan).collect()
    }
}

/// Prints items as JSON, or their names and descriptions.
fn list<T: Serialize>(
    items: &[T],
    line: fn(&T) -> (&String, &String),
    format: OutputFormat,
) -> Result<u8, Failure> {
    if format == OutputFormat::Json {
        print_json(&items)?;
        return Ok(0);
    }
    let lines = || items.iter().map(line);
    let width = lines().map(|(name, _)| name.len()).max().unwrap_or(0);
    let mut text = String::new();
    for (name, about) in lines() {
        text.push_str(&format!("{name:width$}  {about}\n"));
    }
    print(&text)?;
    Ok(0)
}

fn bug(mutant: &Mutant) -> MutantInfo {
    MutantInfo {
        name: mutant.name.clone(),
        about: mutant.about.clone(),
        source: mutant.source.to_owned(),
        area: mutant.area.to_owned(),
    }
}

fn innocent(innocent: &Innocent) -> InnocentInfo {
    InnocentInfo {
        name: innocent.name.clone(),
        about: innocent.about.clone(),
        source: innocent.source.to_owned(),
        permissions: innocent
            .permissions()
            .into_iter()
            .map(str::to_owned)
            .collect(),
        is_itself: innocent.is_itself(),
        is_profile: !innocent.parts.is_empty(),
    }
}

fn open(name: &str) -> Option<Box<dyn Backend>> {
    MutantBackend::new(name).map(|backend| Box::new(backend) as Box<dyn Backend>)
}

fn hunt(
    arguments: &Arguments,
    library: &Library,
    cases: &[Case],
    chosen: &Chosen,
) -> Result<Hunt, Failure> {
    let jobs = processors();
    let rounds = jobs.min(chosen.bugs.len()) + usize::from(!chosen.innocents.is_empty());
    let bar = progress(cases.len() as u64 * rounds as u64);
    let started = provenance::now();
    let start = Instant::now();
    let plan = HuntPlan {
        cases,
        mutants: &chosen.bugs,
        full: arguments.full,
        jobs,
    };
    let found = etalon_runner::hunt(plan, &open, &|| bar.inc(1));
    let mut is_quick = vec![true; cases.len()];
    if let Some(path) = &arguments.redundant {
        let findings = etalon_findings::findings().map_err(Failure::usage)?;
        let choice = QuickChoice::new(library, cases, &found, &findings);
        replace(path, choice.redundant(cases).as_bytes())?;
        is_quick = choice.is_kept;
    }
    if let Some(path) = &arguments.order {
        replace(path, order(cases, &is_quick, &found).as_bytes())?;
    }
    let faithful = || Box::new(CpuBackend::spans("cpu")) as Box<dyn Backend>;
    let plan = InnocentPlan {
        cases,
        innocents: &chosen.planned(),
        jobs,
    };
    let innocents = etalon_runner::try_innocents(plan, &faithful, &open, &|| bar.inc(1));
    bar.finish_and_clear();
    let is_whole = arguments.case_globs.is_empty() && arguments.cases.is_none();
    Ok(Hunt {
        every_case: is_whole && arguments.profile == CaseProfile::Full,
        innocents,
        ..hunted(arguments, cases.len() as u64, started, start, found.records)
    })
}

fn hunted(
    arguments: &Arguments,
    cases: u64,
    started: String,
    start: Instant,
    mutants: Vec<MutantRecord>,
) -> Hunt {
    Hunt {
        format: HUNT_FORMAT,
        provenance: Provenance {
            started,
            ..provenance::here()
        },
        seconds: start.elapsed().as_secs_f64(),
        cases,
        full: arguments.full,
        every_case: false,
        mutants,
        innocents: Vec::new(),
    }
}

/// The number of scenes that are in memory at the same time.
const CHUNK: u64 = 500;

/// Hunts with random scenes, to measure how many bugs they catch. Exits with 1 if the rasterizer
/// fails without a bug.
fn fuzz(
    arguments: &Arguments,
    scenes: u64,
    chosen: &[MutantInfo],
    claim: ClaimedFolder<'_>,
) -> Result<u8, Failure> {
    let (started, start) = (provenance::now(), Instant::now());
    let (found, failing) = fuzzed(arguments.seed, scenes, chosen);
    let hunt = hunted(arguments, scenes, started, start, found);
    let _lock = claim.take()?;
    let written = etalon_report::write_hunt(&arguments.out, &hunt).map_err(Failure::incomplete)?;
    let mut table = recall(&hunt);
    for case in &failing {
        table.push_str(&format!(
            "\nWrong: {case} fails without a bug, and was left out\n"
        ));
    }
    OutputFolder::open(&arguments.out)
        .and_then(|out| out.write(RECALL, table.as_bytes()))
        .map_err(Failure::incomplete)?;
    match arguments.format {
        OutputFormat::Json => print_json(&hunt)?,
        OutputFormat::Text => summarize(&format!("{table}\nReport: {}\n", written.html.display())),
    }
    Ok(if !failing.is_empty() { UNEXPECTED } else { 0 })
}

/// Draws random scenes with the bugs that are not yet caught, chunk by chunk. Returns the record of each bug,
/// and the ids of the scenes that fail without a bug.
fn fuzzed(seed: u64, scenes: u64, chosen: &[MutantInfo]) -> (Vec<MutantRecord>, Vec<String>) {
    let limits = CpuBackend::new("cpu").limits().clone();
    let can_draw = |case: &Case| limits.missing(&case.requirements()).is_none();
    let mut fuzzer = Fuzzer::new(seed, Space::of([&limits]));
    let mut records: Vec<Option<MutantRecord>> = vec![None; chosen.len()];
    let bar = progress(scenes);
    let mut failing = Vec::new();
    let mut drawn = 0;
    while drawn < scenes {
        let count = CHUNK.min(scenes - drawn);
        drawn += count;
        let made = (0..count).filter_map(|_| fuzzer.scene(&can_draw));
        let cases: Vec<Case> = made.map(|s| s.candidate.case).collect();
        let (cases, wrong) = without_own_failures(cases, &limits);
        failing.extend(wrong);
        let caught = |index: &usize| {
            let record = records[*index].as_ref();
            record.is_some_and(|r| r.outcome == Catch::Caught)
        };
        let left: Vec<usize> = (0..chosen.len()).filter(|index| !caught(index)).collect();
        let mutants: Vec<MutantInfo> = left.iter().map(|index| chosen[*index].clone()).collect();
        let plan = HuntPlan {
            cases: &cases,
            mutants: &mutants,
            full: false,
            jobs: processors(),
        };
        let found = etalon_runner::hunt(plan, &open, &|| {});
        for (index, record) in left.into_iter().zip(found.records) {
            match &mut records[index] {
                Some(before) => before.add(record),
                none => *none = Some(record),
            }
        }
        bar.inc(count);
        bar.set_message(format!("{} left", mutants.len()));
    }
    bar.finish_and_clear();
    (records.into_iter().flatten().collect(), failing)
}

/// Separates the cases that the rasterizer fails without a bug: they would catch every bug.
fn without_own_failures(cases: Vec<Case>, limits: &Limits) -> (Vec<Case>, Vec<String>) {
    let fails = |case: &Case| {
        let backend = CpuBackend::spans("cpu");
        let frames = etalon_runner::draw_frames(&backend, case);
        frames.map_or(true, |frames| {
            let judged = Judge::default().judge(0, case, "cpu", limits, &frames);
            judged.record.verdict.is_violation()
        })
    };
    let wrong = each(processors(), &cases, fails);
    let (kept, left): (Vec<_>, Vec<_>) = cases.into_iter().zip(wrong).partition(|(_, w)| !w);
    let kept = kept.into_iter().map(|(case, _)| case).collect();
    (kept, left.into_iter().map(|(case, _)| case.id).collect())
}

/// The class of bugs that need large pictures, which random scenes do not have.
const LARGE: &str = "size";

/// Returns the table of the bugs that random scenes caught, by class, and the names of the others.
fn recall(hunt: &Hunt) -> String {
    let class = |m: &MutantRecord| {
        m.mutant
            .name
            .split('/')
            .next()
            .unwrap_or_default()
            .to_owned()
    };
    let mut classes: BTreeMap<String, [usize; 2]> = BTreeMap::new();
    let mut missed = String::new();
    for mutant in &hunt.mutants {
        let [caught, total] = classes.entry(class(mutant)).or_default();
        *total += 1;
        match mutant.outcome {
            Catch::Caught => *caught += 1,
            _ => missed.push_str(&format!("  {}\n", mutant.mutant.name)),
        }
    }
    let mut text = format!("Bugs that {} random scenes catch\n\n", hunt.cases);
    let mut sums = [0; 2];
    for (class, [caught, total]) in &classes {
        text.push_str(&format!("{class:16} {caught:5} of {total:5}\n"));
        if class != LARGE {
            sums = [sums[0] + caught, sums[1] + total];
        }
    }
    let [caught, total] = sums;
    let share = 100.0 * caught as f64 / (total as f64).max(1.0);
    text.push_str(&format!(
        "\nWithout {LARGE}: {caught} of {total}, {share:.1} %, in {:.0} s\n\nNot caught\n{missed}",
        hunt.seconds
    ));
    text
}
