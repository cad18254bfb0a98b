//! Writing the frames and pictures of a run folder. Each is a file, so that several threads can write at
//! once, and none waits for the records.

use crate::error::RecordError;
use crate::frame_file::FrameFile;
use crate::line::{frame_file, picture_file};
use std::collections::HashSet;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

/// Writes the frames and pictures of a run folder.
#[derive(Debug)]
pub struct FrameWriter {
    folder: PathBuf,
    /// The folders that exist.
    made: Mutex<HashSet<PathBuf>>,
}

impl FrameWriter {
    pub(crate) fn new(folder: &Path) -> Self {
        Self {
            folder: folder.to_owned(),
            made: Mutex::default(),
        }
    }

    fn make_folder_of(&self, path: &Path) -> Result<(), RecordError> {
        let Some(parent) = path.parent() else {
            return Ok(());
        };
        let mut made = self.made.lock().unwrap_or_else(PoisonError::into_inner);
        if !made.contains(parent) {
            fs::create_dir_all(parent).map_err(RecordError::io("create", parent))?;
            made.insert(parent.to_owned());
        }
        Ok(())
    }

    /// Writes a frame file, compressed, and returns its path below the run folder, for
    /// [`Record::frame`](crate::Record::frame). Call it before the record is appended, so that no record
    /// names a missing file.
    ///
    /// # Errors
    /// If the file cannot be written.
    pub fn write_frame(&self, frame: &FrameFile) -> Result<String, RecordError> {
        let (relative, bytes) = frame_file(frame)?;
        self.write(&relative, &bytes)?;
        Ok(relative)
    }

    /// Writes a picture as PNG and returns its path below the run folder. `rgb` holds red, green and
    /// blue of each texel, row by row from the top. Call it before the record is appended.
    ///
    /// # Errors
    /// If the file cannot be written, or if the number of values does not match the size.
    pub fn write_picture(
        &self,
        case: &str,
        size: [u32; 2],
        rgb: &[u8],
    ) -> Result<String, RecordError> {
        let (relative, bytes) = picture_file(case, size, rgb)?;
        self.write(&relative, &bytes)?;
        Ok(relative)
    }

    fn write(&self, relative: &str, bytes: &[u8]) -> Result<(), RecordError> {
        let path = self.folder.join(relative);
        self.make_folder_of(&path)?;
        fs::write(&path, bytes).map_err(RecordError::io("write", &path))
    }
}
