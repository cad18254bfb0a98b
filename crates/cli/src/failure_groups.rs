//! Failing scenes in groups: those of one group leave the same states and the same violation when they are reduced.
//!
//! A reduction takes hundreds of drawings, and a driver's commonest bug is in every tenth scene. So a scene that
//! has all states of a group and its violation is counted there, unless the number of its scenes is a power of
//! four: those are reduced, and show what hides behind.

use crate::failure::Failure;
use crate::known_bugs::{KnownBugs, Match};
use crate::reduction::{DriverOracle, Shown, confirm, file_name};
use etalon_case::Case;
use etalon_diagnose::{Signature, Symptom, Traits};
use etalon_explore::{Candidate, Oracle, RandomScene, keys};
use etalon_frame::Limits;
use etalon_record::{Record, Verdict};
use etalon_runner::{Launch, Trials, Worker};
use serde_json::{Value, json};
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, PoisonError};
use std::thread;
use std::time::Duration;

/// The most draws of a reduction: nineteen of twenty need fewer than 260, and what needs more mostly depends on what
/// was drawn before.
const DRAWS: usize = 400;

/// One way to fail.
pub(crate) struct Group {
    adapter: String,
    /// The number of scenes.
    count: u64,
    /// The number of those that were reduced to it.
    reduced: u64,
    /// The number of its first scene.
    index: u64,
    verdict: Verdict,
    /// The symptom, in words, and why the scene was not reduced.
    way: String,
    traits: Traits,
    sentence: String,
    clause: Option<String>,
    states: String,
    /// The number of keys of the first scene, and of what is left of it.
    keys: [usize; 2],
    /// True if it fails by itself, in a new process; before that was tried, if its reduction was one.
    steady: bool,
    /// The rest of its first scene, until it is drawn in a new process.
    unconfirmed: Option<Case>,
    file: PathBuf,
    /// The traits that tell it from other groups.
    key: (String, Option<Signature>),
    /// The states that other scenes of the group have too: a reduction replaces formats of depth and stencil.
    common: Option<Signature>,
    symptom: Symptom,
    /// The finding that explains it, or that it is like.
    known: Option<Match>,
}

/// The groups of one adapter.
pub(crate) struct Groups {
    launch: Launch,
    limits: Limits,
    folders: Folders,
    /// The time that a scene may take.
    timeout: Duration,
    all: Vec<Group>,
    trials: Option<Trials>,
}

/// The folders of case files.
#[derive(Clone, Debug)]
pub(crate) struct Folders {
    /// Of scenes that no finding explains.
    pub(crate) found: PathBuf,
    /// Of the others.
    pub(crate) known: PathBuf,
}

/// A scene that was looked at, before it is known to be new.
struct Seen {
    scene: Candidate,
    record: Record,
    symptom: Symptom,
    steady: bool,
    key: (String, Option<Signature>),
    keys: usize,
    index: u64,
}

impl Groups {
    pub(crate) fn new(launch: Launch, limits: Limits, folders: Folders, timeout: Duration) -> Self {
        Self {
            launch,
            limits,
            folders,
            timeout,
            all: Vec::new(),
            trials: None,
        }
    }

    pub(crate) fn len(&self) -> usize {
        self.all.len()
    }

    /// Draws what is left of each group in a process of its own, so many at the same time, and notes which groups fail
    /// there. When the search is being stopped, groups are left as they are.
    pub(crate) fn confirm(&mut self, jobs: usize, stop: &AtomicBool) {
        let Self {
            all,
            launch,
            timeout,
            ..
        } = self;
        let unconfirmed = all.iter_mut().filter_map(|group| {
            let case = group.unconfirmed.take()?;
            Some((group, case))
        });
        let queue = Mutex::new(unconfirmed);
        let next = || queue.lock().unwrap_or_else(PoisonError::into_inner).next();
        thread::scope(|scope| {
            for _ in 0..jobs {
                scope.spawn(|| {
                    while !stop.load(Ordering::Relaxed)
                        && let Some((group, case)) = next()
                    {
                        let confirmed = confirm(launch, &case, &group.symptom, *timeout);
                        group.steady = confirmed.is_ok();
                    }
                });
            }
        });
    }

    /// Compares all groups with the known bugs. An error leaves groups that were not compared.
    pub(crate) fn compare(&mut self, bugs: &mut KnownBugs<'_>) -> Result<(), Failure> {
        for group in &mut self.all {
            // Of a scene that was not reduced, nearly everything is left.
            let whole = group.key.1.is_some() || !group.verdict.is_violation();
            if whole {
                group.known = bugs.matching(group.verdict, &group.traits, group.steady)?;
                group.file_under(&self.folders)?;
            }
        }
        Ok(())
    }

    /// Returns the groups, the commonest first.
    pub(crate) fn finish(mut self) -> Vec<Group> {
        self.all.sort_by_key(|g| std::cmp::Reverse(g.count));
        self.all
    }

    /// Adds failing scenes. When the search is being stopped, scenes are kept as they are.
    pub(crate) fn add(
        &mut self,
        failing: Vec<(RandomScene, Record)>,
        stop: &AtomicBool,
    ) -> Result<(), Failure> {
        let mut all = failing.into_iter();
        all.try_for_each(|(scene, record)| self.add_one(scene, record, stop))
    }

    /// Adds a failing scene.
    fn add_one(
        &mut self,
        scene: RandomScene,
        record: Record,
        stop: &AtomicBool,
    ) -> Result<(), Failure> {
        let symptom = Symptom::of(&record);
        if let Some(group) = self.alike(&scene, &symptom, stop.load(Ordering::Relaxed)) {
            group.count += 1;
            return Ok(());
        }
        let seen = self.looked_at(scene, record, symptom, stop)?;
        if let Some(group) = self.all.iter_mut().find(|g| g.key == seen.key) {
            group.count += 1;
            group.reduced += 1;
            return Ok(());
        }
        self.keep(seen)
    }

    /// Returns the group in which a scene is counted by its states.
    fn alike(
        &mut self,
        scene: &RandomScene,
        symptom: &Symptom,
        stopped: bool,
    ) -> Option<&mut Group> {
        let states = Signature::of(&scene.candidate.document);
        // Each reduction of a scene that ends its worker costs processes: its states are not asked for.
        let ends = !symptom.verdict.is_violation();
        let alike = self.all.iter_mut().find(|group| {
            let left = group.common.as_ref().filter(|_| group.steady);
            symptom.covers_elsewhere(&group.symptom)
                && (ends || left.is_some_and(|left| left.is_within(&states)))
        })?;
        let count = alike.count + 1;
        let due = count.is_power_of_two() && count.trailing_zeros().is_multiple_of(2);
        (stopped || !due).then_some(alike)
    }

    /// Reduces a scene, where it fails by itself.
    fn looked_at(
        &mut self,
        scene: RandomScene,
        record: Record,
        symptom: Symptom,
        stop: &AtomicBool,
    ) -> Result<Seen, Failure> {
        let RandomScene { index, candidate } = scene;
        let keys = keys(&candidate.document["scene"]);
        let unsteady = |scene: Candidate, record: Record, why: &str| Seen {
            key: (
                format!("{}, {why}", Traits::of(&scene.document, &symptom).way),
                None,
            ),
            scene,
            record,
            symptom: symptom.clone(),
            steady: false,
            keys,
            index,
        };
        if stop.load(Ordering::Relaxed) {
            return Ok(unsteady(candidate, record, "not reduced"));
        }
        let trials = match self.trials.take() {
            Some(trials) => trials,
            None => {
                let worker = Worker::start(&self.launch).map_err(Failure::incomplete)?;
                Trials::new(self.launch.clone(), worker, self.timeout)
            }
        };
        let mut oracle = DriverOracle::new(trials, record, self.timeout, Some(stop));
        let again = oracle.first(&mut std::iter::once(candidate.clone()));
        let seen = if again.is_none() {
            unsteady(candidate, oracle.record.clone(), "only behind other scenes")
        } else {
            let reduction = oracle.reduce_by(candidate, &self.limits, DRAWS);
            let signature = Signature::of(&reduction.smallest.document);
            Seen {
                key: (
                    Traits::of(&reduction.smallest.document, &oracle.symptom).way,
                    Some(signature),
                ),
                scene: reduction.smallest,
                record: oracle.record.clone(),
                symptom: oracle.symptom.clone(),
                steady: true,
                keys,
                index,
            }
        };
        if let Some(error) = oracle.error {
            let adapter = &self.launch.adapter;
            return Err(Failure::incomplete(format!(
                "the worker of {adapter} could not be started again: {error}"
            )));
        }
        self.trials = Some(oracle.trials);
        Ok(seen)
    }

    /// Makes a group of a scene, and writes its case file.
    fn keep(&mut self, seen: Seen) -> Result<(), Failure> {
        let adapter = self.launch.adapter.clone();
        let id = file_name(
            &format!("{}-{}", adapter, seen.scene.case.id.replace("found/", "")),
            "",
        );
        let path = self
            .folders
            .found
            .join(format!("{}.json", id.trim_end_matches('.')));
        let origin = format!(
            "{} On {adapter}.",
            seen.scene.document["about"].as_str().unwrap_or_default()
        );
        let shown = Shown {
            document: &seen.scene.document,
            record: &seen.record,
            symptom: &seen.symptom,
        };
        let text = serde_json::to_string_pretty(&shown.described(&origin))
            .map_err(|e| Failure::incomplete(format!("cannot write JSON: {e}")))?;
        fs::create_dir_all(&self.folders.found)
            .and_then(|()| fs::write(&path, text + "\n"))
            .map_err(|e| Failure::incomplete(format!("cannot write {}: {e}", path.display())))?;
        self.all.push(Group {
            adapter,
            count: 1,
            reduced: 1,
            index: seen.index,
            verdict: seen.record.verdict,
            way: seen.key.0.clone(),
            traits: Traits::of(&seen.scene.document, &seen.symptom),
            sentence: shown.sentence(),
            clause: shown.clause().map(str::to_owned),
            states: shown.states(),
            keys: [seen.keys, keys(&seen.scene.document["scene"])],
            steady: seen.steady,
            unconfirmed: seen.steady.then_some(seen.scene.case),
            file: path,
            common: seen.key.1.as_ref().map(Signature::without_depth_formats),
            key: seen.key,
            symptom: seen.symptom,
            known: None,
        });
        Ok(())
    }
}

impl Group {
    /// The finding that explains it, or that it is like.
    pub(crate) fn known(&self) -> Option<&Match> {
        self.known.as_ref()
    }

    /// The number of its scenes.
    pub(crate) fn count(&self) -> u64 {
        self.count
    }

    /// Says in its case file what is known, and moves one that is explained.
    fn file_under(&mut self, folders: &Folders) -> Result<(), Failure> {
        let Some(known) = &self.known else {
            return Ok(());
        };
        let failed = |path: &Path, error: &dyn std::fmt::Display| {
            Failure::incomplete(format!("cannot write {}: {error}", path.display()))
        };
        let text = fs::read_to_string(&self.file).map_err(|e| failed(&self.file, &e))?;
        let mut document: Value =
            serde_json::from_str(&text).map_err(|e| failed(&self.file, &e))?;
        let about = document["about"].as_str().unwrap_or_default();
        document["about"] = json!(format!("{about} {}", known.sentence()));
        let text = serde_json::to_string_pretty(&document).map_err(|e| failed(&self.file, &e))?;
        fs::write(&self.file, text + "\n").map_err(|e| failed(&self.file, &e))?;
        if known.is_exact()
            && let Some(name) = self.file.file_name()
        {
            let path = folders.known.join(name);
            fs::create_dir_all(&folders.known)
                .and_then(|()| fs::rename(&self.file, &path))
                .map_err(|e| failed(&path, &e))?;
            self.file = path;
        }
        Ok(())
    }

    pub(crate) fn json(&self) -> Value {
        json!({
            "adapter": self.adapter,
            "file": self.file,
            "count": self.count,
            "reduced": self.reduced,
            "index": self.index,
            "verdict": self.verdict,
            "violation": self.way,
            "sentence": self.sentence,
            "clause": self.clause,
            "states": self.states,
            "keys": self.keys,
            "steady": self.steady,
            "known": self.known.as_ref().map(Match::json),
        })
    }

    pub(crate) fn text(&self) -> String {
        let mut text = format!(
            "\n  {} × {}: {}{}\n",
            self.count,
            self.verdict,
            self.way,
            if self.steady { "" } else { " (unsteady)" }
        );
        for line in [&self.states, &self.sentence] {
            if !line.is_empty() {
                text.push_str(&format!("    {line}\n"));
            }
        }
        if let Some(clause) = &self.clause {
            text.push_str(&format!("    [{clause}]\n"));
        }
        text.push_str(&format!("    {}\n", self.file.display()));
        text
    }

    /// The same in short, for a group below the finding that it is like.
    pub(crate) fn short(&self) -> String {
        let why = self.known.as_ref().map(Match::why).unwrap_or_default();
        format!(
            "    {} × {}: {}{}: {}\n      {why}\n      {}\n",
            self.count,
            self.verdict,
            self.way,
            if self.steady { "" } else { " (unsteady)" },
            self.states,
            self.file.display()
        )
    }
}
