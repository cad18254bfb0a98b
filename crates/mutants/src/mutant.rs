//! A planted bug.

use crate::plant::Plant;

/// A planted bug.
#[derive(Debug)]
pub struct Mutant {
    /// The stable name, its class first: `depth/write-ignored`.
    pub name: String,
    /// The effect, in one sentence.
    pub about: String,
    /// The driver that had the bug, or the kind of mistake.
    pub source: &'static str,
    /// The area whose cases alone must catch the bug.
    pub area: &'static str,
    /// The clause that allows the bug; `None` if the suite must catch it.
    pub legal: Option<&'static str>,
    pub(super) plant: Plant,
}
