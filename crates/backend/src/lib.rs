//! The interface between the suite and a graphics API.
//!
//! A backend draws a [`Scene`] and returns a [`Frame`]. It sees neither the expected result nor the case's
//! name, so it cannot adapt to them.
//!
//! # Conventions
//!
//! The coordinates of scenes and frames are WebGPU's, on every backend; each backend converts
//! internally.
//!
//! - Clip space: y points up, depth is 0..=1.
//! - Framebuffer: the origin is the top left corner, y points down. Row 0 of an image is
//!   its top row.
//! - Front faces: `ccw` is counter-clockwise as seen on the framebuffer.

mod blits;
mod call_fault;
pub mod codes;
#[cfg(feature = "faults")]
mod fault;
mod fault_name;
#[cfg(not(feature = "faults"))]
mod faultless;
mod halves;
pub mod open_limits;
mod recording;
pub mod texels;

pub use blits::{Blit, BlitPiece, Blits, doubled};
pub use call_fault::CallFault;
#[cfg(feature = "faults")]
pub use fault::{
    DrawNumbers, Fault, FaultyCalls, FaultyScenes, LimitFault, OpenQuery, ProcessFault, ReadFault,
};
pub use fault_name::FaultNameError;
#[cfg(not(feature = "faults"))]
pub use faultless::Fault;
pub use halves::halves;
pub use recording::{
    Argument, Constant, CounterPart, Member, NumberForm, Phase, RecordedCall, RecordedContext,
    RecordedCounter, RecordedImage, RecordedPlane, Recording, VulkanNeeds,
};

use etalon_frame::{AdapterInfo, ErrorKind, Frame, Limits, Requirement};
use etalon_scene::Scene;
use serde::{Deserialize, Serialize};
use std::time::Duration;
use thiserror::Error;

/// An open connection to one driver.
pub trait Backend {
    /// Returns the adapter's identity.
    fn adapter(&self) -> &AdapterInfo;

    /// Returns the adapter's limits. They must be true, since the judge relies on them.
    fn limits(&self) -> &Limits;

    /// Creates all objects that drawing the scene needs. Several prepared scenes can exist at once.
    ///
    /// # Errors
    /// If the scene needs what the limits deny, or the driver fails.
    fn prepare(&self, scene: &Scene) -> Result<Box<dyn Prepared + '_>, BackendError>;

    /// Returns the messages of a validation layer or debug output since the last call, oldest first. Empty if
    /// these are not enabled.
    fn messages(&self) -> Vec<String> {
        Vec::new()
    }

    /// Returns the calls so far of the scene that was prepared first. `None` unless the backend was opened to
    /// record.
    fn recording(&self) -> Option<Recording> {
        None
    }
}

/// A scene prepared for drawing.
pub trait Prepared {
    /// Initialises the attachments, draws all passes, and returns when the device is done. Each submit starts
    /// from the same contents.
    ///
    /// # Errors
    /// If the driver fails.
    fn submit(&mut self) -> Result<FrameTime, BackendError>;

    /// Reads back the attachments and counters that the scene requests. [`Prepared::submit`] must have
    /// succeeded at least once.
    ///
    /// # Errors
    /// If the driver fails.
    fn read_back(&mut self) -> Result<Frame, BackendError>;
}

/// The duration of one submit.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct FrameTime {
    /// The time from the first call until the API returned from submitting the last work; in OpenGL, until
    /// the last draw call returned.
    pub cpu: Duration,
    /// The time between GPU timestamps around the passes, if supported.
    pub gpu: Option<Duration>,
    /// The time until the device was done.
    pub wall: Duration,
}

/// An error of a backend.
#[derive(Clone, Debug, PartialEq, Eq, Error, Serialize, Deserialize)]
pub enum BackendError {
    /// The scene needs something that the adapter's limits deny. The runner checks the limits first, so this
    /// occurs only if a driver denies what it advertises.
    #[error("not supported: {0}")]
    NotSupported(Requirement),
    /// The program that draws for the adapter does not support something in the scene, by its own words.
    #[error("not supported: {0}")]
    Unsupported(String),
    /// The backend or its driver failed.
    #[error("{}", failed(kind, message))]
    Failed {
        /// The kind of the failure.
        kind: ErrorKind,
        /// The driver's message, or a detail that differs between scenes; can be empty.
        message: String,
    },
}

impl BackendError {
    /// Returns the kind of the failure; `None` if the scene is not supported.
    pub fn kind(&self) -> Option<&ErrorKind> {
        match self {
            Self::NotSupported(_) | Self::Unsupported(_) => None,
            Self::Failed { kind, .. } => Some(kind),
        }
    }

    /// Returns true if whatever draws must not draw anything else. After a panic, its state is unknown.
    pub fn ends_drawing(&self) -> bool {
        matches!(
            self.kind(),
            Some(ErrorKind::DeviceLost | ErrorKind::Internal { .. })
        )
    }

    /// Returns the error of a lost device.
    pub fn lost(message: impl Into<String>) -> Self {
        Self::failed(ErrorKind::DeviceLost, message)
    }

    /// Returns the error of an object or allocation that the driver refused.
    pub fn refused(object: impl Into<String>, message: impl Into<String>) -> Self {
        let object = object.into();
        Self::failed(ErrorKind::Resource { object, code: None }, message)
    }

    /// Returns the error of a shader that could not be translated or compiled. The message is the log of the
    /// translator or the driver.
    pub fn shader(shader: impl Into<String>, message: impl Into<String>) -> Self {
        Self::failed(ErrorKind::Shader(shader.into()), message)
    }

    /// Returns the error of a condition that the backend's logic rules out.
    pub fn internal(condition: impl Into<String>) -> Self {
        Self::internal_of(condition, "")
    }

    /// Like [`BackendError::internal`], with a message that can differ between scenes.
    pub fn internal_of(condition: impl Into<String>, message: impl Into<String>) -> Self {
        let condition = condition.into();
        let code = None;
        Self::failed(ErrorKind::Internal { condition, code }, message)
    }

    /// Returns an error of this kind.
    pub fn failed(kind: ErrorKind, message: impl Into<String>) -> Self {
        let message = message.into();
        Self::Failed { kind, message }
    }

    /// Adds the API's result code.
    #[must_use]
    pub fn with_code(mut self, value: impl Into<String>) -> Self {
        if let Self::Failed {
            kind: ErrorKind::Resource { code, .. } | ErrorKind::Internal { code, .. },
            ..
        } = &mut self
        {
            *code = Some(value.into());
        }
        self
    }
}

fn failed(kind: &ErrorKind, message: &str) -> String {
    let what = match kind {
        ErrorKind::DeviceLost => "the device was lost".to_owned(),
        ErrorKind::Resource { object, .. } => format!("the driver refused {object}"),
        ErrorKind::Shader(shader) => format!("shader {shader}"),
        ErrorKind::Internal { condition, .. } => format!("internal error: {condition}"),
    };
    if message.is_empty() {
        what
    } else {
        format!("{what}: {message}")
    }
}

/// The reason why an adapter cannot be used, and a remedy.
#[derive(Clone, Debug, PartialEq, Eq, Error, Serialize, Deserialize)]
#[error("{reason}; {remedy}")]
pub struct Unavailable {
    /// The reason why the adapter cannot be used.
    pub reason: String,
    /// Instructions to make it usable.
    pub remedy: String,
}

impl Unavailable {
    /// Returns an error with this reason and remedy.
    pub fn new(reason: impl Into<String>, remedy: impl Into<String>) -> Self {
        Self {
            reason: reason.into(),
            remedy: remedy.into(),
        }
    }
}
