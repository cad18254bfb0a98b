//! Claims about texture sampling.

use crate::claim::{Claim, Condition, Quantity, Test, one};

const QUESTION: &str = "texture-sampling";

pub(crate) const CLAIMS: &[Claim] = &[
    Claim::new(
        QUESTION,
        "Coordinates that are linear over the picture are wrong on a ground that leads away.",
        "Heckbert and Moreton 1991, Interpolation for Polygon Texture Mapping and Shading",
        Test::Ratio {
            quantity: Quantity::Rmse,
            of: one!("affine"),
            over: one!("nearest"),
            holds: Condition::Above(1.0),
        },
    ),
    Claim::new(
        QUESTION,
        "Four samples a texel leave less of the error of one.",
        "Heckbert 1989, Fundamentals of Texture Mapping and Image Warping",
        Test::Ratio {
            quantity: Quantity::Rmse,
            of: one!("supersampling-2x2"),
            over: one!("nearest"),
            holds: Condition::Below(1.0),
        },
    ),
    Claim::new(
        QUESTION,
        "Sixteen samples a texel leave less of the error of four.",
        "Heckbert 1989, Fundamentals of Texture Mapping and Image Warping",
        Test::Ratio {
            quantity: Quantity::Rmse,
            of: one!("supersampling-4x4"),
            over: one!("supersampling-2x2"),
            holds: Condition::Below(1.0),
        },
    ),
];
