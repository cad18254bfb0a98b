//! All case files at hand.

use crate::error::CaseError;
use crate::file::{CaseFile, CaseRef};
use std::fs;
use std::path::Path;

const BUILT_IN: &[(&str, &str)] = include!(concat!(env!("OUT_DIR"), "/case_files.rs"));

/// Case files, in ascending order of their paths.
#[derive(Clone, Debug)]
pub struct Library {
    files: Vec<CaseFile>,
}

impl Library {
    /// The case files that were compiled in.
    ///
    /// # Errors
    /// When one of them is broken; a test holds that none is.
    pub fn built_in() -> Result<Self, CaseError> {
        let files = BUILT_IN
            .iter()
            .map(|(name, text)| CaseFile::parse(name, text))
            .collect::<Result<_, _>>()?;
        Ok(Self { files })
    }

    /// All files ending in `.json` below a folder.
    ///
    /// # Errors
    /// When a folder or file cannot be read or a file is broken.
    pub fn from_folder(folder: &Path) -> Result<Self, CaseError> {
        let mut names = Vec::new();
        collect(folder, "", &mut names)?;
        names.sort();
        let mut files = Vec::new();
        for name in names {
            let text = fs::read_to_string(folder.join(&name)).map_err(|e| unreadable(&name, &e))?;
            files.push(CaseFile::parse(&name, &text)?);
        }
        Ok(Self { files })
    }

    /// The files.
    pub fn files(&self) -> &[CaseFile] {
        &self.files
    }

    /// Every case, file by file.
    pub fn cases(&self) -> impl Iterator<Item = CaseRef<'_>> {
        self.files.iter().flat_map(CaseFile::cases)
    }
}

fn unreadable(name: &str, error: &std::io::Error) -> CaseError {
    CaseError {
        file: name.to_owned(),
        line: 0,
        key: String::new(),
        message: format!("cannot be read: {error}"),
    }
}

fn collect(folder: &Path, prefix: &str, names: &mut Vec<String>) -> Result<(), CaseError> {
    let label = folder.display().to_string();
    let entries = fs::read_dir(folder).map_err(|e| unreadable(&label, &e))?;
    for entry in entries {
        let entry = entry.map_err(|e| unreadable(&label, &e))?;
        let name = format!("{prefix}{}", entry.file_name().to_string_lossy());
        let path = entry.path();
        if path.is_dir() {
            collect(&path, &format!("{name}/"), names)?;
        } else if name.ends_with(".json") {
            names.push(name);
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::HashSet;

    #[test]
    fn every_built_in_case_builds_and_no_id_repeats() {
        let library = Library::built_in().expect("built-in files parse");
        let mut ids = HashSet::new();
        for case in library.cases() {
            let built = case.build().expect("built-in cases build");
            assert_eq!(built.id, case.id());
            assert!(!built.id.contains([' ', ',']), "{}", built.id);
            assert!(ids.insert(built.id.clone()), "{} stands twice", built.id);
            let selftest = built.area() == "selftest";
            assert_eq!(built.judged_as.is_some(), selftest, "{}", built.id);
        }
    }
}
