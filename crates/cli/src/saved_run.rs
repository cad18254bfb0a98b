//! Runs that the page saved: a run folder as one file, `*.tar.gz`. Commands unpack it beside the file, and use the
//! folder.

use crate::failure::Failure;
use crate::output::say;
use etalon_record::{Content, FolderKind, RUN_FILE};
use flate2::read::GzDecoder;
use std::fs::{self, File};
use std::io::{self, Read};
use std::path::{Component, Path, PathBuf};
use tar::Archive;

/// The end of a saved run's name.
const EXTENSION: &str = ".tar.gz";
/// The maximum number of bytes of an unpacked run.
const MAX_BYTES: u64 = 8 << 30;

/// Returns the run folders of a command: for a saved run, the folder that it is unpacked to; any other path
/// unchanged.
///
/// # Errors
/// If a saved run cannot be unpacked.
pub(crate) fn folders(paths: &[PathBuf]) -> Result<Vec<PathBuf>, Failure> {
    paths.iter().map(|path| folder(path)).collect()
}

/// Returns the run folder of a path, as [`folders`] does.
///
/// # Errors
/// If it is a saved run that cannot be unpacked.
pub(crate) fn folder(path: &Path) -> Result<PathBuf, Failure> {
    let name = path.to_str().and_then(|name| name.strip_suffix(EXTENSION));
    let Some(folder) = name.map(PathBuf::from).filter(|_| path.is_file()) else {
        return Ok(path.to_owned());
    };
    let failed =
        |error: io::Error| Failure::usage(format!("cannot unpack {}: {error}", path.display()));
    let mut beside = folder.as_os_str().to_owned();
    beside.push(format!(".{}", std::process::id()));
    let beside = PathBuf::from(beside);
    let unpacked = unpack(path, &beside).and_then(|()| place(&beside, &folder));
    if unpacked.is_err() || beside.exists() {
        // The first error is the one to report.
        let _ = fs::remove_dir_all(&beside);
    }
    if unpacked.map_err(failed)? {
        say!("{} is unpacked to {}", path.display(), folder.display());
    }
    Ok(folder)
}

/// Moves an unpacked run to its folder. Returns false if the folder has the same run already.
fn place(beside: &Path, folder: &Path) -> io::Result<bool> {
    match Content::of(folder) {
        Ok(Content::Empty) => {
            if folder.exists() {
                fs::remove_dir_all(folder)?;
            }
            fs::rename(beside, folder)?;
            Ok(true)
        }
        Ok(Content::Recorded(FolderKind::Run)) if same(beside, folder)? => Ok(false),
        _ => Err(io::Error::other(format!(
            "{} holds something else; move it",
            folder.display()
        ))),
    }
}

/// Returns true if two folders have the same records.
fn same(folder: &Path, other: &Path) -> io::Result<bool> {
    Ok(fs::read(folder.join(RUN_FILE))? == fs::read(other.join(RUN_FILE))?)
}

/// Unpacks an archive into a new folder.
fn unpack(path: &Path, to: &Path) -> io::Result<()> {
    fs::create_dir(to)?;
    let text = GzDecoder::new(File::open(path)?).take(MAX_BYTES);
    let mut archive = Archive::new(text);
    for entry in archive.entries()? {
        let mut entry = entry?;
        let name = entry.path()?.into_owned();
        let plain = name
            .components()
            .all(|part| matches!(part, Component::Normal(_)));
        if !plain || !entry.header().entry_type().is_file() {
            return Err(io::Error::other(format!(
                "{} is not a file of a run",
                name.display()
            )));
        }
        let file = to.join(name);
        if let Some(parent) = file.parent() {
            fs::create_dir_all(parent)?;
        }
        io::copy(&mut entry, &mut File::create_new(file)?)?;
    }
    if to.join(RUN_FILE).is_file() {
        Ok(())
    } else {
        Err(io::Error::other(format!("it has no {RUN_FILE}")))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use flate2::Compression;
    use flate2::write::GzEncoder;
    use tar::{Builder, EntryType, Header};

    const LINE: &str = "{\"format\":4,\"etalon\":\"1\"}\n";

    /// Writes an archive of one file with this name.
    fn archive(path: &Path, name: &str, kind: EntryType) {
        let packed = GzEncoder::new(File::create(path).unwrap(), Compression::fast());
        let mut builder = Builder::new(packed);
        let mut header = Header::new_gnu();
        header.set_entry_type(kind);
        // Sets the bytes of the name, since the builder refuses dangerous ones.
        header.as_old_mut().name[..name.len()].copy_from_slice(name.as_bytes());
        header.set_size(LINE.len() as u64);
        header.set_cksum();
        builder.append(&header, LINE.as_bytes()).unwrap();
        builder.into_inner().unwrap().finish().unwrap();
    }

    #[test]
    fn a_saved_run_is_unpacked_once_and_replaces_nothing() {
        let above = tempfile::tempdir().unwrap();
        let path = above.path().join("mine.tar.gz");
        archive(&path, RUN_FILE, EntryType::Regular);
        let unpacked = folder(&path).unwrap();
        assert_eq!(unpacked, above.path().join("mine"));
        assert_eq!(fs::read_to_string(unpacked.join(RUN_FILE)).unwrap(), LINE);
        fs::write(unpacked.join("index.html"), "report").unwrap();
        assert_eq!(folder(&path).unwrap(), unpacked);
        assert!(unpacked.join("index.html").is_file());
        fs::write(unpacked.join(RUN_FILE), LINE.replace('4', "3")).unwrap();
        assert!(
            folder(&path)
                .unwrap_err()
                .message
                .contains("holds something else")
        );
        assert_eq!(fs::read_dir(above.path()).unwrap().count(), 2);
        assert_eq!(folder(above.path()).unwrap(), above.path());
    }

    #[test]
    fn an_archive_writes_only_files_of_its_folder() {
        let above = tempfile::tempdir().unwrap();
        let path = above.path().join("mine.tar.gz");
        for (name, kind) in [
            ("../out", EntryType::Regular),
            ("/tmp/out", EntryType::Regular),
            (RUN_FILE, EntryType::Symlink),
            ("other", EntryType::Regular),
        ] {
            archive(&path, name, kind);
            assert!(folder(&path).is_err(), "{name}");
            assert_eq!(fs::read_dir(above.path()).unwrap().count(), 1, "{name}");
        }
        fs::write(&path, "no archive").unwrap();
        assert!(folder(&path).is_err());
    }
}
