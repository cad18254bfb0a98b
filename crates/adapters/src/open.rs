//! The request that a worker process gets on its command line, or through standard input if a launcher starts
//! it.

use crate::backend_name::BackendName;
use crate::listen::Listen;
use etalon_backend::Fault;
use etalon_browser::Browser;
use etalon_keeper::Server;
use serde::{Deserialize, Serialize};
use std::path::PathBuf;

/// The argument that stands for a request on standard input.
pub const FROM_INPUT: &str = "-";

/// A request to open an adapter.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct OpenRequest {
    /// The adapter's name.
    pub name: String,
    /// The backend that opens it.
    pub backend: BackendName,
    /// The index of the device in the backend's order; `None` is the default device.
    pub device: Option<usize>,
    /// The EGL library; `None` is the system's.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub egl: Option<PathBuf>,
    /// The browser that the worker starts.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub browser: Option<Browser>,
    /// The program that draws, which the worker starts.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub program: Option<DrawingProgram>,
    /// The server of the driver, which the worker starts.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub server: Option<Server>,
    /// The address at which a browser opens the worker's page.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub listen: Option<Listen>,
    /// True if validation layers and debug output are enabled.
    #[serde(default)]
    pub validate: bool,
    /// True if the calls of the first scene are recorded.
    #[serde(default, skip_serializing_if = "is_false")]
    pub record: bool,
    /// The planted fault, which the end of the name states: `cpu:fault=abort`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub fault: Option<Fault>,
}

/// A program that speaks the open protocol.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct DrawingProgram {
    /// The words of its command.
    pub command: Vec<String>,
    /// The folder in which it runs: that of the user's file. `None` behind a launcher.
    pub folder: Option<PathBuf>,
}

fn is_false(value: &bool) -> bool {
    !value
}
