//! The features and limits that a WebGPU device offers.

use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// The features and limits of a WebGPU device, from which a scene's calls follow.
#[derive(Clone, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub struct DeviceOffer {
    /// True if the device has the feature level `compatibility`.
    #[serde(default)]
    pub compatibility: bool,
    /// The features, by WebGPU's names.
    pub features: Vec<String>,
    /// The limits, by WebGPU's names.
    pub limits: BTreeMap<String, u64>,
}
