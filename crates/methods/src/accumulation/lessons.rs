//! The methods of this question, explained.

use crate::lesson::Lesson;

pub(crate) const LESSONS: &[Lesson] = &[
    Lesson::new(
        "ordered-8-bit",
        "Layers are blended into 8 bits per channel.",
        "Each layer rounds by up to half a code, and the next layer keeps 1 - alpha of that error: half a code over alpha in total.",
        "Porter and Duff 1984, Compositing Digital Images",
    ),
    Lesson::new(
        "ordered-10-bit",
        "Layers are blended into 10 bits per channel.",
        "As with 8 bits, but the error is a quarter as large; alpha has 2 bits.",
        "Vulkan: Blending",
    ),
    Lesson::new(
        "ordered-half",
        "Layers are blended into floats of 16 bits.",
        "Eleven bits of precision near 1, more near 0.",
        "Vulkan: Blending",
    ),
    Lesson::new(
        "ordered-float",
        "Layers are blended into floats of 32 bits.",
        "The error is below any step of a display; the attachment takes four times the memory.",
        "Vulkan: Blending",
    ),
];
