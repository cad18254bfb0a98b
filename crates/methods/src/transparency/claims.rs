//! Claims about transparency.

use crate::claim::{Claim, Condition, Quantity, Test, one};

const QUESTION: &str = "transparency";

pub(crate) const CLAIMS: &[Claim] = &[
    Claim::new(
        QUESTION,
        "Front to back under what is there gives the picture of back to front over it.",
        "Porter and Duff 1984, Compositing Digital Images, 4.3: over is associative",
        Test::Ratio {
            quantity: Quantity::Rmse,
            of: one!("front-to-back"),
            over: one!("sorted"),
            holds: Condition::Between(0.4, 2.5),
        },
    )
    .of(&["windows", "smoke"]),
    Claim::new(
        QUESTION,
        "Depth peeling needs no order: it is right where triangles pass through each other.",
        "Everitt 2001, Interactive Order-Independent Transparency",
        Test::Value {
            quantity: Quantity::Rmse,
            of: "depth-peeling",
            holds: Condition::AtMost(0.01),
        },
    )
    .of(&["windows", "intersecting-panes", "nested-glass"]),
    Claim::new(
        QUESTION,
        "No order of objects is right once they pass through each other.",
        "Everitt 2001, Interactive Order-Independent Transparency: the sorting problem",
        Test::Value {
            quantity: Quantity::Rmse,
            of: "sorted",
            holds: Condition::Above(0.01),
        },
    )
    .of(&["intersecting-panes"])
    .between(35.0, 90.0),
    Claim::new(
        QUESTION,
        "Depth peeling draws all of the geometry again for each layer that it peels.",
        "Everitt 2001, Interactive Order-Independent Transparency",
        Test::Ratio {
            quantity: Quantity::Fragments,
            of: one!("depth-peeling"),
            over: one!("sorted"),
            holds: Condition::Above(4.0),
        },
    )
    .noting("Eight layers are peeled; each peel has one more fragment for each texel of the picture, which composes it.")
    .of(&["windows", "thin-layers", "smoke"]),
    Claim::new(
        QUESTION,
        "Dual depth peeling halves the passes of depth peeling.",
        "Bavoil and Myers 2008, Order Independent Transparency with Dual Depth Peeling",
        Test::Halves {
            of: "dual-depth-peeling",
            over: "depth-peeling",
        },
    )
    .of(&["peeling"]),
    Claim::new(
        QUESTION,
        "Weighted blended transparency takes two passes, whatever the layers.",
        "McGuire and Bavoil 2013, Weighted Blended Order-Independent Transparency",
        Test::Value {
            quantity: Quantity::Passes,
            of: "weighted-blended",
            holds: Condition::Between(2.0, 2.0),
        },
    ),
    Claim::new(
        QUESTION,
        "Weighted blended transparency is nearer to the truth than blending in any order.",
        "McGuire and Bavoil 2013, Weighted Blended Order-Independent Transparency",
        Test::Ratio {
            quantity: Quantity::Rmse,
            of: one!("weighted-blended"),
            over: one!("unsorted"),
            holds: Condition::Below(1.0),
        },
    ),
    Claim::new(
        QUESTION,
        "The error of weighted blended transparency grows with alpha: its mean of colours suits thin surfaces.",
        "McGuire and Bavoil 2013, Weighted Blended Order-Independent Transparency, 5: limitations",
        Test::Trend {
            quantity: Quantity::Rmse,
            of: "weighted-blended",
            holds: Condition::Above(1.5),
        },
    )
    .of(&["windows", "smoke"]),
    Claim::new(
        QUESTION,
        "Masks that are random in each layer compose layers better than the fixed masks of alpha to coverage.",
        "Enderton, Sintorn, Shirley and Luebke 2010, Stochastic Transparency",
        Test::Ratio {
            quantity: Quantity::Rmse,
            of: one!("stochastic"),
            over: one!("alpha-to-coverage"),
            holds: Condition::Below(1.0),
        },
    )
    .of(&["thin-layers", "smoke"]),
    Claim::new(
        QUESTION,
        "Alpha to coverage knows one more level than it has samples.",
        "Akeley 1993, RealityEngine Graphics; Vulkan: Multisample Coverage",
        Test::Levels {
            of: "alpha-to-coverage",
            samples: 4,
        },
    )
    .of(&["levels"]),
];
