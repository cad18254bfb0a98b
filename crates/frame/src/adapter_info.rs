//! The facts that an adapter reports about itself.

use crate::device_offer::DeviceOffer;
use serde::{Deserialize, Serialize};

/// The identity of an adapter. In files, its keys stand among those of the adapter's record.
#[derive(Clone, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub struct AdapterInfo {
    /// The adapter's name: `vulkan:lavapipe`, `gl:es:softpipe`, `cpu`.
    pub name: String,
    /// The backend: `cpu`, `vulkan`, `gl`, `wgpu`, `webgpu`.
    pub backend: String,
    /// The device as the driver names it; empty if unknown.
    pub device: String,
    /// The driver as it names itself.
    pub driver: String,
    /// The driver's version as the driver reports it; empty if it reports none.
    pub driver_version: String,
    /// The driver's identifier for programs: `VkDriverId` and PCI ids in Vulkan; empty if the API has none.
    #[serde(default)]
    pub driver_id: String,
    /// The API's version; empty if unknown.
    pub api_version: String,
    /// True if the device is known to be the processor.
    pub software: bool,
    /// The features and limits that the device offers, in backend `webgpu`.
    #[serde(default)]
    pub offer: Option<DeviceOffer>,
}
