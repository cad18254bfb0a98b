//! Paths of frames and pictures below a run folder.

use crate::error::RecordError;
use crate::folder::{FRAMES, PICTURES};
use crate::hash::fnv;
use std::fs::{self, File};
use std::path::{Component, Path, PathBuf};

/// Returns the path of a file that a record names.
///
/// # Errors
/// If the path leaves the run folder.
pub(crate) fn below(file: &str) -> Result<PathBuf, RecordError> {
    let path = PathBuf::from(file);
    let plain = |c: Component<'_>| matches!(c, Component::Normal(_));
    // A line end would be the end of a name in the list of files.
    let is_text = !file.is_empty() && !file.contains(char::is_control);
    if is_text && path.components().all(plain) {
        Ok(path)
    } else {
        Err(RecordError::Outside {
            path: file.to_owned(),
        })
    }
}

/// Returns true if a record can name this path as one of its files: a frame or a picture.
pub(crate) fn is_of_record(file: &str) -> bool {
    let is_frame =
        file.starts_with("frames/") && [".json.gz", ".json"].iter().any(|end| file.ends_with(end));
    let is_picture = file.starts_with("pictures/") && file.ends_with(".png");
    (is_frame || is_picture) && below(file).is_ok()
}

/// Checks that a path below a folder names a regular file, or nothing.
///
/// # Errors
/// If it names anything else, or goes through a link.
pub(crate) fn check_below(folder: &Path, file: &str) -> Result<(), RecordError> {
    let relative = below(file)?;
    let path = folder.join(&relative);
    if fs::symlink_metadata(&path).is_err() || lowest_real(folder, &relative) {
        Ok(())
    } else {
        Err(RecordError::Irregular { path })
    }
}

/// Opens a file below a folder to read it.
///
/// # Errors
/// If the path leaves the folder or goes through a link, or if it names no regular file.
pub fn open_below(folder: &Path, file: &str) -> Result<File, RecordError> {
    let relative = below(file)?;
    let path = folder.join(&relative);
    let found = fs::symlink_metadata(&path).map_err(RecordError::io("read", &path))?;
    // Reading a pipe would block, and a link can lead to any file of the machine.
    if !found.is_file() || !lowest_real(folder, &relative) {
        return Err(RecordError::Irregular { path });
    }
    File::open(&path).map_err(RecordError::io("read", &path))
}

/// Returns true if a path below a folder names a regular file, and no folder in between is a link.
pub(crate) fn lowest_real(folder: &Path, relative: &Path) -> bool {
    let is = |path: &Path, wanted: fn(&fs::FileType) -> bool| {
        fs::symlink_metadata(folder.join(path)).is_ok_and(|found| wanted(&found.file_type()))
    };
    let mut parents = relative.ancestors().skip(1);
    is(relative, fs::FileType::is_file)
        && parents.all(|parent| parent == Path::new("") || is(parent, fs::FileType::is_dir))
}

/// Returns `frames/<adapter>/<area>/<rest of the case>.json.gz`. The parts of the rest are joined by `,`,
/// because a folder per part would cost more than the frames.
pub(crate) fn frame_path(adapter: &str, case: &str) -> String {
    let (area, path) = case.split_once('/').unwrap_or(("", case));
    let (adapter, area) = (component(adapter, (':', '_')), component(area, SEPARATOR));
    format!(
        "{FRAMES}/{adapter}/{area}/{}.json.gz",
        component(path, SEPARATOR)
    )
}

/// Returns `pictures/<case>.png`, with a folder for each part.
pub(crate) fn picture_path(case: &str) -> String {
    let parts: Vec<String> = case
        .split('/')
        .map(|part| component(part, SEPARATOR))
        .collect();
    format!("{PICTURES}/{}.png", parts.join("/"))
}

/// The separator of an id's parts, and its replacement in one component.
const SEPARATOR: (char, char) = ('/', ',');

/// Makes one safe path component, with one character replaced by another. A name that contains the replacement
/// or anything that a file system could treat specially also gets a hash, so that two names never become
/// equal, even where capitals do not count.
fn component(name: &str, (from, to): (char, char)) -> String {
    const LONGEST: usize = 160;
    let fine = |c: char| c.is_ascii_lowercase() || c.is_ascii_digit() || "._=+-".contains(c);
    let is_unchanged = |c: char| fine(c) && c != to;
    let mut safe: String = name
        .chars()
        .map(|c| match c {
            c if c == from => to,
            c if fine(c) || c.is_ascii_uppercase() => c,
            _ => '_',
        })
        .take(LONGEST)
        .collect();
    if safe.starts_with('.') {
        safe.replace_range(..1, "_");
    }
    let whole = name.chars().count() <= LONGEST && !name.is_empty() && !name.starts_with('.');
    if !whole || !name.chars().all(|c| c == from || is_unchanged(c)) {
        safe.push_str(&format!("-{:016x}", fnv(name.bytes())));
    }
    safe
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
        let apart = [
            ("gl:a", "gl_a"),
            ("gl:a", "gl/a"),
            ("gl:a", "GL:a"),
            ("gl:a:b", "gl:a_b"),
            ("x y", "x?y"),
        ];
        for (one, other) in apart {
            let (one_path, other_path) = (frame_path(one, "a/b"), frame_path(other, "a/b"));
            assert_ne!(
                one_path.to_lowercase(),
                other_path.to_lowercase(),
                "{one} {other}"
            );
        }
        for (one, other) in [("a/b/c", "a/b,c"), ("a/b c", "a/b?c"), ("a/b_c", "a/b:c")] {
            assert_ne!(
                frame_path("a", one),
                frame_path("a", other),
                "{one} {other}"
            );
            assert_ne!(picture_path(one), picture_path(other), "{one} {other}");
        }
        let long = frame_path("a", &"v".repeat(5000));
        assert!(long.len() < 255, "{}", long.len());
    }
}
