//! The reasons why frames cannot be judged.

use thiserror::Error;

/// A frame that cannot be judged, or a texel that cannot be explained: a mistake of the caller, never of a driver.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
pub enum AssertError {
    /// There is no case with this id.
    #[error("there is no case `{id}`{near}; `etalon list --profile full` lists all cases")]
    UnknownCase {
        /// The id.
        id: String,
        /// A suggestion of similar ids; empty without one.
        near: String,
    },
    /// The case cannot be built.
    #[error("{0}")]
    Case(String),
    /// The limits do not hold together.
    #[error("the limits are wrong: {0}")]
    Limits(String),
    /// A frame does not fit the case: another number or another form of images or counters.
    #[error("{0}")]
    Unfit(String),
    /// The texel is outside every attachment that the case reads back, or lacks the sample.
    #[error("{0}")]
    Outside(String),
    /// No texel is wrong, so none is explained.
    #[error("no texel of {case} is wrong ({verdict})")]
    NothingWrong {
        /// The id of the case.
        case: String,
        /// Its verdict.
        verdict: String,
    },
}
