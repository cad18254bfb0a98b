//! Writing a site: beside its place, and renamed into it when it is whole.

use super::docs::{self, Docs};
use super::markdown::Rendered;
use super::runs::{self, Recorded};
use super::start;
use crate::error::ReportError;
use crate::page::Page;
use maud::{PreEscaped, html};
use std::fs;
use std::io;
use std::path::{Path, PathBuf};

/// The file by which a folder is known to be a site.
pub const SITE_FILE: &str = "site.json";
/// All that a site has at its top.
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
    /// Links of documents that lead to nothing in the site and are text there: document and link.
    pub unlinked: Vec<(PathBuf, String)>,
}

/// Writes a site of recorded folders, and of the documents of a checkout where one is given. An earlier site in the
/// folder is replaced if `replace`, and stays as it is if an error is returned.
///
/// # Errors
/// Returns an error if a folder holds no page or lies in the site or around it, a document cannot be read, the site's
/// folder holds something else, or cannot be written to.
pub fn write_site(
    to: &Path,
    folders: &[PathBuf],
    checkout: Option<&Path>,
    replace: bool,
) -> Result<WrittenSite, ReportError> {
    let earlier = earlier(to, replace)?;
    for folder in folders {
        apart(to, folder)?;
    }
    let runs = runs::collect(folders)?;
    let docs = checkout.map(docs::collect).transpose()?;
    let parent = match to.parent() {
        Some(parent) if !parent.as_os_str().is_empty() => parent,
        _ => Path::new("."),
    };
    create(parent)?;
    let Some(name) = to.file_name() else {
        return Err(ReportError::NoFile {
            path: to.to_owned(),
        });
    };
    let beside = parent.join(format!(
        ".{}.{}",
        name.to_string_lossy(),
        std::process::id()
    ));
    let mut site = Site {
        root: beside.clone(),
        files: 0,
        bytes: 0,
    };
    let written = site.fill(&runs, docs.as_ref(), checkout).and_then(|()| {
        if earlier {
            remove(to)?;
        }
        fs::rename(&beside, to).map_err(|source| io_error(to, source))
    });
    if let Err(error) = written {
        // Best effort: the first error is the one to report.
        let _ = fs::remove_dir_all(&beside);
        return Err(error);
    }
    Ok(WrittenSite {
        html: to.join("index.html"),
        files: site.files,
        bytes: site.bytes,
        unlinked: docs.map(|docs| docs.unlinked).unwrap_or_default(),
    })
}

fn io_error(path: &Path, source: io::Error) -> ReportError {
    ReportError::Io {
        path: path.to_owned(),
        source,
    }
}

fn create(folder: &Path) -> Result<(), ReportError> {
    fs::create_dir_all(folder).map_err(|source| io_error(folder, source))
}

fn remove(folder: &Path) -> Result<(), ReportError> {
    fs::remove_dir_all(folder).map_err(|source| io_error(folder, source))
}

/// Returns true if the folder is there and may be replaced.
fn earlier(to: &Path, replace: bool) -> Result<bool, ReportError> {
    let unread = |source| ReportError::Unread {
        path: to.to_owned(),
        source,
    };
    if !to.exists() {
        return Ok(false);
    }
    let mut names = Vec::new();
    for entry in fs::read_dir(to).map_err(unread)? {
        names.push(
            entry
                .map_err(unread)?
                .file_name()
                .to_string_lossy()
                .into_owned(),
        );
    }
    let foreign = names.iter().find(|name| !TOP.contains(&name.as_str()));
    let path = to.to_owned();
    match (
        names.is_empty(),
        names.iter().any(|n| n == SITE_FILE),
        foreign,
    ) {
        (true, ..) => Ok(true),
        (_, true, None) if replace => Ok(true),
        (_, true, None) => Err(ReportError::HasSite { path }),
        (_, true, Some(foreign)) if replace => Err(ReportError::NotOfTheSite {
            path: path.join(foreign),
        }),
        (_, true, _) => Err(ReportError::HasSite { path }),
        _ => Err(ReportError::NoSite { path }),
    }
}

/// A site that holds what it is made from would lose it when it is replaced.
fn apart(to: &Path, folder: &Path) -> Result<(), ReportError> {
    let whole = |path: &Path| fs::canonicalize(path).unwrap_or_else(|_| path.to_owned());
    let (site, folder) = (whole(to), whole(folder));
    if folder.starts_with(&site) || site.starts_with(&folder) {
        return Err(ReportError::Within { site, folder });
    }
    Ok(())
}

/// A site in the making.
struct Site {
    root: PathBuf,
    files: u64,
    bytes: u64,
}

impl Site {
    fn fill(
        &mut self,
        runs: &[Recorded],
        docs: Option<&Docs>,
        checkout: Option<&Path>,
    ) -> Result<(), ReportError> {
        create(&self.root)?;
        for run in runs {
            for file in &run.files {
                self.copy(
                    &run.folder.join(file),
                    &Path::new("runs").join(&run.name).join(file),
                )?;
            }
        }
        if let (Some(docs), Some(checkout)) = (docs, checkout) {
            for (path, page) in &docs.pages {
                let to = Path::new("docs").join(path.with_extension("html"));
                self.write(&to, document(path, page).as_bytes())?;
            }
            for file in &docs.copies {
                self.copy(&checkout.join(file), &Path::new("docs").join(file))?;
            }
        }
        self.write(Path::new("index.html"), start::page(runs, docs).as_bytes())?;
        let kind = serde_json::json!({ "etalon": "site", "format": 1 });
        self.write(Path::new(SITE_FILE), kind.to_string().as_bytes())
    }

    fn place(&self, path: &Path) -> Result<PathBuf, ReportError> {
        let to = self.root.join(path);
        create(to.parent().unwrap_or(&self.root))?;
        Ok(to)
    }

    fn write(&mut self, path: &Path, bytes: &[u8]) -> Result<(), ReportError> {
        let to = self.place(path)?;
        fs::write(&to, bytes).map_err(|source| io_error(&to, source))?;
        self.files += 1;
        self.bytes += bytes.len() as u64;
        Ok(())
    }

    fn copy(&mut self, from: &Path, path: &Path) -> Result<(), ReportError> {
        let bytes = fs::read(from).map_err(|source| ReportError::Unread {
            path: from.to_owned(),
            source,
        })?;
        self.write(path, &bytes)
    }
}

/// The page of a document.
fn document(path: &Path, page: &Rendered) -> String {
    let up = "../".repeat(path.components().count());
    let source = path.display().to_string();
    Page {
        title: &format!("{} – etalon", page.title),
        styles: &[start::STYLE],
        script: None,
        beside: false,
        main: html! {
            nav aria-label="Site" { a href={ (up) "index.html" } { "etalon" } " " code { (source) } }
            article.text { (PreEscaped(&page.html)) }
        },
        source: &source,
    }
    .html()
}
