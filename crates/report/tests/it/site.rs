//! Sites: the folders that they accept and refuse, and that no link is broken.

use crate::browser::made;
use etalon_report::{ReportError, SITE_FILE, write_site};
use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::io::ErrorKind;
use std::path::{Component, Path, PathBuf};

/// The files below a folder, by path below it.
fn files(folder: &Path) -> BTreeSet<PathBuf> {
    let mut files = BTreeSet::new();
    let mut coming = vec![folder.to_owned()];
    while let Some(next) = coming.pop() {
        for entry in fs::read_dir(next).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                coming.push(path);
            } else {
                files.insert(path.strip_prefix(folder).unwrap().to_owned());
            }
        }
    }
    files
}

/// The values of an attribute.
fn attributes<'h>(html: &'h str, name: &str) -> Vec<&'h str> {
    let start = format!(" {name}=\"");
    let parts = html.split(&start).skip(1);
    parts.map(|part| part.split('"').next().unwrap()).collect()
}

fn joined(folder: &Path, link: &str) -> PathBuf {
    let mut path = folder.to_owned();
    for part in Path::new(link).components() {
        match part {
            Component::ParentDir => assert!(path.pop(), "{link} leads out of the site"),
            Component::Normal(name) => path.push(name),
            Component::CurDir => {}
            _ => panic!("{link} is absolute"),
        }
    }
    path
}

/// The pages that the links of a site lead to; every other link has been followed too.
fn linked(site: &Path) -> usize {
    let files = files(site);
    let pages: BTreeMap<&PathBuf, String> = files
        .iter()
        .filter(|path| path.extension().is_some_and(|e| e == "html"))
        .map(|path| (path, fs::read_to_string(site.join(path)).unwrap()))
        .collect();
    let mut followed = 0;
    for (path, html) in &pages {
        let folder = path.parent().unwrap();
        let links = attributes(html, "href")
            .into_iter()
            .chain(attributes(html, "src"));
        for link in links {
            if link.contains("://") || link.starts_with("data:") {
                continue;
            }
            let file = link.split('#').next().unwrap();
            let target = match file {
                "" => (*path).clone(),
                file => joined(folder, file),
            };
            assert!(files.contains(&target), "{}: {link}", path.display());
            followed += 1;
        }
    }
    followed
}

#[test]
fn a_site_of_a_run_has_no_broken_links() {
    let folder = tempfile::tempdir().unwrap();
    let run = folder.path().join("nightly");
    fs::create_dir(&run).unwrap();
    made::write(&run);
    let to = folder.path().join("site");
    let written = write_site(
        &to,
        std::slice::from_ref(&run),
        None,
        &|_, _| Some(made::catalogue()),
        false,
    )
    .unwrap();
    assert_eq!(written.html, to.join("index.html"));
    assert_eq!(written.files, files(&to).len() as u64);
    assert!(linked(&to) > 10);
    for file in [
        "runs/nightly/index.html",
        "runs/nightly/cases/depth.js",
        "runs/nightly/junit.xml",
        SITE_FILE,
    ] {
        assert!(to.join(file).is_file(), "{file}");
    }
    // Records and frames are for programs, and large.
    assert!(!to.join("runs/nightly/run.jsonl").exists());
    let start = fs::read_to_string(written.html).unwrap();
    for text in [
        "runs/nightly/index.html#gallery=depth",
        "13 cases on 4 adapters",
        "unexpected",
    ] {
        assert!(start.contains(text), "{text}");
    }
}

#[test]
fn a_site_replaces_nothing_but_a_site() {
    let folder = tempfile::tempdir().unwrap();
    let run = folder.path().join("run");
    fs::create_dir(&run).unwrap();
    made::write(&run);
    let to = folder.path().join("site");
    let write = |to: &Path, from: &Path, force| {
        write_site(to, &[from.to_owned()], None, &|_, _| None, force)
    };
    fs::create_dir(&to).unwrap();
    write(&to, &run, false).expect("an empty folder may be filled");
    let before = files(&to);
    let error = write(&to, &run, false).unwrap_err().to_string();
    let replaces = format!("{} holds a site; --force replaces it", to.display());
    assert_eq!(error, replaces);
    write(&to, &run, true).expect("a site may be replaced");
    fs::write(to.join("CNAME"), "example.org").unwrap();
    match write(&to, &run, true).unwrap_err() {
        ReportError::Foreign { path, .. } => assert_eq!(path, to.join("CNAME")),
        other => panic!("{other}"),
    }
    fs::remove_file(to.join("CNAME")).unwrap();
    let refused = |from: &Path| write(&to, from, true).unwrap_err();
    let within = refused(&to.join("runs/run"));
    assert!(matches!(within, ReportError::Within { .. }), "{within}");
    match refused(&folder.path().join("none")) {
        ReportError::Unread { source, .. } => assert_eq!(source.kind(), ErrorKind::NotFound),
        other => panic!("{other}"),
    }
    match write(&run, &to, true).unwrap_err() {
        ReportError::Occupied { path, .. } => assert_eq!(path, run),
        other => panic!("{other}"),
    }
    let empty = folder.path().join("empty");
    fs::create_dir(&empty).unwrap();
    match refused(&empty) {
        ReportError::NoPage { path } => assert_eq!(path, empty),
        other => panic!("{other}"),
    }
    assert_eq!(files(&to), before, "a refusal changes nothing");
    let beside = fs::read_dir(folder.path()).unwrap().count();
    assert_eq!(beside, 3, "nothing is left beside the site");
}

#[test]
fn leftovers_of_a_killed_process_do_not_block_a_site() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name);
    let (run, site, old) = (path("run"), path("site"), path(".site.old"));
    fs::create_dir(&run).unwrap();
    made::write(&run);
    let write = |force| write_site(&site, std::slice::from_ref(&run), None, &|_, _| None, force);
    write(false).unwrap();
    let whole = files(&site);
    let pid = std::process::id().to_string();
    // Killed before the new site was renamed.
    fs::rename(&site, &old).unwrap();
    let refused = write(false).unwrap_err();
    assert!(matches!(refused, ReportError::HasPages { .. }), "{refused}");
    assert_eq!(files(&site), whole);
    // Killed while the old site was removed; an unfinished site of a process with the same id.
    copy(&site, &old);
    fs::remove_file(old.join("index.html")).unwrap();
    fs::create_dir(path(&format!(".site.{pid}"))).unwrap();
    fs::write(path(&format!(".site.{pid}/half.js")), "half").unwrap();
    write(true).unwrap();
    assert!(!old.exists());
    assert_eq!(files(&site), whole);
    // What somebody else has under this name stays.
    for mine in ["notes.txt", SITE_FILE] {
        fs::create_dir(&old).unwrap();
        fs::write(old.join(mine), "mine").unwrap();
        write(true).unwrap();
        assert_eq!(fs::read_to_string(old.join(mine)).unwrap(), "mine");
        fs::remove_dir_all(&old).unwrap();
    }
    copy(&site, &old);
    fs::write(old.join("runs/run/notes.txt"), "mine").unwrap();
    write(true).unwrap();
    assert_eq!(files(&old), BTreeSet::from(["runs/run/notes.txt".into()]));
    assert_eq!(files(&site), whole);
}

fn copy(from: &Path, to: &Path) {
    for name in files(from) {
        let path = to.join(&name);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::copy(from.join(name), path).unwrap();
    }
}

#[test]
fn a_site_contains_only_what_the_suite_wrote() {
    let folder = tempfile::tempdir().unwrap();
    let run = folder.path().join("run");
    fs::create_dir(&run).unwrap();
    made::write(&run);
    fs::write(folder.path().join("secret"), "the secret").unwrap();
    for name in [
        "methods.html",
        "index.html",
        "cases/depth.js",
        "evil.html",
        "cases/evil.js",
    ] {
        fs::write(run.join(name), "<script>evil</script>").unwrap();
    }
    #[cfg(unix)]
    for name in ["a.json", "cases/secret.js", "frames/secret.json"] {
        fs::create_dir_all(run.join("frames")).unwrap();
        std::os::unix::fs::symlink(folder.path().join("secret"), run.join(name)).unwrap();
    }
    let to = folder.path().join("site");
    let catalogue = |_: &Path, _: &_| Some(made::catalogue());
    write_site(&to, &[run], None, &catalogue, false).unwrap();
    let files = files(&to);
    assert!(files.contains(Path::new("runs/run/cases/depth.js")));
    for file in files {
        let text = fs::read_to_string(to.join(&file)).unwrap();
        assert!(
            !text.contains("<script>evil") && !text.contains("the secret"),
            "{file:?}"
        );
    }
}
