//! The backend against a real driver: lavapipe, or what `ETALON_VULKAN_ADAPTER` names.
#![expect(clippy::unwrap_used, reason = "a test fails by panicking")]

mod common;
mod counters;
mod drawing;
mod formats;
mod integers;
mod living;
mod multisample;
mod raster;
mod sampling;
mod targets;
mod timing;
