//! Claims about stencil effects.

use crate::claim::{Claim, Test};

const QUESTION: &str = "stencil-effects";

pub(crate) const CLAIMS: &[Claim] = &[
    Claim::new(
        QUESTION,
        "With the eye inside a shadow volume, depth-fail is right and depth-pass is not.",
        "Everitt and Kilgard 2002, Practical and Robust Stenciled Shadow Volumes",
        Test::Unlike {
            right: "shadow-volume-depth-fail",
            wrong: "shadow-volume-depth-pass",
        },
    )
    .of(&["shadow-volume"]),
    Claim::new(
        QUESTION,
        "A stencil confines a reflection to its mirror; without one it shows outside too.",
        "Kilgard 1999, Improving Shadows and Reflections via the Stencil Buffer",
        Test::Unlike {
            right: "mirror",
            wrong: "mirror-unmasked",
        },
    )
    .of(&["mirror"]),
];
