//! Claims about cut-outs.

use crate::claim::{Claim, FigureCondition, Quantity, Test, one};

const QUESTION: &str = "cut-outs";

pub(crate) const CLAIMS: &[Claim] = &[
    Claim::new(
        QUESTION,
        "Alpha to coverage leaves less error in a cut-out than discarding below a half.",
        "Akeley 1993, RealityEngine Graphics",
        Test::Ratio {
            quantity: Quantity::Rmse,
            of: one!("alpha-to-coverage"),
            over: one!("discard"),
            holds: FigureCondition::Below(1.0),
        },
    )
    .of(&["grass"]),
    Claim::new(
        QUESTION,
        "Near the viewer, hashed alpha testing adds noise that a fixed threshold does not have.",
        "Wyman and McGuire 2017, Hashed Alpha Testing",
        Test::Ratio {
            quantity: Quantity::Rmse,
            of: one!("hashed"),
            over: one!("discard"),
            holds: FigureCondition::Above(1.0),
        },
    )
    .of(&["grass"])
    .between(1.0, 4.0),
    Claim::new(
        QUESTION,
        "Alpha to coverage with sharpened alpha leaves less error than discarding at the same cutoff.",
        "Golus 2017, Anti-Aliased Alpha Test: The Esoteric Alpha to Coverage",
        Test::Ratio {
            quantity: Quantity::Rmse,
            of: one!("alpha-to-coverage-sharpened"),
            over: one!("discard"),
            holds: FigureCondition::Below(1.0),
        },
    ),
];
