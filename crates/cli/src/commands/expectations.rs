//! `etalon expectations`.

use crate::cases::ids;
use crate::discovery::{discover, refuse_absent};
use crate::expectations::{ExpectArguments, write};
use crate::failure::Failure;
use crate::flags::AdapterFileArguments;
use crate::named_files::NamedFiles;
use crate::output::{say, summarize};
use clap::{Args, Subcommand};
use etalon_adapters::Query;
use etalon_record::{About, AdapterRecord, Entry, Expectations, Imported, ListKind};
use std::collections::HashSet;
use std::fs;
use std::path::{Path, PathBuf};

/// Conversions between expectations and deqp-runner's lists.
#[derive(Debug, Subcommand)]
pub(crate) enum Conversion {
    /// Add the contents of deqp-runner's lists to an expectations file
    Import(ImportArguments),
    /// Write the expectations of an adapter as deqp-runner's lists: fails.txt, flakes.txt, skips.txt
    Export(ExportArguments),
}

#[derive(Debug, Args)]
pub(crate) struct ImportArguments {
    /// List of failures, with lines `name,status`; may be repeated
    #[arg(long, value_name = "FILE")]
    pub(crate) fails: Vec<PathBuf>,
    /// List of flaky cases, with one regular expression per line; may be repeated
    #[arg(long, value_name = "FILE")]
    pub(crate) flakes: Vec<PathBuf>,
    /// List of cases to skip, with one regular expression per line; may be repeated
    #[arg(long, value_name = "FILE")]
    pub(crate) skips: Vec<PathBuf>,
    /// A results.csv whose bad verdicts become expected; may be repeated
    #[arg(long, value_name = "FILE")]
    pub(crate) results: Vec<PathBuf>,
    /// Glob over the names of the adapters that the entries apply to
    #[arg(long, value_name = "GLOB")]
    pub(crate) adapter: String,
    /// Glob over driver and version
    #[arg(long, value_name = "GLOB", default_value = "*")]
    pub(crate) driver: String,
    /// Range of driver versions, such as `>=22.3, <25.1`
    #[arg(long, value_name = "RANGE")]
    pub(crate) version: Option<String>,
    /// Reason why the verdicts are accepted
    #[arg(long, value_name = "TEXT")]
    pub(crate) reason: String,
    /// Evidence for the reason
    #[arg(long, value_name = "TEXT")]
    pub(crate) evidence: String,
    /// Address of a bug report
    #[arg(long, value_name = "URL")]
    pub(crate) link: Option<String>,
    /// Last day on which the entries apply, such as 2027-01-31
    #[arg(long, value_name = "DAY")]
    pub(crate) expires: Option<String>,
    /// Expectations file to add to, created if it does not exist
    #[arg(long, value_name = "FILE")]
    pub(crate) out: PathBuf,
    /// Read case files from this folder instead of the built-in ones
    #[arg(long, value_name = "DIR")]
    pub(crate) cases: Option<PathBuf>,
}

#[derive(Debug, Args)]
pub(crate) struct ExportArguments {
    /// Adapter that the lists are for
    #[arg(long, value_name = "NAME")]
    pub(crate) adapter: String,
    #[command(flatten)]
    pub(crate) file: AdapterFileArguments,
    #[command(flatten)]
    pub(crate) expected: ExpectArguments,
    /// Folder for the lists
    #[arg(long, value_name = "DIR")]
    pub(crate) out: PathBuf,
    /// Replace lists of the same names
    #[arg(long)]
    pub(crate) force: bool,
    /// Read case files from this folder instead of the built-in ones
    #[arg(long, value_name = "DIR")]
    pub(crate) cases: Option<PathBuf>,
}

/// The files of an export: failures, flaky cases and cases to skip.
const LISTS: [&str; 3] = ["fails.txt", "flakes.txt", "skips.txt"];
/// The largest number of unmatched lines that are printed.
const PRINTED: usize = 20;

/// Imports or exports deqp-runner's lists.
pub(crate) fn run(command: &Conversion) -> Result<u8, Failure> {
    match command {
        Conversion::Import(arguments) => import(arguments),
        Conversion::Export(arguments) => export(arguments),
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
    for (list, line) in imported.unmatched.iter().take(PRINTED) {
        say!("{list}: no case matches: {line}");
    }
    let more = imported.unmatched.len().saturating_sub(PRINTED);
    if more > 0 {
        say!("and {more} more lines that match no case");
    }
    if imported.entries.is_empty() {
        return Err(Failure::nothing(
            "the lists contain no bad verdict of a known case",
        ));
    }
    let mut entries = if arguments.out.exists() {
        list(&arguments.out)?
    } else {
        Vec::new()
    };
    let before = entries.len();
    let known: HashSet<Entry> = entries.iter().cloned().collect();
    let new = imported.entries.into_iter();
    entries.extend(new.filter(|entry| !known.contains(entry)));
    let added = entries.len() - before;
    write(&arguments.out, &entries)?;
    summarize(&format!(
        "{added} entries added to {}\n",
        arguments.out.display()
    ));
    Ok(0)
}

/// Returns the entries of a list.
fn list(path: &Path) -> Result<Vec<Entry>, Failure> {
    let known = Expectations::read(path).map_err(Failure::usage)?;
    let entries = known.entries();
    if path.is_dir() || entries.len() < known.all().len() {
        return Err(Failure::usage(format!(
            "{} holds findings; name a list of expectations to add to",
            path.display()
        )));
    }
    Ok(entries)
}

fn export(arguments: &ExportArguments) -> Result<u8, Failure> {
    let out = NamedFiles {
        folder: &arguments.out,
        force: arguments.force,
    };
    out.check(LISTS)?;
    let expected = arguments.expected.read(&[])?;
    let ids = ids(arguments.cases.as_ref())?;
    let name = std::slice::from_ref(&arguments.adapter);
    let adapters = discover(&Query {
        names: name,
        file: arguments.file.adapter_file.as_deref(),
        ..Query::default()
    })?;
    refuse_absent(name, &adapters)?;
    let Some((_, worker)) = adapters.ready.first() else {
        return Err(Failure::nothing("the adapter was not found"));
    };
    let lists = expected.lists(&AdapterRecord::from(worker), &ids);
    let texts = [lists.fails, lists.flakes, lists.skips];
    let lines = texts.each_ref().map(|text| text.lines().count());
    let files: Vec<_> = LISTS
        .map(str::to_owned)
        .into_iter()
        .zip(texts.map(String::into_bytes))
        .collect();
    for (path, lines) in out.write(&files)?.iter().zip(lines) {
        summarize(&format!("{}: {lines} lines\n", path.display()));
    }
    Ok(0)
}
