//! Exploration: random scenes, and the reduction of a failing case to the smallest one that fails in the
//! same way.
//!
//! [`Fuzzer`] makes scenes over the whole model from choices, and prefers states that were not tried yet.
//! [`reduce()`] works on a case's document, the JSON of a case file, because its result is such a document.
//! The meaning of keys and their defaults is therefore defined only once, where case files are read. An
//! [`Oracle`] decides whether a smaller case still fails; this crate neither draws nor judges.

#![cfg_attr(
    test,
    expect(clippy::unwrap_used, reason = "a test that panics has failed")
)]

mod choices;
mod document;
mod edit;
mod excluded;
mod facts;
mod fuzz;
mod pairs;
mod passes;
mod reduce;
mod scenes;
mod space;

pub use document::{keys, leaves, states};
pub use facts::{
    DrawFact, FactKind, FactPair, FactPairs, PLAIN_FACTS, case_facts, draw_facts, fact_names,
    format_fact,
};
pub use fuzz::{Fuzzer, RandomScene};
pub use reduce::{Candidate, MOST_DRAWS, Oracle, Reduction, ReductionLimits, reduce};
pub use space::Space;
