//! A run on one device.

use crate::case_draw::CaseDraw;
use crate::message::{Drawing, Drawn, Judging};
use crate::verdict::{Observation, outcome};
use etalon_backend::{BackendError, Fault};
use etalon_case::{Case, CaseRef};
use etalon_diagnose::Symptom;
use etalon_judge::{
    Judge, Judged, RoundTrips, is_due_to_fail, is_unexpectedly_bad, mark_flaky, settled, undrawn,
};
use etalon_record::{AdapterRecord, Expectations, Record, Seconds, Verdict};
use etalon_webgpu::Device;
use std::collections::HashMap;

/// The number of unexpected bad verdicts of each kind that are drawn again on a fresh device.
const RECHECKS: u32 = 4;
/// The message of a device that does not answer.
const NO_ANSWER: &str = "the device did not answer within 60 s";

/// A run on one device.
pub(crate) struct Session {
    adapter: AdapterRecord,
    device: Device,
    fault: Option<Fault>,
    expectations: Expectations,
    /// The selected cases, and the round trips that are not among them.
    cases: Vec<CaseRef<'static>>,
    trips: RoundTrips,
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
    /// The first drawing, if this is the second.
    first: Option<Observation>,
}

impl Session {
    pub(crate) fn new(
        adapter: AdapterRecord,
        device: Device,
        fault: Option<Fault>,
        expectations: Expectations,
        cases: Vec<CaseRef<'static>>,
    ) -> Self {
        Self {
            adapter,
            device,
            fault,
            expectations,
            cases,
            trips: RoundTrips::default(),
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
    pub(crate) fn draw(&mut self, number: usize) -> Result<(Drawing, Vec<u8>), String> {
        let case = self.built(number)?;
        let record = undrawn(&case, &self.adapter, &self.expectations, Some(&self.trips));
        if let Some(record) = record {
            return self.not_drawn(number, record);
        }
        match CaseDraw::new(&case, &self.device, self.fault) {
            Ok(draw) => {
                let lengths = draw.requests.iter().map(Vec::len).collect();
                let bytes = draw.requests.concat();
                let pending = Pending {
                    case,
                    draw,
                    judge: Judge::default(),
                    first: None,
                };
                self.pending.insert(number, pending);
                Ok((Drawing::Requests(lengths), bytes))
            }
            Err(error) => {
                let mut record = failed(&case, &self.adapter.name, &error);
                record.due_fail = is_due_to_fail(&case, &self.adapter.limits);
                self.not_drawn(number, record)
            }
        }
    }

    fn not_drawn(&self, number: usize, record: Record) -> Result<(Drawing, Vec<u8>), String> {
        let record = settled(record, &self.expectations, &self.adapter);
        let (outcome, bytes) = outcome(number, record, None)?;
        Ok((Drawing::Undrawn(outcome), bytes))
    }

    /// Judges a drawing. A bad verdict is checked again on a fresh device, if it is unexpected.
    ///
    /// # Errors
    /// If the case is not being drawn.
    pub(crate) fn judge(
        &mut self,
        drawn: &Drawn,
        bytes: &[u8],
    ) -> Result<(Judging, Vec<u8>), String> {
        let number = drawn.number;
        let pending = self.pending.remove(&number);
        let mut pending = pending.ok_or_else(|| format!("case {number} is not being drawn"))?;
        let observed = self.observe(&pending, drawn, bytes)?;
        let renew = observed.ends_device;
        let Some(first) = pending.first.take() else {
            if self.must_be_confirmed(&observed.record) {
                pending.first = Some(observed);
                self.pending.insert(number, pending);
                let judging = Judging {
                    outcome: None,
                    renew: true,
                };
                return Ok((judging, Vec::new()));
            }
            return self.finish(number, &pending, observed, renew);
        };
        let (verdict, repeat) = (first.record.verdict, observed.record.verdict);
        if verdict == repeat {
            return self.finish(number, &pending, first, renew);
        }
        if let Some(confirmed) = self.confirmed.get_mut(&Symptom::of(&first.record).broad()) {
            *confirmed = confirmed.saturating_sub(1);
        }
        let mut worst = if first.record.verdict.severity() > repeat.severity() {
            first
        } else {
            observed
        };
        mark_flaky(
            &mut worst.record,
            verdict,
            vec![repeat],
            "on a fresh device",
        );
        self.finish(number, &pending, worst, renew)
    }

    fn finish(
        &self,
        number: usize,
        pending: &Pending,
        observed: Observation,
        renew: bool,
    ) -> Result<(Judging, Vec<u8>), String> {
        let Observation {
            mut record, frame, ..
        } = observed;
        self.trips.annotate(&pending.case, &mut record);
        let record = settled(record, &self.expectations, &self.adapter);
        let (outcome, bytes) = outcome(number, record, frame.as_ref())?;
        let judging = Judging {
            outcome: Some(outcome),
            renew,
        };
        Ok((judging, bytes))
    }

    fn observe(
        &self,
        pending: &Pending,
        drawn: &Drawn,
        bytes: &[u8],
    ) -> Result<Observation, String> {
        let Pending {
            case, draw, judge, ..
        } = pending;
        let adapter = &self.adapter;
        let mut rest = bytes;
        let mut answers = Vec::new();
        for length in &drawn.answers {
            let split = rest.split_at_checked(*length);
            let (answer, others) = split.ok_or_else(|| "a message is too short".to_owned())?;
            answers.push(answer);
            rest = others;
        }
        let mut observed = if drawn.timeout {
            let mut record = Record::new(&case.id, &adapter.name, Verdict::Timeout);
            NO_ANSWER.clone_into(&mut record.message);
            Observation {
                record,
                frame: None,
                ends_device: true,
            }
        } else {
            match draw.frames(&answers, self.fault) {
                Ok(frames) => {
                    let Judged { record, frame } =
                        judge.judge(drawn.number, case, &adapter.name, &adapter.limits, &frames);
                    Observation {
                        record,
                        frame,
                        ends_device: false,
                    }
                }
                Err(error) => Observation {
                    record: failed(case, &adapter.name, &error),
                    frame: None,
                    ends_device: error.ends_drawing(),
                },
            }
        };
        observed.record.due_fail = is_due_to_fail(case, &adapter.limits);
        observed.record.seconds = Seconds {
            draw: drawn.seconds,
            judge: 0.0,
        };
        Ok(observed)
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
    record.message = error.to_string();
    record.error = kind.cloned();
    record
}
