//! Failing scenes in groups: those of one group leave the same states and the same violation when they are reduced.
//!
//! A reduction takes hundreds of drawings, and a driver's commonest bug is in every tenth scene. So a scene that
//! has all states of a group and its violation is counted there, unless the group is young or the number of its
//! scenes is a power of two: those are reduced, and show what hides behind.

use crate::failure::Failure;
use crate::reduction::{DriverOracle, Shown, confirm, file_name};
use etalon_backend::BackendError;
use etalon_case::Case;
use etalon_explore::{
    Candidate, Fuzzer, MOST_DRAWS, Oracle, RandomScene, Signature, keys, reduce, shrink,
};
use etalon_frame::Limits;
use etalon_record::{Record, Subject, Symptom, Verdict};
use etalon_runner::{DrawError, Launch, Outcome, Trials, Worker};
use serde_json::{Value, json};
use std::fs;
use std::path::PathBuf;
use std::sync::atomic::{AtomicBool, Ordering};

/// The scenes of a group that are reduced before others are counted by their states.
const YOUNG: u64 = 3;
/// The most scenes that are tried to shrink one that ends its worker, and one that takes too long.
const TRIED: usize = 24;
const TRIED_SLOW: usize = 4;

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
    /// The symptom, in words.
    way: String,
    sentence: String,
    clause: Option<String>,
    states: String,
    /// The number of keys of the first scene, and of what is left of it.
    keys: [usize; 2],
    /// True if it fails by itself, in a new process.
    steady: bool,
    file: PathBuf,
    /// The traits that tell it from other groups.
    key: (String, Option<Signature>),
    symptom: Option<Symptom>,
}

/// The groups of one adapter.
pub(crate) struct Groups {
    launch: Launch,
    limits: Limits,
    folder: PathBuf,
    all: Vec<Group>,
    trials: Option<Trials>,
}

/// A scene that was looked at, before it is known to be new.
struct Seen {
    scene: Candidate,
    verdict: Verdict,
    record: Option<Record>,
    symptom: Option<Symptom>,
    message: String,
    steady: bool,
    key: (String, Option<Signature>),
    keys: usize,
    index: u64,
}

impl Groups {
    pub(crate) fn new(launch: Launch, limits: Limits, folder: PathBuf) -> Self {
        Self {
            launch,
            limits,
            folder,
            all: Vec::new(),
            trials: None,
        }
    }

    pub(crate) fn len(&self) -> usize {
        self.all.len()
    }

    /// Returns the groups, the commonest first.
    pub(crate) fn finish(mut self) -> Vec<Group> {
        self.all.sort_by_key(|g| std::cmp::Reverse(g.count));
        self.all
    }

    /// Adds a failing scene. When the search is being stopped, it is kept as it is.
    pub(crate) fn add(
        &mut self,
        fuzzer: &Fuzzer,
        scene: RandomScene,
        outcome: Outcome,
        stop: &AtomicBool,
    ) -> Result<(), Failure> {
        let stopped = stop.load(Ordering::Relaxed);
        let seen = match outcome {
            Outcome::NotDrawn {
                verdict, message, ..
            } => self.lost(fuzzer, scene, verdict, message, stopped)?,
            Outcome::Judged(record) => self.failed(scene, *record, stopped)?,
        };
        let Some(seen) = seen else { return Ok(()) };
        if let Some(group) = self.all.iter_mut().find(|g| g.key == seen.key) {
            group.count += 1;
            group.reduced += 1;
            return Ok(());
        }
        self.keep(seen)
    }

    /// A scene that was drawn wrong: `None` if it was counted by its states.
    fn failed(
        &mut self,
        scene: RandomScene,
        record: Record,
        stopped: bool,
    ) -> Result<Option<Seen>, Failure> {
        let symptom = Symptom::of(&record);
        let document = &scene.candidate.document;
        let alike = self.all.iter_mut().find(|group| {
            let signature = group.key.1.as_ref().filter(|_| group.steady);
            let covered = group.symptom.as_ref().is_some_and(|s| symptom.covers(s));
            covered && signature.is_some_and(|s| s.is_in(document))
        });
        if let Some(group) = alike {
            let next = group.count + 1;
            if stopped || (group.reduced >= YOUNG && !next.is_power_of_two()) {
                group.count = next;
                return Ok(None);
            }
        }
        let keys = keys(&document["scene"]);
        let index = scene.index;
        let unsteady = |scene: Candidate, record: Record, symptom: Symptom, why: &str| Seen {
            key: (format!("{}, {why}", way(&symptom)), None),
            verdict: record.verdict,
            scene,
            record: Some(record),
            symptom: Some(symptom),
            message: why.to_owned(),
            steady: false,
            keys,
            index,
        };
        if stopped {
            let why = "not reduced";
            return Ok(Some(unsteady(scene.candidate, record, symptom, why)));
        }
        let trials = match self.trials.take() {
            Some(trials) => trials,
            None => {
                let worker = Worker::start(&self.launch).map_err(Failure::incomplete)?;
                Trials::new(self.launch.clone(), worker)
            }
        };
        let mut oracle = DriverOracle {
            trials,
            limits: self.limits.clone(),
            symptom: symptom.clone(),
            record,
            error: None,
        };
        let candidate = scene.candidate;
        let again = oracle.first(&mut std::iter::once(candidate.clone()));
        let seen = if again.is_none() {
            let why = "only behind other scenes";
            unsteady(candidate, oracle.record.clone(), symptom, why)
        } else {
            let limits = &self.limits;
            let can_draw = |case: &Case| limits.missing(&case.requirements()).is_none();
            let reduction = reduce(candidate, MOST_DRAWS, &can_draw, &mut oracle);
            let signature = Signature::of(&reduction.smallest.document);
            Seen {
                key: (way(&oracle.symptom), Some(signature)),
                verdict: oracle.record.verdict,
                scene: reduction.smallest,
                record: Some(oracle.record.clone()),
                symptom: Some(oracle.symptom.clone()),
                message: String::new(),
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
        Ok(Some(seen))
    }

    /// A scene that ended its worker, or that the driver gave up: shrunk where it is the first of its kind.
    fn lost(
        &mut self,
        fuzzer: &Fuzzer,
        scene: RandomScene,
        verdict: Verdict,
        message: String,
        stopped: bool,
    ) -> Result<Option<Seen>, Failure> {
        // Numbers are addresses, sizes and times.
        let words: String = message.chars().filter(|c| !c.is_ascii_digit()).collect();
        let key = (format!("{verdict}: {words}"), None);
        let (index, count) = (scene.index, keys(&scene.candidate.document["scene"]));
        let known = self.all.iter().any(|g| g.key == key);
        let mut steady = true;
        let mut scene = scene;
        if !known && !stopped {
            let most = match verdict {
                Verdict::Timeout => TRIED_SLOW,
                _ => TRIED,
            };
            let mut losses = Losses {
                launch: &self.launch,
                worker: None,
            };
            steady = losses.happens(&scene);
            if steady {
                scene = shrink(fuzzer, scene, most, &mut |scene| losses.happens(scene));
            }
        }
        Ok(Some(Seen {
            scene: scene.candidate,
            verdict,
            record: None,
            symptom: None,
            message,
            steady,
            key,
            keys: count,
            index,
        }))
    }

    /// Makes a group of a scene, and writes its case file.
    fn keep(&mut self, seen: Seen) -> Result<(), Failure> {
        let adapter = self.launch.adapter.clone();
        let id = file_name(
            &format!("{}-{}", adapter, seen.scene.case.id.replace("found/", "")),
            "",
        );
        let path = self
            .folder
            .join(format!("{}.json", id.trim_end_matches('.')));
        let origin = format!(
            "{} On {adapter}.",
            seen.scene.document["about"].as_str().unwrap_or_default()
        );
        let mut steady = seen.steady;
        let mut document = seen.scene.document.clone();
        let (mut sentence, mut clause, mut states) = (seen.message.clone(), None, String::new());
        if let (Some(record), Some(symptom)) = (&seen.record, &seen.symptom) {
            let case = &seen.scene.case;
            steady = steady && confirm(&self.launch, case, &self.limits, symptom).is_ok();
            let shown = Shown {
                document: &seen.scene.document,
                record,
                symptom,
            };
            document = shown.described(&origin);
            sentence = shown.sentence();
            clause = shown.clause().map(str::to_owned);
            states = shown.states();
        } else {
            document["about"] = json!(format!("{origin} {}: {}", seen.verdict, seen.message));
        }
        let text = serde_json::to_string_pretty(&document)
            .map_err(|e| Failure::incomplete(format!("cannot write JSON: {e}")))?;
        fs::create_dir_all(&self.folder)
            .and_then(|()| fs::write(&path, text + "\n"))
            .map_err(|e| Failure::incomplete(format!("cannot write {}: {e}", path.display())))?;
        self.all.push(Group {
            adapter,
            count: 1,
            reduced: 1,
            index: seen.index,
            verdict: seen.verdict,
            way: seen.key.0.clone(),
            sentence,
            clause,
            states,
            keys: [seen.keys, keys(&seen.scene.document["scene"])],
            steady,
            file: path,
            key: seen.key,
            symptom: seen.symptom,
        });
        Ok(())
    }
}

/// Workers that are lost by one scene or another.
struct Losses<'a> {
    launch: &'a Launch,
    worker: Option<Worker>,
}

impl Losses<'_> {
    /// True if a scene ends its worker, or the driver gives it up.
    fn happens(&mut self, scene: &RandomScene) -> bool {
        let running = self.worker.take();
        let started = running.map_or_else(|| Worker::start(self.launch), Ok);
        let Ok(mut worker) = started else {
            return false;
        };
        match worker.draw(&scene.candidate.case) {
            Ok(_) | Err(DrawError::Backend(BackendError::NotSupported(_))) => {
                self.worker = Some(worker);
                false
            }
            Err(_) => true,
        }
    }
}

/// Returns a symptom without the names of attachments and what was there before.
fn way(symptom: &Symptom) -> String {
    match symptom.subject {
        Subject::Picture(aspect) => {
            let mut operations = symptom.of_draws();
            operations.sort_unstable();
            format!("{} ({})", aspect.name(), operations.join(", "))
        }
        _ => symptom.to_string(),
    }
}

impl Group {
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
}
