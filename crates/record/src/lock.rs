//! One writer at a time in a folder.

use crate::error::RecordError;
use std::fs::{self, File, OpenOptions, TryLockError};
use std::io::ErrorKind;
use std::path::Path;
use std::thread;
use std::time::{Duration, Instant};

/// The file that is locked; it is empty and stays behind.
const LOCK_FILE: &str = ".lock";

/// How long a lock that is held is tried again.
const PATIENCE: Duration = Duration::from_secs(1);

/// The right to write into a folder, until it is dropped or its process ends, however it ends.
#[derive(Debug)]
pub struct FolderLock {
    _file: File,
}

impl FolderLock {
    /// Takes the right, and makes the folder where it does not exist. A file system without locks gives
    /// it to everyone.
    ///
    /// # Errors
    /// When another process holds it, or the folder cannot be written to.
    pub fn acquire(folder: &Path) -> Result<Self, RecordError> {
        fs::create_dir_all(folder).map_err(RecordError::io("create", folder))?;
        let path = folder.join(LOCK_FILE);
        let file = OpenOptions::new()
            .create(true)
            .truncate(false)
            .write(true)
            .open(&path)
            .map_err(RecordError::io("create", &path))?;
        let begun = Instant::now();
        loop {
            match file.try_lock() {
                // A process that was killed may leave a child that is about to start another program, and
                // holds what its parent held until then.
                Err(TryLockError::WouldBlock) if begun.elapsed() < PATIENCE => {
                    thread::sleep(PATIENCE / 20);
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
    fn the_second_is_refused_until_the_first_has_gone() {
        let folder = tempfile::tempdir().unwrap();
        let inside = folder.path().join("new/run");
        let first = FolderLock::acquire(&inside).unwrap();
        let second = FolderLock::acquire(&inside).unwrap_err();
        assert!(matches!(second, RecordError::InUse { .. }), "{second}");
        drop(first);
        FolderLock::acquire(&inside).unwrap();
    }
}
