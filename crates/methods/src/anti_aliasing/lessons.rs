//! The methods of this question, explained.

use crate::lesson::Lesson;

pub(crate) const LESSONS: &[Lesson] = &[
    Lesson::new(
        "none",
        "A texel has the colour at its centre.",
        "An edge becomes a staircase, and shapes narrower than a texel have gaps.",
        "Crow 1977, The Aliasing Problem in Computer-Generated Shaded Images",
    ),
    Lesson::new(
        "msaa-2",
        "A texel has two coverage samples; the shader runs once for all of them, and the resolve takes their mean.",
        "Two samples give three levels; an edge along their line shows one step instead of two.",
        "Akeley 1993, RealityEngine Graphics",
    ),
    Lesson::new(
        "msaa-4",
        "A texel has four coverage samples; the shader runs once for all of them, and the resolve takes their mean.",
        "Four samples give five levels, and fewer along rows or columns in which samples share a height.",
        "Akeley 1993, RealityEngine Graphics",
    ),
    Lesson::new(
        "msaa-8",
        "A texel has eight coverage samples; the shader runs once for all of them, and the resolve takes their mean.",
        "Shapes that fall between the samples are still lost: slivers break up at their tips.",
        "Akeley 1993, RealityEngine Graphics",
    ),
    Lesson::new(
        "msaa-16",
        "A texel has sixteen coverage samples; the shader runs once for all of them, and the resolve takes their mean.",
        "On long edges sixteen samples leave an error near a step of 8 bits, at sixteen times the memory.",
        "Akeley 1993, RealityEngine Graphics",
    ),
    Lesson::new(
        "supersampling-2x2",
        "The picture is drawn at twice the width and height, then averaged over two by two texels.",
        "A regular grid has only two heights in a texel, so that nearly level edges show two steps.",
        "Crow 1977, The Aliasing Problem in Computer-Generated Shaded Images",
    ),
    Lesson::new(
        "supersampling-4x4",
        "The picture is drawn at four times the width and height and halved twice.",
        "Sixteen samples are shaded but have only four heights: expensive for the levels that they give along rows and columns.",
        "Crow 1977, The Aliasing Problem in Computer-Generated Shaded Images",
    ),
    Lesson::new(
        "jittered-4",
        "Four frames, each moved by another part of a texel, are summed up and divided by four, so that a texel has four samples in four rows and four columns.",
        "The whole geometry is drawn four times, and if the frames are those of a moving scene, the mean shows four copies of it.",
        "Haeberli and Akeley 1990, The Accumulation Buffer",
    ),
    Lesson::new(
        "jittered-8",
        "Eight frames, each moved by another part of a texel, are summed up and divided by eight.",
        "The copies of a moving scene reach back twice as far as with four frames, so that what helps a still picture harms a moving one.",
        "Haeberli and Akeley 1990, The Accumulation Buffer",
    ),
    Lesson::new(
        "jittered-16",
        "Sixteen frames, each moved by another part of a texel, are summed up and divided by sixteen: as many heights as samples, unlike a grid of 4 by 4.",
        "It takes 33 passes, the sum needs more than 8 bits, anything that moves leaves a trail of sixteen frames, and on slanted edges a grid of 4 by 4 has less error.",
        "Haeberli and Akeley 1990, The Accumulation Buffer",
    ),
    Lesson::new(
        "fxaa",
        "A pass over the finished picture finds edges by their luma, walks along each to its ends, and blends with the neighbour across it.",
        "The picture lacks what no sample hit: wires break up, and long, nearly level edges extend past the walk.",
        "Lottes 2009, FXAA",
    ),
    Lesson::new(
        "coverage-to-alpha",
        "The distance of a texel from the nearest edge becomes alpha, blended over a neighbour that extends below the edge.",
        "One distance is exact for one long edge; at corners and thin tips two edges share a texel.",
        "Gupta and Sproull 1981, Filtering Edges for Gray-Scale Displays",
    ),
    Lesson::new(
        "coverage-to-alpha-overlap",
        "As coverage to alpha, but both neighbours blend their side of a shared edge.",
        "The alphas of the two sides are treated as uncorrelated: a quarter of the background shows in the middle of the seam.",
        "Porter and Duff 1984, Compositing Digital Images",
    ),
];
