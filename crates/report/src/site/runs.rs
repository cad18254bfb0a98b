//! The recorded folders of a site: their pages, the files beside them, and what the start page tells of them.

use crate::catalogue::CATALOGUE;
use crate::error::ReportError;
use crate::export::deqp;
use etalon_record::{Bench, FolderKind, Run, Verdict};
use std::collections::{BTreeSet, HashSet};
use std::fs;
use std::path::{Path, PathBuf};

/// Endings of the files of a folder that take part: pages, and what other programs read.
const ENDINGS: [&str; 7] = ["html", "xml", "json", "md", "csv", "svg", "png"];
/// Folders whose files do.
const FOLDERS: [&str; 2] = [CATALOGUE, deqp::FOLDER];

/// One recorded folder.
pub(crate) struct Recorded {
    /// Its name in the site.
    pub(crate) name: String,
    /// The folder itself.
    pub(crate) folder: PathBuf,
    /// The files that are copied, by path below the folder.
    pub(crate) files: BTreeSet<PathBuf>,
    /// Its description.
    pub(crate) facts: Facts,
}

/// The kind of a folder's content.
pub(crate) enum Facts {
    /// A run.
    Run(RunFacts),
    /// A bench: start, cases, adapters.
    Bench(String, u64, Vec<String>),
    /// Pages of something else.
    Other,
}

/// A run in numbers.
pub(crate) struct RunFacts {
    pub(crate) started: String,
    pub(crate) cases: u64,
    pub(crate) adapters: Vec<String>,
    pub(crate) records: u64,
    pub(crate) missing: u64,
    pub(crate) unexpected: u64,
    pub(crate) passed: u64,
    pub(crate) undrawn: u64,
}

impl Recorded {
    /// The pages, `index.html` first.
    pub(crate) fn pages(&self) -> Vec<&str> {
        let names = self.files.iter().filter_map(|file| file.to_str());
        let mut pages: Vec<&str> = names
            .filter(|name| name.ends_with(".html") && !name.contains('/'))
            .collect();
        pages.sort_by_key(|name| (*name != "index.html", *name));
        pages
    }

    /// The files beside the pages.
    pub(crate) fn beside(&self) -> impl Iterator<Item = &str> {
        let names = self.files.iter().filter_map(|file| file.to_str());
        names.filter(|name| !name.ends_with(".html") && !name.contains('/'))
    }

    /// The areas whose cases can be seen.
    pub(crate) fn galleries(&self) -> Vec<&str> {
        let names = self.files.iter().filter_map(|file| file.to_str());
        names
            .filter_map(|name| {
                name.strip_prefix(CATALOGUE)?
                    .strip_prefix('/')?
                    .strip_suffix(".js")
            })
            .collect()
    }
}

/// Looks at recorded folders.
///
/// # Errors
/// Returns an error if one cannot be read, or holds no page.
pub(crate) fn collect(folders: &[PathBuf]) -> Result<Vec<Recorded>, ReportError> {
    let mut taken = HashSet::new();
    folders
        .iter()
        .map(|folder| {
            let files = files(folder)?;
            let recorded = Recorded {
                name: name(folder, &mut taken),
                folder: folder.clone(),
                facts: facts(folder)?,
                files,
            };
            if recorded.pages().is_empty() {
                let path = folder.clone();
                return Err(ReportError::NoPage { path });
            }
            Ok(recorded)
        })
        .collect()
}

fn facts(folder: &Path) -> Result<Facts, ReportError> {
    Ok(match FolderKind::of(folder) {
        Some(FolderKind::Run) => {
            let run = Run::read(folder)?;
            let count =
                |verdict| run.records.iter().filter(|r| r.verdict == verdict).count() as u64;
            Facts::Run(RunFacts {
                started: run.header.started.clone(),
                cases: run.header.cases,
                adapters: run.header.adapters.iter().map(|a| a.name.clone()).collect(),
                records: run.records.len() as u64,
                missing: run.missing(),
                unexpected: run.records.iter().filter(|r| r.unexpected()).count() as u64,
                passed: count(Verdict::Pass),
                undrawn: count(Verdict::NotSupported),
            })
        }
        Some(FolderKind::Bench) => {
            let header = Bench::read(folder)?.header;
            let adapters = header.adapters.iter().map(|a| a.name.clone()).collect();
            Facts::Bench(header.started, header.cases, adapters)
        }
        _ => Facts::Other,
    })
}

fn files(folder: &Path) -> Result<BTreeSet<PathBuf>, ReportError> {
    let mut files = BTreeSet::new();
    for below in [""].into_iter().chain(FOLDERS) {
        let path = folder.join(below);
        if !below.is_empty() && !path.is_dir() {
            continue;
        }
        let unread = |source| ReportError::Unread {
            path: path.clone(),
            source,
        };
        for entry in fs::read_dir(&path).map_err(unread)? {
            let entry = entry.map_err(unread)?;
            let name = PathBuf::from(entry.file_name());
            let ending = name.extension().and_then(|e| e.to_str());
            let takes = match below {
                CATALOGUE => ending == Some("js"),
                _ => ending.is_some_and(|e| ENDINGS.contains(&e)),
            };
            let hidden = name.to_str().is_none_or(|name| name.starts_with('.'));
            if takes && !hidden && entry.path().is_file() {
                files.insert(Path::new(below).join(name));
            }
        }
    }
    Ok(files)
}

/// Returns a folder's name in the site: in plain letters, and its own.
fn name(folder: &Path, taken: &mut HashSet<String>) -> String {
    let whole = fs::canonicalize(folder).unwrap_or_else(|_| folder.to_owned());
    let last = whole
        .file_name()
        .map_or_else(String::new, |n| n.to_string_lossy().into_owned());
    let plain = |c: char| {
        let keeps = c.is_ascii_alphanumeric() || matches!(c, '-' | '_' | '.');
        if keeps { c } else { '_' }
    };
    let word: String = last.trim_start_matches('.').chars().map(plain).collect();
    let word = if word.is_empty() {
        "run".to_owned()
    } else {
        word
    };
    let numbered = (2..).map(|n| format!("{word}-{n}"));
    let mut names = std::iter::once(word.clone()).chain(numbered);
    names
        .find(|name| taken.insert(name.clone()))
        .unwrap_or(word)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_plain_and_differ() {
        let mut taken = HashSet::new();
        let mut named = |path: &str| name(Path::new(path), &mut taken);
        assert_eq!(named("/a/nightly"), "nightly");
        assert_eq!(named("/b/nightly"), "nightly-2");
        assert_eq!(named("/b/<script> x"), "_script__x");
        assert_eq!(named("/b/.hidden"), "hidden");
        assert_eq!(named("/"), "run");
    }
}
