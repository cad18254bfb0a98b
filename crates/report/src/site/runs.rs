//! The recorded folders of a site: their pages, their other files, and their facts on the start page.

use crate::catalogue::CATALOGUE;
use crate::error::ReportError;
use crate::export::deqp;
use crate::files::file_name;
use crate::numbers::{count, thousands};
use etalon_record::{AdapterRecord, Bench, FolderKind, Record, Run, Verdict};
use maud::{Markup, html};
use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

/// Endings of the files that are copied from a folder: pages, and files for other programs.
const ENDINGS: [&str; 7] = ["html", "xml", "json", "md", "csv", "svg", "png"];
/// Subfolders whose files are copied too.
const FOLDERS: [&str; 2] = [CATALOGUE, deqp::FOLDER];

/// One recorded folder.
pub(crate) struct Recorded {
    /// The folder's name in the site.
    pub(crate) name: String,
    /// The folder itself.
    pub(crate) folder: PathBuf,
    /// The copied files, by path below the folder.
    pub(crate) files: BTreeSet<PathBuf>,
    /// The folder's description.
    pub(crate) facts: Facts,
}

/// The facts of a folder on the start page.
#[derive(Default)]
pub(crate) struct Facts {
    pub(crate) started: String,
    /// The number of cases, and the adapters.
    pub(crate) drawn: String,
    pub(crate) result: Markup,
    /// The title of its `index.html`.
    pub(crate) index: &'static str,
}

impl Recorded {
    fn names(&self) -> impl Iterator<Item = &str> {
        self.files.iter().filter_map(|file| file.to_str())
    }

    /// Returns the pages, `index.html` first.
    pub(crate) fn pages(&self) -> Vec<&str> {
        let is_page = |name: &&str| name.ends_with(".html") && !name.contains('/');
        let mut pages: Vec<&str> = self.names().filter(is_page).collect();
        pages.sort_by_key(|name| (*name != "index.html", *name));
        pages
    }

    /// Returns the files other than pages.
    pub(crate) fn beside(&self) -> impl Iterator<Item = &str> {
        let names = self.names();
        names.filter(|name| !name.ends_with(".html") && !name.contains('/'))
    }

    /// Returns the areas whose cases can be shown.
    pub(crate) fn galleries(&self) -> Vec<&str> {
        let scripts = self.names().filter_map(|name| name.strip_suffix(".js"));
        let areas = scripts.filter_map(|name| name.strip_prefix(CATALOGUE)?.strip_prefix('/'));
        areas.collect()
    }
}

/// Reads the facts and files of recorded folders.
///
/// # Errors
/// Returns an error if a folder cannot be read or has no page.
pub(crate) fn collect(folders: &[PathBuf]) -> Result<Vec<Recorded>, ReportError> {
    let mut taken = BTreeSet::new();
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
            Facts {
                drawn: scope(run.header.cases, &run.header.adapters),
                result: result(&run),
                started: run.header.started,
                index: "conformance",
            }
        }
        Some(FolderKind::Bench) => {
            let header = Bench::read(folder)?.header;
            Facts {
                drawn: scope(header.cases, &header.adapters),
                result: html! { "frame times" },
                started: header.started,
                index: "frame times",
            }
        }
        _ => Facts {
            index: "conformance",
            ..Facts::default()
        },
    })
}

fn scope(cases: u64, adapters: &[AdapterRecord]) -> String {
    let cases = match cases {
        1 => "1 case".to_owned(),
        n => format!("{} cases", thousands(n)),
    };
    let names: Vec<&str> = adapters.iter().map(|a| a.name.as_str()).collect();
    match names.len() {
        0..=3 => format!("{cases} on {}", names.join(", ")),
        many => format!("{cases} on {many} adapters"),
    }
}

fn result(run: &Run) -> Markup {
    let count_of =
        |test: &dyn Fn(&Record) -> bool| run.records.iter().filter(|r| test(r)).count() as u64;
    let undrawn = count_of(&|r| r.verdict == Verdict::NotSupported);
    html! {
        @if run.missing() > 0 {
            span.chip.f { (count(run.missing(), "missing record")) } " "
        }
        @match count_of(&Record::unexpected) {
            0 => span.chip.p { "✓ nothing unexpected" },
            n => span.chip.f { "✗ " (thousands(n)) " unexpected" },
        }
        " " (thousands(count_of(&|r| r.verdict == Verdict::Pass))) " of " (thousands(run.records.len() as u64)) " pass"
        @if undrawn > 0 { ", " (thousands(undrawn)) " not supported" }
    }
}

fn files(folder: &Path) -> Result<BTreeSet<PathBuf>, ReportError> {
    let mut files = BTreeSet::new();
    for below in [""].into_iter().chain(FOLDERS) {
        let path = folder.join(below);
        if !below.is_empty() && !path.is_dir() {
            continue;
        }
        for entry in fs::read_dir(&path).map_err(ReportError::unread(&path))? {
            let entry = entry.map_err(ReportError::unread(&path))?;
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

/// Returns a folder's name in the site, which is unique and has only plain letters.
fn name(folder: &Path, taken: &mut BTreeSet<String>) -> String {
    let absolute = fs::canonicalize(folder).unwrap_or_else(|_| folder.to_owned());
    let last = absolute
        .file_name()
        .map_or_else(String::new, |n| n.to_string_lossy().into_owned());
    file_name(&last, "", taken)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_plain_and_differ() {
        let mut taken = BTreeSet::new();
        let mut named = |path: &str| name(Path::new(path), &mut taken);
        assert_eq!(named("/a/nightly"), "nightly");
        assert_eq!(named("/b/nightly"), "nightly-2");
        assert_eq!(named("/b/<script> x"), "_script__x");
        assert_eq!(named("/b/.hidden"), "_hidden");
        assert_eq!(named("/"), "_");
    }
}
