//! The methods of this question, explained.

use crate::lesson::Lesson;

pub(crate) const LESSONS: &[Lesson] = &[
    Lesson::new(
        "none",
        "A texel has the colour at its centre.",
        "An edge becomes a staircase, and what is narrower than a texel comes and goes.",
        "Crow 1977, The Aliasing Problem in Computer-Generated Shaded Images",
    ),
    Lesson::new(
        "msaa-2",
        "Coverage is taken at two samples of a texel, the shader runs once for all of them, and the resolve takes their mean.",
        "Two samples know three levels; an edge along their line shows one step instead of two.",
        "Akeley 1993, RealityEngine Graphics",
    ),
    Lesson::new(
        "msaa-4",
        "Coverage is taken at four samples of a texel, the shader runs once for all of them, and the resolve takes their mean.",
        "Four samples know five levels, fewest along rows and columns where samples share a height.",
        "Akeley 1993, RealityEngine Graphics",
    ),
    Lesson::new(
        "msaa-8",
        "Coverage is taken at eight samples of a texel, the shader runs once for all of them, and the resolve takes their mean.",
        "What falls between the samples is still lost: slivers break up at their tips.",
        "Akeley 1993, RealityEngine Graphics",
    ),
    Lesson::new(
        "msaa-16",
        "Coverage is taken at sixteen samples of a texel, the shader runs once for all of them, and the resolve takes their mean.",
        "Sixteen samples leave an error near a step of 8 bits in long edges, at sixteen times the storage.",
        "Akeley 1993, RealityEngine Graphics",
    ),
    Lesson::new(
        "supersampling-2x2",
        "The picture is drawn at twice the width and height, and the mean of two by two texels is taken.",
        "A regular grid has only two heights in a texel, so that nearly level edges show two steps.",
        "Crow 1977, The Aliasing Problem in Computer-Generated Shaded Images",
    ),
    Lesson::new(
        "supersampling-4x4",
        "The picture is drawn at four times the width and height and halved twice.",
        "Sixteen shaded samples in four heights: dear for the levels that it has along rows and columns.",
        "Crow 1977, The Aliasing Problem in Computer-Generated Shaded Images",
    ),
    Lesson::new(
        "fxaa",
        "A pass over the finished picture finds edges by their luma, walks along each to its ends, and blends with the neighbour across it.",
        "What no sample hit is not in the picture: wires break up, and long nearly level edges end past the walk.",
        "Lottes 2009, FXAA",
    ),
    Lesson::new(
        "coverage-to-alpha",
        "The distance of a texel from the nearest edge becomes alpha, blended over a neighbour that reaches below.",
        "One distance is exact for one long edge; at corners and thin tips two edges share a texel.",
        "Gupta and Sproull 1981, Filtering Edges for Gray-Scale Displays",
    ),
    Lesson::new(
        "coverage-to-alpha-overlap",
        "As coverage to alpha, but neighbours both blend their side of an edge that they share.",
        "Alphas of the two sides are taken for uncorrelated: a quarter of the background shows in the middle of the seam.",
        "Porter and Duff 1984, Compositing Digital Images",
    ),
];
