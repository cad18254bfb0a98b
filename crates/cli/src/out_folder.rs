//! The folder of `--out`: nothing that somebody recorded there is lost without `--force`.

use crate::failure::Failure;
use crate::report_files;
use etalon_record::{Bench, FolderKind, FolderLock, RecordError, Run, clear};
use std::path::Path;

/// The treatment of the present content of a command's folder.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Out<'a> {
    pub(crate) folder: &'a Path,
    /// The kind that is to be written.
    pub(crate) kind: FolderKind,
    /// The default folder, which is replaced by its own kind without being asked.
    pub(crate) latest: &'a str,
    pub(crate) resume: bool,
    pub(crate) force: bool,
}

/// A folder that may be written.
pub(crate) struct Claim<'a> {
    out: Out<'a>,
    /// True if what the folder holds is continued.
    pub(crate) resume: bool,
    /// Of a folder that exists.
    lock: Option<FolderLock>,
}

impl Claim<'_> {
    /// Makes and locks the folder, and removes what it holds of the other kind.
    ///
    /// # Errors
    /// When a file cannot be removed, or another process has the folder.
    pub(crate) fn take(self) -> Result<FolderLock, Failure> {
        let lock = self.lock.map_or_else(|| self.out.lock(), Ok)?;
        self.out.clear_other()?;
        Ok(lock)
    }
}

impl<'a> Out<'a> {
    /// Locks the folder if it exists. A new one is made by [`Claim::take`], once there is something to write.
    ///
    /// # Errors
    /// When the folder holds what may not be replaced, or another process has it. Nothing has been changed then.
    pub(crate) fn claim(self) -> Result<Claim<'a>, Failure> {
        let lock = self.folder.exists().then(|| self.lock()).transpose()?;
        Ok(Claim {
            out: self,
            resume: self.resumes()?,
            lock,
        })
    }

    fn lock(self) -> Result<FolderLock, Failure> {
        FolderLock::acquire(self.folder).map_err(Failure::usage)
    }

    /// Returns true if what the folder holds is continued.
    fn resumes(self) -> Result<bool, Failure> {
        let path = self.folder.to_owned();
        match FolderKind::of(self.folder) {
            None => Ok(false),
            Some(kind) if kind != self.kind => {
                if self.force {
                    return Ok(false);
                }
                Err(Failure::usage(RecordError::Holds { path, kind }))
            }
            Some(_) if self.resume => Ok(true),
            Some(_) if self.force || self.folder == Path::new(self.latest) => Ok(false),
            Some(kind) => {
                let damaged = |e: RecordError| {
                    Failure::usage(format!(
                        "{e}; or replace the {} in {} by --force",
                        kind.noun(),
                        self.folder.display()
                    ))
                };
                Err(Failure::usage(match kind {
                    FolderKind::Run => {
                        let run = Run::read(self.folder).map_err(damaged)?;
                        RecordError::Occupied {
                            path,
                            records: run.records.len() as u64,
                            expected: run.header.expected_records(),
                        }
                    }
                    FolderKind::Bench => RecordError::OccupiedByBench {
                        path,
                        missing: Bench::read(self.folder).map_err(damaged)?.missing(),
                    },
                }))
            }
        }
    }

    /// Removes what the folder holds of the other kind, once [`Out::resumes`] has allowed it.
    fn clear_other(self) -> Result<(), Failure> {
        let reports = match self.kind {
            FolderKind::Run => report_files::BENCH,
            FolderKind::Bench => report_files::RUN,
        };
        match FolderKind::of(self.folder) {
            Some(kind) if kind != self.kind && self.force => {
                clear(self.folder, kind, reports).map_err(Failure::usage)
            }
            _ => Ok(()),
        }
    }
}
