//! Truths compared with closed forms, with sampling, and with truths at another resolution.
#![expect(clippy::unwrap_used, reason = "a test that panics has failed")]

mod closed;
mod common;
mod distances;
mod edges;
mod properties;
