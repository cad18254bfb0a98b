//! The earlier recordings of a default folder: a new run renames the folder of the last one, and a few are kept.

use crate::failure::Failure;
use crate::output::say;
use etalon_record::{FolderKind, OutputFolder, TIMED_FOLDER};
use std::fs;
use std::path::{Path, PathBuf};

/// The folder of earlier recordings, next to the default folder.
const FOLDER: &str = "earlier";
/// The number of recordings of a kind that are kept.
const KEPT: usize = 5;

/// Renames a default folder to the next free name, such as `reports/earlier/run-7`, and removes the oldest
/// recordings of this kind. Returns the new name.
pub(crate) fn keep(folder: &Path, kind: FolderKind) -> Result<PathBuf, Failure> {
    let earlier = folder.with_file_name(FOLDER);
    let failed = |path: &Path| {
        let path = path.to_owned();
        move |error: std::io::Error| {
            Failure::of_file("keep the earlier recording in", &path, &error)
        }
    };
    fs::create_dir_all(&earlier).map_err(failed(&earlier))?;
    let mut numbers = numbers(&earlier, kind).map_err(failed(&earlier))?;
    let next = numbers.last().map_or(1, |last| last + 1);
    let path = |number: u64| earlier.join(format!("{}-{number}", kind.noun()));
    fs::rename(folder, path(next)).map_err(failed(&path(next)))?;
    say!(
        "the earlier {} is now {}",
        kind.noun(),
        path(next).display()
    );
    numbers.push(next);
    let oldest = numbers.len().saturating_sub(KEPT);
    for number in &numbers[..oldest] {
        remove(&path(*number))?;
    }
    Ok(path(next))
}

/// Returns the numbers of the recordings of a kind, in order.
fn numbers(earlier: &Path, kind: FolderKind) -> std::io::Result<Vec<u64>> {
    let mut numbers = Vec::new();
    for entry in fs::read_dir(earlier)? {
        let name = entry?.file_name();
        let name = name.to_string_lossy();
        let number = name
            .strip_prefix(kind.noun())
            .and_then(|n| n.strip_prefix('-'));
        numbers.extend(number.and_then(|n| n.parse::<u64>().ok()));
    }
    numbers.sort_unstable();
    Ok(numbers)
}

/// Removes a recording. A folder with other files stays, and so do these files.
fn remove(folder: &Path) -> Result<(), Failure> {
    for folder in [&folder.join(TIMED_FOLDER), folder] {
        let out = OutputFolder::open(folder).map_err(Failure::of)?;
        out.remove_all().map_err(Failure::of)?;
    }
    Ok(())
}
