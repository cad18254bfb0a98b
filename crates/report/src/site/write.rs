//! Writes a site into a temporary folder, and renames the folder when it is complete.

use super::runs::{self, CasesOf};
use super::start::{self, PAGE};
use crate::error::ReportError;
use crate::staged::{PagesKind, Staged, WrittenFolder};
use etalon_record::overlap;
use serde_json::json;
use std::fs;
use std::path::{Path, PathBuf};

/// The file that marks a folder as a site.
pub const SITE_FILE: &str = "site.json";
/// The kind of a site's folder.
const FOLDER: PagesKind = PagesKind {
    mark: SITE_FILE,
    names: ["site", "site"],
};

/// The file that shows that a folder is such a page.
const MODULE: &str = "etalon.wasm";

/// Writes a site of recorded folders, and of a page for the visitor's device if there is one. The pages are made anew
/// from the records. If `replace` is true, an earlier site in the folder is replaced, unless an error is returned.
///
/// # Errors
/// Returns an error if a folder has no page, contains the site or is inside it, or if the site's folder has
/// other files or cannot be written to.
pub fn write_site(
    to: &Path,
    folders: &[PathBuf],
    page: Option<&Path>,
    cases_of: &CasesOf<'_>,
    replace: bool,
) -> Result<WrittenFolder, ReportError> {
    let site = Staged::begin(to, &FOLDER, replace)?;
    for folder in folders {
        apart(to, folder)?;
    }
    let runs = runs::write(&site, folders, cases_of)?;
    if let Some(page) = page {
        apart(to, page)?;
        for file in page_files(page)? {
            site.write(Path::new(PAGE).join(&file), &read(&page.join(&file))?)?;
        }
    }
    let about = json!({ "etalon": "site", "format": 1 });
    site.finish(start::page(&runs, page.is_some()).as_bytes(), about)
}

/// Refuses a site that contains one of its sources or is inside it: replacing the site would delete the source.
fn apart(to: &Path, folder: &Path) -> Result<(), ReportError> {
    if overlap(to, folder) {
        return Err(ReportError::Within {
            site: to.to_owned(),
            folder: folder.to_owned(),
        });
    }
    Ok(())
}

/// Returns the names of the files of a page that `ci/page` built.
fn page_files(page: &Path) -> Result<Vec<PathBuf>, ReportError> {
    if !page.join(MODULE).is_file() {
        return Err(ReportError::NoPage {
            path: page.to_owned(),
        });
    }
    let mut names = Vec::new();
    for entry in fs::read_dir(page).map_err(ReportError::unread(page))? {
        let name = PathBuf::from(entry.map_err(ReportError::unread(page))?.file_name());
        let extension = name.extension().and_then(|extension| extension.to_str());
        if extension.is_some_and(|e| ["css", "html", "js", "wasm"].contains(&e)) {
            names.push(name);
        }
    }
    names.sort();
    Ok(names)
}

fn read(path: &Path) -> Result<Vec<u8>, ReportError> {
    fs::read(path).map_err(ReportError::unread(path))
}
