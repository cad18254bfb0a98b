//! Claims about stencil effects.

use crate::claim::{Claim, Test};

const QUESTION: &str = "stencil-effects";

pub(crate) const CLAIMS: &[Claim] = &[
    Claim::new(
        QUESTION,
        "Shadow volumes by depth-fail are right with the eye inside, where depth-pass is not.",
        "Everitt and Kilgard 2002, Practical and Robust Stenciled Shadow Volumes",
        Test::Unlike {
            right: "shadow-volume-depth-fail",
            wrong: "shadow-volume-depth-pass",
        },
    )
    .of(&["shadow-volume"]),
    Claim::new(
        QUESTION,
        "A stencil keeps a reflection inside its mirror, where it would show beside it.",
        "Kilgard 1999, Improving Shadows and Reflections via the Stencil Buffer",
        Test::Unlike {
            right: "mirror",
            wrong: "mirror-unmasked",
        },
    )
    .of(&["mirror"]),
];
