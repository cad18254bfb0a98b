//! The adapters of a run or bench, and those that cannot be used.

use etalon_frame::Limits;
use serde::{Deserialize, Serialize};

/// An adapter of a run or bench.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct AdapterRecord {
    /// The adapter's name: `vulkan:lavapipe`.
    pub name: String,
    /// The backend: `cpu`, `vulkan`, `gl`, `wgpu`.
    pub backend: String,
    /// The device as the driver names it.
    pub device: String,
    /// The driver as it names itself.
    pub driver: String,
    /// The driver's version, as far as the driver reports it.
    pub driver_version: String,
    /// The driver's identifier for programs: `VkDriverId` and PCI ids in Vulkan; empty where the API has
    /// none.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub driver_id: String,
    /// The API's version.
    pub api_version: String,
    /// True if the device is the processor.
    pub software: bool,
    /// The release of the driver, as its description says.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub release: Option<Release>,
    /// Its limits and features.
    pub limits: Limits,
}

/// One release of a driver.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Release {
    /// The line: one driver over its releases, such as `swiftshader`.
    pub line: String,
    /// The version within the line, numbers with dots.
    pub version: String,
}

impl AdapterRecord {
    /// The name up to an `@`, behind which one release of a driver is told from others: expectations speak of
    /// all of them.
    pub fn without_release(&self) -> &str {
        let (name, _) = self.name.split_once('@').unwrap_or((&self.name, ""));
        name
    }

    /// Driver and version in one text, which the `driver` globs of expectations match.
    pub fn driver_text(&self) -> String {
        format!("{} {}", self.driver, self.driver_version)
            .trim()
            .to_owned()
    }
}

/// An adapter that cannot be used.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct AbsentAdapter {
    /// The adapter's name.
    pub name: String,
    /// The cause.
    pub reason: String,
    /// The remedy.
    pub remedy: String,
}
