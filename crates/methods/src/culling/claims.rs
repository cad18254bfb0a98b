//! Claims about culling.

use crate::claim::{Claim, FigureCondition, Quantity, Test, one};

const QUESTION: &str = "culling";

pub(crate) const CLAIMS: &[Claim] = &[
    Claim::new(
        QUESTION,
        "Culling the back faces of a closed mesh halves its fragments.",
        "Foley and others 1990, Computer Graphics: Principles and Practice, 15.4: back-face culling",
        Test::Ratio {
            quantity: Quantity::Fragments,
            of: one!("back"),
            over: one!("none"),
            holds: FigureCondition::Between(0.4, 0.6),
        },
    )
    .of(&["closed-mesh"]),
    Claim::new(
        QUESTION,
        "Culling the back faces of a closed mesh does not change its picture.",
        "Foley and others 1990, Computer Graphics: Principles and Practice, 15.4: back-face culling",
        Test::Same {
            methods: ["back", "none"],
        },
    )
    .of(&["closed-mesh"]),
    Claim::new(
        QUESTION,
        "Leaving out objects outside the view saves most draws of a large scene.",
        "Clark 1976, Hierarchical Geometric Models for Visible Surface Algorithms",
        Test::Ratio {
            quantity: Quantity::Draws,
            of: one!("frustum"),
            over: one!("none"),
            holds: FigureCondition::Below(0.5),
        },
    )
    .of(&["field"]),
    Claim::new(
        QUESTION,
        "Back faces first, then front faces, is the right order for convex solids.",
        "McReynolds and Blythe 2005, Advanced Graphics Programming Using OpenGL, 11.9: transparency",
        Test::Unlike {
            right: "front-then-back",
            wrong: "none",
        },
    )
    .of(&["see-through"]),
];
