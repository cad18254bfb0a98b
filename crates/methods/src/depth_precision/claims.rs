//! Claims about depth precision.

use crate::claim::{Claim, Condition, Test};

const QUESTION: &str = "depth-precision";
const GAPS: &[&str] = &["planes", "slanted"];

pub(crate) const CLAIMS: &[Claim] = &[
    Claim::new(
        QUESTION,
        "Reversed float depth resolves smaller gaps than 24 bits.",
        "Reed 2015, Depth Precision Visualized; Kilgard 1999, reversed depth ranges of NV_depth_buffer_float",
        Test::Narrowest {
            of: "reversed-depth",
            over: "depth24",
            holds: Condition::Below(1.0),
        },
    )
    .of(GAPS),
    Claim::new(
        QUESTION,
        "Float depth that is not reversed resolves no smaller gaps than 24 bits.",
        "Reed 2015, Depth Precision Visualized",
        Test::Narrowest {
            of: "depth32float",
            over: "depth24",
            holds: Condition::Above(0.7),
        },
    )
    .of(GAPS),
    Claim::new(
        QUESTION,
        "A far plane at infinity resolves the same gaps.",
        "Everitt and Kilgard 2002, Practical and Robust Stenciled Shadow Volumes",
        Test::Narrowest {
            of: "infinite-depth",
            over: "depth24",
            holds: Condition::Between(0.5, 2.0),
        },
    )
    .of(&["planes"]),
    Claim::new(
        QUESTION,
        "A near plane farther away resolves smaller gaps.",
        "Upchurch and Desbrun 2012, Tightening the Precision of Perspective Rendering",
        Test::Narrowest {
            of: "larger-near",
            over: "depth24",
            holds: Condition::Below(1.0),
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
            holds: Condition::Above(1.0),
        },
    )
    .of(GAPS),
];
