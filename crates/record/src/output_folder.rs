//! An output folder, and the list of the files that were written into it.
//!
//! Only listed files are replaced or removed, so a user's file in the folder is safe whatever its name is. A
//! file is listed before it is written. Links below the folder are never followed.

use crate::content::Content;
use crate::error::RecordError;
use crate::folder::{FolderKind, LIST, LIST_MARK, RUN_FILE, TIMED_FOLDER, WORK_FOLDER};
use crate::list::read_list;
use crate::lock::LOCK_FILE;
use crate::paths::{below, lowest_real};
use crate::unlisted;
use serde::Serialize;
use std::collections::HashSet;
use std::fs::{self, File, FileType, OpenOptions};
use std::io::{ErrorKind, Read, Write};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};

/// More bytes than the list and the header of a new recording have.
const FIRST_FILES: usize = 1 << 20;

/// A folder that files are written to.
#[derive(Debug)]
pub struct OutputFolder {
    folder: PathBuf,
    state: Mutex<FolderState>,
}

#[derive(Debug)]
struct FolderState {
    /// The paths of the files that etalon wrote, below the folder.
    listed: HashSet<String>,
    /// True if these paths are in no list yet.
    is_unlisted: bool,
    /// The list, once a path was added to it.
    list: Option<File>,
    /// Folders that exist and are no links.
    real: HashSet<PathBuf>,
}

impl OutputFolder {
    /// Opens a folder, which does not have to exist. Writes nothing.
    ///
    /// # Errors
    /// If its list cannot be read.
    pub fn open(folder: &Path) -> Result<Self, RecordError> {
        let list = read_list(folder)?;
        let is_unlisted = list.is_none();
        let listed = list.unwrap_or_else(|| unlisted::files(folder));
        Ok(Self {
            folder: folder.to_owned(),
            state: Mutex::new(FolderState {
                listed,
                is_unlisted,
                list: None,
                real: HashSet::new(),
            }),
        })
    }

    /// Opens a folder for a new recording of a kind. Removes an earlier one, but for its marking file, which is
    /// replaced by renaming.
    ///
    /// # Errors
    /// If the folder holds anything else. Nothing has changed then.
    pub fn replace(folder: &Path, kind: FolderKind) -> Result<Self, RecordError> {
        match Content::writable(folder)? {
            Content::Recorded(other) if other != kind => {
                let path = folder.to_owned();
                return Err(RecordError::Holds { path, kind: other });
            }
            _ => {}
        }
        let out = Self::open(folder)?;
        out.check(kind)?;
        out.clear(Some(kind))?;
        Ok(out)
    }

    /// Returns the folder.
    pub fn path(&self) -> &Path {
        &self.folder
    }

    /// Checks that a recording of this kind can be written without touching a file of somebody else.
    ///
    /// # Errors
    /// Names the first file or link that is in the way.
    pub fn check(&self, kind: FolderKind) -> Result<(), RecordError> {
        self.check_names(kind.names().iter().copied())
    }

    /// Checks that the reports of a recording of this kind can be written, as [`OutputFolder::check`] does.
    ///
    /// # Errors
    /// Names the first file or link that is in the way.
    pub fn check_reports(&self, kind: FolderKind) -> Result<(), RecordError> {
        self.check_names(kind.reports())
    }

    fn check_names<'n>(&self, names: impl Iterator<Item = &'n str>) -> Result<(), RecordError> {
        let state = self.state();
        for name in names {
            let path = self.folder.join(name.trim_end_matches('/'));
            let Some(found) = type_of(&path)? else {
                continue;
            };
            match name.strip_suffix('/') {
                _ if found.is_symlink() => return Err(RecordError::Link { path }),
                Some(_) if [WORK_FOLDER, TIMED_FOLDER].contains(&name) => {
                    Content::writable(&path)?;
                }
                Some(folder) if found.is_dir() => self.check_folder(&state, folder)?,
                None if found.is_file() && state.listed.contains(name) => {}
                _ => return Err(RecordError::NotOurs { path }),
            }
        }
        let list = self.folder.join(LIST);
        match type_of(&list)? {
            Some(found) if !found.is_file() => Err(RecordError::Link { path: list }),
            Some(_) if read_list(&self.folder)?.is_none() => {
                Err(RecordError::NotOurs { path: list })
            }
            _ => Ok(()),
        }
    }

    /// Checks that a folder of etalon has listed files and folders only.
    fn check_folder(&self, state: &FolderState, name: &str) -> Result<(), RecordError> {
        let folder = self.folder.join(name);
        let failed = || RecordError::io("read", &folder);
        for entry in fs::read_dir(&folder).map_err(failed())? {
            let entry = entry.map_err(failed())?;
            let (path, last) = (entry.path(), entry.file_name());
            let last = last.to_string_lossy();
            let below = format!("{name}/{last}");
            let found = entry.file_type().map_err(failed())?;
            if found.is_symlink() {
                return Err(RecordError::Link { path });
            } else if found.is_dir() && !state.listed.contains(&below) {
                self.check_folder(state, &below)?;
            } else if !(found.is_file() && (state.listed.contains(&below) || is_temporary(&last))) {
                return Err(RecordError::NotOurs { path });
            }
        }
        Ok(())
    }

    /// Writes a file below the folder, and creates the folders that it needs. A concurrent reader sees the old
    /// file or the new one.
    ///
    /// # Errors
    /// If the path leaves the folder or goes through a link, if there is a file that etalon did not write, or if
    /// the system refuses.
    pub fn write(&self, name: &str, bytes: &[u8]) -> Result<PathBuf, RecordError> {
        self.place(name, |file| file.write_all(bytes).map_err(Into::into))
            .map(|(path, _)| path)
    }

    /// Writes a list as JSON; removes the file if the list is empty. `what` names the list in an error.
    ///
    /// # Errors
    /// As [`OutputFolder::write`].
    pub(crate) fn write_json<T: Serialize>(
        &self,
        name: &str,
        what: &'static str,
        list: &[T],
    ) -> Result<(), RecordError> {
        if list.is_empty() {
            return self.retain(|other| other != name);
        }
        let mut text = serde_json::to_string_pretty(list).map_err(RecordError::serialize(what))?;
        text.push('\n');
        self.write(name, text.as_bytes()).map(drop)
    }

    /// Writes a file that no reader looks for before it is whole. Leaves no temporary file if the process is killed.
    ///
    /// # Errors
    /// As [`OutputFolder::write`].
    pub(crate) fn write_in_place(&self, name: &str, bytes: &[u8]) -> Result<(), RecordError> {
        let relative = below(name)?;
        self.list(&relative)?;
        let path = self.folder.join(relative);
        let mut options = OpenOptions::new();
        remove_if_there(&path)
            .and_then(|()| options.write(true).create_new(true).open(&path))
            .and_then(|mut file| file.write_all(bytes))
            .map_err(RecordError::io("write", &path))
    }

    /// Writes a file as [`OutputFolder::write`] does, from a reader.
    ///
    /// # Errors
    /// As [`OutputFolder::write`], and if the reader fails.
    pub fn write_from(&self, name: &str, reader: &mut dyn Read) -> Result<PathBuf, RecordError> {
        let copy = |file: &mut File| Ok(std::io::copy(reader, file).map(drop)?);
        self.place(name, copy).map(|(path, _)| path)
    }

    /// Writes a file as [`OutputFolder::write`] does, and returns it with its path, to append to.
    pub(crate) fn place(
        &self,
        name: &str,
        fill: impl FnOnce(&mut File) -> Result<(), FillError>,
    ) -> Result<(PathBuf, File), RecordError> {
        let relative = below(name)?;
        self.list(&relative)?;
        let path = self.folder.join(&relative);
        let last = relative.file_name().unwrap_or_default().to_string_lossy();
        let beside = path.with_file_name(format!(".{last}.{}", std::process::id()));
        let result = (|| {
            remove_if_there(&beside)?;
            let mut file = OpenOptions::new()
                .write(true)
                .create_new(true)
                .open(&beside)?;
            fill(&mut file)?;
            fs::rename(&beside, &path)?;
            Ok(file)
        })();
        match result {
            Ok(file) => Ok((path, file)),
            Err(error) => {
                // Errors are ignored: the first error is reported.
                let _ = fs::remove_file(&beside);
                Err(match error {
                    FillError::Io(source) => RecordError::io("write", &path)(source),
                    FillError::Record(error) => error,
                })
            }
        }
    }

    /// Makes the folders of a file, checks that the file can be replaced, and lists it.
    fn list(&self, relative: &Path) -> Result<(), RecordError> {
        let mut state = self.state();
        let parent = relative.parent().unwrap_or(Path::new(""));
        if !state.real.contains(parent) {
            let parts: Vec<_> = parent.components().collect();
            let mut folder = self.folder.clone();
            fs::create_dir_all(&folder).map_err(RecordError::io("create", &folder))?;
            for part in parts {
                folder.push(part);
                match fs::create_dir(&folder) {
                    Err(e) if e.kind() != ErrorKind::AlreadyExists => {
                        return Err(RecordError::io("create", &folder)(e));
                    }
                    _ => {}
                }
                if !type_of(&folder)?.is_some_and(|found| found.is_dir()) {
                    return Err(RecordError::Link { path: folder });
                }
            }
            state.real.insert(parent.to_owned());
        }
        let name = list_name(relative);
        let path = self.folder.join(relative);
        match type_of(&path)? {
            Some(found) if found.is_symlink() => return Err(RecordError::Link { path }),
            Some(found) if !found.is_file() => return Err(RecordError::NotOurs { path }),
            Some(_) if state.listed.contains(&name) => {}
            Some(_) => {
                // Another process may have written it since.
                if let Some(listed) = read_list(&self.folder)? {
                    state.listed.extend(listed);
                }
                if !state.listed.contains(&name) {
                    return Err(RecordError::NotOurs { path });
                }
            }
            None => {}
        }
        if state.listed.insert(name.clone()) || state.is_unlisted {
            self.append(&mut state, &name)?;
            state.is_unlisted = false;
        }
        Ok(())
    }

    /// Adds a path to the list. A new list begins with the files of an earlier version.
    fn append(&self, state: &mut FolderState, name: &str) -> Result<(), RecordError> {
        let path = self.folder.join(LIST);
        let failed = || RecordError::io("write", &path);
        let FolderState { listed, list, .. } = state;
        let file = match list {
            Some(file) => file,
            None => {
                if type_of(&path)?.is_some_and(|found| !found.is_file()) {
                    return Err(RecordError::Link { path });
                }
                let old = fs::read(&path).ok();
                let file = OpenOptions::new()
                    .append(true)
                    .create(true)
                    .open(&path)
                    .map_err(failed())?;
                let file = list.insert(file);
                match old {
                    None => {
                        let others = listed.iter().filter(|other| *other != name);
                        let text = list_text(others);
                        file.write_all(text.as_bytes()).map_err(failed())?;
                    }
                    // An editor can leave out the last line end.
                    Some(old) if !old.ends_with(b"\n") => {
                        file.write_all(b"\n").map_err(failed())?;
                    }
                    Some(_) => {}
                }
                file
            }
        };
        let line = format!("{name}\n");
        file.write_all(line.as_bytes()).map_err(failed())
    }

    /// Removes the listed files and the folders that become empty; a marking file last. Keeps the marking
    /// file of `kept`. Links and other files stay.
    ///
    /// # Errors
    /// If a file cannot be removed, or if the disk has no room for the first files of a new recording. Nothing is
    /// removed then.
    pub fn clear(&self, kept: Option<FolderKind>) -> Result<(), RecordError> {
        if !self.state().listed.is_empty() {
            self.check_room()?;
        }
        self.remove_listed(kept)
    }

    /// Checks that the disk has room for a list and a header.
    fn check_room(&self) -> Result<(), RecordError> {
        let path = self
            .folder
            .join(format!(".{RUN_FILE}.{}", std::process::id()));
        let written = remove_if_there(&path).and_then(|()| {
            let mut options = OpenOptions::new();
            let mut file = options.write(true).create_new(true).open(&path)?;
            file.write_all(&vec![0; FIRST_FILES])?;
            // Some file systems allocate late.
            file.sync_all()
        });
        let removed = remove_if_there(&path);
        written
            .and(removed)
            .map_err(RecordError::io("write", &self.folder.join(LIST)))
    }

    fn remove_listed(&self, kept: Option<FolderKind>) -> Result<(), RecordError> {
        let mut state = self.state();
        let is_mark = |name: &str| FolderKind::ALL.iter().any(|kind| kind.file() == name);
        let (marks, files): (Vec<String>, Vec<String>) =
            state.listed.drain().partition(|name| is_mark(name));
        let mut folders = HashSet::new();
        for name in &files {
            if let Some(relative) = self.remove(name)? {
                let parents = relative.ancestors().skip(1);
                folders.extend(parents.map(Path::to_owned));
            }
        }
        let mut folders: Vec<PathBuf> = folders.into_iter().collect();
        folders.sort_by_key(|folder| std::cmp::Reverse(folder.components().count()));
        for folder in folders.iter().filter(|folder| **folder != Path::new("")) {
            // A folder that holds something else stays.
            let _ = fs::remove_dir(self.folder.join(folder));
        }
        let kept = kept.map(FolderKind::file);
        for name in marks.iter().filter(|name| Some(name.as_str()) != kept) {
            self.remove(name)?;
        }
        // The list stays: it shows that the folder is one of etalon, until there is a marking file again.
        let list = self.folder.join(LIST);
        state.list = None;
        state.real.clear();
        if type_of(&list)?.is_some_and(|found| found.is_file()) {
            let text = list_text(std::iter::empty());
            fs::write(&list, text).map_err(RecordError::io("write", &list))?;
        }
        if let Some(kept) = kept.filter(|kept| marks.iter().any(|name| name == kept)) {
            state.listed.insert(kept.to_owned());
            self.append(&mut state, kept)?;
        }
        Ok(())
    }

    /// Removes the listed files, the list and the lock, and the folder unless it holds something else.
    ///
    /// # Errors
    /// If a file cannot be removed.
    pub fn remove_all(&self) -> Result<(), RecordError> {
        self.remove_listed(None)?;
        for name in [LIST, LOCK_FILE] {
            let path = self.folder.join(name);
            remove_if_there(&path).map_err(RecordError::io("remove", &path))?;
        }
        // A folder that holds something else stays.
        let _ = fs::remove_dir(&self.folder);
        Ok(())
    }

    /// Removes a listed file, and returns its path below the folder; `None` if the path is no regular file.
    fn remove(&self, name: &str) -> Result<Option<PathBuf>, RecordError> {
        let Ok(relative) = below(name) else {
            return Ok(None);
        };
        let path = self.folder.join(&relative);
        if !lowest_real(&self.folder, &relative) {
            return Ok(None);
        }
        match fs::remove_file(&path) {
            Err(e) if e.kind() != ErrorKind::NotFound => Err(RecordError::io("remove", &path)(e)),
            _ => Ok(Some(relative)),
        }
    }

    /// Removes the listed files whose names `keep` refuses, from the list too.
    ///
    /// # Errors
    /// If one cannot be removed.
    pub fn retain(&self, keep: impl Fn(&str) -> bool) -> Result<(), RecordError> {
        let mut state = self.state();
        // Another process may have added to it.
        if let Some(listed) = read_list(&self.folder)? {
            state.listed.extend(listed);
        }
        let others: Vec<String> = state.listed.extract_if(|name| !keep(name)).collect();
        if others.is_empty() {
            return Ok(());
        }
        for name in &others {
            self.remove(name)?;
        }
        let list = self.folder.join(LIST);
        let beside = self.folder.join(format!("{LIST}.{}", std::process::id()));
        fs::write(&beside, list_text(state.listed.iter()))
            .and_then(|()| fs::rename(&beside, &list))
            .map_err(RecordError::io("write", &list))?;
        state.list = None;
        state.is_unlisted = false;
        Ok(())
    }

    fn state(&self) -> MutexGuard<'_, FolderState> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// An error of the closure that fills a file.
#[derive(Debug)]
pub(crate) enum FillError {
    Io(std::io::Error),
    Record(RecordError),
}

impl From<std::io::Error> for FillError {
    fn from(error: std::io::Error) -> Self {
        Self::Io(error)
    }
}

impl From<RecordError> for FillError {
    fn from(error: RecordError) -> Self {
        Self::Record(error)
    }
}

/// Returns the type of what is at a path, without following a link; `None` if there is nothing.
fn type_of(path: &Path) -> Result<Option<FileType>, RecordError> {
    match fs::symlink_metadata(path) {
        Ok(found) => Ok(Some(found.file_type())),
        Err(e) if e.kind() == ErrorKind::NotFound => Ok(None),
        Err(e) => Err(RecordError::io("read", path)(e)),
    }
}

/// Returns the text of a list.
fn list_text<'n>(names: impl Iterator<Item = &'n String>) -> String {
    let mut text = format!("{LIST_MARK}\n");
    for name in names {
        text.push_str(name);
        text.push('\n');
    }
    text
}

/// Returns true for the name of a file that a killed process left: a dot, a name, a dot and a process id.
fn is_temporary(name: &str) -> bool {
    let ending = name
        .strip_prefix('.')
        .and_then(|name| name.rsplit_once('.'));
    ending.is_some_and(|(_, id)| id.parse::<u32>().is_ok())
}

fn remove_if_there(path: &Path) -> std::io::Result<()> {
    match fs::remove_file(path) {
        Err(e) if e.kind() != ErrorKind::NotFound => Err(e),
        _ => Ok(()),
    }
}

/// Returns a path below a folder as the list names it.
fn list_name(relative: &Path) -> String {
    let parts = relative
        .components()
        .map(|part| part.as_os_str().to_string_lossy());
    parts.collect::<Vec<_>>().join("/")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn text(path: &Path) -> String {
        fs::read_to_string(path).unwrap()
    }

    #[test]
    fn only_files_that_etalon_wrote_are_removed() {
        let folder = tempfile::tempdir().unwrap();
        let folder = folder.path();
        let out = OutputFolder::open(folder).unwrap();
        out.write("run.jsonl", b"{\"etalon\":\"1\"}\n").unwrap();
        out.write("frames/a/b/c.json.gz", b"ours").unwrap();
        out.write("index.html", b"ours").unwrap();
        for name in ["frames/a/mine.json.gz", "notes.txt", "pictures/mine.png"] {
            let path = folder.join(name);
            fs::create_dir_all(path.parent().unwrap()).unwrap();
            fs::write(path, "mine").unwrap();
        }
        let again = OutputFolder::open(folder).unwrap();
        let refused = again.check(FolderKind::Run).unwrap_err().to_string();
        assert!(refused.contains("mine."), "{refused}");
        again.clear(Some(FolderKind::Run)).unwrap();
        assert!(folder.join("run.jsonl").exists());
        assert!(!folder.join("index.html").exists() && !folder.join("frames/a/b").exists());
        again.clear(None).unwrap();
        assert!(!folder.join("run.jsonl").exists());
        assert_eq!(text(&folder.join(LIST)), format!("{LIST_MARK}\n"));
        assert_eq!(Content::of(folder).unwrap(), Content::Empty);
        for name in ["frames/a/mine.json.gz", "notes.txt", "pictures/mine.png"] {
            assert_eq!(text(&folder.join(name)), "mine", "{name}");
        }
    }

    #[test]
    fn a_file_of_somebody_else_is_never_replaced() {
        let folder = tempfile::tempdir().unwrap();
        let folder = folder.path();
        let out = OutputFolder::open(folder).unwrap();
        out.write("run.jsonl", b"{}\n").unwrap();
        fs::write(folder.join("index.html"), "mine").unwrap();
        let written = out.write("index.html", b"ours").map(|_| ());
        for refused in [out.check(FolderKind::Run), written] {
            match refused.unwrap_err() {
                RecordError::NotOurs { path } => assert_eq!(path, folder.join("index.html")),
                other => panic!("{other}"),
            }
        }
        assert_eq!(text(&folder.join("index.html")), "mine");
        assert!(out.write("../x", b"").is_err() && out.write("/tmp/x", b"").is_err());
    }

    #[test]
    fn a_file_that_another_process_listed_can_be_replaced() {
        let folder = tempfile::tempdir().unwrap();
        let [one, other] = [(); 2].map(|()| OutputFolder::open(folder.path()).unwrap());
        one.write("index.html", b"1").unwrap();
        let path = other.write("index.html", b"2").unwrap();
        assert_eq!(text(&path), "2");
    }

    #[cfg(unix)]
    #[test]
    fn links_are_not_followed() {
        use std::os::unix::fs::symlink;
        let work = tempfile::tempdir().unwrap();
        let elsewhere = work.path().join("elsewhere");
        fs::create_dir(&elsewhere).unwrap();
        fs::write(elsewhere.join("x"), "mine").unwrap();
        let folder = work.path().join("out");
        let out = OutputFolder::open(&folder).unwrap();
        out.write("run.jsonl", b"{}\n").unwrap();
        symlink(&elsewhere, folder.join("frames")).unwrap();
        symlink(elsewhere.join("x"), folder.join("index.html")).unwrap();
        for name in ["frames/x", "index.html"] {
            let refused = out.write(name, b"ours").unwrap_err();
            assert!(matches!(refused, RecordError::Link { .. }), "{refused}");
        }
        assert!(out.check(FolderKind::Run).is_err());
        // A list that names them removes neither the link nor what is behind it.
        let names = ["frames/x", "index.html", "../elsewhere/x"].map(str::to_owned);
        fs::write(folder.join(LIST), list_text(names.iter())).unwrap();
        OutputFolder::open(&folder).unwrap().clear(None).unwrap();
        assert_eq!(text(&elsewhere.join("x")), "mine");
        assert!(folder.join("index.html").is_symlink());
        // The list itself is not written through a link.
        fs::remove_file(folder.join(LIST)).unwrap();
        symlink(elsewhere.join("new"), folder.join(LIST)).unwrap();
        let out = OutputFolder::open(&folder).unwrap();
        assert!(out.write("summary.md", b"ours").is_err());
        assert!(!elsewhere.join("new").exists());
    }

    #[test]
    fn a_file_of_a_user_named_like_the_list_marks_nothing() {
        let folder = tempfile::tempdir().unwrap();
        let folder = folder.path();
        fs::write(folder.join("notes.txt"), "mine").unwrap();
        for list in ["", "notes.txt\n", "\u{feff}notes.txt"] {
            fs::write(folder.join(LIST), list).unwrap();
            assert_eq!(Content::of(folder).unwrap(), Content::Other, "{list}");
            let refused = OutputFolder::replace(folder, FolderKind::Run).unwrap_err();
            assert!(matches!(refused, RecordError::Foreign { .. }), "{refused}");
        }
        // A list of etalon with files that are there is no leftover.
        fs::write(
            folder.join(LIST),
            list_text([&"notes.txt".to_owned()].into_iter()),
        )
        .unwrap();
        assert_eq!(Content::of(folder).unwrap(), Content::Other);
        assert_eq!(text(&folder.join("notes.txt")), "mine");
    }

    #[test]
    fn a_removed_file_is_not_listed_any_more() {
        let folder = tempfile::tempdir().unwrap();
        let out = OutputFolder::open(folder.path()).unwrap();
        out.write("run.jsonl", b"").unwrap();
        out.write("cases/a.js", b"").unwrap();
        out.retain(|name| name != "cases/a.js").unwrap();
        out.write("junit.xml", b"").unwrap();
        let listed = read_list(folder.path()).unwrap().unwrap();
        assert_eq!(listed.len(), 2, "{listed:?}");
        // A file that is written again is listed already.
        let list = text(&folder.path().join(LIST));
        for _ in 0..2 {
            let again = OutputFolder::open(folder.path()).unwrap();
            again.write("junit.xml", b"2").unwrap();
            again.write("run.jsonl", b"2").unwrap();
        }
        assert_eq!(text(&folder.path().join(LIST)), list);
        // A missing line end joins no names.
        let list = text(&folder.path().join(LIST));
        fs::write(folder.path().join(LIST), list.trim_end()).unwrap();
        OutputFolder::open(folder.path())
            .unwrap()
            .write("x", b"")
            .unwrap();
        assert_eq!(read_list(folder.path()).unwrap().unwrap().len(), 3);
    }
}
