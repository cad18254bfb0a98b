//! `etalon site`.

use crate::catalogue::{catalogue_of, draws_built_in};
use crate::failure::Failure;
use crate::output::summarize;
use crate::saved_run::UnpackArguments;
use clap::Args;
use etalon_record::Run;
use etalon_report::write_site;
use std::path::{Path, PathBuf};

#[derive(Debug, Args)]
pub(crate) struct Arguments {
    /// Folder for the site
    #[arg(value_name = "DIR")]
    pub(crate) to: PathBuf,
    /// Recorded folders whose pages become part of the site, made anew from the records: runs with their methods
    /// page and cases, benches, hunts, searches over releases; and saved runs (`*.tar.gz`)
    #[arg(value_name = "FOLDER", required = true)]
    pub(crate) folders: Vec<PathBuf>,
    /// Include the page that `ci/page` built in this folder, so that visitors can test their own device
    #[arg(long, value_name = "DIR")]
    pub(crate) page: Option<PathBuf>,
    #[command(flatten)]
    pub(crate) unpack: UnpackArguments,
    /// Replace the site in the folder
    #[arg(long)]
    pub(crate) force: bool,
}

/// Builds a static site from the pages of recorded folders.
pub(crate) fn run(arguments: &Arguments) -> Result<u8, Failure> {
    let page = arguments.page.as_deref();
    let folders = arguments.unpack.folders(&arguments.folders)?;
    // A case file that cannot be read any more costs the pages of single cases only.
    let cases_of = |_: &Path, run: &Run| {
        let built_in = draws_built_in(&run.header);
        built_in.then(|| catalogue_of(run, None).ok()).flatten()
    };
    let site = write_site(&arguments.to, &folders, page, &cases_of, arguments.force);
    let site = site.map_err(Failure::of)?;
    summarize(&format!(
        "Site: {}, {} files, {:.1} MB\n",
        site.html.display(),
        site.files,
        site.bytes as f64 / 1e6
    ));
    Ok(0)
}
