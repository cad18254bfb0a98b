//! The methods of this question, explained.

use crate::lesson::Lesson;

pub(crate) const LESSONS: &[Lesson] = &[
    Lesson::new(
        "nearest",
        "A fragment has the colour of the texel at its centre.",
        "Far away, one texel of the picture covers many texels of the texture, and only one is picked: the ground flickers.",
        "Heckbert 1989, Fundamentals of Texture Mapping and Image Warping",
    ),
    Lesson::new(
        "linear",
        "A fragment has the weighted mean of the four texels around its centre.",
        "Four texels are too few far away, and close to the eye edges become as wide as a texel of the texture.",
        "Heckbert 1989, Fundamentals of Texture Mapping and Image Warping",
    ),
    Lesson::new(
        "affine",
        "Texture coordinates are interpolated linearly in the picture, without a division by w.",
        "The two triangles distort the ground, each in its own way.",
        "Heckbert and Moreton 1991, Interpolation for Polygon Texture Mapping and Shading",
    ),
    Lesson::new(
        "supersampling-2x2",
        "The mean of four fragments, each with its nearest texel.",
        "The texture is sampled twice as finely each way, which moves the flicker farther away.",
        "Fuchs and others 1985, Fast Spheres, Shadows, Textures, Transparencies, and Image Enhancements",
    ),
    Lesson::new(
        "supersampling-4x4",
        "The mean of sixteen fragments, each with its nearest texel.",
        "As with four fragments; sixteen times the fragments sample the texture four times as finely.",
        "Fuchs and others 1985, Fast Spheres, Shadows, Textures, Transparencies, and Image Enhancements",
    ),
];
