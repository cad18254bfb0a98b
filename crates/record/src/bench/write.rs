//! Writing a bench folder.

use super::header::BenchHeader;
use super::line::BenchLine;
use super::read::Bench;
use crate::conflict::bench_conflict;
use crate::error::RecordError;
use crate::folder::{BENCH_FILE, FolderKind};
use crate::json::json_line;
use crate::line_writer::{put, reopen};
use crate::output_folder::OutputFolder;
use std::fs::File;
use std::io::Write;
use std::path::{Path, PathBuf};

/// Writes a bench folder, line by line. Appended lines survive the end of the process.
#[derive(Debug)]
pub struct BenchWriter {
    path: PathBuf,
    file: File,
}

impl BenchWriter {
    /// Begins a bench in a folder, and creates the folder if it does not exist. Replaces a bench that the
    /// folder already holds, with its reports.
    ///
    /// # Errors
    /// If the folder cannot be written to, or holds anything other than a bench.
    pub fn create(folder: &Path, header: &BenchHeader) -> Result<Self, RecordError> {
        let out = OutputFolder::replace(folder, FolderKind::Bench)?;
        let file = put(&out, BENCH_FILE, [json_line("the header", header)])?;
        let path = folder.join(BENCH_FILE);
        Ok(Self { path, file })
    }

    /// Resumes the bench in a folder, and returns what was recorded so far. Removes a last line that was
    /// cut off.
    ///
    /// # Errors
    /// If the folder holds no bench, a damaged one, or a bench that does not match the header.
    pub fn resume(folder: &Path, header: &BenchHeader) -> Result<(Self, Bench), RecordError> {
        let (mut bench, length) = Bench::read_prefix(folder)?;
        if let Some(reason) = bench_conflict(&bench.header, header) {
            return Err(RecordError::Another {
                path: folder.to_owned(),
                reason,
            });
        }
        OutputFolder::open(folder)?.check(FolderKind::Bench)?;
        let path = folder.join(BENCH_FILE);
        let file = reopen(&path, length)?;
        bench.truncated = false;
        Ok((Self { path, file }, bench))
    }

    /// Appends one line in a single write.
    ///
    /// # Errors
    /// If the file cannot be written.
    pub fn append(&mut self, line: &BenchLine) -> Result<(), RecordError> {
        self.write(&json_line("a line of a bench", line)?)
    }

    fn write(&mut self, line: &[u8]) -> Result<(), RecordError> {
        let written = self.file.write_all(line);
        written.map_err(RecordError::io("write", &self.path))
    }
}
