//! A case as requests to a device, and the answers as frames.

use etalon_backend::{BackendError, Fault};
use etalon_case::Case;
use etalon_frame::Frame;
use etalon_webgpu::message::{Answer, Request, packed, take_contents, unpacked};
use etalon_webgpu::{Device, Reading, lower, plant};

/// The requests for the frames of a case.
pub(crate) struct CaseDraw {
    pub(crate) requests: Vec<Vec<u8>>,
    /// The meaning of the bytes of each answer.
    readings: Vec<Reading>,
}

impl CaseDraw {
    /// Lowers the scenes of a case.
    ///
    /// # Errors
    /// If the device cannot draw one of them.
    pub(crate) fn new(
        case: &Case,
        device: &Device,
        fault: Option<Fault>,
    ) -> Result<Self, BackendError> {
        let mut requests = Vec::new();
        let mut readings = Vec::new();
        let mut dropped = Vec::new();
        for (slot, (scene, submissions)) in (0..).zip(case.preparations()) {
            let mut list = lower(device, scene).map_err(BackendError::NotSupported)?;
            if let Some(Fault::Call(fault)) = fault {
                plant(fault, &mut list);
            }
            let (places, contents) = take_contents(&mut list);
            for (index, frames) in submissions.into_iter().enumerate() {
                let first = index == 0;
                let request = Request {
                    number: requests.len() as u64,
                    dropped: std::mem::take(&mut dropped),
                    slot,
                    list: first.then_some(&list),
                    contents: if first { places.clone() } else { Vec::new() },
                    frames,
                    read: true,
                };
                let bytes = if first { contents.as_slice() } else { &[] };
                let message = packed(&request, bytes.iter().map(Vec::as_slice));
                requests
                    .push(message.map_err(|e| BackendError::internal_of("a list is not sent", e))?);
                readings.push(list.reading.clone());
            }
            dropped.push(slot);
        }
        Ok(Self { requests, readings })
    }

    /// Returns the frames in the answers of a device.
    ///
    /// # Errors
    /// If the device failed, or an answer is missing.
    pub(crate) fn frames(
        &self,
        answers: &[&[u8]],
        fault: Option<Fault>,
    ) -> Result<Vec<Frame>, BackendError> {
        let garbage = |why: String| BackendError::internal_of("an answer of the page", why);
        let mut frames = Vec::new();
        for (answer, reading) in answers.iter().zip(&self.readings) {
            let (answer, bytes) = unpacked::<Answer>(answer).map_err(garbage)?;
            if let Some(failed) = answer.error {
                return Err(failed.into());
            }
            let frame = reading.frame(bytes);
            let short = || BackendError::internal("the page's frame is too short");
            let mut frame = frame.ok_or_else(short)?;
            if let Some(Fault::Read(fault)) = fault {
                for image in &mut frame.images {
                    fault.apply(&mut image.codes, image.size, image.samples, &image.channels);
                }
            }
            frames.push(frame);
        }
        if frames.len() == self.readings.len() {
            Ok(frames)
        } else {
            Err(BackendError::internal("no frame came back"))
        }
    }
}
