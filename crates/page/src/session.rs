//! A run on one device.

use crate::case_draw::{CaseDraw, timed_request, times};
use crate::message::{DeviceAnswers, NextStep, split};
use crate::tile::tile;
use crate::verdict::{PageObservation, outcome};
use etalon_backend::{BackendError, Fault};
use etalon_case::{Case, CaseRef, Method};
use etalon_diagnose::Symptom;
use etalon_frame::Frame;
use etalon_judge::{
    Judge, Judged, RoundTrips, Timing, Truths, is_due_to_fail, is_unexpectedly_bad, keep_pictures,
    mark_flaky, measured, medians, settled, undrawn,
};
use etalon_record::{
    AdapterRecord, Expectations, Fresh, Reason, Record, RecordError, Verdict, picture_file,
};
use etalon_webgpu::Device;
use std::collections::{HashMap, HashSet};

/// The number of unexpected bad verdicts of each kind that are drawn again on a fresh device.
const RECHECKS: u32 = 4;
/// The page gives up on a device after a minute.
const NO_ANSWER: Reason = Reason::NoAnswer(60.0);

/// A run on one device.
pub(crate) struct Session {
    adapter: AdapterRecord,
    device: Device,
    fault: Option<Fault>,
    expectations: Expectations,
    /// The selected cases, and the round trips that are not among them.
    cases: Vec<CaseRef<'static>>,
    trips: RoundTrips,
    /// The truths of methods.
    truths: Truths,
    /// The numbers of the cases whose pictures are kept.
    pictured: HashSet<usize>,
    /// Cases that are being drawn.
    pending: HashMap<usize, Pending>,
    /// The number of verdicts that were drawn again, by kind.
    confirmed: HashMap<Symptom, u32>,
}

/// A case that is being drawn.
struct Pending {
    case: Case,
    draw: CaseDraw,
    judge: Judge,
    stage: SessionStage,
}

/// The answer that the device gives next, or has given.
enum SessionStage {
    /// The frames of the case.
    Drawn,
    /// The frames once more, on a fresh device. The first observation was bad.
    DrawnAgain(PageObservation),
    /// Frames that are timed, after the case was judged.
    Timed(Timing, PageObservation),
    /// Everything.
    Judged(PageObservation),
}

fn judged(observed: PageObservation) -> (SessionStage, (NextStep, Vec<u8>)) {
    let renew = observed.ends_device;
    let step = (NextStep::Judged { renew }, Vec::new());
    (SessionStage::Judged(observed), step)
}

fn requested(requests: &[Vec<u8>], renew: bool) -> (NextStep, Vec<u8>) {
    let lengths = requests.iter().map(Vec::len).collect();
    (NextStep::Requests { lengths, renew }, requests.concat())
}

impl Session {
    pub(crate) fn new(
        adapter: AdapterRecord,
        device: Device,
        fault: Option<Fault>,
        expectations: Expectations,
        cases: Vec<CaseRef<'static>>,
        pictured: HashSet<usize>,
    ) -> Self {
        Self {
            adapter,
            device,
            fault,
            expectations,
            cases,
            trips: RoundTrips::default(),
            truths: Truths::default(),
            pictured,
            pending: HashMap::new(),
            confirmed: HashMap::new(),
        }
    }

    fn built(&self, number: usize) -> Result<Case, String> {
        let case = self.cases.get(number);
        let case = case.ok_or_else(|| format!("there is no case {number}"))?;
        case.build().map_err(|error| error.to_string())
    }

    /// Adds the record of a round trip.
    ///
    /// # Errors
    /// If there is no case of this number.
    pub(crate) fn take_trip(&mut self, number: usize, record: &Record) -> Result<(), String> {
        let case = self.built(number)?;
        self.trips.take(&case, record);
        Ok(())
    }

    /// Returns the requests of a case, or its record if it is not drawn.
    ///
    /// # Errors
    /// If there is no case of this number.
    pub(crate) fn draw(&mut self, number: usize) -> Result<(NextStep, Vec<u8>), String> {
        let case = self.built(number)?;
        let record = undrawn(&case, &self.adapter, &self.expectations, Some(&self.trips));
        if let Some(record) = record {
            return self.recorded(number, PageObservation::of(record));
        }
        match CaseDraw::new(&case, &self.device, self.fault) {
            Ok(draw) => {
                let step = requested(&draw.requests, false);
                let pending = Pending {
                    case,
                    draw,
                    judge: Judge::default(),
                    stage: SessionStage::Drawn,
                };
                self.pending.insert(number, pending);
                Ok(step)
            }
            Err(error) => {
                let mut record = failed(&case, &self.adapter.info.name, &error);
                record.due_fail = is_due_to_fail(&case, &self.adapter.limits);
                self.recorded(number, PageObservation::of(record))
            }
        }
    }

    /// Takes the answers of the device. An unexpected bad verdict is checked again on a fresh device; a method's frames
    /// are timed.
    ///
    /// # Errors
    /// If the case is not being drawn.
    pub(crate) fn judge(
        &mut self,
        drawn: &DeviceAnswers,
        bytes: &[u8],
    ) -> Result<(NextStep, Vec<u8>), String> {
        let number = drawn.number;
        let mut pending = self.taken(number)?;
        let answers = split(bytes, &drawn.answers)?;
        let (next, step) = match std::mem::replace(&mut pending.stage, SessionStage::Drawn) {
            SessionStage::Timed(timing, observed) => {
                self.take_times(&pending, timing, observed, drawn, &answers)
            }
            SessionStage::Drawn => {
                let observed = self.observe(&pending, drawn, &answers);
                if self.must_be_confirmed(&observed.record) {
                    let step = requested(&pending.draw.requests, true);
                    (SessionStage::DrawnAgain(observed), step)
                } else {
                    self.timed(&pending, observed)
                }
            }
            SessionStage::DrawnAgain(first) => {
                let observed = self.observe(&pending, drawn, &answers);
                let confirmed = self.confirmed(first, observed);
                self.timed(&pending, confirmed)
            }
            judged @ SessionStage::Judged(_) => {
                (judged, (NextStep::Judged { renew: false }, Vec::new()))
            }
        };
        pending.stage = next;
        self.pending.insert(number, pending);
        Ok(step)
    }

    /// Returns the record of a case that is judged.
    ///
    /// # Errors
    /// If the case is not judged.
    pub(crate) fn record(
        &mut self,
        number: usize,
        seconds: f64,
    ) -> Result<(NextStep, Vec<u8>), String> {
        let Pending { case, stage, .. } = self.taken(number)?;
        let SessionStage::Judged(mut observed) = stage else {
            return Err(format!("case {number} is not judged"));
        };
        observed.record.seconds.judge = seconds;
        self.trips.annotate(&case, &mut observed.record);
        self.recorded(number, observed)
    }

    fn taken(&mut self, number: usize) -> Result<Pending, String> {
        let pending = self.pending.remove(&number);
        pending.ok_or_else(|| format!("case {number} is not being drawn"))
    }

    fn recorded(
        &self,
        number: usize,
        observed: PageObservation,
    ) -> Result<(NextStep, Vec<u8>), String> {
        let record = settled(observed.record, &self.expectations, &self.adapter);
        let (outcome, bytes) = outcome(number, PageObservation { record, ..observed })?;
        Ok((NextStep::Outcome(outcome), bytes))
    }

    /// Returns the worse of two drawings, the second on a fresh device.
    fn confirmed(
        &mut self,
        mut first: PageObservation,
        second: PageObservation,
    ) -> PageObservation {
        let (verdict, repeat) = (first.record.verdict, second.record.verdict);
        first.ends_device = second.ends_device;
        if verdict == repeat {
            return first;
        }
        if let Some(confirmed) = self.confirmed.get_mut(&Symptom::of(&first.record).broad()) {
            *confirmed = confirmed.saturating_sub(1);
        }
        let mut worst = if first.record.verdict.severity() > repeat.severity() {
            first
        } else {
            second
        };
        mark_flaky(&mut worst.record, verdict, vec![repeat], Fresh::Device);
        worst
    }

    /// Returns the stage after a drawing: a method's frames are timed, unless the picture is wrong.
    fn timed(
        &self,
        pending: &Pending,
        observed: PageObservation,
    ) -> (SessionStage, (NextStep, Vec<u8>)) {
        if observed.record.measured.is_none() || observed.record.verdict.is_bad() {
            return judged(observed);
        }
        self.time(pending, Timing::default(), observed)
    }

    fn time(
        &self,
        pending: &Pending,
        timing: Timing,
        observed: PageObservation,
    ) -> (SessionStage, (NextStep, Vec<u8>)) {
        match timed_request(&pending.case, &self.device, self.fault, timing) {
            Ok(request) => (
                SessionStage::Timed(timing, observed),
                requested(&[request], false),
            ),
            Err(_) => judged(observed),
        }
    }

    fn take_times(
        &self,
        pending: &Pending,
        timing: Timing,
        mut observed: PageObservation,
        drawn: &DeviceAnswers,
        answers: &[&[u8]],
    ) -> (SessionStage, (NextStep, Vec<u8>)) {
        let record = &mut observed.record;
        if drawn.timeout {
            record.verdict = Verdict::Timeout;
            record.reasons = vec![Reason::WhileTimed, NO_ANSWER];
            observed.ends_device = true;
            return judged(observed);
        }
        let found = answers.first().map(|answer| times(answer));
        match found {
            Some(Ok(found)) => match (timing.next(&found), &mut record.measured) {
                (Some(next), _) => self.time(pending, next, observed),
                (None, measured) => {
                    if let Some(measured) = measured {
                        measured.time = medians(&found, drawn.clock);
                    }
                    judged(observed)
                }
            },
            // The picture was drawn, so failed frames have no time.
            Some(Err(error)) => {
                observed.ends_device = error.ends_drawing();
                judged(observed)
            }
            None => judged(observed),
        }
    }

    fn observe(
        &self,
        pending: &Pending,
        drawn: &DeviceAnswers,
        answers: &[&[u8]],
    ) -> PageObservation {
        let Pending {
            case, draw, judge, ..
        } = pending;
        let adapter = &self.adapter;
        let mut observed = if drawn.timeout {
            let mut record = Record::new(&case.id, &adapter.info.name, Verdict::Timeout);
            record.reasons = vec![NO_ANSWER];
            PageObservation {
                ends_device: true,
                ..PageObservation::of(record)
            }
        } else {
            match draw.frames(answers, self.fault) {
                Ok(frames) => {
                    let Judged { record, frame } = judge.judge(
                        drawn.number,
                        case,
                        &adapter.info.name,
                        &adapter.limits,
                        &frames,
                    );
                    let mut observed = PageObservation {
                        frame,
                        tile: frames.first().map(tile).unwrap_or_default(),
                        ..PageObservation::of(record)
                    };
                    if let (Some(method), Some(frame)) = (&case.method, frames.first()) {
                        self.measure(drawn.number, case, method, frame, &mut observed);
                    }
                    observed
                }
                Err(error) => PageObservation {
                    ends_device: error.ends_drawing(),
                    ..PageObservation::of(failed(case, &adapter.info.name, &error))
                },
            }
        };
        observed.record.due_fail = is_due_to_fail(case, &adapter.limits);
        observed.record.seconds.draw = drawn.seconds;
        observed
    }

    /// Compares the picture of a method with the truth.
    fn measure(
        &self,
        number: usize,
        case: &Case,
        method: &Method,
        frame: &Frame,
        observed: &mut PageObservation,
    ) {
        let truth = self.truths.get(method);
        let PageObservation {
            record, pictures, ..
        } = observed;
        record.measured = measured(case, &truth, frame);
        if let Some(image) = frame
            .images
            .first()
            .filter(|_| self.pictured.contains(&number))
        {
            // A picture that cannot be written is left out.
            let _ = keep_pictures(record, &truth, image, |name, size, rgb| {
                let (path, file) = picture_file(name, size, rgb)?;
                pictures.push((path.clone(), file));
                Ok::<_, RecordError>(path)
            });
        }
    }

    /// Returns true if a verdict is bad and unexpected, and few of its kind were drawn again.
    fn must_be_confirmed(&mut self, record: &Record) -> bool {
        if !is_unexpectedly_bad(record, &self.expectations, &self.adapter) {
            return false;
        }
        let confirmed = self.confirmed.entry(Symptom::of(record).broad());
        let confirmed = confirmed.or_default();
        *confirmed += 1;
        *confirmed <= RECHECKS
    }
}

/// Returns the record of a case whose drawing failed.
fn failed(case: &Case, adapter: &str, error: &BackendError) -> Record {
    let kind = error.kind();
    let verdict = kind.map_or(Verdict::NotSupported, Verdict::of_error);
    let mut record = Record::new(&case.id, adapter, verdict);
    record.reasons = vec![Reason::Text(error.to_string())];
    record.error = kind.cloned();
    record
}
