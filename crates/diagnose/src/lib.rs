//! What failures have in common.
//!
//! A [`Symptom`] is the way in which a record failed, a [`Signature`] what of a scene tells one failure from another,
//! [`Traits`] are both, and say how much a failure is like one that is known. A [`Condition`] on axes tells the failing
//! cases of a file from the others. [`bless()`] makes expectations and findings of a run's failures.

#![cfg_attr(
    test,
    expect(clippy::unwrap_used, reason = "a test that panics has failed")
)]

mod bless;
mod condition;
mod signature;
mod symptom;
mod traits;

pub use bless::{Blessing, bless};
pub use condition::Condition;
pub use signature::Signature;
pub use symptom::{Direction, Subject, Symptom};
pub use traits::{Likeness, Traits};
