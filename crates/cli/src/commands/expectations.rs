//! `etalon expectations` and `etalon run --bless`.

use crate::adapters::{Query, discover, refuse_absent};
use crate::cases::ids;
use crate::expectations::{read, replace, today, write};
use crate::failure::Failure;
use crate::flags::AdapterFileArguments;
use crate::output::print;
use clap::{Args, Subcommand};
use etalon_record::{About, AdapterRecord, Expectations, Imported, ListKind};
use std::fs;
use std::path::PathBuf;

/// Lists of deqp-runner in and out.
#[derive(Debug, Subcommand)]
pub(crate) enum Command {
    /// Add what deqp-runner's lists expect to an expectations file
    Import(ImportArguments),
    /// Write what is expected of an adapter as deqp-runner's lists: fails.txt, flakes.txt, skips.txt
    Export(ExportArguments),
}

#[derive(Debug, Args)]
pub(crate) struct ImportArguments {
    /// A list of failures: lines `name,status` (repeat for several)
    #[arg(long, value_name = "FILE")]
    pub(crate) fails: Vec<PathBuf>,
    /// A list of flaky cases: a regular expression per line (repeat for several)
    #[arg(long, value_name = "FILE")]
    pub(crate) flakes: Vec<PathBuf>,
    /// A list of cases not to be drawn: a regular expression per line (repeat for several)
    #[arg(long, value_name = "FILE")]
    pub(crate) skips: Vec<PathBuf>,
    /// A results.csv, whose bad verdicts are expected from now on (repeat for several)
    #[arg(long, value_name = "FILE")]
    pub(crate) results: Vec<PathBuf>,
    /// The adapters that the entries are about: a glob over names
    #[arg(long, value_name = "GLOB")]
    pub(crate) adapter: String,
    /// Their driver: a glob over driver and version
    #[arg(long, value_name = "GLOB", default_value = "*")]
    pub(crate) driver: String,
    /// The driver's versions, as `>=22.3, <25.1`
    #[arg(long, value_name = "RANGE")]
    pub(crate) version: Option<String>,
    /// Why the verdicts are accepted
    #[arg(long, value_name = "TEXT")]
    pub(crate) reason: String,
    /// Where that is shown
    #[arg(long, value_name = "TEXT")]
    pub(crate) evidence: String,
    /// A bug report's address
    #[arg(long, value_name = "URL")]
    pub(crate) link: Option<String>,
    /// The last day on which the entries count, as 2027-01-31
    #[arg(long, value_name = "DAY")]
    pub(crate) expires: Option<String>,
    /// The expectations file to add to; it is made where it does not exist
    #[arg(long, value_name = "FILE")]
    pub(crate) out: PathBuf,
    /// Read case files from this folder instead of those built in
    #[arg(long, value_name = "DIR")]
    pub(crate) cases: Option<PathBuf>,
}

#[derive(Debug, Args)]
pub(crate) struct ExportArguments {
    /// The adapter that the lists are for
    #[arg(long, value_name = "NAME")]
    pub(crate) adapter: String,
    #[command(flatten)]
    pub(crate) file: AdapterFileArguments,
    /// Expectations to write, instead of those built in
    #[arg(long, value_name = "FILE")]
    pub(crate) expect: Option<PathBuf>,
    /// The folder that the lists go to
    #[arg(long, value_name = "DIR")]
    pub(crate) out: PathBuf,
    /// Read case files from this folder instead of those built in
    #[arg(long, value_name = "DIR")]
    pub(crate) cases: Option<PathBuf>,
}

/// How many lines that name nothing are told.
const TOLD: usize = 20;

/// Exchanges expectations with deqp-runner.
pub(crate) fn run(command: &Command) -> Result<u8, Failure> {
    match command {
        Command::Import(arguments) => import(arguments),
        Command::Export(arguments) => export(arguments),
    }
}

fn import(arguments: &ImportArguments) -> Result<u8, Failure> {
    let ids = ids(arguments.cases.as_ref())?;
    let about = About {
        adapter: arguments.adapter.clone(),
        driver: arguments.driver.clone(),
        version: arguments.version.clone(),
        reason: arguments.reason.clone(),
        evidence: arguments.evidence.clone(),
        link: arguments.link.clone(),
        expires: arguments.expires.clone(),
    };
    let lists = [
        (ListKind::Fails, &arguments.fails),
        (ListKind::Fails, &arguments.results),
        (ListKind::Flakes, &arguments.flakes),
        (ListKind::Skips, &arguments.skips),
    ];
    let mut imported = Imported::default();
    for (kind, paths) in lists {
        for path in paths {
            let text = fs::read_to_string(path)
                .map_err(|e| Failure::usage(format!("cannot read {}: {e}", path.display())))?;
            let name = path.display().to_string();
            imported
                .add(kind, &name, &text, &ids, &about)
                .map_err(Failure::usage)?;
        }
    }
    for (list, line) in imported.unmatched.iter().take(TOLD) {
        eprintln!("{list}: no case here is meant by: {line}");
    }
    let more = imported.unmatched.len().saturating_sub(TOLD);
    if more > 0 {
        eprintln!("and {more} more lines that mean no case here");
    }
    if imported.entries.is_empty() {
        return Err(Failure::nothing(
            "the lists name no bad verdict of any case here",
        ));
    }
    let mut entries = match arguments.out.exists() {
        true => Expectations::read(&arguments.out)
            .map_err(Failure::usage)?
            .entries()
            .to_vec(),
        false => Vec::new(),
    };
    let before = entries.len();
    for entry in imported.entries {
        if !entries.contains(&entry) {
            entries.push(entry);
        }
    }
    let added = entries.len() - before;
    write(&arguments.out, &entries)?;
    print(&format!(
        "{added} entries added to {}\n",
        arguments.out.display()
    ))?;
    Ok(0)
}

fn export(arguments: &ExportArguments) -> Result<u8, Failure> {
    let expected = read(arguments.expect.as_deref())?.on(&today());
    let ids = ids(arguments.cases.as_ref())?;
    let name = std::slice::from_ref(&arguments.adapter);
    let adapters = discover(&Query {
        names: name,
        file: arguments.file.adapter_file.as_deref(),
        ..Query::default()
    })?;
    refuse_absent(name, &adapters.absent)?;
    let Some((_, worker)) = adapters.ready.first() else {
        return Err(Failure::nothing("the adapter was not found"));
    };
    let lists = expected.lists(&AdapterRecord::from(worker), &ids);
    let out = &arguments.out;
    fs::create_dir_all(out)
        .map_err(|e| Failure::usage(format!("cannot create {}: {e}", out.display())))?;
    for (name, text) in [
        ("fails.txt", &lists.fails),
        ("flakes.txt", &lists.flakes),
        ("skips.txt", &lists.skips),
    ] {
        replace(&out.join(name), text)?;
        print(&format!(
            "{}: {} lines\n",
            out.join(name).display(),
            text.lines().count()
        ))?;
    }
    Ok(0)
}
