//! The folder of `--out`: nothing that somebody recorded there is lost without `--force`, and nothing else at all.

use crate::failure::Failure;
use crate::report_files;
use etalon_record::{Bench, Content, FolderKind, FolderLock, RecordError, Run, clear, overlap};
use std::path::Path;

/// The treatment of the present content of a command's folder.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Out<'a> {
    pub(crate) folder: &'a Path,
    /// The kind that is to be written.
    pub(crate) kind: FolderKind,
    /// The default folder if it is replaced by its own kind without being asked.
    pub(crate) latest: Option<&'a str>,
    /// The folder of `--cases`, whose files must not be mixed with what is written.
    pub(crate) cases: Option<&'a Path>,
    /// True if what is missing is to be added; `None` where the command starts from its parts each time.
    pub(crate) resume: Option<bool>,
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
    /// Makes and locks the folder, and removes what it holds of another kind, and the reports of its own.
    ///
    /// # Errors
    /// When a file cannot be removed, or another process has the folder.
    pub(crate) fn take(self) -> Result<FolderLock, Failure> {
        let lock = self.lock.map_or_else(|| self.out.lock(), Ok)?;
        let Out { folder, kind, .. } = self.out;
        match Content::writable(folder).map_err(Failure::usage)? {
            Content::Recorded(other) if other != kind => {
                clear(folder, other, report_files::of(other)).map_err(Failure::usage)?;
            }
            // A run or bench that goes on keeps its reports, and one that is replaced loses them with its records.
            Content::Recorded(FolderKind::Fuzz | FolderKind::Versions | FolderKind::Hunt) => {
                report_files::of(kind)
                    .remove(folder)
                    .map_err(Failure::usage)?;
            }
            _ => {}
        }
        Ok(lock)
    }
}

/// Refuses a folder to write to in which `--cases` lies, or which lies in it.
pub(crate) fn apart(folder: &Path, cases: Option<&Path>) -> Result<(), Failure> {
    match cases {
        Some(cases) if overlap(folder, cases) => Err(Failure::usage(format!(
            "--out {} and --cases {} must not lie one in the other; name another folder with --out",
            folder.display(),
            cases.display()
        ))),
        _ => Ok(()),
    }
}

impl<'a> Out<'a> {
    /// Locks the folder if it exists. A new one is made by [`Claim::take`], once there is something to write.
    ///
    /// # Errors
    /// When the folder holds what may not be replaced, or another process has it. Nothing has been changed then.
    pub(crate) fn claim(self) -> Result<Claim<'a>, Failure> {
        apart(self.folder, self.cases)?;
        Content::writable(self.folder).map_err(Failure::usage)?;
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
        match Content::writable(self.folder).map_err(Failure::usage)? {
            Content::Empty | Content::Other => Ok(false),
            Content::Recorded(kind) if kind != self.kind => {
                if self.force {
                    return Ok(false);
                }
                Err(Failure::usage(RecordError::Holds { path, kind }))
            }
            Content::Recorded(_) if self.resume == Some(true) => Ok(true),
            Content::Recorded(_)
                if self.force || self.latest.is_some_and(|l| self.folder == Path::new(l)) =>
            {
                Ok(false)
            }
            Content::Recorded(kind) => {
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
                            resumes: self.resume.is_some(),
                        }
                    }
                    FolderKind::Bench => RecordError::OccupiedByBench {
                        path,
                        missing: Bench::read(self.folder).map_err(damaged)?.missing(),
                    },
                    kind => RecordError::Holds { path, kind },
                }))
            }
        }
    }
}
