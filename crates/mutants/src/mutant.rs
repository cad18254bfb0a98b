//! A planted bug.

use crate::plant::Plant;

/// A planted bug.
#[derive(Debug)]
pub struct Mutant {
    /// The stable name, its class first: `depth/write-ignored`.
    pub name: String,
    /// The effect, in one sentence.
    pub about: String,
    /// The driver that had it, or the kind of mistake.
    pub source: &'static str,
    /// The area whose cases must be enough to catch it.
    pub area: &'static str,
    /// The clause that allows it; `None` if it must be caught.
    pub legal: Option<&'static str>,
    pub(super) plant: Plant,
}
