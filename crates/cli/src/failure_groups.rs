//! The failing scenes of a search: reduced on their driver, grouped, and written as case files.

use crate::failure::Failure;
use crate::match_text::match_sentence;
use crate::reducing::file_name;
use etalon_case::Case;
use etalon_diagnose::{Groups, KnownBugs, Symptom, Traits};
use etalon_explore::{RandomScene, draw_facts, keys, states};
use etalon_frame::threads::share;
use etalon_record::{OutputFolder, Record};
use etalon_report::ReducedCase;
use etalon_runner::{Looked, Reducer, confirm};
use serde_json::{Value, json};
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::atomic::Ordering;
use std::sync::{Mutex, PoisonError};

/// One way to fail.
pub(crate) type FailureGroup = etalon_diagnose::Group<KeptScene>;

/// The first scene of a group, reduced.
pub(crate) struct KeptScene {
    pub(crate) adapter: String,
    /// The number of the scene.
    pub(crate) index: u64,
    pub(crate) sentence: String,
    pub(crate) clause: Option<String>,
    pub(crate) states: String,
    /// The number of keys of the scene, and of the reduced scene.
    pub(crate) keys: [usize; 2],
    pub(crate) file: PathBuf,
    /// The reduced case, until a new process has drawn it.
    unconfirmed: Option<Case>,
}

/// The failing scenes of one adapter.
pub(crate) struct FailingScenes<'a> {
    groups: Groups<KeptScene>,
    out: &'a OutputFolder,
    reducer: Reducer<'a>,
}

/// The folder of scenes that no finding explains.
const FOUND: &str = "found";
/// The folder of scenes that a finding explains.
const KNOWN: &str = "known";

impl<'a> FailingScenes<'a> {
    pub(crate) fn new(reducer: Reducer<'a>, out: &'a OutputFolder) -> Self {
        Self {
            groups: Groups::default(),
            out,
            reducer,
        }
    }

    /// Returns the number of groups.
    pub(crate) fn groups(&self) -> usize {
        self.groups.len()
    }

    /// Draws the reduced case of each group in its own process, at most `jobs` at a time, and records which
    /// groups fail there. Stops early if the search is being stopped.
    pub(crate) fn confirm(&mut self, jobs: usize) {
        let Self {
            groups, reducer, ..
        } = self;
        let unconfirmed = groups.iter_mut().filter_map(|group| {
            let case = group.scene.unconfirmed.take()?;
            Some((group, case))
        });
        let queue = Mutex::new(unconfirmed);
        let next = || queue.lock().unwrap_or_else(PoisonError::into_inner).next();
        let Reducer {
            launch,
            timeout,
            stop,
            ..
        } = reducer;
        share(jobs, || {
            while !stop.load(Ordering::Relaxed)
                && let Some((group, case)) = next()
            {
                let confirmed = confirm(launch, &case, &group.symptom, *timeout);
                group.steady = confirmed.is_ok();
            }
        });
    }

    /// Compares all groups with the known bugs. After an error, the remaining groups are not compared.
    pub(crate) fn compare(&mut self, bugs: &mut KnownBugs<Reducer<'_>>) -> Result<(), Failure> {
        for group in self.groups.iter_mut().filter(|g| g.can_be_compared()) {
            group.known = bugs.matching(&group.symptom, &group.traits, group.steady)?;
            file_under(group, self.out)?;
        }
        Ok(())
    }

    /// Returns the groups, the most frequent first.
    pub(crate) fn finish(self) -> Vec<FailureGroup> {
        self.groups.finish()
    }

    /// Adds failing scenes. If the search is being stopped, scenes are not reduced.
    pub(crate) fn add(&mut self, failing: Vec<(RandomScene, Record)>) -> Result<(), Failure> {
        let mut scenes = failing.into_iter();
        scenes.try_for_each(|(scene, record)| self.add_one(scene, record))
    }

    fn add_one(&mut self, scene: RandomScene, record: Record) -> Result<(), Failure> {
        let RandomScene { index, candidate } = scene;
        let symptom = Symptom::of(&record);
        let stopped = self.reducer.is_stopped();
        let counted = self.groups.count(&candidate.document, &symptom, stopped);
        if counted.is_some() {
            return Ok(());
        }
        let keys = keys(&candidate.document["scene"]);
        let looked = self.reducer.look(candidate, record, symptom)?;
        if self.groups.count_reduced(&looked.key).is_some() {
            return Ok(());
        }
        self.keep(looked, index, keys)
    }

    /// Makes a group of a scene that had `all_keys` keys before its reduction, and writes its case file.
    fn keep(&mut self, seen: Looked, index: u64, all_keys: usize) -> Result<(), Failure> {
        let adapter = self.reducer.launch.adapter.clone();
        let document = &seen.scene.document;
        let reduced = ReducedCase {
            record: &seen.record,
            symptom: &seen.symptom,
            states: states(&document["scene"]),
        };
        let about = document["about"].as_str().unwrap_or_default();
        let mut described = document.clone();
        described["about"] = json!(reduced.about(&format!("{about} On {adapter}.")));
        let id = format!("{adapter}-{}", seen.scene.case.id.replace("found/", ""));
        let name = file_name(&id, "");
        let name = format!("{FOUND}/{}.json", name.trim_end_matches('.'));
        let file = write(self.out, &name, &described)?;
        let kept = KeptScene {
            adapter,
            index,
            sentence: reduced.sentence(),
            clause: reduced.clause(),
            states: reduced.states(),
            keys: [all_keys, keys(&document["scene"])],
            file,
            unconfirmed: None,
        };
        let traits = Traits::of(document, &seen.symptom, draw_facts(&seen.scene.case));
        let mut group = FailureGroup::new(kept, traits, seen.symptom, seen.key);
        group.scene.unconfirmed = group.steady.then_some(seen.scene.case);
        self.groups.push(group);
        Ok(())
    }
}

/// Writes the matching finding into a group's case file, and moves the file to `known` if the match is exact.
fn file_under(group: &mut FailureGroup, out: &OutputFolder) -> Result<(), Failure> {
    let Some(known) = &group.known else {
        return Ok(());
    };
    let file = &mut group.scene.file;
    let text = fs::read_to_string(&*file).map_err(|e| failed(file, &e))?;
    let mut document: Value = serde_json::from_str(&text).map_err(|e| failed(file, &e))?;
    let about = document["about"].as_str().unwrap_or_default();
    document["about"] = json!(format!("{about} {}", match_sentence(known)));
    let name = file.file_name().unwrap_or_default().to_string_lossy();
    let folder = if known.is_exact() { KNOWN } else { FOUND };
    let path = write(out, &format!("{folder}/{name}"), &document)?;
    if path != *file {
        fs::remove_file(&*file).map_err(|e| failed(file, &e))?;
    }
    *file = path;
    Ok(())
}

/// Writes a case file.
fn write(out: &OutputFolder, name: &str, document: &Value) -> Result<PathBuf, Failure> {
    let path = out.path().join(name);
    let text = serde_json::to_string_pretty(document).map_err(|e| failed(&path, &e))?;
    out.write(name, (text + "\n").as_bytes())
        .map_err(Failure::incomplete)
}

fn failed(path: &Path, error: &dyn std::fmt::Display) -> Failure {
    Failure::incomplete(format!("cannot write {}: {error}", path.display()))
}
