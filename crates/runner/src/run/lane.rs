//! One worker's way through an adapter's cases.

use super::column::{Column, MAX_VAIN_STARTS};
use super::{Shared, again, lock};
use crate::event::Event;
use crate::link::{Drawing, Link, Patience};
use crate::loss::{Loss, Obituary};
use crate::measure::{Timed, measured};
use crate::process::{Drawn, Worker};
use crate::verdict::Judged;
use etalon_backend::BackendError;
use etalon_case::Case;
use etalon_frame::Frame;
use etalon_record::{Expected, FrameFile, MAX_VALIDATION, Record, RecordError, Seconds, Verdict};
use etalon_truth::TruthPicture;
use std::collections::VecDeque;
use std::sync::PoisonError;
use std::time::{Duration, Instant};

/// How many cases are sent ahead, so that the worker draws while the parent judges.
const IN_FLIGHT: usize = 4;
/// Frame files and stories of imprecise cases per adapter and case file; failures keep all of theirs.
const IMPRECISE_FRAMES: u32 = 3;
/// How many times longer than others a case may take that is there to be measured.
const MEASURING: u32 = 4;
/// The most bytes of one validation message that a record keeps.
const MESSAGE_BYTES: usize = 1000;

/// What was seen of a case, before anything of it is written.
pub(super) struct Sight {
    pub(super) record: Record,
    pub(super) frame: Option<FrameFile>,
    /// The frames themselves, where they came back.
    pub(super) frames: Vec<Frame>,
}

/// A case that a worker was asked to draw.
struct Waiting {
    number: usize,
    asked: Instant,
}

/// One worker's way through the cases.
pub(super) struct Lane<'s, 'a> {
    pub(super) shared: &'s Shared<'a>,
    pub(super) column: &'s Column,
    link: Option<Link>,
    /// The cases that the worker was asked to draw since it was started.
    history: Vec<usize>,
}

impl<'s, 'a> Lane<'s, 'a> {
    pub(super) fn new(shared: &'s Shared<'a>, column: &'s Column) -> Self {
        let mut lane = Self {
            shared,
            column,
            link: None,
            history: Vec::new(),
        };
        if let Some(worker) = column.ready() {
            lane.take_link(worker);
        }
        lane
    }

    pub(super) fn case(&self, number: usize) -> &'s Case {
        &self.shared.cases[number]
    }

    pub(super) fn run(&mut self) {
        if self.column.begin() {
            (self.shared.events)(Event::AdapterStarted {
                adapter: self.column.adapter.name.clone(),
                cases: self.column.cases(),
            });
        }
        let shared = self.shared;
        if let Some(how) = &self.column.dead {
            return self.bury(how);
        }
        let mut mine: VecDeque<usize> = VecDeque::new();
        let mut waiting: VecDeque<Waiting> = VecDeque::new();
        while !shared.stopped() {
            // Who times frames waits until nobody draws, and nobody begins meanwhile.
            let busy = shared.quiet.read().unwrap_or_else(PoisonError::into_inner);
            loop {
                if mine.is_empty() {
                    mine = self.column.take();
                }
                let Some(number) = mine.front().copied() else {
                    break;
                };
                let timed = |number: usize| self.case(number).method.is_some();
                // Nothing may be in flight while frames are timed.
                let alone = timed(number) || waiting.front().is_some_and(|w| timed(w.number));
                if waiting.len() >= if alone { 1 } else { IN_FLIGHT } {
                    break;
                }
                mine.pop_front();
                if !self.passed_over(number) {
                    self.send(number);
                    waiting.push_back(Waiting {
                        number,
                        asked: Instant::now(),
                    });
                }
            }
            let Some(Waiting { number, asked }) = waiting.pop_front() else {
                break;
            };
            let drawing = self.receive(number, asked);
            let before = self.before(number);
            let Some(sight) = self.sight(number, drawing) else {
                break;
            };
            if self.link.is_none() {
                self.resend(&mut waiting);
            }
            let Some(mut sight) = again::settle(self, number, sight, &before) else {
                break;
            };
            if let Err(error) = self.keep(number, &mut sight) {
                shared.give_up(error);
                break;
            }
            if sight.record.measured.is_some() {
                drop(busy);
                self.time(number, &mut sight.record);
            }
            self.record(sight.record);
        }
    }

    /// Records that no case could be drawn, since the driver does not start.
    fn bury(&self, how: &str) {
        loop {
            let numbers = self.column.take();
            if numbers.is_empty() || self.shared.stopped() {
                return;
            }
            for number in numbers {
                let case = self.case(number);
                let name = &self.column.adapter.name;
                let mut record = Record::new(&case.id, name, Verdict::Crash);
                let obituary = Obituary::not_started(how.to_owned());
                record.due_fail = case.judged_as.is_some();
                record.message = obituary.message;
                record.process = Some(obituary.end);
                self.record(record);
            }
        }
    }

    /// Records a case that is not to be drawn here; whether that was so.
    fn passed_over(&self, number: usize) -> bool {
        let case = self.case(number);
        let adapter = &self.column.adapter;
        let mut record = if let Some(entry) = self.shared.expectations.skips(adapter, &case.id) {
            let mut record = Record::new(&case.id, &adapter.name, Verdict::Skipped);
            record.expected = Some(Expected {
                reason: entry.reason.clone(),
            });
            record.message = format!("not drawn: {}", entry.reason);
            record
        } else if let Some(missing) = adapter.limits.missing(&case.requirements()) {
            let mut record = Record::new(&case.id, &adapter.name, Verdict::NotSupported);
            record.message = missing.to_string();
            record
        } else {
            return false;
        };
        record.due_fail = case.judged_as.is_some();
        self.record(record);
        true
    }

    fn take_link(&mut self, worker: Worker) {
        let mut link = worker.link;
        if let Some(memory) = self.shared.options.memory {
            link.guard(memory);
        }
        self.history.clear();
        self.link = Some(link);
    }

    /// Starts a worker where there is none. It is tried again at once: cases that wait for answers
    /// must all reach the same worker, or their answers would be taken for each other's.
    fn revive(&mut self) {
        while self.link.is_none() && self.column.state().vain_starts < MAX_VAIN_STARTS {
            match Worker::start(&self.column.launch) {
                Ok(worker) => {
                    self.column.state().vain_starts = 0;
                    self.take_link(worker);
                }
                Err(error) => {
                    let mut state = self.column.state();
                    state.vain_starts += 1;
                    state.last_words = format!("the worker could not be started again: {error}");
                }
            }
        }
    }

    fn send(&mut self, number: usize) {
        self.revive();
        let Some(link) = &mut self.link else { return };
        self.history.push(number);
        for scene in self.shared.cases[number].scenes() {
            link.draw(number as u32, scene);
        }
    }

    /// What was in flight behind a case that took its worker down.
    fn resend(&mut self, waiting: &mut VecDeque<Waiting>) {
        for case in waiting {
            self.send(case.number);
            case.asked = Instant::now();
        }
    }

    /// The cases that the worker drew before this one.
    fn before(&self, number: usize) -> Vec<usize> {
        let at = self.history.iter().rposition(|n| *n == number);
        self.history[..at.unwrap_or(0)].to_vec()
    }

    pub(super) fn patience(&self, case: &Case) -> Patience<'s> {
        let measuring = case.method.is_some() || case.area() == "perf";
        Patience {
            timeout: self.shared.options.timeout * if measuring { MEASURING } else { 1 },
            stop: Some(self.shared.stop),
        }
    }

    fn receive(&mut self, number: usize, asked: Instant) -> Drawing {
        let case = self.case(number);
        let patience = self.patience(case);
        match &mut self.link {
            Some(link) => link.drawn(number as u32, case.scene_count(), asked, patience),
            None => Drawing {
                drawn: Drawn::Lost(Loss::Died),
                working: Duration::ZERO,
                since: Duration::ZERO,
                messages: Vec::new(),
            },
        }
    }

    /// What a drawing came to, judged; `None` when the run is to end. A worker that cannot be used any
    /// more is let go.
    fn sight(&mut self, number: usize, drawing: Drawing) -> Option<Sight> {
        let obituary = match &drawing.drawn {
            Drawn::Lost(Loss::Stopped) => return None,
            Drawn::Lost(loss) => Some(match self.link.take() {
                Some(mut link) => link.obituary(loss.clone()),
                None => Obituary::not_started(self.column.state().last_words.clone()),
            }),
            // After a panic, too, nobody knows in what state the worker is.
            Drawn::Error(BackendError::DeviceLost(_) | BackendError::Internal(_)) => {
                self.link = None;
                None
            }
            _ => None,
        };
        Some(self.judge(number, drawing, obituary))
    }

    /// What a drawing came to, judged.
    pub(super) fn judge(
        &self,
        number: usize,
        drawing: Drawing,
        obituary: Option<Obituary>,
    ) -> Sight {
        let case = self.case(number);
        let adapter = &self.column.adapter;
        let mut sight = Sight {
            record: Record::new(&case.id, &adapter.name, Verdict::InternalError),
            frame: None,
            frames: Vec::new(),
        };
        let mut judging = Duration::ZERO;
        match drawing.drawn {
            Drawn::Frames(frames) => {
                let start = Instant::now();
                let judge = &self.shared.judge;
                let Judged { record, frame } =
                    judge.judge(number, case, &adapter.name, &adapter.limits, &frames);
                judging = start.elapsed();
                sight = Sight {
                    record,
                    frame,
                    frames,
                };
            }
            Drawn::Error(error) => {
                sight.record.verdict = verdict_of(&error);
                sight.record.message = error.to_string();
            }
            Drawn::Lost(loss) => {
                sight.record.verdict = loss.verdict();
                if let Some(Obituary { message, mut end }) = obituary {
                    end.seconds = drawing.since.as_secs_f64();
                    sight.record.message = message;
                    sight.record.process = Some(end);
                }
            }
        }
        let record = &mut sight.record;
        record.due_fail = case.judged_as.is_some();
        let lost = record.process.is_some();
        record.seconds = Seconds {
            draw: if lost { drawing.since } else { drawing.working }.as_secs_f64(),
            judge: judging.as_secs_f64(),
        };
        note_validation(record, drawing.messages);
        sight
    }

    /// Writes the frame and the pictures that are worth keeping, and shortens the rest.
    fn keep(&self, number: usize, sight: &mut Sight) -> Result<(), RecordError> {
        let record = &mut sight.record;
        let kept = sight.frame.take().filter(|_| self.keeps_frame(record));
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
            record.frame = Some(lock(&self.shared.writer).write_frame(&file)?);
        }
        let case = self.case(number);
        if let (Some(method), Some(frame)) = (&case.method, sight.frames.first()) {
            let truth = self.shared.truths.get(method);
            record.measured = measured(case, &truth, frame);
            self.keep_picture(number, record, &truth, frame)?;
        }
        Ok(())
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
        if !shared.pictures.contains(&number) || shared.painter != self.column.launch.adapter {
            return Ok(());
        }
        let Some(measured) = &mut record.measured else {
            return Ok(());
        };
        let Some(image) = frame.images.first() else {
            return Ok(());
        };
        let writer = lock(&shared.writer);
        let seen = etalon_truth::rgb8(image);
        measured.picture = Some(writer.write_picture(&record.case, image.size, &seen)?);
        let due = truth.rgb8();
        measured.truth =
            Some(writer.write_picture(&format!("truth/{}", record.case), truth.size, &due)?);
        Ok(())
    }

    fn keeps_frame(&self, record: &Record) -> bool {
        if matches!(record.verdict, Verdict::Fail | Verdict::Flaky) {
            return true;
        }
        let mut state = self.column.state();
        let kept = state
            .imprecise_frames
            .entry(record.case_file().to_owned())
            .or_default();
        *kept += 1;
        *kept <= IMPRECISE_FRAMES
    }

    /// Times a method case. A wrong picture has no time.
    fn time(&mut self, number: usize, record: &mut Record) {
        let case = self.case(number);
        let Some(link) = &mut self.link else { return };
        if record.verdict.is_bad() {
            return;
        }
        let timeout = self.shared.options.timeout * MEASURING;
        let timed = {
            let quiet = &self.shared.quiet;
            let _alone = quiet.write().unwrap_or_else(PoisonError::into_inner);
            link.time(
                number as u32,
                &case.scene,
                &self.column.adapter.limits,
                timeout,
            )
        };
        match timed {
            Timed::Times(times, fragments) => {
                if let Some(measured) = &mut record.measured {
                    measured.time = times;
                    measured.fragments = fragments;
                }
            }
            Timed::Lost(loss) => {
                record.verdict = loss.verdict();
                if let Some(mut link) = self.link.take() {
                    let obituary = link.obituary(loss);
                    record.message = format!("while its frames were timed: {}", obituary.message);
                    record.process = Some(obituary.end);
                }
            }
        }
    }

    /// Writes a record, whatever the run comes to.
    fn record(&self, mut record: Record) {
        if record.verdict != Verdict::Skipped {
            record.expect(self.shared.expectations, &self.column.adapter);
        }
        let appended = lock(&self.shared.writer).append(&record);
        if let Err(error) = appended {
            return self.shared.give_up(error);
        }
        lock(&self.shared.outcome).count(&record);
        (self.shared.events)(Event::Recorded(Box::new(record)));
        if let Some(wall) = self.column.written() {
            (self.shared.events)(Event::AdapterFinished {
                adapter: self.column.adapter.name.clone(),
                wall,
            });
        }
    }
}

fn verdict_of(error: &BackendError) -> Verdict {
    match error {
        BackendError::NotSupported(_) => Verdict::NotSupported,
        BackendError::DeviceLost(_) => Verdict::DeviceLost,
        BackendError::Resource { .. } => Verdict::ResourceError,
        BackendError::Shader { .. } | BackendError::Internal(_) => Verdict::InternalError,
    }
}

/// Notes what validation said. Calls that break the API's rules are our error: whatever came of them
/// says nothing about the driver.
fn note_validation(record: &mut Record, messages: Vec<String>) {
    let Some(first) = messages.first() else {
        return;
    };
    if record.verdict.is_judged() || record.verdict == Verdict::Measured {
        record.message = format!(
            "validation, {} messages (the picture would be {}): {first}",
            messages.len(),
            record.verdict
        );
        record.verdict = Verdict::InternalError;
    }
    let short = |mut text: String| {
        let end = text.floor_char_boundary(MESSAGE_BYTES);
        text.truncate(end);
        text
    };
    record.validation = messages
        .into_iter()
        .take(MAX_VALIDATION)
        .map(short)
        .collect();
}
