//! Saved runs: a run folder as one file, `*.tar.gz`, as the page saves it or `tar` packs it. Commands unpack it
//! beside the file, and use the folder.
//!
//! Only records, frames and pictures are taken. Pages and scripts are made anew from them, so that nothing
//! runs in a browser that came with an archive.

use crate::failure::Failure;
use crate::output::say;
use clap::Args;
use etalon_record::{
    BESIDE_FILE, CASES_FILE, Content, DEAD_FILE, FolderKind, MISSING_FILE, OutputFolder, RUN_FILE,
    RecordError, open_below,
};
use etalon_report::plain;
use flate2::read::GzDecoder;
use std::cell::Cell;
use std::fs::{self, File};
use std::io::{self, BufRead, BufReader, Read};
use std::path::{Component, Path, PathBuf};
use tar::{Archive, EntryType};

#[cfg(test)]
#[path = "../../record/tests/spoil/mod.rs"]
mod spoil;

/// The end of a saved run's name.
const EXTENSION: &str = ".tar.gz";
/// The files that are taken from an archive.
const FILES: [&str; 5] = [RUN_FILE, CASES_FILE, MISSING_FILE, DEAD_FILE, BESIDE_FILE];
/// The folders whose files are taken, and the ends of the files' names.
const FOLDERS: [(&str, &[&str]); 2] = [("frames", &[".json.gz", ".json"]), ("pictures", &[".png"])];
/// The maximum number of bytes of an entry's header, with a long name and attributes: the reader of archives holds
/// them in memory.
const MAX_HEADER: u64 = 64 << 10;
/// The number of files left out that are named, and the length of a name.
const NAMED: usize = 20;
const LONGEST: usize = 120;

/// The flag for the size of saved runs.
#[derive(Clone, Copy, Debug, Args)]
pub(crate) struct UnpackArguments {
    /// The largest size of a saved run (`*.tar.gz`) when it is unpacked. A full run of thirteen adapters has 320 MiB
    #[arg(long, value_name = "MIB", default_value = "1024", value_parser = clap::value_parser!(u64).range(1..=1 << 20))]
    pub(crate) max_unpacked: u64,
}

impl UnpackArguments {
    /// Returns the run folders of a command: for a saved run, the folder that it is unpacked to; any other path
    /// unchanged.
    ///
    /// # Errors
    /// If a saved run cannot be unpacked.
    pub(crate) fn folders(self, paths: &[PathBuf]) -> Result<Vec<PathBuf>, Failure> {
        paths.iter().map(|path| self.folder(path)).collect()
    }

    /// Returns the run folder of a path, as [`UnpackArguments::folders`] does.
    ///
    /// # Errors
    /// If it is a saved run that cannot be unpacked.
    pub(crate) fn folder(self, path: &Path) -> Result<PathBuf, Failure> {
        let name = path.to_str().and_then(|name| name.strip_suffix(EXTENSION));
        let Some(folder) = name.map(PathBuf::from).filter(|_| path.is_file()) else {
            return Ok(path.to_owned());
        };
        let failed =
            |error: io::Error| Failure::usage(format!("cannot unpack {}: {error}", path.display()));
        let mut beside = folder.as_os_str().to_owned();
        beside.push(format!(".{}", std::process::id()));
        let beside = PathBuf::from(beside);
        fs::create_dir(&beside).map_err(failed)?;
        let unpacked = self.unpack(path, &beside);
        let placed = unpacked.and_then(|left_out| Ok((place(&beside, &folder)?, left_out)));
        if beside.exists() {
            // The first error is the one to report.
            let _ = fs::remove_dir_all(&beside);
        }
        let (is_new, left_out) = placed.map_err(failed)?;
        if is_new {
            say!("{} is unpacked to {}", path.display(), folder.display());
        }
        if !left_out.is_empty() {
            say!("{}", left_out_text(path, &left_out));
        }
        Ok(folder)
    }

    /// Unpacks an archive into an empty folder. Returns the names of the files that were left out.
    fn unpack(self, path: &Path, to: &Path) -> io::Result<Vec<String>> {
        let root = self.root(path)?;
        let out = OutputFolder::open(to).map_err(io::Error::other)?;
        let mut left_out = Vec::new();
        self.each_file(path, |name, entry| {
            let shown = plain(&name.to_string_lossy(), LONGEST);
            let below = parts(name).and_then(|parts| taken(parts.strip_prefix(root.as_slice())?));
            let Some(below) = below else {
                left_out.push(shown);
                return Ok(());
            };
            let written = out.write_from(&below, entry);
            written.map(drop).map_err(|error| match error {
                // The path is that of a temporary folder.
                RecordError::Io { source, .. } => {
                    io::Error::new(source.kind(), format!("{shown}: {source}"))
                }
                error => io::Error::other(error),
            })
        })?;
        Ok(left_out)
    }

    /// Returns the folder in an archive that has the run.
    fn root(self, path: &Path) -> io::Result<Vec<String>> {
        let mut roots: Vec<Vec<String>> = Vec::new();
        self.each_file(path, |name, _| {
            if let Some(mut parts) = parts(name)
                && parts.last().is_some_and(|last| last == RUN_FILE)
            {
                parts.pop();
                roots.push(parts);
            }
            Ok(())
        })?;
        roots.sort_by_key(Vec::len);
        match roots.as_slice() {
            [] => Err(io::Error::other(format!("it has no {RUN_FILE}"))),
            [one, other, ..] if one.len() == other.len() => Err(io::Error::other(format!(
                "it holds several runs, {:?} and {:?}; unpack it, and name them",
                one.join("/"),
                other.join("/")
            ))),
            [one, ..] => Ok(one.clone()),
        }
    }

    /// Calls a function with the path and the content of each file.
    ///
    /// # Errors
    /// If an entry is neither a file nor a folder, or leads out of the archive's folder.
    fn each_file(
        self,
        path: &Path,
        mut call: impl FnMut(&Path, &mut dyn Read) -> io::Result<()>,
    ) -> io::Result<()> {
        let header_left = Cell::new(MAX_HEADER);
        let text = Bounded {
            inner: GzDecoder::new(File::open(path)?),
            left: self.max_unpacked << 20,
            max: self.max_unpacked,
            header_left: &header_left,
        };
        let mut archive = Archive::new(text);
        let mut entries = archive.entries()?;
        for number in 1_u64.. {
            header_left.set(MAX_HEADER);
            let Some(entry) = entries.next() else { break };
            let mut entry =
                entry.map_err(|e| io::Error::new(e.kind(), format!("its entry {number}: {e}")))?;
            header_left.set(u64::MAX);
            let name = entry.path()?.into_owned();
            let shown = plain(&name.to_string_lossy(), LONGEST);
            let is_sparse = name.iter().any(|part| {
                let part = part.to_string_lossy();
                part.starts_with("GNUSparseFile.")
            });
            match entry.header().entry_type() {
                EntryType::Regular | EntryType::Continuous if !is_sparse => {}
                EntryType::Directory | EntryType::XGlobalHeader => {
                    io::copy(&mut entry, &mut io::sink())?;
                    continue;
                }
                kind => {
                    let kind = if is_sparse { SPARSE } else { entry_type(kind) };
                    return Err(io::Error::other(format!(
                        "{shown} is {kind}; only files and folders are unpacked"
                    )));
                }
            }
            let inside = |part| matches!(part, Component::CurDir | Component::Normal(_));
            if !name.components().all(inside) {
                return Err(io::Error::other(format!("{shown} leads out of the folder")));
            }
            call(&name, &mut entry)?;
            // What is read before the next entry is then its header alone.
            io::copy(&mut entry, &mut io::sink())?;
        }
        Ok(())
    }
}

/// Returns the parts of an entry's path; `None` if one is not UTF-8.
fn parts(name: &Path) -> Option<Vec<String>> {
    let parts = name.components().filter_map(|part| match part {
        Component::Normal(part) => Some(part.to_str().map(str::to_owned)),
        _ => None,
    });
    parts.collect()
}

/// Returns the path of a run's file, from its parts below the run's folder; `None` for other files.
fn taken(parts: &[String]) -> Option<String> {
    let path = parts.join("/");
    let is_taken = match parts {
        [file] => FILES.contains(&file.as_str()),
        [folder, .., last] => FOLDERS
            .iter()
            .any(|(name, ends)| folder == name && ends.iter().any(|end| last.ends_with(end))),
        [] => false,
    };
    (is_taken && !path.contains(char::is_control)).then_some(path)
}

/// The words for a sparse file in error messages.
const SPARSE: &str = "a sparse file, which `tar` packs without --sparse";

fn entry_type(kind: EntryType) -> &'static str {
    match kind {
        EntryType::Symlink => "a symbolic link",
        EntryType::Link => "a hard link",
        EntryType::Char | EntryType::Block => "a device",
        EntryType::Fifo => "a pipe",
        EntryType::GNUSparse => SPARSE,
        _ => "no regular file",
    }
}

fn left_out_text(path: &Path, left_out: &[String]) -> String {
    let named = left_out.iter().take(NAMED).map(String::as_str);
    let mut names = named.collect::<Vec<_>>().join(", ");
    let more = left_out.len().saturating_sub(NAMED);
    if more > 0 {
        names.push_str(&format!(" and {more} more"));
    }
    format!(
        "{}: only records, frames and pictures are taken; left out: {names}",
        path.display()
    )
}

/// A reader that fails behind a number of bytes.
struct Bounded<'a, R> {
    inner: R,
    left: u64,
    /// The limit in MiB, for the error.
    max: u64,
    /// The bytes that may follow before a header ends.
    header_left: &'a Cell<u64>,
}

impl<R: Read> Read for Bounded<'_, R> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let length = self.inner.read(buffer)?;
        let header_left = self.header_left.get().checked_sub(length as u64);
        self.header_left.set(header_left.ok_or_else(|| {
            io::Error::other(format!(
                "its name and attributes have more than {} KiB; pack the run again",
                MAX_HEADER >> 10
            ))
        })?);
        self.left = self.left.checked_sub(length as u64).ok_or_else(|| {
            io::Error::other(format!(
                "it unpacks to more than {} MiB; --max-unpacked raises the limit",
                self.max
            ))
        })?;
        Ok(length)
    }
}

/// Moves an unpacked run to its folder. Returns false if the folder has the same run already.
fn place(beside: &Path, folder: &Path) -> io::Result<bool> {
    match Content::of(folder) {
        Ok(Content::Empty) => {
            if folder.exists() {
                // Fails if the folder has files of others.
                OutputFolder::open(folder)
                    .and_then(|folder| folder.remove_all())
                    .map_err(io::Error::other)?;
            }
            fs::rename(beside, folder)?;
            Ok(true)
        }
        Ok(Content::Recorded(FolderKind::Run)) if same(beside, folder)? => Ok(false),
        _ => Err(io::Error::other(format!(
            "{} holds something else; move it",
            folder.display()
        ))),
    }
}

/// Returns true if two folders have the same records.
fn same(folder: &Path, other: &Path) -> io::Result<bool> {
    let open = |folder| open_below(folder, RUN_FILE).map_err(io::Error::other);
    let [mut one, mut other] = [open(folder)?, open(other)?].map(BufReader::new);
    loop {
        let (left, right) = (one.fill_buf()?, other.fill_buf()?);
        let length = left.len().min(right.len());
        if length == 0 || left[..length] != right[..length] {
            return Ok(left.is_empty() && right.is_empty());
        }
        one.consume(length);
        other.consume(length);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use flate2::Compression;
    use flate2::write::GzEncoder;
    use std::io::Write;
    use tar::{Builder, Header};

    const LINE: &str = "{\"format\":4,\"etalon\":\"1\"}\n";
    const DEFAULT: UnpackArguments = UnpackArguments { max_unpacked: 1024 };

    /// Writes an archive of files with these names.
    fn archive(path: &Path, entries: &[(&str, EntryType, &[u8])]) {
        let packed = GzEncoder::new(File::create(path).unwrap(), Compression::fast());
        let mut builder = Builder::new(packed);
        for (name, kind, content) in entries {
            let mut header = Header::new_gnu();
            header.set_entry_type(*kind);
            // Sets the bytes of the name, since the builder refuses dangerous ones.
            header.as_old_mut().name[..name.len()].copy_from_slice(name.as_bytes());
            header.set_size(content.len() as u64);
            header.set_cksum();
            builder.append(&header, *content).unwrap();
        }
        builder.into_inner().unwrap().finish().unwrap();
    }

    const RUN: (&str, EntryType, &[u8]) = (RUN_FILE, EntryType::Regular, LINE.as_bytes());

    #[test]
    fn a_saved_run_is_unpacked_once_and_replaces_nothing() {
        let above = tempfile::tempdir().unwrap();
        let path = above.path().join("mine.tar.gz");
        archive(&path, &[RUN]);
        let unpacked = DEFAULT.folder(&path).unwrap();
        assert_eq!(unpacked, above.path().join("mine"));
        assert_eq!(fs::read_to_string(unpacked.join(RUN_FILE)).unwrap(), LINE);
        fs::write(unpacked.join("notes.txt"), "mine").unwrap();
        assert_eq!(DEFAULT.folder(&path).unwrap(), unpacked);
        assert!(unpacked.join("notes.txt").is_file());
        fs::write(unpacked.join(RUN_FILE), LINE.replace('4', "3")).unwrap();
        let refused = DEFAULT.folder(&path).unwrap_err().message;
        assert!(refused.contains("holds something else"), "{refused}");
        assert_eq!(fs::read_dir(above.path()).unwrap().count(), 2);
        assert_eq!(DEFAULT.folder(above.path()).unwrap(), above.path());
    }

    #[test]
    fn an_archive_brings_records_frames_and_pictures_only() {
        let above = tempfile::tempdir().unwrap();
        let path = above.path().join("mine.tar.gz");
        let file = |name| (name, EntryType::Regular, &b"x"[..]);
        archive(
            &path,
            &[
                ("top/", EntryType::Directory, b""),
                ("top/run.jsonl", EntryType::Regular, LINE.as_bytes()),
                file("./top/frames/cpu/a/b.json.gz"),
                file("top/pictures/a.png"),
                file("top/pictures/a.html"),
                file("top/frames/a.js"),
                file("top/cases/depth.js"),
                file("top/methods.html"),
                file("top/.files"),
            ],
        );
        let folder = DEFAULT.folder(&path).unwrap();
        for name in [RUN_FILE, "frames/cpu/a/b.json.gz", "pictures/a.png"] {
            assert!(folder.join(name).is_file(), "{name}");
        }
        for name in ["pictures/a.html", "frames/a.js", "cases", "methods.html"] {
            assert!(!folder.join(name).exists(), "{name}");
        }
        let listed = fs::read_to_string(folder.join(".files")).unwrap();
        assert_eq!(listed.lines().count(), 1 + 3, "{listed}");
        let many: Vec<String> = (0..NAMED + 2).map(|number| number.to_string()).collect();
        let text = left_out_text(&path, &many);
        assert!(text.ends_with("19 and 2 more"), "{text}");
    }

    #[test]
    fn an_archive_writes_only_files_of_its_folder() {
        let above = tempfile::tempdir().unwrap();
        let path = above.path().join("mine.tar.gz");
        for (name, kind, words) in [
            ("../run.jsonl", EntryType::Regular, "../run.jsonl leads out"),
            ("/tmp/run.jsonl", EntryType::Regular, "leads out"),
            (RUN_FILE, EntryType::Symlink, "run.jsonl is a symbolic link"),
            ("frames/a", EntryType::Link, "frames/a is a hard link"),
            ("frames/a", EntryType::Char, "is a device"),
            ("frames/a", EntryType::Fifo, "is a pipe"),
            ("other", EntryType::Regular, "it has no run.jsonl"),
            ("GNUSparseFile.1/a", EntryType::Regular, "is a sparse file"),
        ] {
            archive(&path, &[(name, kind, b"")]);
            let refused = DEFAULT.folder(&path).unwrap_err().message;
            assert!(refused.contains(words), "{name}: {refused}");
            assert_eq!(fs::read_dir(above.path()).unwrap().count(), 1, "{name}");
        }
        let other = |name| (name, EntryType::Regular, LINE.as_bytes());
        archive(&path, &[other("a/run.jsonl"), other("b/run.jsonl")]);
        let refused = DEFAULT.folder(&path).unwrap_err().message;
        assert!(refused.contains("several runs"), "{refused}");
        fs::write(&path, "no archive").unwrap();
        assert!(DEFAULT.folder(&path).is_err());
    }

    #[test]
    fn no_archive_panics_or_hangs_a_reader() {
        let above = tempfile::tempdir().unwrap();
        let path = above.path().join("mine.tar.gz");
        archive(
            &path,
            &[
                RUN,
                ("frames/", EntryType::Directory, b""),
                ("frames/a.json", EntryType::Regular, b"{}"),
                ("cases/a.js", EntryType::Regular, b"x"),
            ],
        );
        let packed = fs::read(&path).unwrap();
        let mut tar = Vec::new();
        GzDecoder::new(&*packed).read_to_end(&mut tar).unwrap();
        let small = UnpackArguments { max_unpacked: 1 };
        spoil::keep_trying("archives", &[&packed, &tar], |input| {
            // A spoiled archive inside of the compression reaches the reader of entries.
            let bytes = if input.starts_with(&[0x1f, 0x8b]) {
                input.to_owned()
            } else {
                let mut packed = GzEncoder::new(Vec::new(), Compression::fast());
                packed.write_all(input).unwrap();
                packed.finish().unwrap()
            };
            fs::write(&path, bytes).unwrap();
            if let Ok(folder) = small.folder(&path) {
                for file in fs::read_dir(&folder).unwrap() {
                    let name = file.unwrap().file_name();
                    let name = name.to_str().unwrap();
                    let top = ["run.jsonl", "frames", "pictures", ".files"];
                    assert!(top.contains(&name) || FILES.contains(&name), "{name}");
                }
                fs::remove_dir_all(folder).unwrap();
            }
            assert_eq!(fs::read_dir(above.path()).unwrap().count(), 1);
        });
    }

    #[test]
    fn a_name_and_attributes_of_an_entry_have_a_largest_size() {
        let above = tempfile::tempdir().unwrap();
        let path = above.path().join("mine.tar.gz");
        let file = ("frames/a.json", EntryType::Regular, &b"{}"[..]);
        let attribute = |length: usize| {
            let text = format!(" comment={}\n", "a".repeat(length));
            // The length counts its own digits.
            let digits = (text.len() + 8).to_string().len();
            format!("{}{text}", text.len() + digits).into_bytes()
        };
        for kind in [
            EntryType::GNULongName,
            EntryType::GNULongLink,
            EntryType::XHeader,
        ] {
            let content = |length| match kind {
                EntryType::XHeader => attribute(length),
                _ => [&b"frames/"[..], &b"a".repeat(length)].concat(),
            };
            archive(&path, &[RUN, ("long", kind, &content(8 << 20)), file]);
            let refused = DEFAULT.folder(&path).unwrap_err().message;
            let words = "its entry 2: its name and attributes have more than 64 KiB";
            assert!(refused.contains(words), "{kind:?}: {refused}");
            assert_eq!(fs::read_dir(above.path()).unwrap().count(), 1);
            // The content of a file left out is no header.
            let large = vec![b'x'; 8 << 20];
            let other = ("notes.txt", EntryType::Regular, large.as_slice());
            archive(
                &path,
                &[RUN, other, ("long", kind, &content(4 << 10)), file],
            );
            fs::remove_dir_all(DEFAULT.folder(&path).unwrap()).unwrap();
        }
    }

    #[test]
    fn an_archive_has_a_largest_size() {
        let above = tempfile::tempdir().unwrap();
        let path = above.path().join("mine.tar.gz");
        let zeros = vec![0; 2 << 20];
        archive(&path, &[RUN, ("frames/a.json", EntryType::Regular, &zeros)]);
        let small = UnpackArguments { max_unpacked: 2 };
        let refused = small.folder(&path).unwrap_err().message;
        let words = "more than 2 MiB; --max-unpacked raises the limit";
        assert!(refused.contains(words), "{refused}");
        assert_eq!(fs::read_dir(above.path()).unwrap().count(), 1);
        DEFAULT.folder(&path).unwrap();
    }
}
