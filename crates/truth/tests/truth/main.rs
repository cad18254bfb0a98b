//! The truth mode against closed forms, against sampling, and against itself in another resolution.
#![expect(clippy::unwrap_used, reason = "a test that panics has failed")]

mod closed;
mod common;
mod distances;
mod edges;
mod properties;
