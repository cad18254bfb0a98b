//! Claims about transparency.

use crate::claim::{Claim, FigureCondition, Quantity, Test, one};

const QUESTION: &str = "transparency";

/// Families without opaque surfaces.
const GLASS_ALONE: [&str; 3] = ["thin-layers", "intersecting-panes", "hair"];

pub(crate) const CLAIMS: &[Claim] = &[
    Claim::new(
        QUESTION,
        "Composing front to back with under gives the same picture as back to front with over.",
        "Porter and Duff 1984, Compositing Digital Images, 4.3: over is associative",
        Test::Ratio {
            quantity: Quantity::Rmse,
            of: one!("front-to-back"),
            over: one!("sorted"),
            holds: FigureCondition::Between(0.4, 2.5),
        },
    )
    .of(&["windows", "smoke"]),
    Claim::new(
        QUESTION,
        "Depth peeling needs no order: it is right even if triangles intersect.",
        "Everitt 2001, Interactive Order-Independent Transparency",
        Test::Value {
            quantity: Quantity::Rmse,
            of: "depth-peeling",
            holds: FigureCondition::AtMost(0.01),
        },
    )
    .of(&["windows", "intersecting-panes", "nested-glass"]),
    Claim::new(
        QUESTION,
        "No order of objects is right once they intersect.",
        "Everitt 2001, Interactive Order-Independent Transparency: the sorting problem",
        Test::Value {
            quantity: Quantity::Rmse,
            of: "sorted",
            holds: FigureCondition::Above(0.01),
        },
    )
    .of(&["intersecting-panes"])
    .between(35.0, 90.0),
    Claim::new(
        QUESTION,
        "Depth peeling draws the whole geometry again for each layer that it peels.",
        "Everitt 2001, Interactive Order-Independent Transparency",
        Test::Ratio {
            quantity: Quantity::Fragments,
            of: one!("depth-peeling"),
            over: one!("sorted"),
            holds: FigureCondition::Above(4.0),
        },
    )
    .noting("Eight layers are peeled; each peel adds one fragment per texel of the picture to compose it.")
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
        "Weighted blended transparency takes two passes, however many layers there are.",
        "McGuire and Bavoil 2013, Weighted Blended Order-Independent Transparency",
        Test::Value {
            quantity: Quantity::Passes,
            of: "weighted-blended",
            holds: FigureCondition::Between(2.0, 2.0),
        },
    )
    .noting("Scenes with opaque surfaces take another pass for these.")
    .of(&GLASS_ALONE),
    Claim::new(
        QUESTION,
        "Weighted blended transparency is nearer to the truth than unsorted blending.",
        "McGuire and Bavoil 2013, Weighted Blended Order-Independent Transparency",
        Test::Ratio {
            quantity: Quantity::Rmse,
            of: one!("weighted-blended"),
            over: one!("unsorted"),
            holds: FigureCondition::Below(1.0),
        },
    ),
    Claim::new(
        QUESTION,
        "The error of weighted blended transparency grows with alpha: its mean of colours suits thin surfaces.",
        "McGuire and Bavoil 2013, Weighted Blended Order-Independent Transparency, 5: limitations",
        Test::Trend {
            quantity: Quantity::Rmse,
            of: "weighted-blended",
            holds: FigureCondition::Above(1.5),
        },
    )
    .of(&["windows", "smoke"]),
    Claim::new(
        QUESTION,
        "Moment-based transparency draws the geometry twice and takes three passes, however many layers there are.",
        "Münstermann, Krumpen, Klein and Peters 2018, Moment-Based Order-Independent Transparency",
        Test::Value {
            quantity: Quantity::Passes,
            of: "moment-based",
            holds: FigureCondition::Between(3.0, 3.0),
        },
    )
    .noting("Scenes with opaque surfaces take another pass for these.")
    .of(&GLASS_ALONE),
    Claim::new(
        QUESTION,
        "Weights from moments of the scene's absorbance have less error than weights from depth alone.",
        "Münstermann, Krumpen, Klein and Peters 2018, Moment-Based Order-Independent Transparency",
        Test::Ratio {
            quantity: Quantity::Rmse,
            of: one!("moment-based"),
            over: one!("weighted-blended"),
            holds: FigureCondition::Below(1.0),
        },
    ),
    Claim::new(
        QUESTION,
        "Four moments distinguish few depths: the error of moment-based transparency grows with the layers.",
        "Münstermann, Krumpen, Klein and Peters 2018, Moment-Based Order-Independent Transparency",
        Test::Trend {
            quantity: Quantity::Rmse,
            of: "moment-based",
            holds: FigureCondition::Above(1.5),
        },
    )
    .of(&["thin-layers"]),
    Claim::new(
        QUESTION,
        "Linked lists store every fragment, and so are right in any order.",
        "Yang, Hensley, Grün and Thibieroz 2010, Real-Time Concurrent Linked List Construction on the GPU",
        Test::Value {
            quantity: Quantity::Rmse,
            of: "linked-lists",
            holds: FigureCondition::AtMost(0.004),
        },
    )
    .noting("In these scenes no picture has more fragments than the pool has nodes, which is eight per texel.")
    .of(&["windows", "intersecting-panes", "nested-glass", "smoke"]),
    Claim::new(
        QUESTION,
        "Linked lists draw the geometry once; depth peeling draws it once per layer.",
        "Yang, Hensley, Grün and Thibieroz 2010, Real-Time Concurrent Linked List Construction on the GPU",
        Test::Ratio {
            quantity: Quantity::Fragments,
            of: one!("depth-peeling"),
            over: one!("linked-lists"),
            holds: FigureCondition::Above(2.0),
        },
    )
    .of(&["windows", "thin-layers", "smoke"]),
    Claim::new(
        QUESTION,
        "A pool that is nearly large enough drops the fragments drawn last, and peeling drops the farthest layers: lists err more.",
        "Yang, Hensley, Grün and Thibieroz 2010, Real-Time Concurrent Linked List Construction on the GPU: storage overflow",
        Test::Ratio {
            quantity: Quantity::Rmse,
            of: one!("linked-lists"),
            over: one!("depth-peeling"),
            holds: FigureCondition::Above(1.0),
        },
    )
    .of(&["peeling"])
    .between(8.0, 8.0),
    Claim::new(
        QUESTION,
        "An array of the k nearest fragments is right in any order if no texel has more.",
        "Bavoil and others 2007, Multi-Fragment Effects on the GPU Using the k-Buffer",
        Test::Value {
            quantity: Quantity::Rmse,
            of: "nearest-layers",
            holds: FigureCondition::AtMost(0.004),
        },
    )
    .noting("In these scenes no texel has more than eight fragments.")
    .of(&["windows", "intersecting-panes", "nested-glass"]),
    Claim::new(
        QUESTION,
        "The mean of the layers behind the k nearest has less error than no layers there.",
        "Maule, Comba, Torchelsen and Bastos 2013, Hybrid Transparency",
        Test::Ratio {
            quantity: Quantity::Rmse,
            of: one!("nearest-layers"),
            over: one!("depth-peeling"),
            holds: FigureCondition::Below(1.0),
        },
    )
    .of(&["peeling"])
    .between(1.0, 8.0),
    Claim::new(
        QUESTION,
        "A few layers in order in front of the mean leave less error than the mean of all.",
        "Maule, Comba, Torchelsen and Bastos 2013, Hybrid Transparency",
        Test::Ratio {
            quantity: Quantity::Rmse,
            of: one!("nearest-layers"),
            over: one!("weighted-blended"),
            holds: FigureCondition::Below(1.0),
        },
    ),
    Claim::new(
        QUESTION,
        "The nearest layers take three passes and draw the geometry twice, however many layers there are.",
        "Maule, Comba, Torchelsen and Bastos 2013, Hybrid Transparency",
        Test::Value {
            quantity: Quantity::Passes,
            of: "nearest-layers",
            holds: FigureCondition::Between(3.0, 3.0),
        },
    ),
    Claim::new(
        QUESTION,
        "Random masks for each layer compose layers better than the fixed masks of alpha to coverage.",
        "Enderton, Sintorn, Shirley and Luebke 2010, Stochastic Transparency",
        Test::Ratio {
            quantity: Quantity::Rmse,
            of: one!("stochastic"),
            over: one!("alpha-to-coverage"),
            holds: FigureCondition::Below(1.0),
        },
    )
    .of(&["thin-layers", "smoke"]),
    Claim::new(
        QUESTION,
        "Hashed alpha testing is stochastic transparency with one sample: twice the noise of four samples.",
        "Wyman and McGuire 2017, Hashed Alpha Testing",
        Test::Ratio {
            quantity: Quantity::Rmse,
            of: one!("hashed"),
            over: one!("stochastic"),
            holds: FigureCondition::Between(1.6, 2.5),
        },
    )
    .of(&["windows", "thin-layers", "smoke", "intersecting-panes"]),
    Claim::new(
        QUESTION,
        "Alpha to coverage has a level for each sample, and one for none.",
        "Akeley 1993, RealityEngine Graphics; Vulkan: Multisample Coverage",
        Test::Levels {
            of: "alpha-to-coverage",
            samples: 4,
        },
    )
    .of(&["levels"]),
];
