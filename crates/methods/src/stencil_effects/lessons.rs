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
        "A mirror in a mirror needs its own value and pass.",
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
        "Fragments of shadow volumes that pass the depth test count: front faces up, back faces down.",
        "If the eye or the near plane is inside a volume, a front face is missing, and light and shadow are swapped.",
        "Heidmann 1991, Real Shadows Real Time",
    ),
    Lesson::new(
        "shadow-volume-depth-fail",
        "Fragments of shadow volumes that fail the depth test count: back faces up, front faces down.",
        "The eye can be anywhere, but volumes need caps and must not be cut by the far plane.",
        "Everitt and Kilgard 2002, Practical and Robust Stenciled Shadow Volumes",
    ),
];
