//! Claims about anti-aliasing.

use crate::claim::{Claim, FigureCondition, Quantity, Test, one};

const QUESTION: &str = "anti-aliasing";

/// The families in which nothing moves.
const STILL: [&str; 4] = ["checker-fan", "half-planes", "thin-wedge", "wire-torus"];

pub(crate) const CLAIMS: &[Claim] = &[
    Claim::new(
        QUESTION,
        "More samples leave less error.",
        "Crow 1977, The Aliasing Problem in Computer-Generated Shaded Images",
        Test::Ratio {
            quantity: Quantity::Rmse,
            of: one!("msaa-8"),
            over: one!("msaa-2"),
            holds: FigureCondition::Below(1.0),
        },
    ),
    Claim::new(
        QUESTION,
        "Using the area below an edge as alpha beats four samples.",
        "Crow 1977, The Aliasing Problem in Computer-Generated Shaded Images: convolution with a box",
        Test::Ratio {
            quantity: Quantity::Rmse,
            of: one!("coverage-to-alpha"),
            over: one!("msaa-4"),
            holds: FigureCondition::Below(1.0),
        },
    )
    .of(&["half-planes"]),
    Claim::new(
        QUESTION,
        "If neighbours share an edge, alpha from both sides lets the background through.",
        "Porter and Duff 1984, Compositing Digital Images: alphas are taken to be uncorrelated",
        Test::Ratio {
            quantity: Quantity::Rmse,
            of: one!("coverage-to-alpha-overlap"),
            over: one!("coverage-to-alpha"),
            holds: FigureCondition::Above(1.5),
        },
    )
    .of(&["checker-fan", "half-planes"]),
    Claim::new(
        QUESTION,
        "Supersampling by 2×2 shades four times as many fragments.",
        "Akenine-Möller and others, Real-Time Rendering, 4th edition, 5.4: screen-based antialiasing",
        Test::Ratio {
            quantity: Quantity::Fragments,
            of: one!("supersampling-2x2"),
            over: one!("none"),
            holds: FigureCondition::Between(3.5, 6.0),
        },
    )
    .of(&["checker-fan", "half-planes", "thin-wedge"])
    .noting("The pass that takes the mean adds one fragment per texel of the picture; in these scenes the ground fills the picture."),
    Claim::new(
        QUESTION,
        "Multisampling shades fewer fragments than supersampling with as many samples.",
        "Akeley 1993, RealityEngine Graphics",
        Test::Ratio {
            quantity: Quantity::Fragments,
            of: one!("msaa-4"),
            over: one!("supersampling-2x2"),
            holds: FigureCondition::Below(1.0),
        },
    ),
    Claim::new(
        QUESTION,
        "Multisampling takes less time than supersampling with as many samples.",
        "Akenine-Möller and others, Real-Time Rendering, 4th edition, 5.4: screen-based antialiasing",
        Test::Ratio {
            quantity: Quantity::Time,
            of: one!("msaa-4"),
            over: one!("supersampling-2x2"),
            holds: FigureCondition::Below(1.0),
        },
    ),
    Claim::new(
        QUESTION,
        "The more jittered frames are accumulated, the less error is left, if nothing moves.",
        "Haeberli and Akeley 1990, The Accumulation Buffer",
        Test::Ratio {
            quantity: Quantity::Rmse,
            of: one!("jittered-16"),
            over: one!("jittered-4"),
            holds: FigureCondition::Below(1.0),
        },
    )
    .of(&STILL),
    Claim::new(
        QUESTION,
        "Along nearly level edges, sixteen samples in sixteen rows leave less error than sixteen in a grid of four rows.",
        "Akenine-Möller and others, Real-Time Rendering, 4th edition, 5.4: N-rooks sampling",
        Test::Ratio {
            quantity: Quantity::Rmse,
            of: one!("jittered-16"),
            over: one!("supersampling-4x4"),
            holds: FigureCondition::Below(1.0),
        },
    )
    .of(&["thin-wedge"]),
    Claim::new(
        QUESTION,
        "The mean of the frames of a moving scene is a trail: its error grows with the speed.",
        "Haeberli and Akeley 1990, The Accumulation Buffer: motion blur",
        Test::Trend {
            quantity: Quantity::Rmse,
            of: "jittered-8",
            holds: FigureCondition::Above(1.5),
        },
    )
    .of(&["moving"]),
    Claim::new(
        QUESTION,
        "In a moving scene, one frame without anti-aliasing errs less than the mean of eight.",
        "Haeberli and Akeley 1990, The Accumulation Buffer: motion blur",
        Test::Ratio {
            quantity: Quantity::Rmse,
            of: one!("jittered-8"),
            over: one!("none"),
            holds: FigureCondition::Above(1.0),
        },
    )
    .of(&["moving"])
    .between(0.5, 4.0),
    Claim::new(
        QUESTION,
        "A filter over the finished picture reduces the error of edges.",
        "Lottes 2009, FXAA",
        Test::Ratio {
            quantity: Quantity::Rmse,
            of: one!("fxaa"),
            over: one!("none"),
            holds: FigureCondition::Below(1.0),
        },
    )
    .of(&["checker-fan", "half-planes", "thin-wedge"]),
    Claim::new(
        QUESTION,
        "A filter over the finished picture cannot restore what no sample hit: four samples err less on thin shapes.",
        "Jimenez and others 2011, Filtering Approaches for Real-Time Anti-Aliasing",
        Test::Ratio {
            quantity: Quantity::Rmse,
            of: one!("fxaa"),
            over: one!("msaa-4"),
            holds: FigureCondition::Above(1.0),
        },
    )
    .of(&["thin-wedge", "wire-torus"]),
];
