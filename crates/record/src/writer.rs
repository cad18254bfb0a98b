//! Writing a run folder.

use crate::conflict::resume_conflict;
use crate::error::RecordError;
use crate::folder::{FolderKind, RUN_FILE};
use crate::frame_writer::FrameWriter;
use crate::header::Header;
use crate::json::json_line;
use crate::line_writer::{put, reopen};
use crate::output_folder::OutputFolder;
use crate::record::Record;
use crate::run::Run;
use crate::selection::write_cases;
use crate::shorten::fit;
use std::fs::File;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::{Duration, Instant};

/// Writes a run folder, line by line. Appended lines survive the end of the process.
#[derive(Debug)]
pub struct RunWriter {
    out: Arc<OutputFolder>,
    path: PathBuf,
    file: File,
    synced: Instant,
}

/// The interval between two syncs. A power cut loses at most this part of a run.
const SYNC_EVERY: Duration = Duration::from_secs(1);

impl Run {
    /// Replaces the run in a folder. A concurrent reader sees the old run or the new one, never a mixture.
    ///
    /// # Errors
    /// If the file cannot be written, or if a record cannot be shortened enough.
    pub fn replace_in(&self, folder: &Path) -> Result<(), RecordError> {
        let header = json_line("the header", &self.header);
        let lines = std::iter::once(header).chain(self.records.iter().map(fit));
        put(&OutputFolder::open(folder)?, RUN_FILE, lines).map(drop)
    }
}

impl RunWriter {
    /// Begins a run in a folder, and creates the folder if it does not exist. Replaces a run that the
    /// folder already holds, with its reports; refuses any other content.
    ///
    /// # Errors
    /// If the folder cannot be written to, or holds anything other than a run.
    pub fn create(folder: &Path, header: &Header) -> Result<Self, RecordError> {
        let out = OutputFolder::replace(folder, FolderKind::Run)?;
        let file = put(&out, RUN_FILE, [json_line("the header", header)])?;
        Ok(Self::new(out, file))
    }

    /// Resumes the run in a folder, and returns what was recorded so far. Removes a last record that was
    /// cut off.
    ///
    /// # Errors
    /// If the folder holds no run, a damaged one, or a run that does not match the header.
    pub fn resume(folder: &Path, header: &Header) -> Result<(Self, Run), RecordError> {
        let (mut run, length) = Run::read_prefix(folder)?;
        if let Some(reason) = resume_conflict(&run.header, header) {
            return Err(RecordError::Another {
                path: folder.to_owned(),
                reason,
            });
        }
        let out = OutputFolder::open(folder)?;
        out.check(FolderKind::Run)?;
        let file = reopen(&folder.join(RUN_FILE), length)?;
        run.truncated = false;
        Ok((Self::new(out, file), run))
    }

    fn new(out: OutputFolder, file: File) -> Self {
        Self {
            path: out.path().join(RUN_FILE),
            out: Arc::new(out),
            file,
            synced: Instant::now(),
        }
    }

    /// Writes the list of ids selected before sharding, in the order of the case files. The list must match
    /// the header's digest.
    ///
    /// # Errors
    /// If the file cannot be written.
    pub fn write_cases<'a>(
        &self,
        ids: impl IntoIterator<Item = &'a str>,
    ) -> Result<(), RecordError> {
        write_cases(&self.out, ids)
    }

    /// Appends one record in a single write. A record longer than [`MAX_LINE`](crate::MAX_LINE) is
    /// shortened: first its wrong texels, then the story, then the message.
    ///
    /// # Errors
    /// If the file cannot be written, or the record cannot be shortened enough.
    pub fn append(&mut self, record: &Record) -> Result<(), RecordError> {
        let line = fit(record)?;
        self.file
            .write_all(&line)
            .map_err(RecordError::io("write", &self.path))?;
        if self.synced.elapsed() >= SYNC_EVERY {
            self.sync()?;
        }
        Ok(())
    }

    /// Syncs everything that was appended to the disk; [`RunWriter::append`] does this about once a second.
    ///
    /// # Errors
    /// If the system fails to sync the file.
    pub fn sync(&mut self) -> Result<(), RecordError> {
        self.synced = Instant::now();
        let synced = self.file.sync_data();
        synced.map_err(RecordError::io("write", &self.path))
    }

    /// Returns a writer of frames and pictures for the folder.
    pub fn frames(&self) -> FrameWriter {
        FrameWriter::new(Arc::clone(&self.out))
    }

    /// Returns the run folder.
    pub fn out(&self) -> &OutputFolder {
        &self.out
    }
}
