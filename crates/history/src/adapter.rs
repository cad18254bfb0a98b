//! An adapter as one run found it.

use etalon_record::{AdapterRecord, Release};

/// An adapter as one run found it, without its limits.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct Adapter {
    /// The adapter's name in the run: `vulkan:lavapipe`, or `vulkan:swiftshader@118.0.0`.
    pub name: String,
    /// The backend: `cpu`, `vulkan`, `gl`, `wgpu`.
    pub backend: String,
    /// The device as the driver names it; empty if unknown.
    pub device: String,
    /// The driver as it names itself.
    pub driver: String,
    /// The driver's version as the driver reports it; empty if it reports none.
    pub driver_version: String,
    /// The driver's identifier for programs, or empty.
    pub driver_id: String,
    /// The API's version; empty if unknown.
    pub api_version: String,
    /// True if the device is known to be a software renderer.
    pub software: bool,
    /// The line: one driver over its releases, such as `swiftshader`; empty if unknown.
    pub line: String,
    /// The version within the line, or empty.
    pub version: String,
}

impl Adapter {
    /// Returns the version that distinguishes releases of the driver: the version within the line, or else
    /// the version that the driver reports.
    pub fn shown_version(&self) -> &str {
        match self.version.as_str() {
            "" => &self.driver_version,
            version => version,
        }
    }
}

impl From<&AdapterRecord> for Adapter {
    fn from(adapter: &AdapterRecord) -> Self {
        let text = |get: fn(&Release) -> &String| {
            adapter
                .release
                .as_ref()
                .map(|r| get(r).clone())
                .unwrap_or_default()
        };
        Self {
            name: adapter.name.clone(),
            backend: adapter.backend.clone(),
            device: adapter.device.clone(),
            driver: adapter.driver.clone(),
            driver_version: adapter.driver_version.clone(),
            driver_id: adapter.driver_id.clone(),
            api_version: adapter.api_version.clone(),
            software: adapter.software,
            line: text(|r| &r.line),
            version: text(|r| &r.version),
        }
    }
}
