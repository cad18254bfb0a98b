//! The seam between the suite and a graphics API.
//!
//! A backend draws a [`Scene`] and hands back a [`Frame`]; it never sees what is expected of it,
//! nor the case's name. Conventions are WebGPU's: y up in clip space, depth 0..=1, framebuffer
//! origin at the top left, counter-clockwise front faces. Each backend adapts inside itself.

use etalon_frame::{Frame, Limits, Requirement};
use etalon_scene::Scene;
use serde::{Deserialize, Serialize};
use std::time::Duration;
use thiserror::Error;

/// Who an adapter is.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct AdapterInfo {
    /// The adapter's name: `vulkan:lavapipe`, `gl:es:softpipe`, `cpu`.
    pub name: String,
    /// The backend: `cpu`, `vulkan`, `gl`, `wgpu`.
    pub backend: String,
    /// The device as the driver names it.
    pub device: String,
    /// The driver as it names itself.
    pub driver: String,
    /// The driver's version, as far as it tells.
    pub driver_version: String,
    /// What tells the driver from others for programs: `VkDriverId` and PCI ids in Vulkan; empty where
    /// the API tells none.
    #[serde(default)]
    pub driver_id: String,
    /// The API's version.
    pub api_version: String,
    /// Whether the device is the processor.
    pub software: bool,
}

/// An open connection to one driver.
pub trait Backend {
    /// Who it is.
    fn adapter(&self) -> &AdapterInfo;

    /// What it can do; truthful, for the judge builds on it.
    fn limits(&self) -> &Limits;

    /// Creates everything that drawing the scene takes. Several prepared scenes may live at once.
    ///
    /// # Errors
    /// When the scene asks for what the limits deny, or the driver fails.
    fn prepare(&self, scene: &Scene) -> Result<Box<dyn Prepared + '_>, BackendError>;

    /// Messages of a validation layer or of debug output since the last call, oldest first; empty
    /// where none was asked for.
    fn messages(&self) -> Vec<String> {
        Vec::new()
    }
}

/// A scene, ready to be drawn.
pub trait Prepared {
    /// Initialises the attachments, draws all passes, and returns when the device is done. Drawing
    /// again starts from the same contents.
    ///
    /// # Errors
    /// When the driver fails.
    fn submit(&mut self) -> Result<FrameTime, BackendError>;

    /// Reads back what the scene asks for, after at least one [`Prepared::submit`].
    ///
    /// # Errors
    /// When the driver fails.
    fn read_back(&mut self) -> Result<Frame, BackendError>;
}

/// How long one submit took.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct FrameTime {
    /// From the first call to the API's return from the last one that submits work.
    pub cpu: Duration,
    /// Between GPU timestamps around the passes, where there are any.
    pub gpu: Option<Duration>,
    /// Until the device was done.
    pub wall: Duration,
}

/// Why a backend could not do what was asked.
#[derive(Clone, Debug, PartialEq, Eq, Error, Serialize, Deserialize)]
pub enum BackendError {
    /// The scene needs what the adapter's limits deny. The runner asks the limits first, so this
    /// arrives only where a driver denies what it advertised.
    #[error("not supported: {0}")]
    NotSupported(Requirement),
    /// The device is gone.
    #[error("the device was lost: {0}")]
    DeviceLost(String),
    /// The driver refused an allocation or an object.
    #[error("the driver refused {what}: {message}")]
    Resource {
        /// What was being made.
        what: String,
        /// The driver's word.
        message: String,
    },
    /// Our shader could not be translated or compiled.
    #[error("shader {shader}: {message}")]
    Shader {
        /// The shader.
        shader: String,
        /// Translator's or driver's log.
        message: String,
    },
    /// Something that the backend's own logic rules out.
    #[error("internal error: {0}")]
    Internal(String),
}

/// Why an adapter cannot be used, and what would help.
#[derive(Clone, Debug, PartialEq, Eq, Error, Serialize, Deserialize)]
#[error("{reason}; {remedy}")]
pub struct Unavailable {
    /// What is missing or failed.
    pub reason: String,
    /// What to do about it.
    pub remedy: String,
}

impl Unavailable {
    /// An adapter that cannot be used for a reason, with its remedy.
    pub fn new(reason: impl Into<String>, remedy: impl Into<String>) -> Self {
        Self {
            reason: reason.into(),
            remedy: remedy.into(),
        }
    }
}
