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
        "A depth test with triangles in arbitrary order.",
        "A fragment is skipped only if a nearer one came first: of n layers, about the nth harmonic number is shaded.",
        "Catmull 1974, A Subdivision Algorithm for Computer Display of Curved Surfaces",
    ),
    Lesson::new(
        "front-to-back",
        "The nearest triangles are drawn first, with a depth test.",
        "Only visible fragments are shaded, provided that there is an order and that the test runs before the shader.",
        "Akenine-Möller and others, Real-Time Rendering, 4th edition, 18.4",
    ),
    Lesson::new(
        "depth-prepass",
        "All depths are drawn first, without colour, then fragments of equal depth.",
        "Only visible fragments are shaded, but all geometry is drawn twice, and both passes must compute the same depths.",
        "Akenine-Möller and others, Real-Time Rendering, 4th edition, 18.4",
    ),
    Lesson::new(
        "forced-early-test",
        "A shader that could discard, with tests forced to run before it.",
        "A discarded fragment would already have stored its depth; here the shader discards nothing.",
        "Vulkan: Early Fragment Test",
    ),
    Lesson::new(
        "discard",
        "The shader could discard, so depth is stored after it.",
        "The test can still run early, but depth cannot be stored before the shader has run.",
        "Vulkan: Early Per-Fragment Tests",
    ),
    Lesson::new(
        "written-depth",
        "The shader writes its fragment's own depth.",
        "The test has to wait for the shader: every fragment is shaded.",
        "Vulkan: Early Per-Fragment Tests",
    ),
];
