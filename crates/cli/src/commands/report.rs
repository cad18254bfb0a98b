//! `etalon report`.

use crate::catalogue::{catalogue_of, draws_built_in};
use crate::expectations;
use crate::failure::{Failure, IMPROVED, INCOMPLETE, UNEXPECTED};
use crate::news::{NewsArguments, shown};
use crate::output::{say, summarize, table_options};
use crate::saved_run::UnpackArguments;
use clap::Args;
use etalon_record::{Bench, Expectation, FolderKind, Record, Run};
use etalon_report::{RunReport, TableOptions};
use std::path::{Path, PathBuf};

#[derive(Debug, Args)]
pub(crate) struct Arguments {
    /// Run and bench folders, and runs that the page saved (`*.tar.gz`)
    #[arg(value_name = "DIR", required = true)]
    pub(crate) folders: Vec<PathBuf>,
    /// Read the case files of a run of `--cases` from this folder, for the pages of single cases
    #[arg(long, value_name = "DIR")]
    pub(crate) cases: Option<PathBuf>,
    #[command(flatten)]
    pub(crate) unpack: UnpackArguments,
    #[command(flatten)]
    pub(crate) news: NewsArguments,
    /// Also write `results/<adapter>.csv`, in deqp-runner's format
    #[arg(long)]
    pub(crate) deqp: bool,
}

/// Rebuilds the reports of run and bench folders, and compares runs with the history if one is named. Returns
/// the exit code that the records of the folders give; for several folders, the most serious one.
pub(crate) fn run(arguments: &Arguments) -> Result<u8, Failure> {
    arguments.news.check()?;
    let options = table_options();
    let mut codes = Vec::new();
    for folder in &arguments.unpack.folders(&arguments.folders)? {
        codes.push(match FolderKind::of(folder) {
            Some(FolderKind::Bench) => bench(folder, options)?,
            // A folder that is neither a run nor a bench is reported as a missing run.
            _ => of_run(folder, arguments, options)?,
        });
    }
    let gravest = [INCOMPLETE, UNEXPECTED, IMPROVED];
    Ok(gravest.into_iter().find(|c| codes.contains(c)).unwrap_or(0))
}

fn of_run(folder: &Path, arguments: &Arguments, options: TableOptions) -> Result<u8, Failure> {
    let run = Run::read(folder).map_err(Failure::usage)?;
    let news = arguments.news.news(&run)?;
    let shown = shown(&run, news.as_ref());
    let catalogue = match &arguments.cases {
        Some(cases) => Some(catalogue_of(&run, Some(cases))?),
        None if draws_built_in(&run.header) => Some(catalogue_of(&run, None)?),
        None => None,
    };
    let written = RunReport {
        folder,
        run: &shown,
        catalogue: catalogue.as_ref(),
        news: news.as_ref(),
        deqp: arguments.deqp,
    }
    .write()
    .map_err(Failure::of)?;
    if let Some(news) = &news {
        summarize(&etalon_report::news_table(news, options));
    }
    summarize(&etalon_report::table(&shown, options));
    summarize("\n");
    for path in written.all() {
        summarize(&format!("{}\n", path.display()));
    }
    Ok(if run.missing() > 0 {
        say!(
            "etalon: {} is incomplete: {} of {} records are missing",
            folder.display(),
            run.missing(),
            run.header.expected_records()
        );
        INCOMPLETE
    } else if shown.records.iter().any(Record::unexpected) {
        UNEXPECTED
    } else if run.records.iter().any(Record::improvement) {
        IMPROVED
    } else {
        0
    })
}

fn bench(folder: &Path, options: TableOptions) -> Result<u8, Failure> {
    let bench = Bench::read(folder).map_err(Failure::usage)?;
    let written = etalon_report::write_bench(folder).map_err(Failure::of)?;
    summarize(&etalon_report::bench_table(&bench, options));
    summarize(&etalon_report::matrix_table(&bench, options));
    let matrix = written.matrix.into_iter().flatten();
    for path in [written.html, written.bencher, written.action]
        .into_iter()
        .chain(matrix)
    {
        summarize(&format!("{}\n", path.display()));
    }
    let adapters = bench.header.adapters.len() as u64;
    let expected = bench.header.cases.saturating_mul(adapters);
    let pictures = bench.records.len() as u64;
    if pictures < expected {
        say!(
            "etalon: {} is incomplete: {pictures} of {expected} pictures were judged",
            folder.display()
        );
        return Ok(INCOMPLETE);
    }
    // A bench uses only the built-in findings.
    let expectations = expectations::built_in()?;
    let unexpected = bench.records.iter().any(|record| {
        let picture = &record.picture;
        // The picture has only its verdict; the failure itself was compared when it was drawn.
        let known = bench
            .header
            .adapter(&picture.adapter)
            .is_some_and(|adapter| {
                let found = expectations.look_up(adapter, &picture.case, picture.verdict);
                matches!(found, Expectation::Agrees(_))
            });
        let lost = record.ended.as_ref().is_some_and(|e| e.verdict.is_bad());
        lost || picture.verdict.is_bad() && !known
    });
    Ok(if unexpected { UNEXPECTED } else { 0 })
}
