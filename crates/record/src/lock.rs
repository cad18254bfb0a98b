//! The lock of a folder: one writer at a time.

use crate::error::RecordError;
use std::fs::{self, File, OpenOptions, TryLockError};
use std::io::ErrorKind;
use std::path::Path;
use std::thread;
use std::time::{Duration, Instant};

/// The file that is locked. It is empty, and is never removed.
pub(crate) const LOCK_FILE: &str = ".lock";

/// The time to retry if another process has the lock.
const RETRY_TIME: Duration = Duration::from_secs(1);

/// An exclusive lock on a folder. It is released when dropped, or when its process ends in any way.
#[derive(Debug)]
pub struct FolderLock {
    _file: File,
}

impl FolderLock {
    /// Locks a folder, and creates it if it does not exist. On a file system without locks this always
    /// succeeds.
    ///
    /// # Errors
    /// If another process has the lock, or the folder cannot be written to.
    pub fn acquire(folder: &Path) -> Result<Self, RecordError> {
        fs::create_dir_all(folder).map_err(RecordError::io("create", folder))?;
        let path = folder.join(LOCK_FILE);
        if fs::symlink_metadata(&path).is_ok_and(|found| !found.is_file()) {
            return Err(RecordError::Link { path });
        }
        let file = OpenOptions::new()
            .create(true)
            .truncate(false)
            .write(true)
            .open(&path)
            .map_err(RecordError::io("create", &path))?;
        let begun = Instant::now();
        loop {
            match file.try_lock() {
                // A killed process can leave a forked child that has not yet executed another program, and
                // has the lock until then.
                Err(TryLockError::WouldBlock) if begun.elapsed() < RETRY_TIME => {
                    thread::sleep(RETRY_TIME / 20);
                }
                tried => return Self::after(tried, file, folder, &path),
            }
        }
    }

    fn after(
        tried: Result<(), TryLockError>,
        file: File,
        folder: &Path,
        path: &Path,
    ) -> Result<Self, RecordError> {
        match tried {
            Ok(()) => Ok(Self { _file: file }),
            Err(TryLockError::WouldBlock) => Err(RecordError::InUse {
                path: folder.to_owned(),
            }),
            Err(TryLockError::Error(e)) if e.kind() == ErrorKind::Unsupported => {
                Ok(Self { _file: file })
            }
            Err(TryLockError::Error(e)) => Err(RecordError::io("lock", path)(e)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_second_lock_is_refused_until_the_first_is_released() {
        let folder = tempfile::tempdir().unwrap();
        let inside = folder.path().join("new/run");
        let first = FolderLock::acquire(&inside).unwrap();
        let second = FolderLock::acquire(&inside).unwrap_err();
        assert!(matches!(second, RecordError::InUse { .. }), "{second}");
        drop(first);
        FolderLock::acquire(&inside).unwrap();
    }
}
