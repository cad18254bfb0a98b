//! Paths of frames and pictures below a run folder.

use crate::error::RecordError;
use crate::folder::{FRAMES, PICTURES};
use crate::hash::fnv;
use std::path::{Component, PathBuf};

/// Returns the path of a file that a record names.
///
/// # Errors
/// If the path leaves the run folder.
pub(crate) fn below(file: &str) -> Result<PathBuf, RecordError> {
    let path = PathBuf::from(file);
    let plain = |c: Component<'_>| matches!(c, Component::Normal(_));
    if !file.is_empty() && path.components().all(plain) {
        Ok(path)
    } else {
        Err(RecordError::Outside {
            path: file.to_owned(),
        })
    }
}

/// Returns `frames/<adapter>/<area>/<rest of the case>.json.gz`. The parts of the rest are joined by `,`,
/// and characters that a file system could treat specially are replaced. A folder per part would cost more
/// than the frames.
pub(crate) fn frame_path(adapter: &str, case: &str) -> String {
    let (area, path) = case.split_once('/').unwrap_or(("", case));
    let (adapter, area) = (safe(adapter), safe(area));
    format!("{FRAMES}/{adapter}/{area}/{}.json.gz", safe(path))
}

/// Returns `pictures/<case>.png`, with the same replacements.
pub(crate) fn picture_path(case: &str) -> String {
    format!("{}.png", path_below(PICTURES, case))
}

/// Returns `<folder>/<case>`, with characters replaced that a file system could treat specially.
fn path_below(folder: &str, case: &str) -> String {
    let mut path = folder.to_owned();
    for part in case.split('/') {
        path.push('/');
        path.push_str(&safe(part));
    }
    path
}

/// Makes one safe path component. `:` becomes `_`, and `/` becomes `,`. A component that changes in any
/// other way also gets a hash of the original, so that two components never become equal.
fn safe(part: &str) -> String {
    const LONGEST: usize = 160;
    let fine = |c: char| c.is_ascii_alphanumeric() || "._=+-".contains(c);
    let mut name: String = part
        .chars()
        .map(|c| match c {
            '/' => ',',
            c if fine(c) => c,
            _ => '_',
        })
        .take(LONGEST)
        .collect();
    if name.starts_with('.') {
        name.replace_range(..1, "_");
    }
    if name.is_empty() || name != part.replace(':', "_").replace('/', ",") {
        name.push_str(&format!("-{:016x}", fnv(part.bytes())));
    }
    name
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn frame_paths_stay_below_the_folder_and_apart() {
        assert_eq!(
            frame_path("gl:es:softpipe", "depth/compare/stored=0.5"),
            "frames/gl_es_softpipe/depth/compare,stored=0.5.json.gz"
        );
        for hostile in [
            "../../x",
            "/etc/passwd",
            "a//b",
            "..",
            ".",
            "",
            "a\\b\0c",
            "ü",
        ] {
            let path = frame_path(hostile, hostile);
            assert!(
                path.split('/')
                    .all(|p| !p.is_empty() && !p.starts_with('.')),
                "{path}"
            );
            assert!(path.is_ascii() && !path.contains('\\'), "{path}");
        }
        assert_ne!(frame_path("a", "x y"), frame_path("a", "x?y"));
        let long = frame_path("a", &"v".repeat(5000));
        assert!(long.len() < 255, "{}", long.len());
    }
}
