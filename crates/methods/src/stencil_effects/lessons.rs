//! The methods of this question, explained.

use crate::lesson::Lesson;

pub(crate) const LESSONS: &[Lesson] = &[
    Lesson::new(
        "outline-merged",
        "All objects store one stencil value, and are drawn again, larger, outside the area that has it.",
        "Objects that overlap share one outline.",
        "McReynolds and Blythe 2005, Advanced Graphics Programming Using OpenGL",
    ),
    Lesson::new(
        "outline-separate",
        "Each object stores its own value, and is drawn again, larger, outside the area that has it.",
        "8 bits distinguish only 255 objects.",
        "McReynolds and Blythe 2005, Advanced Graphics Programming Using OpenGL",
    ),
    Lesson::new(
        "mirror",
        "The mirror stores a stencil value, and the scene is drawn upside down inside it.",
        "One mirror in another needs a value and a pass for each.",
        "Kilgard 1999, Improving Shadows and Reflections via the Stencil Buffer",
    ),
    Lesson::new(
        "mirror-unmasked",
        "The scene is drawn upside down below the mirror, without a stencil.",
        "The reflection of an object that is not above the mirror shows outside it.",
        "Kilgard 1999, Improving Shadows and Reflections via the Stencil Buffer",
    ),
    Lesson::new(
        "shadow-volume-depth-pass",
        "Front faces of shadow volumes count up and back faces down, where they pass the depth test.",
        "If the eye or the near plane is inside a volume, a front face is missing, and light and shadow are swapped.",
        "Heidmann 1991, Real Shadows Real Time",
    ),
    Lesson::new(
        "shadow-volume-depth-fail",
        "Back faces of shadow volumes count up and front faces down, where they fail the depth test.",
        "The eye can be anywhere, but volumes need caps and must not be cut by the far plane.",
        "Everitt and Kilgard 2002, Practical and Robust Stenciled Shadow Volumes",
    ),
];
