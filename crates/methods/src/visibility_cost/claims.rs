//! Claims about the cost of visibility.

use crate::claim::{Claim, FigureCondition, Quantity, Test, one};

const QUESTION: &str = "visibility-cost";

/// A comparison that holds on adapters whose fragment counts a depth test lowers.
const COUNTED: [&str; 2] = ["unsorted", "no-test"];

pub(crate) const CLAIMS: &[Claim] = &[
    Claim::new(
        QUESTION,
        "A depth test shades fewer fragments front to back than in arbitrary order.",
        "Akenine-Möller and others, Real-Time Rendering, 4th edition, 18.4: optimization",
        Test::Ratio {
            quantity: Quantity::Fragments,
            of: one!("front-to-back"),
            over: one!("unsorted"),
            holds: FigureCondition::Below(0.9),
        },
    )
    .between(2.0, f64::INFINITY)
    .where_fewer(COUNTED),
    Claim::new(
        QUESTION,
        "Drawing front to back shades as few fragments as drawing after a depth prepass.",
        "Akenine-Möller and others, Real-Time Rendering, 4th edition, 18.4: optimization",
        Test::Ratio {
            quantity: Quantity::Fragments,
            of: one!("front-to-back"),
            over: &[("depth-prepass", 1.0), ("unsorted", -1.0)],
            holds: FigureCondition::Between(0.8, 1.2),
        },
    )
    .noting("A prepass is drawn in the order of unsorted with the same test, and so has that method's fragments; the rest were shaded.")
    .between(2.0, f64::INFINITY)
    .where_fewer(COUNTED),
    Claim::new(
        QUESTION,
        "A depth prepass takes less time than arbitrary order if shading is expensive.",
        "Akenine-Möller and others, Real-Time Rendering, 4th edition, 18.4: optimization",
        Test::Ratio {
            quantity: Quantity::Time,
            of: one!("depth-prepass"),
            over: one!("unsorted"),
            holds: FigureCondition::Below(1.0),
        },
    )
    .between(8.0, f64::INFINITY),
    Claim::new(
        QUESTION,
        "Early tests cannot skip a shader that writes depth.",
        "Greene, Kass and Miller 1993, Hierarchical Z-Buffer Visibility; Vulkan: Early Fragment Test",
        Test::Ratio {
            quantity: Quantity::Fragments,
            of: one!("written-depth"),
            over: one!("front-to-back"),
            holds: FigureCondition::Above(1.0),
        },
    )
    .between(2.0, f64::INFINITY)
    .where_fewer(COUNTED),
    Claim::new(
        QUESTION,
        "Early tests never change the picture.",
        "Vulkan: Early Fragment Test; OpenGL 4.6: 14.9",
        Test::Same {
            methods: ["forced-early-test", "discard"],
        },
    ),
];
