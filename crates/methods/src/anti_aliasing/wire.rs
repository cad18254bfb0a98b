//! The parameters of an anti-aliasing case.

use schemars::JsonSchema;
use serde::Deserialize;

/// Edges and how they are drawn.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Wire {
    /// The scene.
    pub(crate) scene: SceneName,
    /// The method.
    pub(crate) method: MethodName,
    /// The angle of the edges of half planes to the rows of texels in degrees, 0 to 90.
    pub(crate) angle: Option<f64>,
    /// The opening of wedges in degrees, 0.25 to 60.
    pub(crate) opening: Option<f64>,
}

/// The method.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub(crate) enum MethodName {
    /// One sample.
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
    /// One sample, blended along the edges that the picture's luma shows.
    Fxaa,
    /// Alpha from the distance to the nearest edge, blended over a neighbour that reaches below.
    CoverageToAlpha,
    /// The same where neighbours share edges and each blends its own side, and where lines end.
    CoverageToAlphaOverlap,
}

/// The scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub(crate) enum SceneName {
    /// Sixteen half planes whose edges lie at `angle` and at different parts of a texel.
    HalfPlanes,
    /// Four wedges that open by `opening`, in different directions.
    ThinWedge,
    /// Sectors and rings around a point in two colours by turns.
    CheckerFan,
    /// The wires of a torus, as quads a little wider than a texel.
    WireTorus,
}
