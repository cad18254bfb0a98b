//! Merging several runs into one: shards of a selection, or adapters that ran elsewhere.

use crate::beside;
use crate::dead::Dead;
use crate::error::RecordError;
use crate::folder::{CASES_FILE, MISSING_FILE};
use crate::header::{FORMAT, Header, Settings};
use crate::output_folder::OutputFolder;
use crate::paths::{check_below, frame_path, open_below};
use crate::reason::Reason;
use crate::record::{Record, count_unexpected};
use crate::run::Run;
use crate::selection::read_cases;
use crate::verdict::Verdict;
use crate::writer::RunWriter;
use std::collections::{BTreeMap, BTreeSet, HashMap};
use std::io::Read;
use std::path::{Path, PathBuf};

/// Parts of a run that fit together, ready to be written.
#[derive(Debug)]
pub struct Merge {
    header: Header,
    ids: Vec<String>,
    /// Records and their folders, by the index of the adapter in the header and of the case in `ids`.
    records: HashMap<(usize, usize), (Record, PathBuf)>,
    merged: Merged,
    /// The dead expectations that all parts have in common.
    dead: Vec<Dead>,
    /// The records beside those of the selected cases.
    beside: Vec<Record>,
}

/// The counts of a merge.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Merged {
    /// Records written, one per case and adapter.
    pub records: u64,
    /// Records that count against the run.
    pub unexpected: u64,
    /// Verdicts better than the expectations.
    pub improvements: u64,
    /// Adapter and case of each record that no part has.
    pub missing: Vec<(String, String)>,
    /// Folders that hold no run.
    pub empty: Vec<PathBuf>,
    /// Records that several parts have with the same verdict; one of each is kept.
    pub twice: u64,
    /// Adapter and case of each record on which parts disagree; it becomes `Flaky`.
    pub disagreeing: Vec<(String, String)>,
}

impl Merge {
    /// Reads run folders and checks that they are parts of one run. Nothing is written.
    ///
    /// # Errors
    /// If a run is damaged, if its selection is not known, or if two are not parts of one run because their
    /// selection, settings, version of the suite or driver differ.
    pub fn read(folders: &[PathBuf]) -> Result<Self, RecordError> {
        let mut merged = Merged::default();
        let mut parts: Vec<(&PathBuf, Run)> = Vec::new();
        for folder in folders {
            match Run::read(folder) {
                Ok(run) => {
                    for file in run.records.iter().flat_map(Record::files) {
                        check_below(folder, file)?;
                    }
                    parts.push((folder, run));
                }
                Err(RecordError::NoRun { .. }) => merged.empty.push(folder.clone()),
                Err(error) => return Err(error),
            }
        }
        let Some((first, _)) = parts.first() else {
            return Err(RecordError::NoRun {
                path: folders.first().cloned().unwrap_or_default(),
            });
        };
        let ids = selection(&parts)?;
        let header = header(first, &parts)?;
        let mut dead = Dead::read(first)?;
        let mut beside = Vec::new();
        for (folder, run) in &parts {
            let also = Dead::read(folder)?;
            // An expectation that matched nothing in this part can match in another part.
            dead.retain(|entry| also.contains(entry));
            beside::add(&mut beside, run.beside.iter().cloned());
        }
        let mut merge = Self {
            header,
            ids,
            records: HashMap::new(),
            merged,
            dead,
            beside,
        };
        for (folder, run) in parts {
            merge.take(folder, run)?;
        }
        Ok(merge)
    }

    fn take(&mut self, folder: &Path, run: Run) -> Result<(), RecordError> {
        let cases: HashMap<&str, usize> = places(self.ids.iter());
        let adapters: HashMap<&str, usize> =
            places(self.header.adapters.iter().map(|a| &a.info.name));
        for record in run.records {
            let (Some(adapter), Some(case)) = (
                adapters.get(record.adapter.as_str()),
                cases.get(record.case.as_str()),
            ) else {
                return Err(RecordError::Unmergeable {
                    path: folder.to_owned(),
                    reason: format!(
                        "it has a record of {} on {}, which its header does not name",
                        record.case, record.adapter
                    ),
                });
            };
            let place = (*adapter, *case);
            let kept = match self.records.remove(&place) {
                None => (record, folder.to_owned()),
                Some(other) if other.0.verdict == record.verdict => {
                    self.merged.twice += 1;
                    // The complete record is kept.
                    if other.0.example.is_some() && record.example.is_none() {
                        (record, folder.to_owned())
                    } else {
                        other
                    }
                }
                Some(other) => {
                    let names = (record.adapter.clone(), record.case.clone());
                    self.merged.disagreeing.push(names);
                    disagreeing(other, (record, folder.to_owned()))
                }
            };
            self.records.insert(place, kept);
        }
        Ok(())
    }

    /// Returns the header of the merged run; the caller can replace its command and start.
    pub fn header_mut(&mut self) -> &mut Header {
        &mut self.header
    }

    /// Writes the merged run as a run folder: records by adapter and then case, their frames and pictures,
    /// and a list of the missing records.
    ///
    /// # Errors
    /// If a file cannot be read or written, or if a record names a file outside its folder.
    pub fn write(mut self, out: &Path) -> Result<Merged, RecordError> {
        let mut writer = RunWriter::create(out, &self.header)?;
        writer.write_cases(self.ids.iter().map(String::as_str))?;
        let mut merged = self.merged;
        for (a, adapter) in self.header.adapters.iter().enumerate() {
            for (c, case) in self.ids.iter().enumerate() {
                let Some((mut record, folder)) = self.records.remove(&(a, c)) else {
                    merged
                        .missing
                        .push((adapter.info.name.clone(), case.clone()));
                    continue;
                };
                if let Some(frame) = &mut record.frame {
                    // Two parts of earlier versions can have one path for two adapters.
                    let packed = frame.ends_with(".gz");
                    let path = frame_path(&record.adapter, &record.case);
                    let to = if packed { path } else { frame.clone() };
                    copy(&folder, frame, writer.out(), &to)?;
                    *frame = to;
                }
                for picture in record.pictures() {
                    copy(&folder, picture, writer.out(), picture)?;
                }
                writer.append(&record)?;
                merged.records += 1;
                merged.unexpected += u64::from(record.unexpected());
                merged.improvements += u64::from(record.improvement());
            }
        }
        writer.sync()?;
        Dead::write(out, &self.dead)?;
        beside::write(out, &self.beside)?;
        merged.unexpected += count_unexpected(&self.beside);
        if !merged.missing.is_empty() {
            let lines = merged.missing.iter();
            let text: String = lines.map(|(a, c)| format!("{a} {c}\n")).collect();
            writer.out().write(MISSING_FILE, text.as_bytes())?;
        }
        Ok(merged)
    }
}

fn places<'a>(names: impl Iterator<Item = &'a String>) -> HashMap<&'a str, usize> {
    names.enumerate().map(|(i, n)| (n.as_str(), i)).collect()
}

/// Returns the list of cases that all parts were selected from.
fn selection(parts: &[(&PathBuf, Run)]) -> Result<Vec<String>, RecordError> {
    let mut list = None;
    for (folder, run) in parts {
        if run.header.settings.selection.is_empty() {
            return Err(RecordError::Unmergeable {
                path: (*folder).clone(),
                reason: "it does not state its selection of cases; record it with this etalon"
                    .to_owned(),
            });
        }
        if list.is_none() {
            list = read_cases(folder, &run.header)?;
        }
    }
    let first = parts.first().map(|(folder, _)| (*folder).clone());
    list.ok_or_else(|| RecordError::Unmergeable {
        path: first.unwrap_or_default(),
        reason:
            "neither it nor any other part has its list of cases, cases.txt; copy whole folders"
                .to_owned(),
    })
}

/// Returns the header of the merged run.
fn header(first: &Path, parts: &[(&PathBuf, Run)]) -> Result<Header, RecordError> {
    let mut merged: Option<Header> = None;
    // The folder in which each adapter was first seen.
    let mut seen: HashMap<String, &Path> = HashMap::new();
    for (folder, run) in parts {
        let header = &run.header;
        let merged = match &mut merged {
            None => {
                let mut begun = header.clone();
                begun.format = FORMAT;
                begun.settings.shard = None;
                begun.adapters.clear();
                begun.absent.clear();
                merged.insert(begun)
            }
            Some(merged) => merged,
        };
        let apart = |earlier: &Path, reason| RecordError::Apart {
            one: earlier.to_owned(),
            other: (*folder).clone(),
            reason,
        };
        if let Some(reason) = merged.conflict(header) {
            let reason = match selections(first, &merged.settings, folder, &header.settings) {
                Some(globs) => format!("the selection of cases differs: {globs}"),
                None => reason,
            };
            return Err(apart(first, reason));
        }
        if header.provenance.started < merged.provenance.started {
            merged
                .provenance
                .started
                .clone_from(&header.provenance.started);
        }
        for adapter in &header.adapters {
            match merged.adapter(&adapter.info.name) {
                None => {
                    seen.insert(adapter.info.name.clone(), folder);
                    merged.adapters.push(adapter.clone());
                }
                Some(known) => {
                    if let Some(reason) = known.conflict(adapter) {
                        let folder = seen.get(&adapter.info.name).copied().unwrap_or(first);
                        return Err(apart(folder, reason));
                    }
                }
            }
        }
        for absent in &header.absent {
            if !merged.absent.iter().any(|a| a.name == absent.name) {
                merged.absent.push(absent.clone());
            }
        }
        if header.provenance.machine != merged.provenance.machine {
            let join = |list: &mut String, name: &str| {
                if !list.split("; ").any(|known| known == name) {
                    *list = format!("{list}; {name}");
                }
            };
            join(
                &mut merged.provenance.machine.os,
                &header.provenance.machine.os,
            );
            join(
                &mut merged.provenance.machine.cpu,
                &header.provenance.machine.cpu,
            );
            merged.provenance.machine.cores = merged
                .provenance
                .machine
                .cores
                .max(header.provenance.machine.cores);
        }
    }
    let mut merged = merged.ok_or_else(|| RecordError::NoRun {
        path: first.to_owned(),
    })?;
    let here: BTreeSet<String> = merged
        .adapters
        .iter()
        .map(|a| a.info.name.clone())
        .collect();
    merged.absent.retain(|a| !here.contains(&a.name));
    let digest = &merged.settings.selection;
    let count = digest.split('-').next().and_then(|n| n.parse().ok());
    merged.cases = count.unwrap_or(merged.cases);
    Ok(merged)
}

/// The maximum number of globs that are named per side.
const GLOBS: usize = 4;

/// Returns the globs of the case files in which two selections differ; `None` if they are the same, or if a
/// list is missing.
fn selections(
    first: &Path,
    of_one: &Settings,
    other: &Path,
    of_other: &Settings,
) -> Option<String> {
    if of_one.selection == of_other.selection {
        return None;
    }
    let ids = |folder: &Path| -> Option<BTreeSet<String>> {
        let mut text = String::new();
        open_below(folder, CASES_FILE)
            .ok()?
            .read_to_string(&mut text)
            .ok()?;
        Some(text.lines().map(str::to_owned).collect())
    };
    let (a, b) = (ids(first)?, ids(other)?);
    let only = |folder: &Path, ids: &BTreeSet<String>, others: &BTreeSet<String>| {
        let mut globs: BTreeMap<String, usize> = BTreeMap::new();
        for id in ids.difference(others) {
            let record = Record::new(id.as_str(), "", Verdict::Pass);
            // If the other selection lacks a whole area, the area is named instead of its files.
            let area = format!("{}/", record.parts().area());
            let is_whole_area = !others.iter().any(|other| other.starts_with(&area));
            let glob = if is_whole_area {
                record.parts().area().to_owned()
            } else {
                record.parts().file().to_owned()
            };
            *globs.entry(format!("{glob}/*")).or_default() += 1;
        }
        let named: Vec<String> = globs
            .iter()
            .take(GLOBS)
            .map(|(glob, n)| format!("{glob} ({n})"))
            .collect();
        let more = globs.len().saturating_sub(GLOBS);
        let more = if more > 0 {
            format!(" and {more} more")
        } else {
            String::new()
        };
        (!named.is_empty())
            .then(|| format!("only {} has {}{more}", folder.display(), named.join(", ")))
    };
    let sides: Vec<String> = only(first, &a, &b)
        .into_iter()
        .chain(only(other, &b, &a))
        .collect();
    (!sides.is_empty()).then(|| sides.join("; "))
}

/// Merges two records of a case that disagree.
fn disagreeing(first: (Record, PathBuf), other: (Record, PathBuf)) -> (Record, PathBuf) {
    let disagreement = Reason::PartsDisagree(first.0.verdict, other.0.verdict);
    let (mut worse, better) = if first.0.verdict.severity() >= other.0.verdict.severity() {
        (first, other.0)
    } else {
        (other, first.0)
    };
    let record = &mut worse.0;
    record.repeats.push(better.verdict);
    record.verdict = Verdict::Flaky;
    record.expected = None;
    record.improves = None;
    record.reasons.push(disagreement);
    worse
}

/// Copies a file that a record names. A missing file is left for the report to note.
fn copy(from: &Path, file: &str, out: &OutputFolder, to: &str) -> Result<(), RecordError> {
    let mut bytes = Vec::new();
    match open_below(from, file) {
        Ok(mut file) => file.read_to_end(&mut bytes),
        Err(e) if e.is_missing() => return Ok(()),
        Err(e) => return Err(e),
    }
    .map_err(RecordError::io("read", &from.join(file)))?;
    out.write(to, &bytes).map(drop)
}
