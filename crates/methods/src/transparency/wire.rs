//! The parameters of a transparency case.

use schemars::JsonSchema;
use serde::Deserialize;

/// Transparent surfaces, and the method that draws them.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct TransparencyWire {
    /// The scene.
    pub(crate) scene: TransparencyScene,
    /// The method.
    pub(crate) method: TransparencyMethod,
    /// Alpha of the transparent surfaces, 0.01 to 0.99.
    pub(crate) alpha: Option<f64>,
    /// The number of thin layers, 1 to 256, or to 64 if alpha is above 0.25.
    pub(crate) layers: Option<u32>,
    /// The angle by which panes are turned in degrees, 0 to 65.
    pub(crate) angle: Option<f64>,
    /// The number of peels, 1 to 64; a dual peel takes two layers. By default, 8 layers are peeled. For
    /// linked lists, the average number of nodes per texel, for nearest layers, the number of layers, 1 to 32; 8 by
    /// default.
    pub(crate) k: Option<u32>,
}

/// The method.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub(crate) enum TransparencyMethod {
    /// Blended in no particular order, and depths are stored.
    Unsorted,
    /// Blended object by object, farthest first, by the mean depth of the corners.
    Sorted,
    /// Blended triangle by triangle, farthest first, by the mean depth of the corners.
    SortedTriangles,
    /// Blended in no particular order; depths are tested but not stored.
    DepthWriteOff,
    /// Opaque if alpha is at least a half, otherwise discarded.
    AlphaTest,
    /// Opaque in some of four samples; their number follows alpha.
    AlphaToCoverage,
    /// Opaque in random ones of four samples, different in each layer (Enderton and others 2010).
    Stochastic,
    /// Opaque if alpha is at least a hash of the place on the surface (Wyman and McGuire 2017).
    Hashed,
    /// One layer per peel, nearest first (Everitt 2001).
    DepthPeeling,
    /// The nearest and the farthest layer per peel (Bavoil and Myers 2008).
    DualDepthPeeling,
    /// The weighted mean of all layers (McGuire and Bavoil 2013).
    WeightedBlended,
    /// The weighted mean of all layers, with weights from moments of absorbance along depth (Münstermann and others
    /// 2018).
    MomentBased,
    /// Every fragment in a list of its texel, sorted at the end (Yang and others 2010).
    LinkedLists,
    /// The nearest `k` fragments of a texel, over the weighted mean of all others (Maule and others 2013).
    NearestLayers,
    /// Blended object by object, nearest first: premultiplied colours under the picture so far.
    FrontToBack,
}

/// The scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub(crate) enum TransparencyScene {
    /// Six panes next to and over each other, each at its own depth, and an opaque pane between them.
    /// `alpha` is that of the six.
    Windows,
    /// Three panes. Two are turned by `angle` degrees, so that they pass through each other if the angle is
    /// large.
    IntersectingPanes,
    /// Three nested boxes of glass, with an opaque polygon in the innermost.
    NestedGlass,
    /// A stack of `layers` panes of low `alpha`.
    ThinLayers,
    /// A bundle of thin slanted strips.
    Hair,
    /// A stack of large quads around an opaque polygon. `alpha` is that of the quads.
    Smoke,
}
