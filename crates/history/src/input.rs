//! Reading what can be added: the folders and files that `etalon run`, `bench` and `bisect` wrote.

mod bench;
mod run;
mod started;
mod versions;

use crate::dates::ReleaseDates;
use crate::digest::Digesting;
use crate::error::HistoryError;
use crate::new_run::NewRun;
use etalon_record::{BENCH_FILE, RUN_FILE, VERSIONS_FILE, open_below};
use flate2::read::MultiGzDecoder;
use serde_json::{Map, Value};
use std::fs::{self, File};
use std::io::{BufRead, BufReader, Read};
use std::path::{Path, PathBuf};

/// The maximum number of bytes of a header that are read to find out what a file is.
const MAX_HEADER: u64 = 16 << 20;
/// The first bytes of gzip files.
const GZIP: [u8; 2] = [0x1f, 0x8b];

/// Reads the runs to add from a folder with `run.jsonl`, `bench.jsonl` or `versions.jsonl`, or from such a
/// file under any name; each file can be compressed with gzip, as `run.jsonl.gz`. A list of versions gives
/// one run per release.
///
/// # Errors
/// If there is no such file, or if it is damaged.
pub fn read_runs(path: &Path, dates: &ReleaseDates) -> Result<Vec<NewRun>, HistoryError> {
    let file = if path.is_dir() {
        in_folder(path)?
    } else {
        path.to_owned()
    };
    match What::of(&file)? {
        What::Run => Ok(vec![run::read(&file, open(&file)?)?]),
        What::Bench => Ok(vec![bench::read(&file, open(&file)?)?]),
        What::Versions => versions::read(&file, open(&file)?, dates),
    }
}

fn in_folder(folder: &Path) -> Result<PathBuf, HistoryError> {
    let plain = [BENCH_FILE, RUN_FILE, VERSIONS_FILE];
    let packed = plain.map(|name| format!("{name}.gz"));
    let names = plain.into_iter().chain(packed.iter().map(String::as_str));
    for name in names {
        let path = folder.join(name);
        if fs::symlink_metadata(&path).is_ok() {
            open_below(folder, name)?;
            return Ok(path);
        }
    }
    Err(HistoryError::NoRun {
        path: folder.to_owned(),
    })
}

/// The content of a file.
enum What {
    Run,
    Bench,
    Versions,
}

/// The byte order mark with which some editors begin a text.
const MARK: &[u8] = b"\xef\xbb\xbf";

impl What {
    /// Determines the kind by the header, since files can be renamed.
    fn of(path: &Path) -> Result<Self, HistoryError> {
        let none = || HistoryError::NoRun {
            path: path.to_owned(),
        };
        let mut line = Vec::new();
        BufReader::new(open(path)?.take(MAX_HEADER))
            .read_until(b'\n', &mut line)
            .map_err(HistoryError::io("read", path))?;
        let header: Map<String, Value> =
            serde_json::from_slice(line.strip_prefix(MARK).unwrap_or(&line)).map_err(|_| none())?;
        let has = |keys: &[&str]| keys.iter().all(|key| header.contains_key(*key));
        if !has(&["format"]) {
            Err(none())
        } else if has(&["releases"]) {
            Ok(Self::Versions)
        } else if has(&["ruler"]) {
            Ok(Self::Bench)
        } else {
            // A newer format can have other keys. The reader of runs reports its number.
            Ok(Self::Run)
        }
    }
}

/// Opens a file, compressed or not, and digests its decompressed bytes.
fn open(path: &Path) -> Result<Digesting<Box<dyn Read>>, HistoryError> {
    let opened = || File::open(path).map_err(HistoryError::io("read", path));
    // Opening a pipe waits until another process writes to it, and it can be read only once.
    if fs::metadata(path).is_ok_and(|found| !found.is_file()) {
        return Err(HistoryError::NoRun {
            path: path.to_owned(),
        });
    }
    let mut begin = Vec::new();
    opened()?
        .take(GZIP.len() as u64)
        .read_to_end(&mut begin)
        .map_err(HistoryError::io("read", path))?;
    let file = BufReader::with_capacity(1 << 16, opened()?);
    Ok(Digesting::new(if begin == GZIP {
        Box::new(MultiGzDecoder::new(file))
    } else {
        Box::new(file)
    }))
}
