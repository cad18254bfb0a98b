//! `etalon merge`.

use crate::catalogue::{catalogue_of, draws_built_in};
use crate::failure::{Failure, IMPROVED, INCOMPLETE, UNEXPECTED};
use crate::flags::OutputFormat;
use crate::news::{NewsArguments, shown};
use crate::out_folder::Out;
use crate::output::{print_json, say, summarize, table_options};
use crate::saved_run::UnpackArguments;
use crate::{idle, provenance};
use clap::Args;
use etalon_record::{FolderKind, MISSING_FILE, Merge, Merged, Run};
use etalon_report::{Catalogue, RunNews, RunReport};
use serde_json::json;
use std::fs;
use std::path::{Path, PathBuf};

#[derive(Debug, Args)]
pub(crate) struct Arguments {
    /// Run folders of one selection of cases, and runs that the page saved (`*.tar.gz`)
    #[arg(value_name = "DIR", required = true)]
    pub(crate) folders: Vec<PathBuf>,
    /// Folder for the merged run
    #[arg(long, value_name = "DIR")]
    pub(crate) out: PathBuf,
    /// Replace the run or bench in the folder
    #[arg(long)]
    pub(crate) force: bool,
    #[command(flatten)]
    pub(crate) unpack: UnpackArguments,
    #[command(flatten)]
    pub(crate) news: NewsArguments,
    /// Output format
    #[arg(long, value_enum, default_value = "text")]
    pub(crate) format: OutputFormat,
}

/// The largest number of missing records that are printed.
const NAMED: usize = 20;

/// Merges runs into one and lists the missing records.
pub(crate) fn run(arguments: &Arguments) -> Result<u8, Failure> {
    arguments.news.check()?;
    let out = &arguments.out;
    refuse_part(arguments)?;
    let folders = arguments.unpack.folders(&arguments.folders)?;
    let mut merge = Merge::read(&folders).map_err(Failure::usage)?;
    let built_in = draws_built_in(merge.header_mut());
    merge.header_mut().provenance.command = provenance::command();
    let claim = Out {
        folder: out,
        kind: FolderKind::Run,
        latest: None,
        cases: None,
        resume: None,
        force: arguments.force,
    }
    .claim()?;
    let _lock = claim.take()?;
    let merged = merge.write(out).map_err(Failure::incomplete)?;
    let run = Run::read(out).map_err(Failure::incomplete)?;
    let catalogue = if built_in {
        Some(catalogue_of(&run, None)?)
    } else {
        None
    };
    let news = arguments.news.news(&run)?;
    print(arguments, &merged, &run, catalogue.as_ref(), news.as_ref())?;
    print_overlap(&merged);
    if !merged.missing.is_empty() || !merged.empty.is_empty() {
        return Err(Failure::incomplete(holes(&merged, out)));
    }
    arguments.news.tell_how_to_add(out);
    let unexpected = news.map_or(merged.unexpected, |news| news.counted(&run));
    let idle = idle::report(&run);
    Ok(if unexpected > 0 {
        UNEXPECTED
    } else if idle {
        INCOMPLETE
    } else if merged.improvements > 0 {
        IMPROVED
    } else {
        0
    })
}

/// Refuses to replace one of the parts.
fn refuse_part(arguments: &Arguments) -> Result<(), Failure> {
    let out = &arguments.out;
    if arguments.folders.iter().any(|folder| same(folder, out)) {
        return Err(Failure::usage(format!(
            "{} is one of the parts; choose another --out",
            out.display()
        )));
    }
    Ok(())
}

/// Writes the pages of a merged run, and prints its summary.
fn print(
    arguments: &Arguments,
    merged: &Merged,
    run: &Run,
    catalogue: Option<&Catalogue>,
    news: Option<&RunNews>,
) -> Result<(), Failure> {
    let out = &arguments.out;
    let shown = shown(run, news);
    let written = RunReport {
        folder: out,
        run: &shown,
        catalogue,
        news,
        deqp: false,
    }
    .write()
    .map_err(Failure::incomplete)?;
    if arguments.format == OutputFormat::Json {
        let pair = |(adapter, case): &(String, String)| json!({"adapter": adapter, "case": case});
        return print_json(&json!({
            "records": merged.records,
            "missing": merged.missing.iter().map(pair).collect::<Vec<_>>(),
            "empty": merged.empty,
            "twice": merged.twice,
            "disagreeing": merged.disagreeing.iter().map(pair).collect::<Vec<_>>(),
            "unexpected": merged.unexpected,
            "beside": run.beside,
            "improvements": merged.improvements,
            "news": news,
            "folder": out,
            "report": written.html,
        }));
    }
    if let Some(news) = news {
        summarize(&etalon_report::news_table(news, table_options()));
    }
    summarize(&etalon_report::table(&shown, table_options()));
    summarize(&format!("\nReport: {}\n", written.html.display()));
    summarize(&format!("{}\n", etalon_report::conclusion(&shown)));
    Ok(())
}

/// Returns true if both paths name the same folder.
fn same(folder: &Path, other: &Path) -> bool {
    match (fs::canonicalize(folder), fs::canonicalize(other)) {
        (Ok(folder), Ok(other)) => folder == other,
        _ => folder == other,
    }
}

fn print_overlap(merged: &Merged) {
    if merged.twice > 0 {
        say!(
            "{} records are in more than one part, with the same verdict; one of each was kept",
            merged.twice
        );
    }
    for (adapter, case) in merged.disagreeing.iter().take(NAMED) {
        say!("flaky: the parts disagree on {case} on {adapter}");
    }
}

fn holes(merged: &Merged, out: &Path) -> String {
    let mut text = String::new();
    for folder in &merged.empty {
        text.push_str(&format!("{} contains no run\n", folder.display()));
    }
    for (adapter, case) in merged.missing.iter().take(NAMED) {
        text.push_str(&format!("missing: {adapter} {case}\n"));
    }
    let more = merged.missing.len().saturating_sub(NAMED);
    if more > 0 {
        let file = out.join(MISSING_FILE);
        text.push_str(&format!("and {more} more, in {}\n", file.display()));
    }
    format!(
        "the merged run is incomplete: {} records are missing\n{}",
        merged.missing.len(),
        text.trim_end()
    )
}
