//! `etalon man`.

use crate::failure::Failure;
use crate::named_files::NamedFiles;
use crate::output::{print, summarize};
use clap::{Args, Command};
use clap_mangen::Man;
use std::path::PathBuf;

#[derive(Debug, Args)]
pub(crate) struct Arguments {
    /// Write a page for each command to this folder, instead of printing the first page
    #[arg(long, value_name = "DIR")]
    pub(crate) out: Option<PathBuf>,
    /// Replace pages of the same names
    #[arg(long, requires = "out")]
    pub(crate) force: bool,
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
    let mut command = command.disable_help_subcommand(true);
    command.build();
    let mut pages = Vec::new();
    add_pages(&command, &mut pages)?;
    NamedFiles {
        folder,
        force: arguments.force,
    }
    .write(&pages)?;
    summarize(&format!("manual pages written to {}\n", folder.display()));
    Ok(0)
}

/// Adds the pages of a command's commands, then its own: the name of each file and its text.
fn add_pages(command: &Command, pages: &mut Vec<(String, Vec<u8>)>) -> Result<(), Failure> {
    for below in command.get_subcommands().filter(|c| !c.is_hide_set()) {
        add_pages(below, pages)?;
    }
    let man = Man::new(command.clone());
    let mut page = Vec::new();
    man.render(&mut page).map_err(Failure::incomplete)?;
    pages.push((man.get_filename(), page));
    Ok(())
}
