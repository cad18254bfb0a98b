//! Writing a run folder.

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

/// The interval between two syncs: the most of a run that a power cut takes.
const SYNC_EVERY: Duration = Duration::from_secs(1);
/// The files of a run beside its reports and records. The records go last: while they are there, the rest is known to
/// belong to a run.
pub(crate) const BESIDE: ReportFiles = ReportFiles {
    // Earlier versions wrote frames uncompressed.
    folders: &[(FRAMES, "gz"), (FRAMES, "json"), (PICTURES, "png")],
    files: &[MISSING_FILE, DEAD_FILE, CASES_FILE],
};

impl Run {
    /// Puts the run in the place of the one that a folder holds: whoever reads it sees the one or the other.
    ///
    /// # Errors
    /// When the file cannot be written, or a record cannot be shortened enough.
    pub fn replace_in(&self, folder: &Path) -> Result<(), RecordError> {
        let header = json_line("the header", &self.header);
        let lines = std::iter::once(header).chain(self.records.iter().map(fit));
        put(folder, RUN_FILE, lines).map(drop)
    }
}

impl RunWriter {
    /// Begins a run in a folder, which is made when it does not exist. A run that the folder already
    /// holds is replaced, and its reports stay; any other content is refused.
    ///
    /// # Errors
    /// When the folder cannot be written to, or holds something else than a run.
    pub fn create(folder: &Path, header: &Header) -> Result<Self, RecordError> {
        Self::replace(folder, header, ReportFiles::NONE)
    }

    /// [`RunWriter::create`], which also removes the reports of the run before.
    ///
    /// # Errors
    /// When the folder cannot be written to, or holds something else than a run.
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

    /// Resumes the run that a folder holds, and returns what it holds. A last record that was cut off is
    /// removed.
    ///
    /// # Errors
    /// When there is no run, it is damaged, or it is another run than that of the header.
    pub fn resume(folder: &Path, header: &Header) -> Result<(Self, Run), RecordError> {
        let (mut run, whole) = Run::read_prefix(folder)?;
        if let Some(reason) = resume_conflict(&run.header, header) {
            return Err(RecordError::Another {
                path: folder.to_owned(),
                reason,
            });
        }
        let path = folder.join(RUN_FILE);
        let file = reopen(&path, whole)?;
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

    /// Writes the list of ids selected before sharding, in the order of the case files. It must be the
    /// selection that the header's digest names.
    ///
    /// # Errors
    /// When the file cannot be written.
    pub fn write_cases<'a>(
        &self,
        ids: impl IntoIterator<Item = &'a str>,
    ) -> Result<(), RecordError> {
        write_cases(&self.folder, ids)
    }

    /// Appends one record in a single write. A record longer than [`MAX_LINE`](crate::MAX_LINE) is shortened: wrong
    /// texels first, then the story, then the message.
    ///
    /// # Errors
    /// When the file cannot be written, or the record cannot be shortened enough.
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

    /// Syncs everything that was appended to the disk; [`RunWriter::append`] does so about once a second.
    ///
    /// # Errors
    /// When the system cannot.
    pub fn sync(&mut self) -> Result<(), RecordError> {
        self.synced = Instant::now();
        let synced = self.file.sync_data();
        synced.map_err(RecordError::io("write", &self.path))
    }

    /// Returns what writes frames and pictures into the folder.
    pub fn frames(&self) -> FrameWriter {
        FrameWriter::new(&self.folder)
    }

    /// The run folder.
    pub fn folder(&self) -> &Path {
        &self.folder
    }
}
