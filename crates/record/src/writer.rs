//! Writing a run folder.

use crate::error::RecordError;
use crate::frame_file::FrameFile;
use crate::header::Header;
use crate::record::{MAX_WRONG_TEXELS, Record};
use crate::run::Run;
use crate::selection::{fnv, write_cases};
use etalon_frame::StoryLine;
use serde::Serialize;
use std::fs::{self, File};
use std::io::{ErrorKind, Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

/// The most bytes of a record's line, its newline among them.
pub const MAX_LINE: usize = 64 * 1024;
/// The file of a run folder that lists the selected ids, one per line, before sharding.
pub const CASES_FILE: &str = "cases.txt";

/// The file of a merged run that lists the records that no part has: adapter, space, case.
pub const MISSING_FILE: &str = "missing.txt";

/// Writes a run folder, line by line. What was appended survives the writer's death.
#[derive(Debug)]
pub struct RunWriter {
    folder: PathBuf,
    path: PathBuf,
    file: File,
    synced: Instant,
}

/// How much of a run a power cut may take: so long a time's records.
const SYNC_EVERY: Duration = Duration::from_secs(1);
/// What belongs to a run beside its records.
const FOLDERS: [&str; 3] = ["frames", "pictures", "results"];
const FILES: [&str; 8] = [
    "index.html",
    "methods.html",
    "junit.xml",
    "ctrf.json",
    "summary.md",
    MISSING_FILE,
    CASES_FILE,
    "run.jsonl",
];

impl RunWriter {
    /// Begins a run in a folder, which is made when it does not exist. A run that the folder
    /// already holds is replaced, with its frames and reports; a folder without a run loses
    /// nothing.
    ///
    /// # Errors
    /// When the folder cannot be written to.
    pub fn create(folder: &Path, header: &Header) -> Result<Self, RecordError> {
        let path = folder.join("run.jsonl");
        if path.is_file() {
            // The run goes last: while it is there, the rest is known to be ours to remove.
            for name in FOLDERS {
                gone(fs::remove_dir_all(folder.join(name)), folder, name)?;
            }
            for name in FILES {
                gone(fs::remove_file(folder.join(name)), folder, name)?;
            }
        }
        fs::create_dir_all(folder).map_err(RecordError::io("create", folder))?;
        // Renamed into place, so that no run ever has half a header.
        let beside = folder.join(format!(".run.jsonl.{}", std::process::id()));
        let mut file = File::create(&beside).map_err(RecordError::io("create", &beside))?;
        let line = json_line("the header", header)?;
        file.write_all(&line)
            .and_then(|()| file.sync_data())
            .and_then(|()| fs::rename(&beside, &path))
            .map_err(RecordError::io("write", &path))?;
        Ok(Self::new(folder, path, file))
    }

    /// Goes on with the run that a folder holds; a last record that was cut off is cut away. Also gives
    /// what the run holds.
    ///
    /// # Errors
    /// When there is no run, it is damaged, or it is another run than that of the header.
    pub fn resume(folder: &Path, header: &Header) -> Result<(Self, Run), RecordError> {
        let (mut run, whole) = Run::read_prefix(folder)?;
        if let Some(reason) = another(&run.header, header) {
            return Err(RecordError::Another {
                path: folder.to_owned(),
                reason,
            });
        }
        let path = folder.join("run.jsonl");
        let mut file = File::options()
            .read(true)
            .write(true)
            .open(&path)
            .map_err(RecordError::io("write", &path))?;
        let cut = |file: &mut File| -> std::io::Result<()> {
            file.set_len(whole)?;
            file.seek(SeekFrom::Start(whole.saturating_sub(1)))?;
            let mut last = [0];
            file.read_exact(&mut last)?;
            // A record may lack no more than its newline.
            if last != *b"\n" {
                file.write_all(b"\n")?;
            }
            Ok(())
        };
        cut(&mut file).map_err(RecordError::io("write", &path))?;
        run.truncated = false;
        Ok((Self::new(folder, path, file), run))
    }

    fn new(folder: &Path, path: PathBuf, file: File) -> Self {
        Self {
            folder: folder.to_owned(),
            path,
            file,
            synced: Instant::now(),
        }
    }

    /// Writes the list of selected ids beside the run, before sharding and in the case files' order. It
    /// must be the selection that the header's digest names.
    ///
    /// # Errors
    /// When the file cannot be written.
    pub fn write_cases<'a>(
        &self,
        ids: impl IntoIterator<Item = &'a str>,
    ) -> Result<(), RecordError> {
        write_cases(&self.folder, ids)
    }

    /// Appends one record in a single write. A record longer than [`MAX_LINE`] is shortened: wrong
    /// texels first, then the story, then the message.
    ///
    /// # Errors
    /// When the file cannot be written, or the record cannot be shortened enough.
    pub fn append(&mut self, record: &Record) -> Result<(), RecordError> {
        let line = fit(record)?;
        self.file
            .write_all(&line)
            .map_err(RecordError::io("write", &self.path))?;
        if self.synced.elapsed() >= SYNC_EVERY {
            self.sync()?;
        }
        Ok(())
    }

    /// Has the system put everything that was appended where a power cut leaves it; [`RunWriter::append`]
    /// does so about once a second.
    ///
    /// # Errors
    /// When the system cannot.
    pub fn sync(&mut self) -> Result<(), RecordError> {
        self.synced = Instant::now();
        let synced = self.file.sync_data();
        synced.map_err(RecordError::io("write", &self.path))
    }

    /// Writes a frame file and returns its path below the run folder, for [`Record::frame`]. Call
    /// it before the record is appended, so that no record names a file that is not there.
    ///
    /// # Errors
    /// When the file cannot be written.
    pub fn write_frame(&self, frame: &FrameFile) -> Result<String, RecordError> {
        let relative = frame_path(&frame.adapter, &frame.case);
        let path = self.folder.join(&relative);
        if let Some(parent) = path.parent() {
            fs::create_dir_all(parent).map_err(RecordError::io("create", parent))?;
        }
        let bytes = json_line("a frame", frame)?;
        fs::write(&path, bytes).map_err(RecordError::io("write", &path))?;
        Ok(relative)
    }

    /// Writes a picture as PNG and returns its path below the run folder. `rgb` holds red, green and
    /// blue of each texel, row by row from the top. Call it before the record is appended.
    ///
    /// # Errors
    /// When the file cannot be written, or there are not as many values as the size asks for.
    pub fn write_picture(
        &self,
        case: &str,
        [width, height]: [u32; 2],
        rgb: &[u8],
    ) -> Result<String, RecordError> {
        let relative = format!("{}.png", path_below("pictures", case));
        let path = self.folder.join(&relative);
        if let Some(parent) = path.parent() {
            fs::create_dir_all(parent).map_err(RecordError::io("create", parent))?;
        }
        image::save_buffer(&path, rgb, width, height, image::ColorType::Rgb8)
            .map_err(std::io::Error::other)
            .map_err(RecordError::io("write", &path))?;
        Ok(relative)
    }

    /// The run folder.
    pub fn folder(&self) -> &Path {
        &self.folder
    }
}

/// What makes the run of one header another than that of the other.
fn another(there: &Header, here: &Header) -> Option<String> {
    if let Some(conflict) = there.conflict(here) {
        return Some(conflict);
    }
    let shard = |h: &Header| match h.settings.shard {
        Some(shard) => format!("shard {shard}"),
        None => "not sharded".to_owned(),
    };
    if shard(there) != shard(here) {
        return Some(format!("it is {} and not {}", shard(there), shard(here)));
    }
    for adapter in &there.adapters {
        match here.adapter(&adapter.name) {
            None => return Some(format!("{} was there and is not here", adapter.name)),
            Some(now) => {
                if let Some(conflict) = adapter.conflict(now) {
                    return Some(conflict);
                }
            }
        }
    }
    let new = here.adapters.iter();
    new.map(|a| &a.name)
        .find(|name| there.adapter(name).is_none())
        .map(|name| format!("{name} is here and was not there"))
}

pub(crate) fn gone(
    result: std::io::Result<()>,
    folder: &Path,
    name: &str,
) -> Result<(), RecordError> {
    match result {
        Err(e) if e.kind() != ErrorKind::NotFound => {
            Err(RecordError::io("remove", &folder.join(name))(e))
        }
        _ => Ok(()),
    }
}

pub(crate) fn json_line(
    what: &'static str,
    value: &impl Serialize,
) -> Result<Vec<u8>, RecordError> {
    let mut line = serde_json::to_vec(value).map_err(RecordError::serialize(what))?;
    line.push(b'\n');
    Ok(line)
}

/// `frames/<adapter>/<case>.json`, with everything that could mislead a file system replaced.
fn frame_path(adapter: &str, case: &str) -> String {
    let folder = format!("frames/{}", safe(adapter));
    format!("{}.json", path_below(&folder, case))
}

/// `<folder>/<case>`, with everything in the case that could mislead a file system replaced.
fn path_below(folder: &str, case: &str) -> String {
    let mut path = folder.to_owned();
    for part in case.split('/') {
        path.push('/');
        path.push_str(&safe(part));
    }
    path
}

/// One safe path component. `:` becomes `_`; a component that changes otherwise also gets a hash
/// of what it was, so that two of them do not become one.
fn safe(part: &str) -> String {
    const LONGEST: usize = 160;
    let fine = |c: char| c.is_ascii_alphanumeric() || "._=+-".contains(c);
    let mut name: String = part
        .chars()
        .map(|c| if fine(c) { c } else { '_' })
        .take(LONGEST)
        .collect();
    if name.starts_with('.') {
        name.replace_range(..1, "_");
    }
    if name.is_empty() || name != part.replace(':', "_") {
        name.push_str(&format!("-{:016x}", fnv(part.bytes())));
    }
    name
}

/// The record's line, shortened until it fits.
fn fit(record: &Record) -> Result<Vec<u8>, RecordError> {
    let write = |record: &Record| json_line("a record", record);
    let mut line = write(record)?;
    if line.len() <= MAX_LINE && record.wrong.len() <= MAX_WRONG_TEXELS {
        return Ok(line);
    }
    let mut short = record.clone();
    short.wrong.truncate(MAX_WRONG_TEXELS);
    line = write(&short)?;
    while line.len() > MAX_LINE && short.wrong.len() > 1 {
        short.wrong.truncate(short.wrong.len() * 3 / 4);
        line = write(&short)?;
    }
    while line.len() > MAX_LINE
        && let Some(story) = &mut short.story
    {
        let kept = story.lines.len() / 2;
        if kept < 3 {
            short.story = None;
        } else {
            story.lines.truncate(kept);
            story.lines.push(StoryLine {
                at: "end of the record".to_owned(),
                operation: "cut".to_owned(),
                detail: "the rest of the story did not fit".to_owned(),
                citation: None,
            });
        }
        line = write(&short)?;
    }
    while line.len() > MAX_LINE && !short.message.is_empty() {
        cut(&mut short.message);
        line = write(&short)?;
    }
    if line.len() > MAX_LINE {
        return Err(RecordError::TooLong {
            case: record.case.chars().take(200).collect(),
            adapter: record.adapter.chars().take(200).collect(),
            limit: MAX_LINE,
        });
    }
    Ok(line)
}

/// Takes a quarter off the front of a message: the reason of a death usually stands at its end.
fn cut(message: &mut String) {
    const MARK: &str = "[cut] ";
    let text = message.strip_prefix(MARK).unwrap_or(message);
    let mut from = text.len() / 4 + 1;
    while from < text.len() && !text.is_char_boundary(from) {
        from += 1;
    }
    let rest = text.get(from..).unwrap_or_default();
    *message = if rest.is_empty() {
        String::new()
    } else {
        format!("{MARK}{rest}")
    };
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn frame_paths_stay_below_the_folder_and_apart() {
        assert_eq!(
            frame_path("gl:es:softpipe", "depth/compare/stored=0.5"),
            "frames/gl_es_softpipe/depth/compare/stored=0.5.json"
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
