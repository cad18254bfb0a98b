//! `etalon bisect`.

use crate::cases::{chosen, round_trips};
use crate::discovery::discover;
use crate::failure::{Failure, INCOMPLETE};
use crate::flags::{CaseArguments, CaseProfile, OutputFormat};
use crate::interruption::listen;
use crate::out_folder::Out;
use crate::output::{print_json, say, summarize, table_options};
use crate::processors::processors;
use crate::progress::progress;
use crate::{expectations, provenance};
use clap::Args;
use etalon_adapters::{Adapters, Query, releases_of};
use etalon_case::Case;
use etalon_record::{
    AbsentAdapter, AdapterRecord, CaseVersions, Expectation, Expectations, FolderKind, Header,
    OutputFolder, Release, ReleaseRecord, Run, Standing, VERSIONS_FORMAT, Verdict, Versions,
    VersionsHeader, WORK_FOLDER,
};
use etalon_runner::{
    Launch, Plan, RunError, RunEvent, RunOptions, Worker, releases_to_draw, run as draw,
};
use indicatif::ProgressBar;
use serde_json::json;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, Ordering};

#[derive(Debug, Args)]
pub(crate) struct Arguments {
    /// Case ids, globs over them, or run folders, whose cases with a bad verdict are used
    #[arg(value_name = "CASE|GLOB|RUN", required = true)]
    pub(crate) inputs: Vec<String>,
    /// Line of the driver: the adapters described with this `line`, one per version
    #[arg(long, value_name = "NAME")]
    pub(crate) line: String,
    /// File that describes the adapters of the line, in the format of the built-in adapters.json
    #[arg(long = "adapters", value_name = "FILE")]
    pub(crate) adapter_file: Option<PathBuf>,
    /// Folder for versions.jsonl and its page
    #[arg(long, value_name = "DIR", default_value = "reports/versions")]
    pub(crate) out: PathBuf,
    /// Replace the results in the folder
    #[arg(long)]
    pub(crate) force: bool,
    /// Read case files from this folder instead of the built-in ones
    #[arg(long, value_name = "DIR")]
    pub(crate) cases: Option<PathBuf>,
    /// Share of each family of cases that globs select from
    #[arg(long, value_enum, default_value = "full")]
    pub(crate) profile: CaseProfile,
    /// Number of workers that draw at the same time. Default: one per processor
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub(crate) jobs: Option<u16>,
    /// Output format
    #[arg(long, value_enum, default_value = "text")]
    pub(crate) format: OutputFormat,
}

/// One release that cases are drawn with.
struct DrawnRelease {
    launch: Launch,
    /// The worker that discovery started; later ones start on demand.
    worker: Option<Worker>,
    adapter: AdapterRecord,
}

/// The part of a search that all rounds share.
struct ReleaseSearch<'a> {
    folder: &'a Path,
    cases: &'a [Case],
    library: Option<&'a PathBuf>,
    jobs: usize,
    stop: &'a AtomicBool,
}

/// Draws cases with releases of one driver until it is known which releases draw each case wrong.
pub(crate) fn run(arguments: &Arguments) -> Result<u8, Failure> {
    let mut releases =
        releases_of(arguments.adapter_file.as_deref(), &arguments.line).map_err(Failure::usage)?;
    let names: Vec<String> = releases.iter().map(|(name, _)| name.clone()).collect();
    let cases = selected(arguments)?;
    let claim = Out {
        folder: &arguments.out,
        kind: FolderKind::Versions,
        latest: None,
        cases: arguments.cases.as_deref(),
        resume: None,
        force: arguments.force,
    }
    .claim()?;
    let stop = listen()?;
    let mut adapters = discover(&Query {
        names: &names,
        file: arguments.adapter_file.as_deref(),
        ..Query::default()
    })?;
    leave_out(&mut releases, &adapters.absent)?;
    let mut drawn = in_order(&releases, &mut adapters);
    let mut versions = Versions {
        header: header(arguments, &releases, &drawn),
        cases: cases
            .iter()
            .map(|case| undrawn(case, drawn.len()))
            .collect(),
    };
    let _lock = claim.take()?;
    versions
        .write(&arguments.out)
        .map_err(Failure::incomplete)?;
    let search = ReleaseSearch {
        folder: &arguments.out.join(WORK_FOLDER),
        cases: &cases,
        library: arguments.cases.as_ref(),
        jobs: arguments.jobs.map_or_else(processors, usize::from),
        stop,
    };
    let findings = expectations::built_in()?;
    let outcome = search.run(&mut versions, &mut drawn, &findings, &arguments.out);
    // The file already has everything that an interrupted run holds.
    let _ = OutputFolder::open(search.folder).and_then(|work| work.remove_all());
    outcome?;
    let written =
        etalon_report::write_versions(&arguments.out, &versions).map_err(Failure::incomplete)?;
    let interrupted = stop.load(Ordering::Relaxed);
    print(arguments.format, &versions, &written, interrupted)?;
    if interrupted {
        say!("interrupted: some cases were not drawn with all the releases that decide about them");
        return Ok(INCOMPLETE);
    }
    Ok(0)
}

/// Prints the result and the path of its report.
fn print(
    format: OutputFormat,
    versions: &Versions,
    report: &Path,
    interrupted: bool,
) -> Result<(), Failure> {
    match format {
        OutputFormat::Json => print_json(&json!({
            "line": versions.header.line,
            "releases": versions.header.releases,
            "cases": versions.cases.len(),
            "bad": versions.cases.iter().filter(|c| !c.bad().is_empty()).count(),
            "interrupted": interrupted,
            "report": report,
        }))?,
        OutputFormat::Text => {
            summarize(&etalon_report::versions_table(versions, table_options()));
            summarize(&format!("\nReport: {}\n", report.display()));
        }
    }
    Ok(())
}

/// Removes the releases that cannot be used, and prints the reasons.
fn leave_out(
    releases: &mut Vec<(String, Release)>,
    absent: &[AbsentAdapter],
) -> Result<(), Failure> {
    for absent in absent {
        say!(
            "left out: {}: {}; {}",
            absent.name,
            absent.reason,
            absent.remedy
        );
    }
    releases.retain(|(name, _)| absent.iter().all(|absent| absent.name != *name));
    match releases.len() {
        2.. => Ok(()),
        _ => Err(Failure::usage(
            "fewer than two releases of the line can be used, and a search needs two",
        )),
    }
}

/// Returns the cases that globs and run folders select.
fn selected(arguments: &Arguments) -> Result<Vec<Case>, Failure> {
    let mut globs = Vec::new();
    for input in &arguments.inputs {
        let folder = Path::new(input);
        if FolderKind::of(folder) != Some(FolderKind::Run) {
            globs.push(input.clone());
            continue;
        }
        let run = Run::read(folder).map_err(Failure::usage)?;
        let bad =
            |verdict: Verdict| matches!(Standing::from(verdict), Standing::Bad | Standing::Flaky);
        let records = run.records.iter();
        let failed = records.filter(|r| bad(r.verdict) && r.parts().area() != "selftest");
        let before = globs.len();
        globs.extend(failed.map(|r| etalon_glob::escape(&r.case)));
        if globs.len() == before {
            say!("{input}: no case has a bad verdict");
        }
    }
    globs.sort();
    globs.dedup();
    if globs.is_empty() {
        return Err(Failure::nothing("no case of these runs has a bad verdict"));
    }
    chosen(&CaseArguments {
        globs,
        cases: arguments.cases.clone(),
        gltf: None,
        profile: arguments.profile,
    })
}

/// Returns the adapters that were found, in the order of the releases.
fn in_order(releases: &[(String, Release)], adapters: &mut Adapters) -> Vec<DrawnRelease> {
    let mut found: BTreeMap<String, (Launch, Worker)> = BTreeMap::new();
    for (launch, worker) in adapters.ready.drain(..) {
        found.insert(launch.adapter.clone(), (launch, worker));
    }
    let each = releases.iter().filter_map(|(name, _)| found.remove(name));
    each.map(|(launch, worker)| DrawnRelease {
        launch,
        adapter: (&worker).into(),
        worker: Some(worker),
    })
    .collect()
}

fn header(
    arguments: &Arguments,
    releases: &[(String, Release)],
    drawn: &[DrawnRelease],
) -> VersionsHeader {
    VersionsHeader {
        format: VERSIONS_FORMAT,
        provenance: provenance::here(),
        line: arguments.line.clone(),
        releases: releases
            .iter()
            .zip(drawn)
            .map(|((name, release), drawn)| ReleaseRecord {
                version: release.version.clone(),
                adapter: name.clone(),
                driver: drawn.adapter.driver_text(),
            })
            .collect(),
    }
}

fn undrawn(case: &Case, releases: usize) -> CaseVersions {
    CaseVersions {
        case: case.id.clone(),
        finding: None,
        verdicts: vec![None; releases],
    }
}

impl ReleaseSearch<'_> {
    /// Draws until every case is decided or the search is stopped. Writes the file after each round.
    fn run(
        &self,
        versions: &mut Versions,
        drawn: &mut [DrawnRelease],
        findings: &Expectations,
        out: &Path,
    ) -> Result<(), Failure> {
        for round in 1_u32.. {
            let mut wanted: Vec<Vec<usize>> = vec![Vec::new(); drawn.len()];
            for (number, case) in versions.cases.iter().enumerate() {
                let known: Vec<_> = case
                    .verdicts
                    .iter()
                    .map(|v| v.map(Standing::from))
                    .collect();
                for release in releases_to_draw(&known) {
                    wanted[release].push(number);
                }
            }
            let total: usize = wanted.iter().map(Vec::len).sum();
            if total == 0 {
                return Ok(());
            }
            say!("round {round}: {total} records");
            let bar = progress(total as u64);
            for (release, numbers) in wanted.into_iter().enumerate() {
                if numbers.is_empty() || self.stop.load(Ordering::Relaxed) {
                    continue;
                }
                let version = &versions.header.releases[release].version;
                bar.set_message(version.clone());
                let verdicts = self.draw(&mut drawn[release], &numbers, &bar)?;
                let adapter = &drawn[release].adapter;
                for (number, verdict) in verdicts {
                    let case = &mut versions.cases[number];
                    case.verdicts[release] = Some(verdict);
                    let expectation = findings.look_up(adapter, &case.case, verdict);
                    if let (Expectation::Agrees(known), None) = (expectation, &case.finding) {
                        case.finding = Some(known.reason.clone());
                    }
                }
            }
            bar.finish_and_clear();
            versions.write(out).map_err(Failure::incomplete)?;
            if self.stop.load(Ordering::Relaxed) {
                return Ok(());
            }
        }
        Ok(())
    }

    /// Draws some cases with one release and returns their verdicts. Bad verdicts are checked again in
    /// another process.
    fn draw(
        &self,
        drawn: &mut DrawnRelease,
        numbers: &[usize],
        bar: &ProgressBar,
    ) -> Result<Vec<(usize, Verdict)>, Failure> {
        let cases: Vec<Case> = numbers.iter().map(|n| self.cases[*n].clone()).collect();
        let by_id: BTreeMap<&str, usize> = numbers
            .iter()
            .map(|n| (self.cases[*n].id.as_str(), *n))
            .collect();
        let round_trips = round_trips(self.library, &cases)?;
        let worker = match drawn.worker.take() {
            Some(worker) => worker,
            None => Worker::start(&drawn.launch).map_err(|error| {
                Failure::incomplete(format!("{}: {error}", drawn.launch.adapter))
            })?,
        };
        let found: Mutex<Vec<(usize, Verdict)>> = Mutex::default();
        let plan = Plan {
            cases: &cases,
            round_trips: &round_trips,
            selection: None,
            adapters: vec![(drawn.launch.clone(), worker)],
            dead: Vec::new(),
            options: RunOptions {
                jobs: self.jobs,
                recheck: u32::MAX,
                ..RunOptions::default()
            },
            // Without expectations, every bad verdict is checked again.
            expectations: &Expectations::default(),
            folder: self.folder,
            header: Header {
                provenance: provenance::here(),
                ..Header::new(vec![drawn.adapter.clone()], cases.len() as u64)
            },
            resume: false,
            stop: self.stop,
            drawn: &|_, _, _| {},
        };
        let drawing = draw(plan, &|event| {
            if let RunEvent::Recorded(record) = event {
                if let (Some(number), Ok(mut found)) = (by_id.get(&*record.case), found.lock()) {
                    found.push((*number, record.verdict));
                }
                bar.inc(1);
            }
        });
        drawing.map_err(|error| match error {
            RunError::Folder(error) => Failure::of(error),
            RunError::Write(error) => Failure::incomplete(error),
        })?;
        Ok(found.into_inner().unwrap_or_default())
    }
}
