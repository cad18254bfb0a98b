//! The texts of files in a folder of cases.

use crate::error::CaseError;
use std::path::Path;
use std::{fs, io};

/// Reads a regular file. Reading a pipe would block.
pub(crate) fn text_of(path: &Path) -> io::Result<String> {
    if !fs::metadata(path)?.is_file() {
        return Err(io::Error::other("it is not a regular file"));
    }
    fs::read_to_string(path)
}

pub(crate) fn unreadable(name: &str, error: &io::Error) -> CaseError {
    CaseError {
        file: name.to_owned(),
        line: 0,
        key: String::new(),
        message: format!("cannot be read: {error}"),
    }
}
