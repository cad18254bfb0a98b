//! How see-through surfaces are put together.
//!
//! What is opaque comes first or last, as a method needs it; all methods test what is seen through
//! against its depth. Blending equations are those of Porter and Duff (1984).

mod many_samples;
mod ordered;
mod peeling;
mod scenes;
#[cfg(test)]
mod tests;
mod weighted;

use super::stage::{Polygon, Stage, depth, draw, mesh};
use super::{Made, SIZE};
use crate::error::ParameterError;
use etalon_frame::TextureFormat;
use etalon_scene::{CompareFunction, Draw, Shader};
use scenes::{Glass, SceneName};
use schemars::JsonSchema;
use serde::Deserialize;

/// Something to see through and how it is drawn.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Wire {
    /// What is seen.
    pub(crate) scene: SceneName,
    /// How it is drawn.
    pub(crate) method: MethodName,
    /// Alpha of what is seen through, 0.01 to 0.99.
    pub(crate) alpha: Option<f64>,
    /// How many thin layers there are, 1 to 64.
    pub(crate) layers: Option<u32>,
    /// By how many degrees panes are turned, 0 to 65.
    pub(crate) angle: Option<f64>,
    /// How often is peeled, 1 to 64: dual peeling takes two layers each time. Without it, so often
    /// that 8 layers are peeled.
    pub(crate) k: Option<u32>,
}

/// How it is drawn.
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
    /// Blended object by object, nearest first: premultiplied colours under what is there.
    FrontToBack,
}

/// How many layers are peeled where no `k` is given.
const PEELED_LAYERS: u32 = 8;

/// Draws the scene by the method.
///
/// # Errors
/// When a parameter is out of its range.
pub(crate) fn make(wire: &Wire) -> Result<Made, ParameterError> {
    let glass = Glass::new(wire)?;
    if let Some(k) = wire.k {
        super::within("k", f64::from(k), 1.0..=64.0)?;
    }
    let list = || glass.polygons().cloned().collect::<Vec<_>>();
    let scene = match wire.method {
        MethodName::Unsorted => ordered::blended(&glass, &list(), true),
        MethodName::DepthWriteOff => ordered::blended(&glass, &list(), false),
        MethodName::Sorted => ordered::blended(&glass, &ordered::by_object(&glass), false),
        MethodName::SortedTriangles => {
            ordered::blended(&glass, &ordered::by_triangle(&glass), false)
        }
        MethodName::AlphaTest => ordered::alpha_test(&glass, &list()),
        MethodName::FrontToBack => ordered::front_to_back(&glass),
        MethodName::AlphaToCoverage => many_samples::alpha_to_coverage(&glass, &list()),
        MethodName::Stochastic => many_samples::stochastic(&glass, &list()),
        MethodName::DepthPeeling => {
            peeling::depth_peeling(&glass, &list(), wire.k.unwrap_or(PEELED_LAYERS))
        }
        MethodName::DualDepthPeeling => {
            peeling::dual_depth_peeling(&glass, &list(), wire.k.unwrap_or(PEELED_LAYERS / 2))
        }
        MethodName::WeightedBlended => weighted::weighted_blended(&glass, &list()),
    };
    Ok(Made {
        scene,
        truth: glass.truth(),
    })
}

/// The format of pictures.
const PICTURE: TextureFormat = TextureFormat::Rgba8Unorm;

/// The format of depths.
const DEPTH: TextureFormat = TextureFormat::Depth32Float;

/// The background's colour, opaque.
fn clear(glass: &Glass) -> [f64; 4] {
    let [r, g, b] = glass.background;
    [r, g, b, 1.0]
}

/// Adds a depth attachment with nothing in it.
fn depths(stage: &mut Stage, samples: u32) -> usize {
    stage.depth("depth", DEPTH, SIZE, samples, 1.0)
}

/// A draw of what is opaque, with depth; none where nothing is.
fn opaque(glass: &Glass, shader: Shader) -> Option<Draw> {
    if glass.opaque.is_empty() {
        return None;
    }
    let mut draw = draw(shader, mesh(SIZE, &glass.opaque));
    draw.depth = depth(CompareFunction::Less, true);
    Some(draw)
}

/// A draw of what is opaque for its depth alone.
fn opaque_depth(glass: &Glass, shader: Shader) -> Option<Draw> {
    let mut draw = opaque(glass, shader)?;
    for target in &mut draw.targets {
        target.write_mask = 0;
    }
    Some(draw)
}

/// A draw of the colour of what is opaque, the farthest first, without depth.
fn opaque_color(glass: &Glass) -> Option<Draw> {
    let mut polygons = glass.opaque.clone();
    polygons.sort_by(|a, b| b.corners[0][2].total_cmp(&a.corners[0][2]));
    let some = !polygons.is_empty();
    some.then(|| draw(Shader::FlatColor, mesh(SIZE, &polygons)))
}

/// The polygon with its colour multiplied by its alpha.
fn premultiplied(polygon: &Polygon) -> Polygon {
    let [r, g, b, a] = polygon.color;
    Polygon {
        color: [r * a, g * a, b * a, a],
        ..polygon.clone()
    }
}
