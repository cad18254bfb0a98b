//! Files that a command adds to a folder, which can hold other files.

use crate::failure::Failure;
use etalon_record::check_folder;
use std::fs;
use std::path::{Path, PathBuf};

/// A folder that gets files with given names.
#[derive(Clone, Copy, Debug)]
pub(crate) struct NamedFiles<'a> {
    pub(crate) folder: &'a Path,
    /// True to replace files of the same names.
    pub(crate) force: bool,
}

impl NamedFiles<'_> {
    /// Checks that files of these names can be written. Writes nothing.
    ///
    /// # Errors
    /// If a name is taken and must not be replaced, or is no regular file.
    pub(crate) fn check<N: AsRef<Path>>(
        self,
        names: impl IntoIterator<Item = N>,
    ) -> Result<(), Failure> {
        check_folder(self.folder).map_err(Failure::usage)?;
        for name in names {
            let path = self.folder.join(name);
            let shown = path.display();
            match fs::symlink_metadata(&path) {
                Err(_) => {}
                Ok(found) if !found.is_file() => {
                    return Err(Failure::usage(format!(
                        "{shown} is a link or no regular file, and nothing is written through it; remove it, or name another folder with --out"
                    )));
                }
                Ok(_) if self.force => {}
                Ok(_) => {
                    return Err(Failure::usage(format!(
                        "{shown} exists; replace it with --force, or name another folder with --out"
                    )));
                }
            }
        }
        Ok(())
    }

    /// Checks all names, then writes all files and returns their paths.
    ///
    /// # Errors
    /// As [`NamedFiles::check`], or if the system refuses.
    pub(crate) fn write(self, files: &[(String, Vec<u8>)]) -> Result<Vec<PathBuf>, Failure> {
        self.check(files.iter().map(|(name, _)| name))?;
        fs::create_dir_all(self.folder).map_err(|e| Failure::of_file("create", self.folder, &e))?;
        let write = |(name, bytes): &(String, Vec<u8>)| {
            let path = self.folder.join(name);
            replace(&path, bytes)?;
            Ok(path)
        };
        files.iter().map(write).collect()
    }
}

/// A file of one kind that a command writes to a path that the user names, and can overwrite there.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Renewed {
    /// A page.
    Page,
    /// A list of cases by their worth.
    #[cfg_attr(
        not(feature = "mutants"),
        expect(dead_code, reason = "only `etalon mutants` writes it")
    )]
    Order,
    /// A list of redundant cases.
    #[cfg_attr(
        not(feature = "mutants"),
        expect(dead_code, reason = "only `etalon mutants` writes it")
    )]
    Redundant,
    /// A picture.
    Picture,
}

/// The beginning of every list of cases by their worth.
pub(crate) const ORDER_HEAD: &str =
    "# Cases by the planted bugs that each one catches beyond those before it, per second.\n";

/// The beginning of every list of redundant cases.
pub(crate) const REDUNDANT_HEAD: &str =
    "# Candidates that the quick profile leaves out: others have their power.\n";

impl Renewed {
    fn is_one(self, bytes: &[u8]) -> bool {
        /// Text in the last line of every page.
        const MADE: &[u8] = b"Made by etalon from ";
        match self {
            Self::Page => {
                let made = bytes.windows(MADE.len()).any(|part| part == MADE);
                bytes.starts_with(b"<!DOCTYPE html>") && made
            }
            Self::Order => bytes.starts_with(ORDER_HEAD.as_bytes()),
            Self::Redundant => bytes.starts_with(REDUNDANT_HEAD.as_bytes()),
            Self::Picture => bytes.starts_with(b"\x89PNG\r\n\x1a\n"),
        }
    }

    /// Checks that such a file can be written to a path that the user named: only one of its kind is replaced.
    ///
    /// # Errors
    /// If anything else is there.
    pub(crate) fn check(self, path: &Path) -> Result<(), Failure> {
        check_file(path)?;
        let Ok(found) = fs::symlink_metadata(path) else {
            return Ok(());
        };
        if found.is_file() && fs::read(path).is_ok_and(|bytes| self.is_one(&bytes)) {
            return Ok(());
        }
        let kind = match self {
            Self::Page => "page of etalon",
            Self::Order => "order that etalon wrote",
            Self::Redundant => "list of redundant cases that etalon wrote",
            Self::Picture => "PNG file",
        };
        Err(Failure::usage(format!(
            "{} exists and is no {kind}; name another file",
            path.display()
        )))
    }
}

/// Checks that a file that the user named can be written. A regular file, or a link to one, can be replaced; a new file
/// needs a folder. Writes nothing.
///
/// # Errors
/// If something else is there.
pub(crate) fn check_file(path: &Path) -> Result<(), Failure> {
    let shown = path.display();
    let folder = path
        .parent()
        .filter(|folder| !folder.as_os_str().is_empty());
    Err(Failure::usage(match fs::metadata(path) {
        // Renaming a file to the place of a device or a pipe would remove that.
        Ok(found) if !found.is_file() => {
            format!("{shown} is no regular file; name another file")
        }
        Ok(_) => return Ok(()),
        Err(_) if path.is_symlink() => {
            format!("{shown} is a link that leads nowhere; remove it, or name another file")
        }
        Err(_) => match folder {
            Some(folder) if !folder.is_dir() => format!(
                "{shown} cannot be written: {} is no folder; make it, or name another file",
                folder.display()
            ),
            _ => return Ok(()),
        },
    }))
}

/// Writes a file that the user named. A reader sees the old file or the new one. A link stays a link: its target
/// is replaced.
///
/// # Errors
/// If the system refuses.
pub(crate) fn replace(path: &Path, bytes: &[u8]) -> Result<(), Failure> {
    check_file(path)?;
    let failed = |e: std::io::Error| Failure::of_file("write", path, &e);
    let target = if path.is_symlink() {
        fs::canonicalize(path).map_err(failed)?
    } else {
        path.to_owned()
    };
    let mut beside = target.as_os_str().to_owned();
    beside.push(format!(".{}", std::process::id()));
    let beside = PathBuf::from(beside);
    let written = fs::write(&beside, bytes).and_then(|()| fs::rename(&beside, &target));
    written.map_err(|e| {
        // The first error is the one to report.
        let _ = fs::remove_file(&beside);
        failed(e)
    })
}
