//! The methods of this question, explained.

use crate::lesson::Lesson;

pub(crate) const LESSONS: &[Lesson] = &[
    Lesson::new(
        "no-test",
        "Everything is drawn back to front without a depth test.",
        "Every hidden fragment is shaded.",
        "Newell, Newell and Sancha 1972, A Solution to the Hidden Surface Problem",
    ),
    Lesson::new(
        "unsorted",
        "A depth test with triangles in no order.",
        "A fragment is spared only where something nearer came first, of n layers about the nth harmonic number is shaded.",
        "Catmull 1974, A Subdivision Algorithm for Computer Display of Curved Surfaces",
    ),
    Lesson::new(
        "front-to-back",
        "A depth test with the nearest triangles first.",
        "Only what is seen is shaded, as long as there is an order and the test comes before the shader.",
        "Akenine-Möller and others, Real-Time Rendering, 4th edition, 18.4",
    ),
    Lesson::new(
        "depth-prepass",
        "All depths first, without colour; then fragments of equal depth.",
        "Only what is seen is shaded, but all geometry is drawn twice, and both passes must compute the same depths.",
        "Akenine-Möller and others, Real-Time Rendering, 4th edition, 18.4",
    ),
    Lesson::new(
        "forced-early-test",
        "A shader that could discard, with tests forced to come before it.",
        "A discarded fragment would have stored its depth already; here none is discarded.",
        "Vulkan: Early Fragment Test",
    ),
    Lesson::new(
        "discard",
        "A shader that could discard, so that depth is stored after it.",
        "The test may still come early, but depth cannot be stored before the shader has run.",
        "Vulkan: Early Per-Fragment Tests",
    ),
    Lesson::new(
        "written-depth",
        "A shader that writes the depth that its fragment has anyway.",
        "The test has to wait for the shader: every fragment is shaded.",
        "Vulkan: Early Per-Fragment Tests",
    ),
];
