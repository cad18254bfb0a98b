//! `etalon site`.

use crate::failure::Failure;
use crate::output::summarize;
use clap::Args;
use etalon_report::{ReportError, write_site};
use std::path::PathBuf;

#[derive(Debug, Args)]
pub(crate) struct Arguments {
    /// Folder for the site
    #[arg(value_name = "DIR")]
    pub(crate) to: PathBuf,
    /// Recorded folders whose pages become part of the site: runs with their methods page and case catalogue,
    /// benches, hunts, searches over releases
    #[arg(value_name = "FOLDER", required = true)]
    pub(crate) folders: Vec<PathBuf>,
    /// Include the page that `ci/page` built in this folder, so that visitors can test their own device
    #[arg(long, value_name = "DIR")]
    pub(crate) page: Option<PathBuf>,
    /// Replace the site in the folder
    #[arg(long)]
    pub(crate) force: bool,
}

/// Builds a static site from the pages of recorded folders.
pub(crate) fn run(arguments: &Arguments) -> Result<u8, Failure> {
    let page = arguments.page.as_deref();
    let site = write_site(&arguments.to, &arguments.folders, page, arguments.force);
    let site = site.map_err(|error| match error {
        ReportError::Io { .. } => Failure::incomplete(error),
        other => Failure::usage(other),
    })?;
    summarize(&format!(
        "Site: {}, {} files, {:.1} MB\n",
        site.html.display(),
        site.files,
        site.bytes as f64 / 1e6
    ));
    Ok(0)
}
