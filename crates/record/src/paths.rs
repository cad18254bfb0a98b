//! Paths of frames and pictures below a run folder.

use crate::error::RecordError;
use crate::folder::{FRAMES, PICTURES};
use crate::hash::fnv;
use std::path::{Component, PathBuf};

/// The path of a file that a record names, which must not leave the run folder.
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

/// `frames/<adapter>/<area>/<rest of the case>.json.gz`, with `,` between the parts of the rest and every
/// character that a file system may treat specially replaced. A folder per part would cost a file system
/// more than the frames.
pub(crate) fn frame_path(adapter: &str, case: &str) -> String {
    let (area, path) = case.split_once('/').unwrap_or(("", case));
    let (adapter, area) = (safe(adapter), safe(area));
    format!("{FRAMES}/{adapter}/{area}/{}.json.gz", safe(path))
}

/// `pictures/<case>.png`, likewise.
pub(crate) fn picture_path(case: &str) -> String {
    format!("{}.png", path_below(PICTURES, case))
}

/// `<folder>/<case>`, with every character that a file system may treat specially replaced.
fn path_below(folder: &str, case: &str) -> String {
    let mut path = folder.to_owned();
    for part in case.split('/') {
        path.push('/');
        path.push_str(&safe(part));
    }
    path
}

/// One safe path component. `:` becomes `_` and `/` becomes `,`; a component that changes otherwise also
/// gets a hash of what it was, so that two of them do not become one.
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
