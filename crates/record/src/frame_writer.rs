//! Writing the frames and pictures of a run folder. Each is a file, so that several threads can write at
//! once, and none waits for the records.

use crate::error::RecordError;
use crate::frame_file::FrameFile;
use crate::line::{frame_file, picture_file};
use crate::output_folder::OutputFolder;
use std::sync::Arc;

/// Writes the frames and pictures of a run folder.
#[derive(Debug)]
pub struct FrameWriter {
    out: Arc<OutputFolder>,
}

impl FrameWriter {
    pub(crate) fn new(out: Arc<OutputFolder>) -> Self {
        Self { out }
    }

    /// Writes a frame file, compressed, and returns its path below the run folder, for
    /// [`Record::frame`](crate::Record::frame). Call it before the record is appended, so that no record
    /// names a missing file.
    ///
    /// # Errors
    /// If the file cannot be written.
    pub fn write_frame(&self, frame: &FrameFile) -> Result<String, RecordError> {
        let (relative, bytes) = frame_file(frame)?;
        self.out.write_in_place(&relative, &bytes)?;
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
        self.out.write_in_place(&relative, &bytes)?;
        Ok(relative)
    }
}
