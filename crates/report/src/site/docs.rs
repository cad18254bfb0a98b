//! The documents of a checkout: those that its README leads to, and what they link to.

use super::markdown::{Rendered, Target, anchors, render};
use crate::error::ReportError;
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use std::collections::{BTreeMap, BTreeSet, HashMap, VecDeque};
use std::fs;
use std::path::{Component, Path, PathBuf};

/// The document that all others are found from.
const FIRST: &str = "README.md";

/// Documents as pages, and the files that they link to.
#[derive(Default)]
pub(crate) struct Docs {
    /// By path below the checkout, in order of it.
    pub(crate) pages: BTreeMap<PathBuf, Rendered>,
    /// Files that are copied as they are, by path below the checkout.
    pub(crate) copies: BTreeSet<PathBuf>,
    /// Links that lead to nothing in the site: document and link.
    pub(crate) unlinked: Vec<(PathBuf, String)>,
}

/// Reads the documents of a checkout.
///
/// # Errors
/// Returns an error if a document cannot be read.
pub(crate) fn collect(root: &Path) -> Result<Docs, ReportError> {
    let mut docs = Docs::default();
    let mut texts = HashMap::new();
    let mut coming = VecDeque::from([PathBuf::from(FIRST)]);
    while let Some(document) = coming.pop_front() {
        if docs.pages.contains_key(&document) {
            continue;
        }
        let text = text_of(root, &document, &mut texts)?.to_owned();
        let mut failed = None;
        let rendered = render(&text, |link, picture| {
            let place = resolve(root, &document, link, picture);
            let target = match place {
                Ok(Place::Away) => Target::To(link.to_owned()),
                Ok(Place::Picture(uri)) => Target::To(uri),
                Ok(Place::Copy(file)) => {
                    docs.copies.insert(file);
                    Target::To(link.to_owned())
                }
                Ok(Place::Document(other, anchor)) => match text_of(root, &other, &mut texts) {
                    Ok(text) if anchor.is_empty() || anchors(text).contains(&anchor) => {
                        coming.push_back(other);
                        Target::To(page_of(link, &anchor))
                    }
                    Ok(_) => Target::Text,
                    Err(error) => {
                        failed = Some(error);
                        Target::Text
                    }
                },
                Err(Unlinked) => Target::Text,
            };
            if target == Target::Text {
                docs.unlinked.push((document.clone(), link.to_owned()));
            }
            target
        });
        if let Some(error) = failed {
            return Err(error);
        }
        docs.pages.insert(document, rendered);
    }
    Ok(docs)
}

fn text_of<'t>(
    root: &Path,
    document: &Path,
    texts: &'t mut HashMap<PathBuf, String>,
) -> Result<&'t str, ReportError> {
    if !texts.contains_key(document) {
        let path = root.join(document);
        let text = match fs::read_to_string(&path) {
            Ok(text) => text,
            Err(source) => return Err(ReportError::Unread { path, source }),
        };
        texts.insert(document.to_owned(), text);
    }
    Ok(&texts[document])
}

/// The page of a linked document, relative as the link is.
fn page_of(link: &str, anchor: &str) -> String {
    let path = link.split('#').next().unwrap_or_default();
    let page = match path {
        "" => String::new(),
        path => {
            let file = Path::new(path).with_extension("html");
            file.display().to_string()
        }
    };
    match anchor {
        "" => page,
        anchor => format!("{page}#{anchor}"),
    }
}

/// The destination of a link.
enum Place {
    /// Another site.
    Away,
    /// A document, and the anchor in it; empty for its beginning.
    Document(PathBuf, String),
    /// Any other file of the checkout.
    Copy(PathBuf),
    /// A picture, as a `data:` address.
    Picture(String),
}

/// A link that leads to nothing that a site can have.
struct Unlinked;

fn resolve(root: &Path, document: &Path, link: &str, picture: bool) -> Result<Place, Unlinked> {
    if link.contains("://") || link.starts_with("mailto:") {
        // The policy of the pages loads nothing from elsewhere.
        return if picture {
            Err(Unlinked)
        } else {
            Ok(Place::Away)
        };
    }
    let (path, anchor) = link.split_once('#').unwrap_or((link, ""));
    let target = match path {
        "" => document.to_owned(),
        path => below(document.parent().unwrap_or(Path::new("")), path).ok_or(Unlinked)?,
    };
    let file = root.join(&target);
    if !file.is_file() {
        return Err(Unlinked);
    }
    match target.extension().and_then(|e| e.to_str()) {
        Some("png") if picture => {
            let bytes = fs::read(&file).map_err(|_| Unlinked)?;
            let uri = format!("data:image/png;base64,{}", STANDARD.encode(bytes));
            Ok(Place::Picture(uri))
        }
        _ if picture => Err(Unlinked),
        Some("md") => Ok(Place::Document(target, anchor.to_owned())),
        _ => Ok(Place::Copy(target)),
    }
}

/// Joins a relative path to a folder of the checkout; `None` if it leads out of it.
fn below(folder: &Path, path: &str) -> Option<PathBuf> {
    let mut joined = folder.to_owned();
    for part in Path::new(path).components() {
        match part {
            Component::Normal(name) => joined.push(name),
            Component::CurDir => {}
            Component::ParentDir => {
                if !joined.pop() {
                    return None;
                }
            }
            Component::RootDir | Component::Prefix(_) => return None,
        }
    }
    Some(joined)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn documents_are_found_by_their_links_and_what_leads_nowhere_is_named() {
        let root = tempfile::tempdir().unwrap();
        let write = |path: &str, text: &str| {
            let path = root.path().join(path);
            fs::create_dir_all(path.parent().unwrap()).unwrap();
            fs::write(path, text).unwrap();
        };
        write(
            "README.md",
            "# Top\n[a](sub/a.md#second-part) [gone](gone.md) [out](../up.md) [web](https://a.b/c.md) [f](sub/run)\n\
             [folder](sub) [here](#top) [wrong](#bottom) [anchor](sub/a.md#third)",
        );
        write("sub/a.md", "# A\n[top](../README.md)\n## Second part\n");
        write("sub/run", "#!/bin/sh\n");
        write("sub/unlinked.md", "# Nobody links here\n");
        let docs = collect(root.path()).unwrap();
        let pages: Vec<_> = docs.pages.keys().map(|p| p.to_str().unwrap()).collect();
        assert_eq!(pages, ["README.md", "sub/a.md"]);
        let top = &docs.pages[Path::new("README.md")];
        for href in [
            "\"sub/a.html#second-part\"",
            "\"https://a.b/c.md\"",
            "\"sub/run\"",
            "\"#top\"",
        ] {
            assert!(
                top.html.contains(&format!("<a href={href}>")),
                "{}",
                top.html
            );
        }
        assert!(
            docs.pages[Path::new("sub/a.md")]
                .html
                .contains("href=\"../README.html\"")
        );
        assert_eq!(docs.copies, BTreeSet::from([PathBuf::from("sub/run")]));
        let unlinked: Vec<&str> = docs.unlinked.iter().map(|(_, link)| &**link).collect();
        let due = ["gone.md", "../up.md", "sub", "#bottom", "sub/a.md#third"];
        assert_eq!(unlinked, due);
    }

    #[test]
    fn a_checkout_without_a_readme_is_named() {
        let root = tempfile::tempdir().unwrap();
        let error = collect(root.path()).err().unwrap().to_string();
        assert!(error.contains("README.md"), "{error}");
    }
}
