//! The methods of this question, explained.

use crate::lesson::Lesson;

pub(crate) const LESSONS: &[Lesson] = &[
    Lesson::new(
        "depth16",
        "Window depth is stored in 16 bits.",
        "Depth follows one over the distance, which spends nearly all codes close to the eye: planes farther away share a code and fight.",
        "Vulkan: Depth Test",
    ),
    Lesson::new(
        "depth24",
        "Window depth is stored in 24 bits.",
        "As with 16 bits, but 256 times farther away.",
        "Vulkan: Depth Test",
    ),
    Lesson::new(
        "depth32float",
        "Window depth is stored as a float of 32 bits, 1 at the far plane.",
        "Floats are dense around 0, where one over the distance is dense already, and sparse around 1, where it is sparse too.",
        "Reed 2015, Depth Precision Visualized",
    ),
    Lesson::new(
        "reversed-depth",
        "Window depth is a float that is 0 at the far plane.",
        "The two hyperbolas cancel, so that steps are about a constant fraction of the distance; the rounding of clip-space z and w remains.",
        "Reed 2015, Depth Precision Visualized",
    ),
    Lesson::new(
        "infinite-depth",
        "Window depth is stored in 24 bits, 1 at infinity.",
        "Little precision is lost, because few codes are past a far plane.",
        "Everitt and Kilgard 2002, Practical and Robust Stenciled Shadow Volumes",
    ),
    Lesson::new(
        "infinite-reversed-depth",
        "Window depth is a float that is 0 at infinity.",
        "Clip-space z is the near distance everywhere, so that only the rounding of w remains.",
        "Upchurch and Desbrun 2012, Tightening the Precision of Perspective Rendering",
    ),
    Lesson::new(
        "linear-depth",
        "The shader writes depth in proportion to the distance.",
        "Steps are the same everywhere, so that gaps in proportion to the distance are lost close to the eye first. Early tests are lost too.",
        "Upchurch and Desbrun 2012, Tightening the Precision of Perspective Rendering",
    ),
    Lesson::new(
        "logarithmic-depth",
        "The shader writes the logarithm of the distance.",
        "Steps are a constant fraction of the distance, but a shader that writes depth prevents early tests.",
        "Kemen 2009, Logarithmic Depth Buffer",
    ),
    Lesson::new(
        "larger-near",
        "Window depth is stored in 24 bits, with a near plane farther away.",
        "Steps shrink by the same factor, and everything nearer than the plane is cut off.",
        "Upchurch and Desbrun 2012, Tightening the Precision of Perspective Rendering",
    ),
    Lesson::new(
        "polygon-offset",
        "A bias pulls a decal towards the eye, by its slope and by some steps.",
        "A bias that is large enough for the decal also pulls it through surfaces that are only a little in front of it.",
        "Vulkan: Depth Bias",
    ),
];
