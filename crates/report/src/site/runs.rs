//! The recorded folders of a site: their pages, made from the records, and their facts on the start page.

use crate::bench::write_bench_to;
use crate::catalogue::{CATALOGUE, Catalogue};
use crate::error::ReportError;
use crate::files::{Destination, file_name};
use crate::hunt::write_hunt_page;
use crate::numbers::{count, thousands};
use crate::run::RunReport;
use crate::staged::Staged;
use crate::versions::write_versions_page;
use etalon_record::{AdapterRecord, Bench, FolderKind, Hunt, Record, Run, Verdict, Versions};
use maud::{Markup, html};
use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

/// Returns the cases of the run in a folder, for the pages of single cases.
pub type CasesOf<'a> = dyn Fn(&Path, &Run) -> Option<Catalogue> + 'a;

/// One recorded folder.
pub(crate) struct RecordedFolder {
    /// The folder's name in the site.
    pub(crate) name: String,
    /// The files, by path below the folder.
    pub(crate) files: BTreeSet<PathBuf>,
    /// The folder's description.
    pub(crate) facts: FolderFacts,
}

/// The facts of a folder on the start page.
#[derive(Default)]
pub(crate) struct FolderFacts {
    pub(crate) started: String,
    /// The number of cases, and the adapters.
    pub(crate) drawn: String,
    pub(crate) result: Markup,
    /// The title of its `index.html`.
    pub(crate) index: &'static str,
}

impl RecordedFolder {
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

/// Writes the pages of recorded folders, made anew from their records.
///
/// # Errors
/// Returns an error if a folder cannot be read or has no page.
pub(crate) fn write(
    site: &Staged,
    folders: &[PathBuf],
    cases_of: &CasesOf<'_>,
) -> Result<Vec<RecordedFolder>, ReportError> {
    let mut taken = BTreeSet::new();
    let write = |folder: &PathBuf| {
        fs::read_dir(folder).map_err(ReportError::unread(folder))?;
        let name = name(folder, &mut taken);
        let to = site.below(Path::new("runs").join(&name));
        Ok(RecordedFolder {
            facts: write_pages(folder, &to, cases_of)?,
            name,
            files: to.names(),
        })
    };
    folders.iter().map(write).collect()
}

/// Writes the pages of a folder, and the files for other programs. Returns its description.
fn write_pages(
    folder: &Path,
    to: &dyn Destination,
    cases_of: &CasesOf<'_>,
) -> Result<FolderFacts, ReportError> {
    Ok(match FolderKind::of(folder) {
        Some(FolderKind::Run) => {
            let run = Run::read(folder)?;
            let catalogue = cases_of(folder, &run);
            let report = RunReport {
                folder,
                run: &run,
                catalogue: catalogue.as_ref(),
                news: None,
                deqp: false,
            };
            report.write_to(to)?;
            FolderFacts {
                drawn: scope(run.header.cases, &run.header.adapters),
                result: result(&run),
                started: run.header.provenance.started,
                index: "conformance",
            }
        }
        Some(FolderKind::Bench) => {
            let bench = Bench::read(folder)?;
            write_bench_to(to, &bench)?;
            let header = bench.header;
            FolderFacts {
                drawn: scope(header.cases, &header.adapters),
                result: html! { "frame times" },
                started: header.provenance.started,
                index: "frame times",
            }
        }
        Some(FolderKind::Versions) => {
            let versions = Versions::read(folder)?;
            write_versions_page(to, &versions)?;
            FolderFacts {
                started: versions.header.provenance.started,
                ..FolderFacts::default()
            }
        }
        Some(FolderKind::Hunt) => {
            let hunt = Hunt::read(folder)?;
            write_hunt_page(to, &hunt)?;
            FolderFacts {
                started: hunt.provenance.started,
                ..FolderFacts::default()
            }
        }
        Some(FolderKind::Fuzz) | None => {
            let path = folder.to_owned();
            return Err(ReportError::NoPage { path });
        }
    })
}

fn scope(cases: u64, adapters: &[AdapterRecord]) -> String {
    let cases = match cases {
        1 => "1 case".to_owned(),
        n => format!("{} cases", thousands(n)),
    };
    let names: Vec<&str> = adapters.iter().map(|a| a.info.name.as_str()).collect();
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
