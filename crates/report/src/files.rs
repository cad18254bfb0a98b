//! Files of reports.

use crate::error::ReportError;
use etalon_record::OutputFolder;
use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

/// The place of a report's files.
pub(crate) trait Destination: Sync {
    /// Writes a file. A reader never sees half of it.
    ///
    /// # Errors
    /// If the system refuses, or a file of somebody else is in the way.
    fn write(&self, name: &str, bytes: &[u8]) -> Result<PathBuf, ReportError>;
}

impl Destination for OutputFolder {
    fn write(&self, name: &str, bytes: &[u8]) -> Result<PathBuf, ReportError> {
        Ok(OutputFolder::write(self, name, bytes)?)
    }
}

/// Writes a file at a path that the user named.
pub(crate) fn replace_at(path: &Path, bytes: &[u8]) -> Result<PathBuf, ReportError> {
    let Some(name) = path.file_name() else {
        return Err(ReportError::NoFile {
            path: path.to_owned(),
        });
    };
    let hidden = format!(".{}.{}", name.to_string_lossy(), std::process::id());
    let beside = path.with_file_name(hidden);
    match fs::write(&beside, bytes).and_then(|()| fs::rename(&beside, path)) {
        Ok(()) => Ok(path.to_owned()),
        Err(source) => {
            // Errors are ignored: the first error is reported.
            let _ = fs::remove_file(&beside);
            Err(ReportError::unwritten(path)(source))
        }
    }
}

/// Returns a file name for a text that differs from all earlier ones. Characters that could mislead a file
/// system or a URL are replaced.
pub(crate) fn file_name(text: &str, ending: &str, taken: &mut BTreeSet<String>) -> String {
    const LONGEST: usize = 120;
    let fine = |c: char| c.is_ascii_alphanumeric() || "._=+-".contains(c);
    let safe = |c: char| if fine(c) { c } else { '_' };
    let safe: String = text.chars().take(LONGEST).map(safe).collect();
    let safe = match safe.strip_prefix('.') {
        Some(suffix) => format!("_{suffix}"),
        None if safe.is_empty() => "_".to_owned(),
        None => safe,
    };
    let mut name = format!("{safe}{ending}");
    let mut number = 1;
    // Some file systems ignore case in names.
    while !taken.insert(name.to_ascii_lowercase()) {
        number += 1;
        name = format!("{safe}-{number}{ending}");
    }
    name
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn file_names_stay_in_the_folder_and_apart() {
        let mut taken = BTreeSet::new();
        let mut name = |text: &str| file_name(text, ".csv", &mut taken);
        assert_eq!(name("gl:es:llvmpipe"), "gl_es_llvmpipe.csv");
        assert_eq!(name("gl:es/llvmpipe"), "gl_es_llvmpipe-2.csv");
        assert_eq!(name("GL:es:llvmpipe"), "GL_es_llvmpipe-3.csv");
        assert_eq!(name("../../x"), "_._.._x.csv");
        assert_eq!(name(""), "_.csv");
        assert!(name(&"v".repeat(5000)).len() < 130);
    }
}
