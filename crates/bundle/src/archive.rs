//! A bundle on disk: a folder, and an archive with the same files.

use flate2::Compression;
use flate2::write::GzEncoder;
use std::fs;
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use thiserror::Error;

/// A file of a bundle.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct File {
    /// The file's name.
    pub name: String,
    /// A description for the report.
    pub about: String,
    /// The file's content.
    pub content: Vec<u8>,
}

impl File {
    /// Returns a file.
    pub fn new(name: &str, about: &str, content: Vec<u8>) -> Self {
        Self {
            name: name.to_owned(),
            about: about.to_owned(),
            content,
        }
    }

    /// Returns a text file.
    pub fn text(name: &str, about: &str, content: String) -> Self {
        Self::new(name, about, content.into_bytes())
    }
}

/// A bundle that was written.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Written {
    /// The folder.
    pub folder: PathBuf,
    /// The archive.
    pub archive: PathBuf,
}

/// An error from writing a bundle.
#[derive(Debug, Error)]
pub enum WriteError {
    /// A bundle of the same name exists.
    #[error("{path} exists; replace it with --force, or choose another folder with --out", path = .0.display())]
    Exists(PathBuf),
    /// A folder of the same name exists that is not a bundle.
    #[error("{path} holds no bundle of etalon; name another folder with --out", path = .0.display())]
    Foreign(PathBuf),
    /// A link or a folder has the name of a file.
    #[error("{path} is a link or no regular file, and nothing is written through it; remove it, or name another folder with --out", path = .0.display())]
    Irregular(PathBuf),
    /// The system refused.
    #[error("cannot write {path}: {source}", path = .path.display())]
    Io {
        /// The file or folder.
        path: PathBuf,
        /// The system's error.
        source: io::Error,
    },
}

/// The files that a bundle can have.
const NAMES: [&str; 10] = [
    "report.md",
    "repro.c",
    "repro.html",
    "main.rs",
    "Cargo.toml",
    "Cargo.lock",
    "expected.png",
    "actual.png",
    "difference.png",
    CASE,
];
/// The case file, by which a folder is recognized as a bundle.
const CASE: &str = "case.json";

/// Checks that writing a bundle of this name overwrites nothing.
///
/// # Errors
/// If anything other than a bundle exists there, or a bundle that may not be replaced.
pub fn free(out: &Path, name: &str, replace: bool) -> Result<(), WriteError> {
    let Written { folder, archive } = places(out, name);
    let is = |path: &Path, wanted: fn(&fs::FileType) -> bool| {
        fs::symlink_metadata(path).map_or(true, |found| wanted(&found.file_type()))
    };
    if !is(&folder, fs::FileType::is_dir) || folder.exists() && !is_bundle(&folder) {
        return Err(WriteError::Foreign(folder));
    }
    let files = NAMES.map(|name| folder.join(name));
    for file in files.iter().chain([&archive]) {
        if !is(file, fs::FileType::is_file) {
            return Err(WriteError::Irregular(file.clone()));
        }
    }
    for path in [folder, archive] {
        if !replace && path.exists() {
            return Err(WriteError::Exists(path));
        }
    }
    Ok(())
}

/// Returns true if a folder is empty or has the case file of a bundle.
fn is_bundle(folder: &Path) -> bool {
    let case = fs::read_to_string(folder.join(CASE)).unwrap_or_default();
    let empty = fs::read_dir(folder).is_ok_and(|mut entries| entries.next().is_none());
    let has = |key: &str| case.contains(&format!("\"{key}\":"));
    empty || has("about") && has("scene")
}

/// Moves the files of a folder into another one, and removes the files of an earlier bundle there. Other
/// files stay.
fn put(from: &Path, to: &Path) -> io::Result<()> {
    fs::create_dir_all(to)?;
    for name in NAMES {
        let path = to.join(name);
        if path.exists() {
            fs::remove_file(path)?;
        }
    }
    for entry in fs::read_dir(from)? {
        let entry = entry?;
        fs::rename(entry.path(), to.join(entry.file_name()))?;
    }
    fs::remove_dir(from)
}

/// Writes a bundle. It is either complete or absent: an unfinished bundle has another name.
///
/// # Errors
/// If a bundle of the same name exists and may not be replaced, or if the system refuses.
pub fn write(out: &Path, name: &str, files: &[File], replace: bool) -> Result<Written, WriteError> {
    free(out, name, replace)?;
    let written = places(out, name);
    let unfinished = out.join(format!(".{name}.{}", std::process::id()));
    let io = |path: &Path| {
        let path = path.to_owned();
        move |source| WriteError::Io { path, source }
    };
    let done = || -> Result<(), WriteError> {
        fs::create_dir_all(&unfinished).map_err(io(&unfinished))?;
        for file in files {
            let path = unfinished.join(&file.name);
            fs::write(&path, &file.content).map_err(io(&path))?;
        }
        let packed = packed(name, files).map_err(io(&written.archive))?;
        if written.folder.exists() {
            put(&unfinished, &written.folder)
        } else {
            fs::rename(&unfinished, &written.folder)
        }
        .map_err(io(&written.folder))?;
        let beside = out.join(format!(".{name}.tar.gz.{}", std::process::id()));
        fs::write(&beside, packed)
            .and_then(|()| fs::rename(&beside, &written.archive))
            .map_err(io(&written.archive))
    };
    let result = done();
    if result.is_err() {
        // The first error is the one to report.
        let _ = fs::remove_dir_all(&unfinished);
    }
    result.map(|()| written.clone())
}

fn places(out: &Path, name: &str) -> Written {
    Written {
        folder: out.join(name),
        archive: out.join(format!("{name}.tar.gz")),
    }
}

/// Returns the files as an archive, in a folder with the bundle's name. The same files give the same bytes.
fn packed(name: &str, files: &[File]) -> io::Result<Vec<u8>> {
    let mut archive = tar::Builder::new(GzEncoder::new(Vec::new(), Compression::default()));
    for file in files {
        let mut header = tar::Header::new_gnu();
        header.set_size(file.content.len() as u64);
        header.set_mode(0o644);
        header.set_mtime(0);
        archive.append_data(
            &mut header,
            Path::new(name).join(&file.name),
            file.content.as_slice(),
        )?;
    }
    let mut packed = archive.into_inner()?;
    packed.flush()?;
    packed.finish()
}

#[cfg(test)]
mod tests {
    use super::*;
    use flate2::read::GzDecoder;
    use std::io::Read;

    #[test]
    fn an_archive_holds_the_files_and_is_always_the_same() {
        let files = [
            File::text("a.txt", "a", "one".to_owned()),
            File::new("b.bin", "b", vec![0, 255]),
        ];
        let bytes = packed("name", &files).unwrap();
        assert_eq!(bytes, packed("name", &files).unwrap());
        let mut archive = tar::Archive::new(GzDecoder::new(bytes.as_slice()));
        let mut found = Vec::new();
        for entry in archive.entries().unwrap() {
            let mut entry = entry.unwrap();
            let mut content = Vec::new();
            entry.read_to_end(&mut content).unwrap();
            found.push((entry.path().unwrap().display().to_string(), content));
        }
        let expected = [
            ("name/a.txt", b"one".to_vec()),
            ("name/b.bin", vec![0, 255]),
        ];
        assert_eq!(
            found,
            expected.map(|(name, content)| (name.to_owned(), content))
        );
    }

    #[test]
    fn a_bundle_replaces_only_another_bundle_and_only_when_asked() {
        let folder = tempfile::tempdir().unwrap();
        let case = r#"{ "about": "a", "scene": {} }"#;
        let files = |name: &str| {
            let more = File::text(name, "a", "one".to_owned());
            [File::text(CASE, "a", case.to_owned()), more]
        };
        let written = write(folder.path(), "x", &files("repro.c"), false).unwrap();
        let again = write(folder.path(), "x", &files("repro.c"), false).unwrap_err();
        assert!(again.to_string().contains("--force"), "{again}");
        fs::write(written.folder.join("notes.txt"), "mine").unwrap();
        write(folder.path(), "x", &files("main.rs"), true).unwrap();
        assert!(!written.folder.join("repro.c").exists());
        assert_eq!(fs::read(written.folder.join("main.rs")).unwrap(), b"one");
        assert_eq!(fs::read(written.folder.join("notes.txt")).unwrap(), b"mine");
        for text in ["{}", "mine"] {
            fs::write(written.folder.join(CASE), text).unwrap();
            let foreign = write(folder.path(), "x", &files("repro.c"), true).unwrap_err();
            assert!(matches!(foreign, WriteError::Foreign(_)), "{foreign}");
            assert!(written.folder.join("main.rs").exists());
        }
    }
}
