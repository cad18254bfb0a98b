//! `etalon site`.

use crate::failure::Failure;
use crate::output::{say, summarize};
use clap::Args;
use etalon_report::{ReportError, write_site};
use std::path::PathBuf;

#[derive(Debug, Args)]
pub(crate) struct Arguments {
    /// Folder for the site
    #[arg(value_name = "DIR")]
    pub(crate) to: PathBuf,
    /// Recorded folders whose pages become part of it: runs with their methods page and case catalogue, benches,
    /// hunts, searches over releases
    #[arg(value_name = "FOLDER", required_unless_present = "docs")]
    pub(crate) folders: Vec<PathBuf>,
    /// Checkout of etalon: its README, and the documents and files that it leads to, become part
    #[arg(long, value_name = "CHECKOUT")]
    pub(crate) docs: Option<PathBuf>,
    /// Replace the site in the folder
    #[arg(long)]
    pub(crate) force: bool,
}

/// The number of links that are printed.
const NAMED: usize = 10;

/// Puts the pages of recorded folders and the documents of a checkout into one static folder.
pub(crate) fn run(arguments: &Arguments) -> Result<u8, Failure> {
    let docs = arguments.docs.as_deref();
    let site = write_site(&arguments.to, &arguments.folders, docs, arguments.force);
    let site = site.map_err(|error| match error {
        ReportError::Io { .. } => Failure::incomplete(error),
        other => Failure::usage(other),
    })?;
    for (document, link) in site.unlinked.iter().take(NAMED) {
        say!(
            "{}: the link {link} leads to nothing in the site; its text stays",
            document.display()
        );
    }
    let more = site.unlinked.len().saturating_sub(NAMED);
    if more > 0 {
        say!("and {more} more links");
    }
    summarize(&format!(
        "Site: {}, {} files, {:.1} MB\n",
        site.html.display(),
        site.files,
        site.bytes as f64 / 1e6
    ));
    Ok(0)
}
