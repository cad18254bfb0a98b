//! Writing a run folder.

use crate::bad_end::BAD_ENDS_FILE;
use crate::conflict::resume_conflict;
use crate::content::Content;
use crate::error::RecordError;
use crate::folder::{CASES_FILE, DEAD_FILE, FRAMES, FolderKind, MISSING_FILE, PICTURES, RUN_FILE};
use crate::frame_writer::FrameWriter;
use crate::header::Header;
use crate::json::json_line;
use crate::json_lines::{begin, put, reopen};
use crate::record::Record;
use crate::report_files::ReportFiles;
use crate::run::Run;
use crate::selection::write_cases;
use crate::shorten::fit;
use std::fs::File;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

/// Writes a run folder, line by line. Appended lines survive the end of the process.
#[derive(Debug)]
pub struct RunWriter {
    folder: PathBuf,
    path: PathBuf,
    file: File,
    synced: Instant,
}

/// The interval between two syncs. A power cut loses at most this part of a run.
const SYNC_EVERY: Duration = Duration::from_secs(1);
/// The files of a run other than its reports and records. The records are removed last: as long as they
/// exist, the other files are known to belong to a run.
pub(crate) const BESIDE: ReportFiles = ReportFiles {
    // Earlier versions wrote frames uncompressed.
    folders: &[(FRAMES, "gz"), (FRAMES, "json"), (PICTURES, "png")],
    files: &[MISSING_FILE, DEAD_FILE, BAD_ENDS_FILE, CASES_FILE],
};

impl Run {
    /// Replaces the run in a folder. A concurrent reader sees the old run or the new one, never a mixture.
    ///
    /// # Errors
    /// If the file cannot be written, or if a record cannot be shortened enough.
    pub fn replace_in(&self, folder: &Path) -> Result<(), RecordError> {
        let header = json_line("the header", &self.header);
        let lines = std::iter::once(header).chain(self.records.iter().map(fit));
        put(folder, RUN_FILE, lines).map(drop)
    }
}

impl RunWriter {
    /// Begins a run in a folder, and creates the folder if it does not exist. Replaces a run that the
    /// folder already holds, but keeps its reports; refuses any other content.
    ///
    /// # Errors
    /// If the folder cannot be written to, or holds anything other than a run.
    pub fn create(folder: &Path, header: &Header) -> Result<Self, RecordError> {
        Self::replace(folder, header, ReportFiles::NONE)
    }

    /// Like [`RunWriter::create`], but also removes the reports of the earlier run.
    ///
    /// # Errors
    /// If the folder cannot be written to, or holds anything other than a run.
    pub fn replace(
        folder: &Path,
        header: &Header,
        reports: ReportFiles,
    ) -> Result<Self, RecordError> {
        match Content::writable(folder)? {
            Content::Recorded(FolderKind::Run) => {
                reports.remove(folder)?;
                BESIDE.remove(folder)?;
            }
            Content::Recorded(kind) => {
                return Err(RecordError::Holds {
                    path: folder.to_owned(),
                    kind,
                });
            }
            Content::Empty | Content::Other => {}
        }
        let file = begin(folder, RUN_FILE, &json_line("the header", header)?)?;
        Ok(Self::new(folder, folder.join(RUN_FILE), file))
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
        let path = folder.join(RUN_FILE);
        let file = reopen(&path, length)?;
        run.truncated = false;
        Ok((Self::new(folder, path, file), run))
    }

    fn new(folder: &Path, path: PathBuf, file: File) -> Self {
        Self {
            folder: folder.to_owned(),
            path,
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
        write_cases(&self.folder, ids)
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
        FrameWriter::new(&self.folder)
    }

    /// Returns the run folder.
    pub fn folder(&self) -> &Path {
        &self.folder
    }
}
