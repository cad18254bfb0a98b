//! What failures have in common.
//!
//! A [`Symptom`] is the way in which a record failed, a [`Signature`] what of a scene tells one failure from another,
//! [`Traits`] are both, and say how much a failure is like one that is known. A [`Condition`] on axes tells the failing
//! cases of a file from the others. [`Groups`] holds failing scenes by what is left of them, [`KnownBugs`] finds the finding
//! that explains a group, or that it is like. [`bless()`] makes expectations and findings of a run's failures.

#![cfg_attr(
    test,
    expect(clippy::unwrap_used, reason = "a test that panics has failed")
)]

mod bless;
mod condition;
mod groups;
mod known_bugs;
mod matching;
mod signature;
mod symptom;
mod traits;

pub use bless::{Blessing, bless};
pub use condition::Condition;
pub use groups::{Group, Groups, Key, Unreduced};
pub use known_bugs::{Driver, KnownBugs};
pub use matching::{Beyond, Match};
pub use signature::Signature;
pub use symptom::{Direction, Subject, Symptom, violated_clause};
pub use traits::{Likeness, Traits, Violation};
