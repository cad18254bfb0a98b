//! Claims about cut-outs.

use crate::claim::{Claim, FigureCondition, Quantity, Test, one};

pub(crate) const CLAIMS: &[Claim] = &[Claim::new(
    "cut-outs",
    "Alpha to coverage leaves less error in a cut-out than discarding below a half.",
    "Akeley 1993, RealityEngine Graphics",
    Test::Ratio {
        quantity: Quantity::Rmse,
        of: one!("alpha-to-coverage"),
        over: one!("discard"),
        holds: FigureCondition::Below(1.0),
    },
)
.of(&["grass"])];
