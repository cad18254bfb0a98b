//! Claims about depth precision.

use crate::claim::{Claim, FigureCondition, Test};

const QUESTION: &str = "depth-precision";
const GAPS: &[&str] = &["planes", "slanted"];

/// A far plane at infinity changes each difference of depths by the factor 1 - near / far, which is 0.9999.
/// Whether two depths less than a step apart get different codes depends on where the step between them is.
/// The factor moves that step, and rounding vertices to 32 bits moves each depth by up to a step. Gaps of a
/// few steps are therefore resolved by chance with either far plane, and gaps of eight steps are resolved
/// with both.
const fn infinite(families: &'static [&'static str], from: f64) -> Claim {
    Claim::new(
        QUESTION,
        "A far plane at infinity resolves the same gaps if they are at least eight steps of 24 bits.",
        "Everitt and Kilgard 2002, Practical and Robust Stenciled Shadow Volumes",
        Test::Same {
            methods: ["infinite-depth", "depth24"],
        },
    )
    .of(families)
    .between(from, f64::INFINITY)
}

pub(crate) const CLAIMS: &[Claim] = &[
    Claim::new(
        QUESTION,
        "Reversed float depth resolves smaller gaps than 24 bits.",
        "Reed 2015, Depth Precision Visualized; Kilgard 1999, reversed depth ranges of NV_depth_buffer_float",
        Test::Narrowest {
            of: "reversed-depth",
            over: "depth24",
            holds: FigureCondition::Below(1.0),
        },
    )
    .of(GAPS),
    Claim::new(
        QUESTION,
        "Float depth that is not reversed does not resolve smaller gaps than 24 bits.",
        "Reed 2015, Depth Precision Visualized",
        Test::Narrowest {
            of: "depth32float",
            over: "depth24",
            holds: FigureCondition::Above(0.7),
        },
    )
    .of(GAPS),
    // Eight steps at distance 900, and at 420, the distance of the first row.
    infinite(&["planes"], 4.0),
    infinite(&["slanted"], 0.002),
    Claim::new(
        QUESTION,
        "A near plane farther away resolves smaller gaps.",
        "Upchurch and Desbrun 2012, Tightening the Precision of Perspective Rendering",
        Test::Narrowest {
            of: "larger-near",
            over: "depth24",
            holds: FigureCondition::Below(1.0),
        },
    )
    .of(GAPS),
    Claim::new(
        QUESTION,
        "Sixteen bits of depth resolve less than twenty-four.",
        "Akenine-Möller and others, Real-Time Rendering, 4th edition, 4.7: projections",
        Test::Narrowest {
            of: "depth16",
            over: "depth24",
            holds: FigureCondition::Above(1.0),
        },
    )
    .of(GAPS),
];
