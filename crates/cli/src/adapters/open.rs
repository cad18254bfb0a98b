//! The request that a worker process gets on its command line, or through standard input if a launcher starts
//! it.

use super::backend_name::BackendName;
use super::listen::Listen;
use etalon_backend::Fault;
use etalon_browser::Browser;
use etalon_keeper::Server;
use serde::{Deserialize, Serialize};
use std::path::PathBuf;

/// The argument that stands for a request on standard input.
pub(crate) const FROM_INPUT: &str = "-";

/// The adapter that a worker opens.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Open {
    pub(crate) name: String,
    pub(crate) backend: BackendName,
    /// The index of the device in the backend's order; `None` is the default device.
    pub(crate) device: Option<usize>,
    /// The EGL library; `None` is the system's.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(crate) egl: Option<PathBuf>,
    /// The browser that the worker starts.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(crate) browser: Option<Browser>,
    /// The server of the driver, which the worker starts.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(crate) server: Option<Server>,
    /// The address at which a browser opens the worker's page.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(crate) listen: Option<Listen>,
    /// True if validation layers and debug output are enabled.
    #[serde(default)]
    pub(crate) validate: bool,
    /// True if the calls of the first scene are recorded.
    #[serde(default, skip_serializing_if = "is_false")]
    pub(crate) record: bool,
    /// The fault at the end of the name.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(crate) fault: Option<Fault>,
}

fn is_false(value: &bool) -> bool {
    !value
}
