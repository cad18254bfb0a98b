//! The features that failures have in common.
//!
//! A [`Symptom`] is the way in which a record failed. A [`Signature`] contains the parts of a scene that
//! distinguish failures. [`Traits`] combine both, and measure how similar a failure is to a known one. A
//! [`Condition`] on axes separates the failing cases of a file from the others. [`Groups`] collects failing
//! scenes by their reduced form, and [`KnownBugs`] finds the finding that explains or resembles a group.
//! [`Preflight`] says which known bugs a driver shows, and what it draws right.
//! [`bless()`] turns a run's failures into expectations and findings.

#![cfg_attr(
    test,
    expect(clippy::unwrap_used, reason = "a test that panics has failed")
)]

mod bless;
mod condition;
mod groups;
mod known_bugs;
mod matching;
mod preflight;
mod signature;
mod symptom;
mod traits;

pub use bless::{Blessing, bless};
pub use condition::Condition;
pub use groups::{Group, Groups, Key, Unreduced};
pub use known_bugs::{Driver, KnownBugs};
pub use matching::{Difference, Match};
pub use preflight::{Advice, DrawnCase, Fact, Preflight, Safety, ShownBug, UnseenBug};
pub use signature::Signature;
pub use symptom::{Direction, Symptom, WrongPart, violated_clause};
pub use traits::{Similarity, Traits, Violation};
