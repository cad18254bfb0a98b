//! The methods of this question, explained.

use crate::lesson::Lesson;
use crate::order::Order;

pub(crate) const LESSONS: &[Lesson] = &[
    Lesson::new(
        "unsorted",
        "Surfaces are blended in the order of the mesh, and each stores its depth.",
        "A surface behind an earlier one fails the depth test and is missing.",
        "Porter and Duff 1984, Compositing Digital Images",
    )
    .ordered(Order::Submitted),
    Lesson::new(
        "sorted",
        "Objects are blended one over the other, the farthest first by the mean depth of their corners.",
        "One depth per object gives no right order if objects enclose each other or intersect.",
        "Porter and Duff 1984, Compositing Digital Images",
    )
    .ordered(Order::Sorted),
    Lesson::new(
        "sorted-triangles",
        "Triangles are blended one over the other, the farthest first by the mean depth of their corners.",
        "Intersecting triangles need both orders at once, so one side of their intersection is wrong.",
        "Newell, Newell and Sancha 1972, A Solution to the Hidden Surface Problem",
    )
    .ordered(Order::Sorted),
    Lesson::new(
        "depth-write-off",
        "Surfaces are blended in the order of the mesh, and only opaque ones store depth.",
        "Nothing is missing, but over is not commutative: the wrong order shows wherever two surfaces of different colours overlap.",
        "Porter and Duff 1984, Compositing Digital Images",
    )
    .ordered(Order::Submitted),
    Lesson::new(
        "alpha-test",
        "Fragments whose alpha is below a half are discarded, all others are opaque.",
        "Every alpha becomes 0 or 1, so that the error is the distance of alpha from the nearer of the two.",
        "Akeley 1993, RealityEngine Graphics",
    )
    .ordered(Order::Independent),
    Lesson::new(
        "alpha-to-coverage",
        "Alpha becomes a mask of a texel's four samples; the surface is opaque in these samples.",
        "Four samples give five levels, and since each layer has the same mask, a layer hides all layers of equal alpha behind it.",
        "Akeley 1993, RealityEngine Graphics",
    )
    .ordered(Order::Independent),
    Lesson::new(
        "stochastic",
        "Alpha becomes a random mask of the four samples, a different one in each layer and texel, so that the mean is right.",
        "The variance of four samples is visible as noise, whatever the number of layers.",
        "Enderton, Sintorn, Shirley and Luebke 2010, Stochastic Transparency",
    )
    .ordered(Order::Independent),
    Lesson::new(
        "hashed",
        "A fragment is opaque if its alpha is at least a hash of its place on the surface, so that the share of opaque texels is alpha, and the pattern moves with the surface.",
        "With one sample, a texel shows one surface as a whole: the picture is right on average, with twice the noise of four random samples.",
        "Wyman and McGuire 2017, Hashed Alpha Testing",
    )
    .ordered(Order::Independent),
    Lesson::new(
        "depth-peeling",
        "Each pass keeps the nearest surface behind that of the previous pass, and composes it under the picture so far.",
        "Everything behind the last peeled layer, here the eighth, is missing.",
        "Everitt 2001, Interactive Order-Independent Transparency",
    )
    .ordered(Order::Independent),
    Lesson::new(
        "dual-depth-peeling",
        "Each pass takes the nearest and the farthest remaining surface, by minimum and maximum blending.",
        "It ends in the middle: with more than two layers per pass, the middle layers are missing.",
        "Bavoil and Myers 2008, Order Independent Transparency with Dual Depth Peeling",
    )
    .ordered(Order::Independent),
    Lesson::new(
        "weighted-blended",
        "One pass adds up colours, weighted by alpha and depth, and multiplies the transmittances; a second takes the weighted mean.",
        "A mean has no order: if alpha is high, the nearest surface should hide the others, but its weight is only somewhat larger.",
        "McGuire and Bavoil 2013, Weighted Blended Order-Independent Transparency",
    )
    .ordered(Order::Independent),
    Lesson::new(
        "moment-based",
        "One pass adds up four moments of the absorbance along depth; a second draws all surfaces again, each weighted by the transmittance in front of it, which the moments give; a third takes the weighted mean.",
        "Four moments distinguish two or three depths: with more layers, the steps of the transmittance blur into a curve, and the front layers hide too little.",
        "Münstermann, Krumpen, Klein and Peters 2018, Moment-Based Order-Independent Transparency",
    )
    .ordered(Order::Independent),
    Lesson::new(
        "linked-lists",
        "One pass adds every fragment to its texel's list in a pool of storage; a second sorts each list and composes it.",
        "Fragments that no longer fit into the pool are missing, whether near or far; here it holds eight nodes per texel.",
        "Yang, Hensley, Grün and Thibieroz 2010, Real-Time Concurrent Linked List Construction on the GPU",
    )
    .ordered(Order::Independent),
    Lesson::new(
        "nearest-layers",
        "One pass sorts the depths of a texel's eight nearest fragments into an array by atomic minima, a second stores their colours and sums up all others, a third composes the eight over the mean of the others.",
        "The layers in the array are exact and those behind it have no order: with more layers than the array holds, or with less alpha in front, the mean shows.",
        "Maule, Comba, Torchelsen and Bastos 2013, Hybrid Transparency; Bavoil and others 2007, Multi-Fragment Effects on the GPU Using the k-Buffer",
    )
    .ordered(Order::Independent),
    Lesson::new(
        "front-to-back",
        "Objects are composed under the picture, the nearest first, with premultiplied colours and the remaining alpha in the attachment.",
        "Right if the order of objects is right; alpha in 8 bits is rounded once per layer.",
        "Porter and Duff 1984, Compositing Digital Images: under",
    )
    .ordered(Order::Sorted),
];
