//! Writing a site: beside its place, and renamed into it when it is whole.

use super::runs;
use super::start;
use crate::error::ReportError;
use crate::staged::{Kind, Staged, WrittenFolder};
use etalon_record::overlap;
use serde_json::json;
use std::fs;
use std::path::{Path, PathBuf};

/// The file by which a folder is known to be a site.
pub const SITE_FILE: &str = "site.json";
/// The kind of its folder. `docs` was part of earlier ones.
const FOLDER: Kind = Kind {
    mark: SITE_FILE,
    top: &["index.html", "runs", "docs"],
    names: ["site", "site"],
};

/// Writes a site of recorded folders. An earlier site in the folder is replaced if `replace`, and stays as it is if an
/// error is returned.
///
/// # Errors
/// Returns an error if a folder holds no page or lies in the site or around it, the site's folder holds something else,
/// or cannot be written to.
pub fn write_site(
    to: &Path,
    folders: &[PathBuf],
    replace: bool,
) -> Result<WrittenFolder, ReportError> {
    let mut site = Staged::begin(to, &FOLDER, replace)?;
    for folder in folders {
        apart(to, folder)?;
    }
    let runs = runs::collect(folders)?;
    for run in &runs {
        for file in &run.files {
            let to = Path::new("runs").join(&run.name).join(file);
            site.write(to, &read(&run.folder.join(file))?)?;
        }
    }
    let about = json!({ "etalon": "site", "format": 1 });
    site.finish(start::page(&runs).as_bytes(), about)
}

/// A site that holds what it is made from would lose it when it is replaced.
fn apart(to: &Path, folder: &Path) -> Result<(), ReportError> {
    if overlap(to, folder) {
        return Err(ReportError::Within {
            site: to.to_owned(),
            folder: folder.to_owned(),
        });
    }
    Ok(())
}

fn read(path: &Path) -> Result<Vec<u8>, ReportError> {
    fs::read(path).map_err(ReportError::unread(path))
}
