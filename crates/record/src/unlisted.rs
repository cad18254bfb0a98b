//! The files of a folder without a list: earlier versions wrote none, and a copy can lack it.

use crate::content::is_marked;
use crate::folder::FolderKind;
use crate::paths::open_below;
use crate::run::Run;
use std::collections::HashSet;
use std::fs;
use std::io::Read;
use std::path::Path;

/// The beginning of a script of a run's cases.
const SCRIPT: &[u8] = b"etalonArea(";

/// Returns the files that etalon wrote: files with a name of the folder's kind, files that its records name, and
/// scripts of cases. Empty if the folder has no header of etalon.
pub(crate) fn files(folder: &Path) -> HashSet<String> {
    let mut files = HashSet::new();
    for kind in FolderKind::ALL {
        if is_marked(folder, kind.file()) {
            let names = kind.names().iter().filter(|name| !name.ends_with('/'));
            files.extend(names.map(|name| (*name).to_owned()));
            if kind == FolderKind::Run {
                add_named(folder, &mut files);
            }
        }
    }
    files
}

/// Adds the files that a run's records name, its scripts and its lists for deqp-runner.
fn add_named(folder: &Path, files: &mut HashSet<String>) {
    // The files of a damaged run stay.
    let Ok(run) = Run::read(folder) else { return };
    for record in &run.records {
        // Reading refuses other paths.
        files.extend(record.files().map(str::to_owned));
    }
    let plain = |c: char| {
        if c.is_ascii_alphanumeric() || "._=+-".contains(c) {
            c
        } else {
            '_'
        }
    };
    for adapter in &run.header.adapters {
        let name: String = adapter.info.name.chars().map(plain).collect();
        files.insert(format!("results/{name}.csv"));
    }
    let scripts = fs::read_dir(folder.join("cases"));
    for entry in scripts.into_iter().flatten().flatten() {
        let name = format!("cases/{}", entry.file_name().to_string_lossy());
        if is_script(folder, &name) {
            files.insert(name);
        }
    }
}

fn is_script(folder: &Path, name: &str) -> bool {
    let mut start = [0; SCRIPT.len()];
    let read = open_below(folder, name).is_ok_and(|mut file| file.read_exact(&mut start).is_ok());
    read && start == SCRIPT
}
