//! The folder of `--out`. Records in it are replaced only with `--force`, and other files never. Everything is
//! checked before anything is removed.

use crate::earlier;
use crate::failure::Failure;
use etalon_record::{
    Bench, Content, FolderKind, FolderLock, OutputFolder, RecordError, Run, overlap,
};
use std::path::Path;

/// The treatment of an output folder's existing content.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Out<'a> {
    pub(crate) folder: &'a Path,
    /// The kind of records that the command writes.
    pub(crate) kind: FolderKind,
    /// The default folder, whose records of the same kind are kept elsewhere without `--force`.
    pub(crate) latest: Option<&'a str>,
    /// The folder of `--cases`, whose files must stay separate from the output.
    pub(crate) cases: Option<&'a Path>,
    /// True to add only missing records; `None` if the command cannot resume.
    pub(crate) resume: Option<bool>,
    pub(crate) force: bool,
}

/// A folder that the command can write to.
pub(crate) struct ClaimedFolder<'a> {
    out: Out<'a>,
    /// True if the command continues the folder's records.
    pub(crate) resume: bool,
    /// The lock of a folder that already exists.
    lock: Option<FolderLock>,
}

impl ClaimedFolder<'_> {
    /// Makes and locks the folder, and removes or renames what the command does not continue. The writers of runs and
    /// benches replace records of their own kind.
    ///
    /// # Errors
    /// If a file cannot be removed, or another process has locked the folder.
    pub(crate) fn take(self) -> Result<FolderLock, Failure> {
        let Out { folder, kind, .. } = self.out;
        let is_kept =
            !self.resume && !self.out.force && self.out.is_latest() && !folder.is_symlink();
        if is_kept && Content::of(folder).map_err(Failure::usage)? == Content::Recorded(kind) {
            earlier::keep(folder, kind)?;
            return self.out.lock();
        }
        let lock = self.lock.map_or_else(|| self.out.lock(), Ok)?;
        let kept = matches!(kind, FolderKind::Run | FolderKind::Bench).then_some(kind);
        match Content::writable(folder).map_err(Failure::usage)? {
            Content::Recorded(held) if Some(held) != kept => {
                let out = OutputFolder::open(folder).map_err(Failure::of)?;
                out.clear(None).map_err(Failure::of)?;
            }
            _ => {}
        }
        Ok(lock)
    }
}

/// Refuses an output folder that contains the folder of `--cases`, or is inside it.
pub(crate) fn apart(folder: &Path, cases: Option<&Path>) -> Result<(), Failure> {
    match cases {
        Some(cases) if overlap(folder, cases) => Err(Failure::usage(format!(
            "--out {} and --cases {} must not be inside each other; name another folder with --out",
            folder.display(),
            cases.display()
        ))),
        _ => Ok(()),
    }
}

impl<'a> Out<'a> {
    /// Locks the folder if it exists. [`ClaimedFolder::take`] makes a new one, once there is something to write.
    ///
    /// # Errors
    /// If the folder holds something that must not be replaced, or another process has locked it. Nothing has
    /// changed then.
    pub(crate) fn claim(self) -> Result<ClaimedFolder<'a>, Failure> {
        apart(self.folder, self.cases)?;
        Content::writable(self.folder).map_err(Failure::usage)?;
        let lock = self.folder.exists().then(|| self.lock()).transpose()?;
        let resume = self.resumes()?;
        OutputFolder::open(self.folder)
            .and_then(|out| out.check(self.kind))
            .map_err(Failure::usage)?;
        Ok(ClaimedFolder {
            out: self,
            resume,
            lock,
        })
    }

    fn is_latest(self) -> bool {
        self.latest
            .is_some_and(|latest| self.folder == Path::new(latest))
    }

    fn lock(self) -> Result<FolderLock, Failure> {
        FolderLock::acquire(self.folder).map_err(Failure::of)
    }

    /// Returns true if the command continues the folder's records.
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
            Content::Recorded(_) if self.force || self.is_latest() => Ok(false),
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
