//! The backend on real drivers: lavapipe, or what `ETALON_VULKAN_ADAPTER` names.
#![expect(clippy::unwrap_used, reason = "a test fails by panicking")]

mod capabilities;
mod drivers;
mod library;

etalon_conformance::driver_tests! { lavapipe; [library::sample] }
