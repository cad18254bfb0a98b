//! Files of reports. Each is written to a temporary file and renamed, so a reader never sees half a report.

use crate::error::ReportError;
use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

/// Creates a folder and its parents.
pub(crate) fn make(folder: &Path) -> Result<(), ReportError> {
    fs::create_dir_all(folder).map_err(ReportError::unwritten(folder))
}

/// Writes a file in a folder.
pub(crate) fn replace(folder: &Path, name: &str, bytes: &[u8]) -> Result<PathBuf, ReportError> {
    let path = folder.join(name);
    let beside = folder.join(format!(".{name}.{}", std::process::id()));
    let result = fs::write(&beside, bytes).and_then(|()| fs::rename(&beside, &path));
    match result {
        Ok(()) => Ok(path),
        Err(source) => {
            // Errors are ignored: the first error is reported.
            let _ = fs::remove_file(&beside);
            Err(ReportError::Io { path, source })
        }
    }
}

/// Writes a file at a path.
pub(crate) fn replace_at(path: &Path, bytes: &[u8]) -> Result<PathBuf, ReportError> {
    let folder = path.parent().unwrap_or(Path::new(""));
    match path.file_name().and_then(|n| n.to_str()) {
        Some(name) => replace(folder, name, bytes),
        None => Err(ReportError::NoFile {
            path: path.to_owned(),
        }),
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
