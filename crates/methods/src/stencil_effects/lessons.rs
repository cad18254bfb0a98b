//! The methods of this question, explained.

use crate::lesson::Lesson;

pub(crate) const LESSONS: &[Lesson] = &[
    Lesson::new(
        "outline-merged",
        "Objects store one stencil value, and are drawn again larger where it is not.",
        "Objects that overlap have one outline around both.",
        "McReynolds and Blythe 2005, Advanced Graphics Programming Using OpenGL",
    ),
    Lesson::new(
        "outline-separate",
        "Each object stores a value of its own, and is drawn again larger where that is not.",
        "Values are few: 8 bits tell 255 objects apart.",
        "McReynolds and Blythe 2005, Advanced Graphics Programming Using OpenGL",
    ),
    Lesson::new(
        "mirror",
        "The mirror stores a stencil value, and the scene is drawn upside down where it is.",
        "One mirror in another needs a value and a pass for each.",
        "Kilgard 1999, Improving Shadows and Reflections via the Stencil Buffer",
    ),
    Lesson::new(
        "mirror-unmasked",
        "The scene is drawn upside down below the mirror, without a stencil.",
        "The reflection shows beside the mirror as soon as an object stands at its side.",
        "Kilgard 1999, Improving Shadows and Reflections via the Stencil Buffer",
    ),
    Lesson::new(
        "shadow-volume-depth-pass",
        "Front faces of shadow volumes count up and back faces down, where they pass the depth test.",
        "With the eye or the near plane in a volume a front face is missing, and light and shadow change places.",
        "Heidmann 1991, Real Shadows Real Time",
    ),
    Lesson::new(
        "shadow-volume-depth-fail",
        "Back faces of shadow volumes count up and front faces down, where they fail the depth test.",
        "The eye may be anywhere, but volumes need caps and must not be cut by the far plane.",
        "Everitt and Kilgard 2002, Practical and Robust Stenciled Shadow Volumes",
    ),
];
