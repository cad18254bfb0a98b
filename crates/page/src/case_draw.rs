//! A case as requests to a device, and the answers as frames or times.

use etalon_backend::{BackendError, Fault};
use etalon_case::Case;
use etalon_frame::Frame;
use etalon_judge::{FrameSeconds, Timing};
use etalon_scene::Scene;
use etalon_webgpu::message::{Answer, PageTimes, Request, packed, take_contents, unpacked};
use etalon_webgpu::{CallList, Device, MappedReading, lower, plant};

/// The requests for the frames of a case.
pub(crate) struct CaseDraw {
    pub(crate) requests: Vec<Vec<u8>>,
    /// The meaning of the bytes of each answer.
    readings: Vec<MappedReading>,
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
            let mut list = lowered(scene, device, fault)?;
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
                requests.push(sent(&request, bytes)?);
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
        let mut frames = Vec::new();
        for (answer, reading) in answers.iter().zip(&self.readings) {
            let (_, bytes) = received(answer)?;
            let frame = reading.frame(bytes);
            let short = || BackendError::internal("the page's frame is too short");
            let mut frame = frame.ok_or_else(short)?;
            if let Some(fault) = fault {
                for image in &mut frame.images {
                    fault.change_codes(
                        &mut image.codes,
                        image.size,
                        image.samples,
                        &image.channels,
                    );
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

/// Returns a request for frames of a case's scene that are timed. Only the request for the first frame has the scene.
///
/// # Errors
/// If the device cannot draw the scene.
pub(crate) fn timed_request(
    case: &Case,
    device: &Device,
    fault: Option<Fault>,
    timing: Timing,
) -> Result<Vec<u8>, BackendError> {
    let mut request = Request {
        number: 0,
        dropped: Vec::new(),
        slot: 0,
        list: None,
        contents: Vec::new(),
        frames: timing.frames(),
        read: false,
    };
    if timing != Timing::First {
        return sent(&request, &[]);
    }
    let mut list = lowered(&case.scene, device, fault)?;
    let (places, contents) = take_contents(&mut list);
    (request.list, request.contents) = (Some(&list), places);
    sent(&request, &contents)
}

/// Returns the times in an answer of a device.
///
/// # Errors
/// If the device failed.
pub(crate) fn times(answer: &[u8]) -> Result<Vec<FrameSeconds>, BackendError> {
    let (answer, _) = received(answer)?;
    let seconds = |times: &PageTimes| FrameSeconds {
        wall: times.wall / 1e3,
        cpu: times.cpu / 1e3,
        gpu: times.gpu.map(|gpu| gpu / 1e3),
    };
    Ok(answer.times.iter().map(seconds).collect())
}

fn lowered(scene: &Scene, device: &Device, fault: Option<Fault>) -> Result<CallList, BackendError> {
    let mut list = lower(device, scene).map_err(BackendError::NotSupported)?;
    plant(fault, &mut list);
    Ok(list)
}

fn sent(request: &Request<'_>, contents: &[Vec<u8>]) -> Result<Vec<u8>, BackendError> {
    let message = packed(request, contents.iter().map(Vec::as_slice));
    message.map_err(|error| BackendError::internal_of("a list is not sent", error))
}

fn received(answer: &[u8]) -> Result<(Answer, &[u8]), BackendError> {
    let garbage = |why: String| BackendError::internal_of("an answer of the page", why);
    let (mut answer, bytes) = unpacked::<Answer>(answer).map_err(garbage)?;
    match answer.error.take() {
        Some(failed) => Err(failed.into()),
        None => Ok((answer, bytes)),
    }
}
