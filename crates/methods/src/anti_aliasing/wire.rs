//! The parameters of an anti-aliasing case.

use schemars::JsonSchema;
use serde::Deserialize;

/// Edges and how they are drawn.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct AntiAliasingWire {
    /// The shapes whose edges are drawn.
    pub(crate) scene: AntiAliasingScene,
    /// How the edges are smoothed.
    pub(crate) method: AntiAliasingMethod,
    /// The angle between the edges of half planes and the rows of texels in degrees, 0 to 90; by default 20. Only for
    /// `half-planes`.
    pub(crate) angle: Option<f64>,
    /// The opening angle of wedges in degrees, 0.25 to 60; by default 4. Only for `thin-wedge`.
    pub(crate) opening: Option<f64>,
    /// The movement of the pieces to the right in texels per frame, 0 to 4; by default 0. Only methods that take
    /// the mean of several frames show it; the truth is the last frame.
    pub(crate) speed: Option<f64>,
}

/// A way to smooth edges.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub(crate) enum AntiAliasingMethod {
    /// One sample per texel.
    None,
    /// The mean of two samples.
    #[serde(rename = "msaa-2")]
    Msaa2,
    /// The mean of four samples.
    #[serde(rename = "msaa-4")]
    Msaa4,
    /// The mean of eight samples.
    #[serde(rename = "msaa-8")]
    Msaa8,
    /// The mean of sixteen samples.
    #[serde(rename = "msaa-16")]
    Msaa16,
    /// The mean of 2 by 2 texels.
    #[serde(rename = "supersampling-2x2")]
    Supersampling2x2,
    /// The mean of 4 by 4 texels, in two steps.
    #[serde(rename = "supersampling-4x4")]
    Supersampling4x4,
    /// The mean of four frames, each moved by another part of a texel (Haeberli and Akeley 1990).
    #[serde(rename = "jittered-4")]
    Jittered4,
    /// The mean of eight frames, each moved by another part of a texel.
    #[serde(rename = "jittered-8")]
    Jittered8,
    /// The mean of sixteen frames, each moved by another part of a texel.
    #[serde(rename = "jittered-16")]
    Jittered16,
    /// One sample, blended along the edges that the picture's luma shows.
    Fxaa,
    /// Alpha from the distance to the nearest edge, blended over a neighbour that extends below the edge.
    CoverageToAlpha,
    /// Like `coverage-to-alpha`, but the polygons on both sides of an edge are blended, and the ends of wires
    /// too.
    CoverageToAlphaOverlap,
}

/// Shapes with edges.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub(crate) enum AntiAliasingScene {
    /// Sixteen half planes whose edges have the angle `angle` and cross texels at different offsets.
    HalfPlanes,
    /// Four wedges that open by `opening`, in different directions.
    ThinWedge,
    /// Alternating sectors and rings in two colours around a point.
    CheckerFan,
    /// The wires of a torus, as quads a little wider than a texel.
    WireTorus,
}
