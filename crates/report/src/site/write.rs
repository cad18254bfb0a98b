//! Writing a site: beside its place, and renamed into it when it is whole.

use super::runs::{self, Recorded};
use super::start;
use crate::error::ReportError;
use crate::staged::{Content, Staged};
use etalon_record::overlap;
use serde_json::json;
use std::fs;
use std::path::{Path, PathBuf};

/// The file by which a folder is known to be a site.
pub const SITE_FILE: &str = "site.json";
/// All that a site has at its top.
/// `docs` was part of earlier ones.
const TOP: [&str; 4] = ["index.html", "runs", "docs", SITE_FILE];

/// A site that was written.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct WrittenSite {
    /// The start page.
    pub html: PathBuf,
    /// The number of files.
    pub files: u64,
    /// Their bytes.
    pub bytes: u64,
}

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
) -> Result<WrittenSite, ReportError> {
    let path = to.to_owned();
    match Content::of(to, SITE_FILE, &TOP)? {
        Content::Empty => {}
        Content::Earlier if replace => {}
        Content::Foreign(path) if replace => return Err(ReportError::NotOfTheSite { path }),
        Content::Earlier | Content::Foreign(_) => return Err(ReportError::HasSite { path }),
        Content::Other => return Err(ReportError::NoSite { path }),
    }
    for folder in folders {
        apart(to, folder)?;
    }
    let runs = runs::collect(folders)?;
    let mut site = Staged::begin(to)?;
    fill(&mut site, &runs)?;
    site.finish(SITE_FILE, json!({ "etalon": "site", "format": 1 }))?;
    Ok(WrittenSite {
        html: to.join("index.html"),
        files: site.files,
        bytes: site.bytes,
    })
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

fn fill(site: &mut Staged, runs: &[Recorded]) -> Result<(), ReportError> {
    for run in runs {
        for file in &run.files {
            let to = Path::new("runs").join(&run.name).join(file);
            site.write(to, &read(&run.folder.join(file))?)?;
        }
    }
    site.write("index.html", start::page(runs).as_bytes())
}

fn read(path: &Path) -> Result<Vec<u8>, ReportError> {
    fs::read(path).map_err(|source| ReportError::Unread {
        path: path.to_owned(),
        source,
    })
}
