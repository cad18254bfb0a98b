//! The folder of `--out`: nothing that somebody recorded there is lost without `--force`.

use crate::failure::Failure;
use crate::report_files;
use etalon_record::{Bench, FolderKind, RecordError, Run, clear};
use std::path::Path;

/// What a command is told to do with what its folder holds.
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

impl Out<'_> {
    /// Returns true if what the folder holds is continued.
    ///
    /// # Errors
    /// When the folder holds what may not be replaced. Nothing has been changed then.
    pub(crate) fn resumes(self) -> Result<bool, Failure> {
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
    ///
    /// # Errors
    /// When a file cannot be removed.
    pub(crate) fn clear_other(self) -> Result<(), Failure> {
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
