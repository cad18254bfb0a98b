//! One adapter's part of a run, except its workers: judging frames and writing records.

use super::adapter_queue::AdapterQueue;
use super::plan::KeptFrames;
use super::shared::Shared;
use crate::drawing::Drawing;
use crate::event::RunEvent;
use crate::failure_report::FailureReport;
use crate::loss::Loss;
use crate::loss::RequestError;
use crate::process::Wait;
use crate::sync::lock;
use etalon_case::Case;
use etalon_frame::Frame;
use etalon_judge::{
    IMPRECISE_FRAMES, Judged, ShownDetail, SizedScene, is_due_to_fail, keep_pictures, measured,
    note_validation, settled, shorten, undrawn,
};
use etalon_record::{FrameFile, Record, RecordError, Seconds, Verdict};
use std::time::{Duration, Instant};

/// The factor by which a case that is measured may take longer than other cases.
const MEASURING: u32 = 4;
/// A judged drawing that has not been written yet.
pub(super) struct Observation {
    pub(super) record: Record,
    pub(super) frame: Option<FrameFile>,
    /// The frames themselves; empty if drawing failed.
    pub(super) frames: Vec<Frame>,
}

/// One adapter's part of a run.
#[derive(Clone, Copy)]
pub(super) struct RunningAdapter<'s, 'a> {
    pub(super) shared: &'s Shared<'a>,
    pub(super) queue: &'s AdapterQueue,
}

impl<'s> RunningAdapter<'s, '_> {
    pub(super) fn case(&self, number: usize) -> &'s Case {
        self.shared.cases[number]
    }

    /// Returns the limits of waiting for a case.
    pub(super) fn wait(&self, case: &Case) -> Wait<'s> {
        Wait {
            timeout: if case.measured {
                self.measuring_timeout()
            } else {
                self.shared.options.timeout
            },
            stop: Some(self.shared.stop),
        }
    }

    /// Returns a method's scene at the size of its picture and at all sizes that the run times; none if it times only
    /// the picture.
    pub(super) fn sized_scenes(&self, case: &Case) -> Vec<SizedScene> {
        let sizes = self
            .shared
            .options
            .sizes
            .on(self.queue.adapter.info.software);
        let others = sizes
            .iter()
            .filter_map(|size| self.shared.truths.sized(case, *size));
        let others: Vec<SizedScene> = others.collect();
        let picture = SizedScene::of_picture(case).filter(|_| !others.is_empty());
        picture.into_iter().chain(others).collect()
    }

    /// Returns the time limit of a case that is measured.
    pub(super) fn measuring_timeout(&self) -> Duration {
        self.shared.options.timeout * MEASURING
    }

    /// Records every case as a `Crash`, because the driver does not start.
    pub(super) fn record_not_started(&self, error: &str) {
        loop {
            let numbers = self.queue.take();
            if numbers.is_empty() || self.shared.stopped() {
                return;
            }
            for number in numbers {
                let case = self.case(number);
                let failure = RequestError::Lost(Loss::NotStarted(error.to_owned()));
                let report = FailureReport::new(failure, None);
                let mut record = report.record(&case.id, &self.queue.adapter.info.name);
                record.due_fail = is_due_to_fail(case, &self.queue.adapter.limits);
                self.record(self.settled(record));
            }
        }
    }

    /// Returns the record of a case that is not drawn on this adapter; `None` if it must be drawn.
    pub(super) fn undrawn(&self, number: usize) -> Option<Record> {
        let trips = self.queue.round_trips();
        let (case, adapter) = (self.case(number), &self.queue.adapter);
        let undrawn = undrawn(case, adapter, &self.queue.expectations, trips);
        undrawn.or_else(|| {
            let budget = self.shared.budget.as_ref();
            let budget = budget.filter(|_| self.queue.is_late())?;
            let mut record = Record::new(&case.id, &adapter.info.name, Verdict::Skipped);
            record.due_fail = is_due_to_fail(case, &adapter.limits);
            record.reasons = vec![budget.reason()];
            Some(record)
        })
    }

    /// Returns a record with what the expectations say about it.
    pub(super) fn settled(&self, record: Record) -> Record {
        settled(record, &self.queue.expectations, &self.queue.adapter)
    }

    /// Judges a drawing. `report` makes the report if drawing failed.
    pub(super) fn observe(
        &self,
        number: usize,
        drawing: Drawing,
        report: impl FnOnce(RequestError) -> FailureReport,
    ) -> Observation {
        let case = self.case(number);
        let adapter = &self.queue.adapter;
        let mut judging = Duration::ZERO;
        let mut observed = match drawing.frames {
            Ok(frames) => {
                let start = Instant::now();
                let judge = &self.shared.judge;
                let Judged { record, frame } =
                    judge.judge(number, case, &adapter.info.name, &adapter.limits, &frames);
                judging = start.elapsed();
                Observation {
                    record,
                    frame,
                    frames,
                }
            }
            Err(failure) => {
                let mut record = report(failure).record(&case.id, &adapter.info.name);
                if let Some(end) = &mut record.process {
                    end.seconds = drawing.since.as_secs_f64();
                }
                Observation {
                    record,
                    frame: None,
                    frames: Vec::new(),
                }
            }
        };
        let record = &mut observed.record;
        record.due_fail = is_due_to_fail(case, &self.queue.adapter.limits);
        let lost = record.process.is_some();
        let drawing_time = if lost { drawing.since } else { drawing.working };
        record.seconds = Seconds::new(drawing_time, judging);
        note_validation(record, drawing.messages);
        observed
    }

    /// Passes the first frame on, writes the frame and pictures if they are kept, and shortens the record.
    pub(super) fn keep(
        &self,
        number: usize,
        observed: &mut Observation,
    ) -> Result<(), RecordError> {
        if !self.queue.has_record(number) {
            return Ok(());
        }
        let record = &mut observed.record;
        if let Some(trips) = self.queue.round_trips() {
            trips.annotate(self.case(number), record);
        }
        let shown = self.shown(record);
        let frame = observed.frame.take();
        let kept = frame.filter(|_| self.keeps_frame(record, &shown));
        shorten(record, shown, kept.is_some());
        if let Some(file) = kept {
            record.frame = Some(self.shared.frames.write_frame(&file)?);
        }
        let case = self.case(number);
        let Some(frame) = observed.frames.first() else {
            return Ok(());
        };
        (self.shared.drawn)(&self.queue.adapter, case, frame);
        if let Some(method) = &case.method {
            let truth = self.shared.truths.get(method);
            record.measured = measured(case, &truth, frame);
            let kept = self.shared.pictures.contains(&number)
                && self.shared.picture_adapter == self.queue.launch.adapter;
            if let Some(image) = frame.images.first().filter(|_| kept) {
                let writer = &self.shared.frames;
                keep_pictures(record, &truth, image, |name, size, rgb| {
                    writer.write_picture(name, size, rgb)
                })?;
            }
        }
        Ok(())
    }

    /// Returns how much the record of a failure shows.
    fn shown(&self, record: &Record) -> ShownDetail {
        if self.shared.options.frames == KeptFrames::All || !record.verdict.is_bad() {
            return ShownDetail::Whole;
        }
        let settled = self.settled(record.clone());
        let Some(reason) = settled.excuse() else {
            return ShownDetail::Whole;
        };
        let example = self.queue.example_or_insert(reason, &record.case);
        example.map_or(ShownDetail::Example, ShownDetail::By)
    }

    fn keeps_frame(&self, record: &Record, shown: &ShownDetail) -> bool {
        let frames = self.shared.options.frames;
        match frames {
            KeptFrames::All => {}
            KeptFrames::Examples if matches!(shown, ShownDetail::By(_)) => return false,
            KeptFrames::Examples => {}
            KeptFrames::New if self.settled(record.clone()).unexpected() => {}
            KeptFrames::New | KeptFrames::None => return false,
        }
        if record.verdict.is_violation() || record.verdict == Verdict::Flaky {
            return true;
        }
        let mut state = self.queue.state();
        let kept = state
            .imprecise_frames
            .entry(record.parts().file().to_owned())
            .or_default();
        *kept += 1;
        let most = match frames {
            KeptFrames::All => IMPRECISE_FRAMES,
            _ => 1,
        };
        *kept <= most
    }

    /// Writes a record. An error ends the run.
    pub(super) fn record(&self, record: Record) {
        let appended = lock(&self.shared.writer).append(&record);
        if let Err(error) = appended {
            return self.shared.fail(error);
        }
        lock(&self.shared.summary).count(&record);
        (self.shared.events)(RunEvent::Recorded(Box::new(record)));
        if let Some(wall) = self.queue.record_written() {
            (self.shared.events)(RunEvent::AdapterFinished {
                adapter: self.queue.adapter.info.name.clone(),
                wall,
            });
        }
    }
}
