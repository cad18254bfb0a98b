//! Claims about texture sampling.

use crate::claim::{Claim, FigureCondition, Quantity, Test, one};

const QUESTION: &str = "texture-sampling";

pub(crate) const CLAIMS: &[Claim] = &[
    Claim::new(
        QUESTION,
        "Coordinates that are linear in the picture are wrong on a ground that leads away.",
        "Heckbert and Moreton 1991, Interpolation for Polygon Texture Mapping and Shading",
        Test::Ratio {
            quantity: Quantity::Rmse,
            of: one!("affine"),
            over: one!("nearest"),
            holds: FigureCondition::Above(1.0),
        },
    ),
    Claim::new(
        QUESTION,
        "Four samples per texel leave less error than one.",
        "Heckbert 1989, Fundamentals of Texture Mapping and Image Warping",
        Test::Ratio {
            quantity: Quantity::Rmse,
            of: one!("supersampling-2x2"),
            over: one!("nearest"),
            holds: FigureCondition::Below(1.0),
        },
    ),
    Claim::new(
        QUESTION,
        "Sixteen samples per texel leave less error than four.",
        "Heckbert 1989, Fundamentals of Texture Mapping and Image Warping",
        Test::Ratio {
            quantity: Quantity::Rmse,
            of: one!("supersampling-4x4"),
            over: one!("supersampling-2x2"),
            holds: FigureCondition::Below(1.0),
        },
    ),
];
