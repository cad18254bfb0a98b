//! The parameters of a transparency case.

use schemars::JsonSchema;
use serde::Deserialize;

/// Something to see through and how it is drawn.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Wire {
    /// The scene.
    pub(crate) scene: SceneName,
    /// The method.
    pub(crate) method: MethodName,
    /// Alpha of what is seen through, 0.01 to 0.99.
    pub(crate) alpha: Option<f64>,
    /// The number of thin layers, 1 to 64.
    pub(crate) layers: Option<u32>,
    /// By how many degrees panes are turned, 0 to 65.
    pub(crate) angle: Option<f64>,
    /// The number of peels, 1 to 64: dual peeling takes two layers each time. Without it, so many
    /// that 8 layers are peeled. Of linked lists, the nodes per texel, 1 to 32, on average; without it 8.
    pub(crate) k: Option<u32>,
}

/// The method.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub(crate) enum MethodName {
    /// Blended in any order, and depths are stored.
    Unsorted,
    /// Blended object by object, farthest first, by the mean depth of the corners.
    Sorted,
    /// Blended triangle by triangle, farthest first, by the mean depth of the corners.
    SortedTriangles,
    /// Blended in any order; depths are tested but not stored.
    DepthWriteOff,
    /// Opaque where alpha is at least a half, nothing elsewhere.
    AlphaTest,
    /// Opaque on a share of four samples.
    AlphaToCoverage,
    /// Opaque on a random share of four samples, another one in each layer (Enderton and others
    /// 2010).
    Stochastic,
    /// Layer after layer, nearest first (Everitt 2001).
    DepthPeeling,
    /// The nearest and the farthest layer at a time (Bavoil and Myers 2008).
    DualDepthPeeling,
    /// The weighted mean of all layers (McGuire and Bavoil 2013).
    WeightedBlended,
    /// The weighted mean of all layers, with weights from moments of absorbance along depth (Münstermann and others
    /// 2018).
    MomentBased,
    /// Every fragment in a list of its texel, which is sorted in the end (Yang and others 2010).
    LinkedLists,
    /// Blended object by object, nearest first: premultiplied colours under what is there.
    FrontToBack,
}

/// The scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub(crate) enum SceneName {
    /// Six panes beside and over each other, each at a depth of its own, and an opaque one between
    /// them. `alpha` is theirs.
    Windows,
    /// Three panes, two of which are turned by `angle` degrees, so that they pass through each other
    /// where it is large.
    IntersectingPanes,
    /// Three boxes of glass, one in the other, and something opaque in the innermost.
    NestedGlass,
    /// So many panes of low `alpha` as `layers` says.
    ThinLayers,
    /// A bundle of thin slanted strips.
    Hair,
    /// A stack of large quads around something opaque. `alpha` is theirs.
    Smoke,
}
