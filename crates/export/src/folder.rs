//! The folder of an export, and the names in it.

use crate::error::ExportError;
use etalon_record::check_folder;
use std::fmt::Write as _;
use std::fs;
use std::path::Path;

/// The length in bytes up to which a name is written in full. File systems allow 255 bytes in one part of a
/// path.
const LONGEST: usize = 180;

/// Creates the folder of an export. An existing folder must be empty.
pub(crate) fn empty(path: &Path) -> Result<(), ExportError> {
    check_folder(path)?;
    fs::create_dir_all(path).map_err(ExportError::io(path))?;
    let mut entries = fs::read_dir(path).map_err(ExportError::io(path))?;
    match entries.next() {
        None => Ok(()),
        Some(_) => Err(ExportError::NotEmpty {
            path: path.to_owned(),
        }),
    }
}

/// Returns a name as one part of a path. Letters, digits, `.`, `_` and `-` are unchanged; every other byte
/// becomes `%` and two digits, which readers of Hive partitions decode. A very long name is cut and made
/// unique by `place`.
pub(crate) fn part(name: &str, place: usize) -> String {
    let mut part = String::new();
    for byte in name.bytes() {
        match byte {
            b'a'..=b'z' | b'A'..=b'Z' | b'0'..=b'9' | b'.' | b'_' | b'-' => {
                part.push(char::from(byte));
            }
            other => {
                // Writing to a string does not fail.
                let _ = write!(part, "%{other:02X}");
            }
        }
        if part.len() > LONGEST {
            let _ = write!(part, "~{place}");
            break;
        }
    }
    part
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_hold_no_separators() {
        assert_eq!(part("vulkan:lavapipe", 0), "vulkan%3Alavapipe");
        assert_eq!(part("../a\0b\nc%", 0), "..%2Fa%00b%0Ac%25");
        let long = "é".repeat(500);
        assert!(part(&long, 7).len() < 200);
        assert_ne!(part(&long, 7), part(&long, 8));
    }

    #[test]
    fn only_an_empty_folder_is_taken() {
        let dir = tempfile::tempdir().unwrap();
        let new = dir.path().join("a/b");
        empty(&new).unwrap();
        empty(&new).unwrap();
        fs::write(new.join("x"), "").unwrap();
        assert!(matches!(empty(&new), Err(ExportError::NotEmpty { .. })));
        assert!(matches!(empty(&new.join("x")), Err(ExportError::Folder(_))));
    }
}
