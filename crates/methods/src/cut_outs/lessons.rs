//! The methods of this question, explained.

use crate::lesson::Lesson;

pub(crate) const LESSONS: &[Lesson] = &[
    Lesson::new(
        "discard",
        "Fragments whose filtered alpha is below a cutoff are discarded.",
        "A texel is kept or lost as a whole: edges alias, and parts thinner than a texel vanish.",
        "Akeley 1993, RealityEngine Graphics",
    ),
    Lesson::new(
        "blend-sorted",
        "Cards are blended by their filtered alpha, the farthest first.",
        "Cards that cross each other have no right order, and a repeating filter brings in the opposite border.",
        "Porter and Duff 1984, Compositing Digital Images",
    ),
    Lesson::new(
        "hashed",
        "Fragments whose filtered alpha is below a hash of their place on the card are discarded, so that thin parts keep their share of texels.",
        "Wherever alpha is between 0 and 1 the picture is noise: near the viewer, edges are rougher than with a fixed cutoff.",
        "Wyman and McGuire 2017, Hashed Alpha Testing",
    ),
    Lesson::new(
        "alpha-to-coverage",
        "The filtered alpha becomes a mask of the samples of a texel.",
        "No order is needed, but the same mask in each card hides what should be visible through two of them.",
        "Akeley 1993, RealityEngine Graphics",
    ),
    Lesson::new(
        "alpha-to-coverage-sharpened",
        "As alpha to coverage, with alpha divided by its change from texel to texel, so that it goes from 0 to 1 over one texel around the cutoff.",
        "The edge is smooth at any magnification, but the softness of the texture is lost, and parts thinner than two texels change their width.",
        "Golus 2017, Anti-Aliased Alpha Test: The Esoteric Alpha to Coverage",
    ),
];
