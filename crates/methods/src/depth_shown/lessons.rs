//! The methods of this question, explained.

use crate::lesson::Lesson;

pub(crate) const LESSONS: &[Lesson] = &[
    Lesson::new(
        "grey",
        "Window depth is written as grey.",
        "With a near plane close to the eye nearly everything is almost 1.",
        "OpenGL 4.6: 13.8",
    ),
    Lesson::new(
        "linearized",
        "The distance is computed from window depth and written as grey.",
        "One over a difference of nearly equal numbers: with a near plane close to the eye the steps of 32 bits show.",
        "OpenGL 4.6: 13.8",
    ),
    Lesson::new(
        "fog",
        "Colour fades to the fog's with the distance that is computed from window depth.",
        "As linearized, as far as the two colours differ.",
        "OpenGL 4.6: 13.8",
    ),
    Lesson::new(
        "dissolve",
        "One picture is blended over another by the blend constant.",
        "Both terms are rounded once, at the store.",
        "Porter and Duff 1984, Compositing Digital Images: dissolve",
    ),
];
