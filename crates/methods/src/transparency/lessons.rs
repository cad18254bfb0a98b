//! The methods of this question, explained.

use crate::lesson::Lesson;

pub(crate) const LESSONS: &[Lesson] = &[
    Lesson::new(
        "unsorted",
        "Surfaces are blended in the order of the mesh, and each stores its depth.",
        "A surface behind one that came first fails the depth test and is missing; one in front of it is composed in the wrong order.",
        "Porter and Duff 1984, Compositing Digital Images",
    ),
    Lesson::new(
        "sorted",
        "Objects are blended one over the other, the farthest first by the mean depth of their corners.",
        "One depth per object has no right order where objects enclose or pass through each other.",
        "Porter and Duff 1984, Compositing Digital Images",
    ),
    Lesson::new(
        "sorted-triangles",
        "Triangles are blended one over the other, the farthest first by the mean depth of their corners.",
        "Triangles that pass through each other need both orders at once, so that one side of the line where they meet is wrong.",
        "Newell, Newell and Sancha 1972, A Solution to the Hidden Surface Problem",
    ),
    Lesson::new(
        "depth-write-off",
        "Surfaces are blended in the order of the mesh, and only opaque ones store depth.",
        "Nothing is lost, but over is not commutative: the wrong order shows wherever two surfaces of different colours overlap.",
        "Porter and Duff 1984, Compositing Digital Images",
    ),
    Lesson::new(
        "alpha-test",
        "Fragments whose alpha is below a half are discarded, all others are opaque.",
        "Every alpha becomes 0 or 1, so that the error is as large as the distance of alpha from these.",
        "Akeley 1993, RealityEngine Graphics",
    ),
    Lesson::new(
        "alpha-to-coverage",
        "Alpha becomes a mask of the four samples of a texel, in which the surface is opaque.",
        "Four samples know five levels, and the same mask in each layer hides all layers behind the first of equal alpha.",
        "Akeley 1993, RealityEngine Graphics",
    ),
    Lesson::new(
        "stochastic",
        "Alpha becomes a random mask of the four samples, another one in each layer and texel, so that the mean is right.",
        "The variance of four samples is seen as noise, whatever the number of layers.",
        "Enderton, Sintorn, Shirley and Luebke 2010, Stochastic Transparency",
    ),
    Lesson::new(
        "depth-peeling",
        "Each pass keeps the nearest surface behind the one of the pass before, and puts it under the picture so far.",
        "What lies behind the last layer that is peeled is missing, here the eighth.",
        "Everitt 2001, Interactive Order-Independent Transparency",
    ),
    Lesson::new(
        "dual-depth-peeling",
        "Each pass takes the nearest and the farthest surface that is left, by minimum and maximum blending.",
        "It stops in the middle: with more layers than twice the passes, those between are missing.",
        "Bavoil and Myers 2008, Order Independent Transparency with Dual Depth Peeling",
    ),
    Lesson::new(
        "weighted-blended",
        "One pass adds up colours, weighted by alpha and depth, and multiplies what alphas let through; a second takes the weighted mean.",
        "A mean has no order: where alpha is high, the nearest surface should hide the others and does so only as far as its weight is larger.",
        "McGuire and Bavoil 2013, Weighted Blended Order-Independent Transparency",
    ),
    Lesson::new(
        "moment-based",
        "One pass adds up four moments of the absorbance along depth; a second draws all surfaces again, each by the transmittance that the moments tell in front of it; a third takes the weighted mean.",
        "Four moments tell two or three depths apart: among more layers the steps of the transmittance blur into a curve, and what is in front hides too little.",
        "Münstermann, Krumpen, Klein and Peters 2018, Moment-Based Order-Independent Transparency",
    ),
    Lesson::new(
        "linked-lists",
        "One pass adds every fragment to a list of its texel in a pool of storage; a second sorts each list and composes it.",
        "What no longer finds room in the pool is missing, whether near or far: here as many nodes as eight layers have texels.",
        "Yang, Hensley, Grün and Thibieroz 2010, Real-Time Concurrent Linked List Construction on the GPU",
    ),
    Lesson::new(
        "front-to-back",
        "Objects are put under the picture, the nearest first, with premultiplied colours and the alpha that is left in the attachment.",
        "Right where the order of objects is; alpha in 8 bits rounds once more in each layer.",
        "Porter and Duff 1984, Compositing Digital Images: under",
    ),
];
