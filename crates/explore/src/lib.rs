//! Exploration: random scenes, and from a case that fails to the smallest one that fails in the same way.
//!
//! [`Fuzzer`] makes scenes over the whole model from choices, and weighs them by what was not tried yet.
//! [`reduce()`] works on a case's document, the JSON of a case file, because that is what comes out of it: what
//! a key is, and what is left without it, is then said once, where case files are read. Whether a smaller
//! case still fails is for an [`Oracle`] to say; this crate draws and judges nothing.

#![cfg_attr(
    test,
    expect(clippy::unwrap_used, reason = "a test that panics has failed")
)]

mod choices;
mod document;
mod edit;
mod fuzz;
mod pairs;
mod passes;
mod reduce;
mod scenes;
mod space;

pub use document::{keys, leaves, states};
pub use fuzz::{Fuzzer, RandomScene};
pub use reduce::{Budget, Candidate, MOST_DRAWS, Oracle, Reduction, reduce};
pub use space::Space;
