//! `etalon report`.

use crate::failure::Failure;
use crate::output::{print, table_options};
use clap::Args;
use etalon_record::{Bench, FolderKind, Run};
use etalon_report::TableOptions;
use std::path::{Path, PathBuf};

#[derive(Debug, Args)]
pub(crate) struct Arguments {
    /// Run and bench folders
    #[arg(value_name = "DIR", required = true)]
    pub(crate) folders: Vec<PathBuf>,
}

/// Rebuilds the reports of run and bench folders from the folders alone.
pub(crate) fn run(arguments: &Arguments) -> Result<u8, Failure> {
    let options = table_options();
    for folder in &arguments.folders {
        match FolderKind::of(folder) {
            Some(FolderKind::Bench) => bench(folder, options)?,
            // A folder that is neither is reported as a missing run.
            Some(FolderKind::Run) | None => of_run(folder, options)?,
        }
    }
    Ok(0)
}

fn of_run(folder: &Path, options: TableOptions) -> Result<(), Failure> {
    let run = Run::read(folder).map_err(Failure::usage)?;
    let written = etalon_report::write(folder).map_err(Failure::usage)?;
    print(&etalon_report::table(&run, options))?;
    print("\n")?;
    for path in written.all() {
        print(&format!("{}\n", path.display()))?;
    }
    Ok(())
}

fn bench(folder: &Path, options: TableOptions) -> Result<(), Failure> {
    let bench = Bench::read(folder).map_err(Failure::usage)?;
    let written = etalon_report::write_bench(folder).map_err(Failure::usage)?;
    print(&etalon_report::bench_table(&bench, options))?;
    for path in [written.html, written.bencher, written.action] {
        print(&format!("{}\n", path.display()))?;
    }
    Ok(())
}
