//! `etalon mutants`.

use crate::cases::{build, is_measuring, library};
use crate::failure::{Failure, UNEXPECTED};
use crate::flags::{CaseProfile, Format};
use crate::output::{print, print_json, summarize, summarize_json, table_options};
use crate::progress::progress;
use crate::provenance;
use clap::Args;
use etalon_backend::Backend;
use etalon_case::Case;
use etalon_mutants::{MutantBackend, mutants};
use etalon_record::{HUNT_FORMAT, Hunt, MutantInfo};
use etalon_runner::{Globs, HuntPlan};
use std::path::PathBuf;
use std::time::Instant;

#[derive(Debug, Args)]
pub(crate) struct Arguments {
    /// Globs over the names of planted bugs, such as `blend/*`. Default: all
    #[arg(value_name = "GLOB")]
    pub(crate) globs: Vec<String>,
    /// Print names and descriptions only
    #[arg(long)]
    pub(crate) list: bool,
    /// Hunt with the cases that match this glob only; may be repeated
    #[arg(long = "case", value_name = "GLOB")]
    pub(crate) case_globs: Vec<String>,
    /// Share of each family of cases
    #[arg(long, value_enum, default_value = "quick")]
    pub(crate) profile: CaseProfile,
    /// Read case files from this folder instead of the built-in ones
    #[arg(long, value_name = "DIR")]
    pub(crate) cases: Option<PathBuf>,
    /// Draw every case with every bug, instead of leaving an area after the first Fail of a bug
    #[arg(long)]
    pub(crate) full: bool,
    /// Folder for mutants.json and mutants.html
    #[arg(long, value_name = "DIR", default_value = "reports/mutants-latest")]
    pub(crate) out: PathBuf,
    /// Output format
    #[arg(long, value_enum, default_value = "text")]
    pub(crate) format: Format,
}

/// Hunts the selected bugs, or lists them.
pub(crate) fn run(arguments: &Arguments) -> Result<u8, Failure> {
    let chosen = chosen(&arguments.globs)?;
    if arguments.list {
        return list(&chosen, arguments.format);
    }
    let library = library(arguments.cases.as_ref())?;
    let named = !arguments.case_globs.is_empty();
    let cases: Vec<Case> = build(&library, arguments.profile.into(), &arguments.case_globs)?
        .into_iter()
        .filter(|c| c.judged_as.is_none())
        .filter(|c| named || !is_measuring(c))
        .collect();
    if cases.is_empty() {
        return Err(Failure::nothing(format!(
            "no case matches {}; selftests are excluded",
            arguments.case_globs.join(" ")
        )));
    }
    let hunt = hunt(arguments, &cases, &chosen);
    let written = etalon_report::write_hunt(&arguments.out, &hunt).map_err(Failure::incomplete)?;
    if arguments.format == Format::Json {
        summarize_json(&hunt)?;
    } else {
        let options = table_options();
        summarize(&etalon_report::hunt_table(&hunt, options));
        summarize(&format!("\nReport: {}\n", written.html.display()));
    }
    Ok(if hunt.complaints().next().is_some() {
        UNEXPECTED
    } else {
        0
    })
}

/// Returns the bugs of the registry whose names match.
fn chosen(globs: &[String]) -> Result<Vec<MutantInfo>, Failure> {
    let set = Globs::new(globs).map_err(Failure::usage)?;
    let chosen: Vec<MutantInfo> = mutants()
        .iter()
        .filter(|m| set.matches(&m.name))
        .map(|m| MutantInfo {
            name: m.name.clone(),
            about: m.about.clone(),
            source: m.source.to_owned(),
            area: m.area.to_owned(),
            legal: m.legal.map(str::to_owned),
        })
        .collect();
    if chosen.is_empty() {
        return Err(Failure::nothing(format!(
            "no planted bug matches {}; `etalon mutants --list` lists all",
            globs.join(" ")
        )));
    }
    Ok(chosen)
}

fn list(chosen: &[MutantInfo], format: Format) -> Result<u8, Failure> {
    if format == Format::Json {
        print_json(&chosen)?;
        return Ok(0);
    }
    let width = chosen.iter().map(|m| m.name.len()).max().unwrap_or(0);
    let mut text = String::new();
    for mutant in chosen {
        text.push_str(&format!("{:width$}  {}\n", mutant.name, mutant.about));
    }
    print(&text)?;
    Ok(0)
}

fn hunt(arguments: &Arguments, cases: &[Case], chosen: &[MutantInfo]) -> Hunt {
    let jobs = std::thread::available_parallelism().map_or(1, usize::from);
    let bar = progress(cases.len() as u64 * jobs.min(chosen.len()) as u64);
    let started = provenance::now();
    let start = Instant::now();
    let plan = HuntPlan {
        cases,
        mutants: chosen,
        full: arguments.full,
        jobs,
    };
    let open =
        |name: &str| MutantBackend::new(name).map(|backend| Box::new(backend) as Box<dyn Backend>);
    let found = etalon_runner::hunt(plan, &open, &|| bar.inc(1));
    bar.finish_and_clear();
    Hunt {
        format: HUNT_FORMAT,
        etalon: provenance::VERSION.to_owned(),
        commit: provenance::commit(),
        machine: provenance::machine(),
        started,
        command: provenance::command(),
        seconds: start.elapsed().as_secs_f64(),
        cases: cases.len() as u64,
        full: arguments.full,
        mutants: found,
    }
}
