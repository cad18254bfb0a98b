//! Claims about accumulated rounding.

use crate::claim::{Claim, FigureCondition, Quantity, Test, one};

const QUESTION: &str = "accumulation";

pub(crate) const CLAIMS: &[Claim] = &[
    Claim::new(
        QUESTION,
        "The error of blending into 8 bits stays below half a code over alpha.",
        "Closed form: half a code per layer, reduced by 1 - alpha in each later layer; a conversion within 0.6 codes",
        Test::HalfCodes {
            of: "ordered-8-bit",
            holds: FigureCondition::AtMost(1.2),
        },
    )
    .of(&["columns-alpha"]),
    Claim::new(
        QUESTION,
        "The error of blending into 8 bits grows with the number of layers.",
        "Closed form: half a code per layer, reduced by 1 - alpha in each later layer",
        Test::Trend {
            quantity: Quantity::Largest,
            of: "ordered-8-bit",
            holds: FigureCondition::Above(1.0),
        },
    )
    .of(&["columns"]),
    Claim::new(
        QUESTION,
        "Two more bits leave a quarter of the rounding error.",
        "Closed form: half a code is 1/510 of 8 bits and 1/2046 of 10",
        Test::Ratio {
            quantity: Quantity::Rmse,
            of: one!("ordered-10-bit"),
            over: one!("ordered-8-bit"),
            holds: FigureCondition::Between(0.15, 0.4),
        },
    )
    .of(&["columns"])
    .between(4.0, f64::INFINITY),
];
