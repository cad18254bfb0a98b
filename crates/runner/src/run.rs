//! A whole run: every selected case on every adapter, one record each.

use crate::event::Event;
use crate::measure::{Timed, Truths, measured};
use crate::process::{DRAW_TIMEOUT, Drawn, Launch, Link, Loss, Worker};
use crate::verdict::{Judge, Judged};
use etalon_backend::BackendError;
use etalon_case::Case;
use etalon_frame::{Frame, Limits};
use etalon_record::{
    AdapterRecord, Expectations, Header, Record, RecordError, RunWriter, Seconds, Verdict,
};
use etalon_reference::TruthPicture;
use std::collections::{BTreeMap, HashMap, HashSet, VecDeque};
use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, PoisonError, RwLock};
use std::thread;
use std::time::{Duration, Instant};
use thiserror::Error;

/// How many cases are sent ahead, so that the worker draws while the parent judges.
const IN_FLIGHT: usize = 4;
/// After so many vain starts in a row an adapter's other cases are not tried.
const MAX_VAIN_STARTS: u32 = 3;
/// Frame files and stories of imprecise cases per adapter and case file; failures keep all of theirs.
const IMPRECISE_FRAMES: u32 = 3;

/// What to run.
pub struct Plan<'a> {
    /// The cases, each once.
    pub cases: &'a [Case],
    /// How to start each adapter again, and the worker that is already up.
    pub adapters: Vec<(Launch, Worker)>,
    /// How many adapters run side by side; at least one.
    pub jobs: usize,
    /// What is known to go wrong.
    pub expectations: &'a Expectations,
    /// Where the run is written.
    pub folder: &'a Path,
    /// Its first line.
    pub header: Header,
}

/// How a run ended.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Outcome {
    /// Records written.
    pub records: u64,
    /// Records that speak against the run.
    pub unexpected: u64,
    /// Verdicts better than the expectations.
    pub improvements: u64,
}

/// Why a run could not be completed.
#[derive(Debug, Error)]
pub enum RunError {
    /// The run folder cannot be begun; nothing was run.
    #[error(transparent)]
    Folder(RecordError),
    /// The run folder can no longer be written to; what was written is readable.
    #[error("the run is incomplete: {0}")]
    Write(RecordError),
}

struct Shared<'a> {
    cases: &'a [Case],
    expectations: &'a Expectations,
    judge: Judge,
    writer: Mutex<RunWriter>,
    error: Mutex<Option<RecordError>>,
    stop: AtomicBool,
    outcome: Mutex<Outcome>,
    truths: Truths,
    /// Held for writing by who times frames, for reading by who draws and judges.
    quiet: RwLock<()>,
    /// Numbers of the method cases whose pictures are kept, and the adapter that they are taken from.
    pictures: HashSet<usize>,
    painter: String,
    events: &'a (dyn Fn(Event) + Sync),
}

/// Runs every case on every adapter. Events come from several threads.
///
/// # Errors
/// When the run folder cannot be written to.
pub fn run(plan: Plan<'_>, events: &(dyn Fn(Event) + Sync)) -> Result<Outcome, RunError> {
    let writer = RunWriter::create(plan.folder, &plan.header).map_err(RunError::Folder)?;
    let shared = Shared {
        cases: plan.cases,
        expectations: plan.expectations,
        judge: Judge::default(),
        writer: Mutex::new(writer),
        error: Mutex::new(None),
        stop: AtomicBool::new(false),
        outcome: Mutex::new(Outcome::default()),
        truths: Truths::default(),
        quiet: RwLock::new(()),
        pictures: in_the_middle(plan.cases),
        painter: plan
            .adapters
            .first()
            .map_or_else(String::new, |(l, _)| l.adapter.clone()),
        events,
    };
    let jobs = plan.jobs.max(1);
    let queue: Mutex<VecDeque<(Launch, Worker)>> = Mutex::new(plan.adapters.into());
    let next = || {
        let mut queue = queue.lock().unwrap_or_else(PoisonError::into_inner);
        queue.pop_front()
    };
    thread::scope(|scope| {
        for _ in 0..jobs {
            scope.spawn(|| {
                while let Some((launch, worker)) = next() {
                    if shared.stop.load(Ordering::Relaxed) {
                        break;
                    }
                    AdapterRun::new(&shared, launch, worker).run();
                }
            });
        }
    });
    let error = shared
        .error
        .into_inner()
        .unwrap_or_else(PoisonError::into_inner);
    match error {
        Some(error) => Err(RunError::Write(error)),
        None => Ok(*shared
            .outcome
            .lock()
            .unwrap_or_else(PoisonError::into_inner)),
    }
}

/// The verdict of a case whose worker was lost.
fn lost(loss: &Loss) -> Verdict {
    match loss {
        Loss::Timeout(_) => Verdict::Timeout,
        Loss::Garbage(_) | Loss::Died => Verdict::Crash,
    }
}

/// Of each method's cases in a scene the one in the middle of its parameter's range: the one whose
/// picture is kept.
fn in_the_middle(cases: &[Case]) -> HashSet<usize> {
    type Family<'a> = (&'a str, &'a str, &'a str);
    let mut families: BTreeMap<Family<'_>, Vec<(f64, usize)>> = BTreeMap::new();
    for (number, case) in cases.iter().enumerate() {
        if let Some(method) = &case.method {
            let family = (&*method.question, &*method.scene, &*method.name);
            let value = method.parameter.as_ref().map_or(0.0, |p| p.value);
            families.entry(family).or_default().push((value, number));
        }
    }
    let middle = |mut all: Vec<(f64, usize)>| {
        all.sort_by(|a, b| a.0.total_cmp(&b.0));
        all.get(all.len() / 2).map(|(_, number)| *number)
    };
    families.into_values().filter_map(middle).collect()
}

/// The record form of an adapter.
pub(crate) fn adapter_record(worker: &Worker) -> AdapterRecord {
    let info = &worker.hello.info;
    AdapterRecord {
        name: info.name.clone(),
        backend: info.backend.clone(),
        device: info.device.clone(),
        driver: info.driver.clone(),
        driver_version: info.driver_version.clone(),
        driver_id: info.driver_id.clone(),
        api_version: info.api_version.clone(),
        software: info.software,
        limits: worker.hello.limits.clone(),
    }
}

impl From<&Worker> for AdapterRecord {
    fn from(worker: &Worker) -> Self {
        adapter_record(worker)
    }
}

/// One adapter's way through the cases.
struct AdapterRun<'s, 'a> {
    shared: &'s Shared<'a>,
    launch: Launch,
    adapter: AdapterRecord,
    link: Option<Link>,
    vain_starts: u32,
    last_words: String,
    imprecise_frames: HashMap<String, u32>,
}

impl<'s, 'a> AdapterRun<'s, 'a> {
    fn new(shared: &'s Shared<'a>, launch: Launch, worker: Worker) -> Self {
        Self {
            shared,
            adapter: adapter_record(&worker),
            launch,
            link: Some(worker.link),
            vain_starts: 0,
            last_words: String::new(),
            imprecise_frames: HashMap::new(),
        }
    }

    fn run(&mut self) {
        let start = Instant::now();
        let cases = self.shared.cases;
        (self.shared.events)(Event::AdapterStarted {
            adapter: self.adapter.name.clone(),
            cases: cases.len() as u64,
        });
        let mut waiting: VecDeque<usize> = VecDeque::new();
        let mut next = 0;
        while !self.shared.stop.load(Ordering::Relaxed) {
            while next < cases.len() {
                let timed = |number: &usize| cases[*number].method.is_some();
                // Nothing may be in flight while frames are timed.
                let alone = timed(&next) || waiting.front().is_some_and(timed);
                if waiting.len() >= if alone { 1 } else { IN_FLIGHT } {
                    break;
                }
                let number = next;
                next += 1;
                if let Some(missing) = self.limits().missing(&cases[number].requirements()) {
                    self.finish_without_frame(
                        number,
                        Verdict::NotSupported,
                        missing.to_string(),
                        Duration::ZERO,
                    );
                    continue;
                }
                self.send(number);
                waiting.push_back(number);
            }
            let Some(number) = waiting.pop_front() else {
                break;
            };
            let asked = Instant::now();
            let shared = self.shared;
            let busy = shared.quiet.read().unwrap_or_else(PoisonError::into_inner);
            let (drawn, drawing) = self.receive(cases[number].scene_count());
            match drawn {
                Drawn::Frames(frames) => match self.judge(number, &frames, drawing) {
                    Some(record) if record.measured.is_some() => {
                        drop(busy);
                        self.time(number, record);
                    }
                    Some(record) => self.record(record),
                    None => {}
                },
                Drawn::Error(error) => {
                    let verdict = match &error {
                        BackendError::NotSupported(_) => Verdict::NotSupported,
                        BackendError::DeviceLost(_) => Verdict::DeviceLost,
                        BackendError::Resource { .. } => Verdict::ResourceError,
                        BackendError::Shader { .. } | BackendError::Internal(_) => {
                            Verdict::InternalError
                        }
                    };
                    self.finish_without_frame(number, verdict, error.to_string(), drawing);
                    // After a panic, too, nobody knows in what state the worker is.
                    if matches!(
                        error,
                        BackendError::DeviceLost(_) | BackendError::Internal(_)
                    ) {
                        self.link = None;
                        self.resend(&waiting);
                    }
                }
                Drawn::Lost(loss) => {
                    let verdict = lost(&loss);
                    let message = match self.link.take() {
                        Some(mut link) => link.obituary(loss),
                        None => self.last_words.clone(),
                    };
                    self.finish_without_frame(number, verdict, message, asked.elapsed());
                    self.resend(&waiting);
                }
            }
        }
        self.link = None;
        (self.shared.events)(Event::AdapterFinished {
            adapter: self.adapter.name.clone(),
            wall: start.elapsed(),
        });
    }

    fn limits(&self) -> &Limits {
        &self.adapter.limits
    }

    /// Starts a worker where there is none. It is tried again at once: cases that wait for answers
    /// must all reach the same worker, or their answers would be taken for each other's.
    fn revive(&mut self) {
        while self.link.is_none() && self.vain_starts < MAX_VAIN_STARTS {
            match Worker::start(&self.launch) {
                Ok(worker) => {
                    self.vain_starts = 0;
                    self.link = Some(worker.link);
                }
                Err(error) => {
                    self.vain_starts += 1;
                    self.last_words = format!("the worker could not be started again: {error}");
                }
            }
        }
    }

    fn send(&mut self, number: usize) {
        self.revive();
        let Some(link) = &mut self.link else { return };
        for scene in self.shared.cases[number].scenes() {
            link.draw(number as u32, scene);
        }
    }

    /// What was in flight behind a case that took its worker down.
    fn resend(&mut self, waiting: &VecDeque<usize>) {
        for number in waiting {
            self.send(*number);
        }
    }

    fn receive(&mut self, scenes: usize) -> (Drawn, Duration) {
        match &mut self.link {
            Some(link) => link.drawn(scenes, DRAW_TIMEOUT),
            None => (Drawn::Lost(Loss::Died), Duration::ZERO),
        }
    }

    /// Times a method case and records it. A wrong picture has no time.
    fn time(&mut self, number: usize, mut record: Record) {
        let scene = &self.shared.cases[number].scene;
        if record.verdict != Verdict::Fail
            && let Some(link) = &mut self.link
        {
            let timed = {
                let quiet = &self.shared.quiet;
                let _alone = quiet.write().unwrap_or_else(PoisonError::into_inner);
                link.time(number as u32, scene, &self.adapter.limits)
            };
            match timed {
                Timed::Times(times, fragments) => {
                    if let Some(measured) = &mut record.measured {
                        measured.time = times;
                        measured.fragments = fragments;
                    }
                }
                Timed::Lost(loss) => {
                    record.verdict = lost(&loss);
                    if let Some(mut link) = self.link.take() {
                        let how = link.obituary(loss);
                        record.message = format!("while its frames were timed: {how}");
                    }
                }
            }
        }
        self.record(record);
    }

    /// The record of a case's frames, but for frame times; `None` when the run cannot go on.
    fn judge(&mut self, number: usize, frames: &[Frame], drawing: Duration) -> Option<Record> {
        let start = Instant::now();
        let case = &self.shared.cases[number];
        let Judged {
            mut record,
            frame: file,
        } = self
            .shared
            .judge
            .judge(number, case, &self.adapter.name, self.limits(), frames);
        record.seconds = Seconds {
            draw: drawing.as_secs_f64(),
            judge: start.elapsed().as_secs_f64(),
        };
        let kept = file.filter(|_| self.keeps_frame(&record));
        if record.due_fail && record.verdict == Verdict::Fail {
            // The frame file shows the rest of what had to go wrong.
            record.wrong.truncate(4);
        }
        if record.verdict == Verdict::Imprecise {
            // Legal deviations come by the hundred; one texel each tells what kind they are.
            record.wrong.truncate(if kept.is_some() { 16 } else { 1 });
            if kept.is_none() {
                record.story = None;
            }
        }
        if let Some(file) = kept {
            let written = self
                .shared
                .writer
                .lock()
                .unwrap_or_else(PoisonError::into_inner)
                .write_frame(&file);
            match written {
                Ok(path) => record.frame = Some(path),
                Err(error) => {
                    self.give_up(error);
                    return None;
                }
            }
        }
        if let (Some(method), Some(frame)) = (&case.method, frames.first()) {
            let truth = self.shared.truths.get(method);
            record.measured = measured(case, &truth, frame);
            if let Err(error) = self.keep_picture(number, &mut record, &truth, frame) {
                self.give_up(error);
                return None;
            }
        }
        Some(record)
    }

    /// Writes the pictures of a method and of the truth, where this is the case and the adapter that
    /// stands for the method.
    fn keep_picture(
        &self,
        number: usize,
        record: &mut Record,
        truth: &TruthPicture,
        frame: &Frame,
    ) -> Result<(), RecordError> {
        let shared = self.shared;
        if !shared.pictures.contains(&number) || shared.painter != self.launch.adapter {
            return Ok(());
        }
        let Some(measured) = &mut record.measured else {
            return Ok(());
        };
        let Some(image) = frame.images.first() else {
            return Ok(());
        };
        let writer = shared.writer.lock().unwrap_or_else(PoisonError::into_inner);
        let seen = etalon_reference::shown(image);
        measured.picture = Some(writer.write_picture(&record.case, image.size, &seen)?);
        let due = truth.shown();
        measured.truth =
            Some(writer.write_picture(&format!("truth/{}", record.case), truth.size, &due)?);
        Ok(())
    }

    fn keeps_frame(&mut self, record: &Record) -> bool {
        if record.verdict == Verdict::Fail {
            return true;
        }
        let kept = self
            .imprecise_frames
            .entry(record.case_file().to_owned())
            .or_default();
        *kept += 1;
        *kept <= IMPRECISE_FRAMES
    }

    fn finish_without_frame(
        &self,
        number: usize,
        verdict: Verdict,
        message: String,
        drawing: Duration,
    ) {
        let case = &self.shared.cases[number];
        let mut record = Record::new(&case.id, &self.adapter.name, verdict);
        record.due_fail = case.judged_as.is_some();
        record.message = message;
        record.seconds.draw = drawing.as_secs_f64();
        self.record(record);
    }

    fn record(&self, mut record: Record) {
        record.expect(self.shared.expectations, &self.adapter);
        let appended = {
            let mut writer = self
                .shared
                .writer
                .lock()
                .unwrap_or_else(PoisonError::into_inner);
            writer.append(&record)
        };
        if let Err(error) = appended {
            return self.give_up(error);
        }
        {
            let mut outcome = self
                .shared
                .outcome
                .lock()
                .unwrap_or_else(PoisonError::into_inner);
            outcome.records += 1;
            outcome.unexpected += u64::from(record.unexpected());
            outcome.improvements += u64::from(record.improvement());
        }
        (self.shared.events)(Event::Recorded(Box::new(record)));
    }

    fn give_up(&self, error: RecordError) {
        self.shared.stop.store(true, Ordering::Relaxed);
        let mut first = self
            .shared
            .error
            .lock()
            .unwrap_or_else(PoisonError::into_inner);
        first.get_or_insert(error);
    }
}
