//! The origin of an adapter.

use serde::Serialize;
use std::collections::BTreeMap;
use std::path::PathBuf;

/// The description of an adapter and the environment of its worker.
#[derive(Clone, Debug, Serialize)]
pub struct Origin {
    /// `built-in`, `found` by enumeration, or the path of the user's file.
    pub described_in: String,
    /// The words of the launcher; empty if the worker runs on this machine.
    pub launcher: Vec<String>,
    /// Environment variables of the worker; `null` removes a variable.
    pub environment: BTreeMap<String, Option<String>>,
    /// The manifest of the Vulkan driver, if one was chosen.
    pub manifest: Option<PathBuf>,
    /// The EGL library, if it is not the system's.
    pub egl: Option<PathBuf>,
    /// Folders searched for libraries before those of the system.
    pub library_path: Vec<PathBuf>,
    /// The index of the device in the backend's order, if one was chosen.
    pub device_index: Option<usize>,
}
