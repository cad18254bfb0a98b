//! The limits by which frames of unknown origin are judged.

use crate::failure::Failure;
use clap::ValueEnum;
use etalon_assert::any_device;
use etalon_cpu::limits_of;
use etalon_external::limits;
use etalon_external::message::Hello;
use etalon_frame::{AdapterInfo, Api};
use etalon_record::AdapterRecord;
use std::fs;
use std::path::Path;

/// The API whose rules bind frames.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum RulesApi {
    /// Vulkan 1.4.
    Vulkan,
    /// OpenGL 4.6.
    Opengl,
    /// OpenGL ES 3.2.
    OpenglEs,
    /// WebGPU.
    Webgpu,
}

impl From<RulesApi> for Api {
    fn from(rules: RulesApi) -> Self {
        match rules {
            RulesApi::Vulkan => Self::Vulkan,
            RulesApi::Opengl => Self::OpenGl,
            RulesApi::OpenglEs => Self::OpenGlEs,
            RulesApi::Webgpu => Self::WebGpu,
        }
    }
}

/// Returns the adapter that drew frames: what a file describes, or any device.
pub(crate) fn adapter(
    name: &str,
    rules: Option<RulesApi>,
    file: Option<&Path>,
) -> Result<AdapterRecord, Failure> {
    let mut info = AdapterInfo {
        name: name.to_owned(),
        backend: "external".to_owned(),
        driver: "frames from files".to_owned(),
        ..AdapterInfo::default()
    };
    let mut limits = match file {
        Some(path) => {
            let hello = description(path)?;
            let wrong = |why: String| Failure::usage(format!("{}: {why}", path.display()));
            let limits = limits(&hello).map_err(wrong)?;
            let limits = limits.checked().map_err(|why| wrong(why.to_string()))?;
            info.device = hello.device;
            info.driver = hello.driver;
            info.driver_version = hello.driver_version;
            info.software = hello.software;
            limits
        }
        None => any_device(rules.unwrap_or(RulesApi::Webgpu).into()),
    };
    if let Some(rules) = rules
        && limits.api != rules.into()
    {
        limits.version = limits_of(rules.into()).version;
        limits.api = rules.into();
    }
    // How a scene reached the device changes nothing that is legal.
    limits.paths = limits_of(limits.api).paths;
    Ok(AdapterRecord {
        info,
        release: None,
        limits,
    })
}

fn description(path: &Path) -> Result<Hello, Failure> {
    let text = fs::read_to_string(path).map_err(|error| Failure::of_file("read", path, &error))?;
    serde_json::from_str(&text).map_err(|error| {
        let line = "it must be the first line of the open protocol (ci/adapters/external.md)";
        Failure::usage(format!("{}: {error}; {line}", path.display()))
    })
}
