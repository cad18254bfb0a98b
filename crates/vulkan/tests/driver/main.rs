//! The backend against a real driver: lavapipe, or what `ETALON_VULKAN_ADAPTER` names.
#![expect(clippy::unwrap_used, reason = "a test fails by panicking")]

mod chains;
mod common;
mod counters;
mod drawing;
mod formats;
mod integers;
mod layers;
mod living;
mod multisample;
mod raster;
mod sampling;
mod shaders;
mod targets;
mod timing;
