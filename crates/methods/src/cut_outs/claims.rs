//! Claims about cut-outs.

use crate::claim::{Claim, Condition, Quantity, Test, one};

pub(crate) const CLAIMS: &[Claim] = &[Claim::new(
    "cut-outs",
    "Alpha to coverage leaves less of the error of a cut-out than discarding below a half.",
    "Akeley 1993, RealityEngine Graphics",
    Test::Ratio {
        quantity: Quantity::Rmse,
        of: one!("alpha-to-coverage"),
        over: one!("discard"),
        holds: Condition::Below(1.0),
    },
)
.of(&["grass"])];
