//! `etalon man`.

use crate::failure::Failure;
use crate::output::{print, summarize};
use clap::{Args, Command};
use clap_mangen::{Man, generate_to};
use std::fs;
use std::path::PathBuf;

#[derive(Debug, Args)]
pub(crate) struct Arguments {
    /// Write a page for each command to this folder, instead of printing the first page
    #[arg(long, value_name = "DIR")]
    pub(crate) out: Option<PathBuf>,
}

/// Prints or writes the manual pages of a command.
pub(crate) fn run(arguments: &Arguments, command: Command) -> Result<u8, Failure> {
    let Some(folder) = &arguments.out else {
        let mut page = Vec::new();
        Man::new(command)
            .render(&mut page)
            .map_err(Failure::incomplete)?;
        print(&String::from_utf8_lossy(&page))?;
        return Ok(0);
    };
    fs::create_dir_all(folder)
        .map_err(|e| Failure::usage(format!("cannot create {}: {e}", folder.display())))?;
    generate_to(command, folder)
        .map_err(|e| Failure::incomplete(format!("cannot write to {}: {e}", folder.display())))?;
    summarize(&format!("manual pages written to {}\n", folder.display()));
    Ok(0)
}
