//! Where an adapter comes from.

use serde::Serialize;
use std::collections::BTreeMap;
use std::path::PathBuf;

/// Where an adapter comes from, and what was set to reach it.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct Origin {
    /// `built-in`, `found` by enumeration, or the path of the user's file.
    pub(crate) described_in: String,
    /// Environment variables of its worker; `null` is one taken away.
    pub(crate) environment: BTreeMap<String, Option<String>>,
    /// The Vulkan driver's manifest, where one was chosen.
    pub(crate) manifest: Option<PathBuf>,
    /// The EGL library, where it is not the system's.
    pub(crate) egl: Option<PathBuf>,
    /// Folders in which libraries were looked for first.
    pub(crate) library_path: Vec<PathBuf>,
    /// The device's place in the backend's order, where one was chosen.
    pub(crate) device_index: Option<usize>,
}
