//! What a worker process is asked to open, as the parent writes it on its command line.

use super::backend_name::BackendName;
use super::hidden::Hidden;
use serde::{Deserialize, Serialize};
use std::path::PathBuf;

/// What a worker is to open.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Open {
    pub(crate) name: String,
    pub(crate) backend: BackendName,
    /// The device in the backend's own order; without it, the default one.
    pub(crate) device: Option<usize>,
    /// The EGL library; without it, the system's.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(crate) egl: Option<PathBuf>,
    /// Whether validation layers and debug output listen.
    #[serde(default)]
    pub(crate) validate: bool,
    /// What is planted in an adapter that no list names.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(crate) hidden: Option<Hidden>,
}
