//! `etalon expectations` and `etalon run --bless`.

use crate::adapters::{Wanted, discover};
use crate::args::{ExpectationsCommand, ExportArguments, ImportArguments};
use crate::commands::run::{expectations, today};
use crate::commands::{build, library, refuse_absent};
use crate::failure::Failure;
use crate::output::print;
use etalon_case::Profile;
use etalon_record::{
    About, AdapterRecord, Entry, Expectations, Imported, ListKind, RecordError, Run,
};
use std::fs;
use std::path::{Path, PathBuf};

/// The file that is blessed where none is named.
const DEFAULT: &str = "ci/expectations.json";
/// How many lines that name nothing are told.
const TOLD: usize = 20;

/// Exchanges expectations with deqp-runner.
pub(crate) fn run(command: &ExpectationsCommand) -> Result<u8, Failure> {
    match command {
        ExpectationsCommand::Import(arguments) => import(arguments),
        ExpectationsCommand::Export(arguments) => export(arguments),
    }
}

/// The ids of all cases there are.
fn ids(cases: Option<&PathBuf>) -> Result<Vec<String>, Failure> {
    let library = library(cases)?;
    let all = build(&library, Profile::Full, &[])?;
    Ok(all.into_iter().map(|case| case.id).collect())
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
    let expected = expectations(arguments.expect.as_deref())?.on(&today());
    let ids = ids(arguments.cases.as_ref())?;
    let name = std::slice::from_ref(&arguments.adapter);
    let adapters = discover(&Wanted {
        names: name,
        file: arguments.file.adapter_file.as_deref(),
        ..Wanted::default()
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

/// The file that `--bless` is to write.
///
/// # Errors
/// In CI, which never writes what it is held against, and where no file is named or found.
pub(crate) fn to_bless(named: Option<&Path>) -> Result<PathBuf, Failure> {
    let ci = std::env::var("CI").unwrap_or_default();
    if !matches!(ci.to_lowercase().as_str(), "" | "0" | "false" | "no") {
        return Err(Failure::usage(
            "--bless writes what runs are held against, which CI never does (the variable CI is set); \
             bless on your own machine and have the change reviewed",
        ));
    }
    match named {
        Some(path) => Ok(path.to_owned()),
        None if Path::new(DEFAULT).is_file() => Ok(PathBuf::from(DEFAULT)),
        None => Err(Failure::usage(format!(
            "there is no {DEFAULT} here; name the file to write with --expect"
        ))),
    }
}

/// Writes into the file what a run showed.
pub(crate) fn bless(
    path: &Path,
    run: &Run,
    expected: &Expectations,
    cases: Option<&PathBuf>,
    all_adapters: bool,
) -> Result<(), Failure> {
    let ids = ids(cases)?;
    let blessing = expected.bless(run, &ids, all_adapters, &today());
    write(path, &blessing.entries)?;
    eprintln!(
        "{}: {} entries added, {} removed",
        path.display(),
        blessing.added,
        blessing.removed.len()
    );
    if blessing.added > 0 {
        eprintln!("each new entry wants its reason written before it is reviewed");
    }
    for entry in &blessing.to_narrow {
        eprintln!(
            "to narrow by hand: some of what it names is better now: {} {} {}",
            entry.adapter, entry.verdict, entry.case
        );
    }
    if blessing.unblessed > 0 {
        eprintln!(
            "{} selftests that do not fail cannot be blessed",
            blessing.unblessed
        );
    }
    Ok(())
}

fn write(path: &Path, entries: &[Entry]) -> Result<(), Failure> {
    let text = Expectations::to_text(entries).map_err(Failure::usage)?;
    // What cannot be read again must not take the place of what can.
    Expectations::parse(&text, path).map_err(|error: RecordError| Failure::usage(error))?;
    replace(path, &text)
}

/// Writes a file beside its place and renames it.
fn replace(path: &Path, text: &str) -> Result<(), Failure> {
    let mut beside = path.as_os_str().to_owned();
    beside.push(format!(".{}", std::process::id()));
    let beside = PathBuf::from(beside);
    let written = fs::write(&beside, text).and_then(|()| fs::rename(&beside, path));
    written.map_err(|e| {
        // Best effort: the first error is the one to tell.
        let _ = fs::remove_file(&beside);
        Failure::incomplete(format!("cannot write {}: {e}", path.display()))
    })
}
