//! `etalon diff`.

use crate::args::{DiffArguments, DiffTime, Format};
use crate::failure::{Failure, UNEXPECTED};
use crate::output::{print, print_json, table_options};
use etalon_record::{Bench, FolderKind, Time};
use std::path::Path;

/// Says what became faster or slower from one bench to another.
pub(crate) fn run(arguments: &DiffArguments) -> Result<u8, Failure> {
    let before = bench(&arguments.before)?;
    let after = bench(&arguments.after)?;
    let diff = etalon_report::diff(&before, &after, arguments.time.into());
    if diff.changes.is_empty() && diff.gone.is_empty() {
        return Err(Failure::nothing(format!(
            "neither bench has a {} time",
            diff.time
        )));
    }
    let page = match &arguments.out {
        Some(path) => Some(etalon_report::write_diff(path, &diff).map_err(Failure::incomplete)?),
        None => None,
    };
    if arguments.format == Format::Json {
        print_json(&diff)?;
    } else {
        let options = table_options();
        print(&etalon_report::diff_table(&diff, options))?;
        if let Some(page) = page {
            print(&format!("\nReport: {}\n", page.display()))?;
        }
    }
    Ok(if diff.worse() { UNEXPECTED } else { 0 })
}

fn bench(folder: &Path) -> Result<Bench, Failure> {
    if FolderKind::of(folder) == Some(FolderKind::Run) {
        return Err(Failure::usage(format!(
            "{} holds a run of verdicts; diff compares two benches, folders that `etalon bench --out` \
             wrote, and no runs yet",
            folder.display()
        )));
    }
    Bench::read(folder).map_err(Failure::usage)
}

impl From<DiffTime> for Time {
    fn from(time: DiffTime) -> Self {
        match time {
            DiffTime::Wall => Self::Wall,
            DiffTime::Cpu => Self::Cpu,
            DiffTime::Gpu => Self::Gpu,
            DiffTime::ReadBack => Self::ReadBack,
            DiffTime::Prepare => Self::Prepare,
            DiffTime::First => Self::First,
        }
    }
}
