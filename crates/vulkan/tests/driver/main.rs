//! The backend against a real driver: lavapipe, or what `ETALON_VULKAN_ADAPTER` names.
#![expect(clippy::unwrap_used, reason = "a test fails by panicking")]

mod common;
mod drawing;
mod formats;
mod living;
mod multisample;
mod raster;
mod targets;
mod timing;
