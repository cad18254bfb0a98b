//! Transparency: how transparent surfaces are composed.
//!
//! Opaque surfaces are drawn first, and all methods test transparent surfaces against their depth. The blend equations are those of Porter and Duff (1984).

mod claims;
mod draws;
mod hashed;
mod lessons;
mod lists;
mod many_samples;
mod model;
mod moments;
mod nearest;
mod ordered;
mod peeling;
mod scenes;
#[cfg(test)]
mod tests;
mod weighted;
mod wire;

pub(crate) use claims::CLAIMS;
pub(crate) use lessons::LESSONS;
pub(crate) use wire::TransparencyWire;

use crate::error::{ParameterError, within};
use crate::method_scene::MethodScene;
use crate::seen_model::{SeenModel, named};
use scenes::GlassScene;
use wire::TransparencyMethod;

/// The number of layers that are peeled or kept, or of nodes per texel, if no `k` is given.
const PEELED_LAYERS: u32 = 8;
/// The maximum number of nodes per texel: no API requires support for larger storage buffers.
const MOST_NODES: f64 = 32.0;

/// Draws the scene by the method.
///
/// # Errors
/// If a parameter is out of its range.
pub(crate) fn make(wire: &TransparencyWire) -> Result<MethodScene, ParameterError> {
    let glass = GlassScene::new(wire)?;
    drawn(&glass, wire.method, wire.k)
}

/// The methods that draw a model: all.
pub(crate) const MODEL_METHODS: [&str; 15] = [
    "unsorted",
    "sorted",
    "sorted-triangles",
    "depth-write-off",
    "alpha-test",
    "alpha-to-coverage",
    "stochastic",
    "hashed",
    "depth-peeling",
    "dual-depth-peeling",
    "weighted-blended",
    "moment-based",
    "linked-lists",
    "nearest-layers",
    "front-to-back",
];

/// Draws what a model's camera sees by the method of this name; `None` if there is no such method.
pub(crate) fn of_model(seen: &SeenModel, method: &str) -> Option<MethodScene> {
    let method = named(method)?;
    // Without a number of layers there is no parameter that could be out of range.
    drawn(&GlassScene::of_model(seen), method, None).ok()
}

fn drawn(
    glass: &GlassScene,
    method: TransparencyMethod,
    layers: Option<u32>,
) -> Result<MethodScene, ParameterError> {
    if let Some(k) = layers {
        within("k", f64::from(k), 1.0..=64.0)?;
    }
    let list = || glass.polygons().cloned().collect::<Vec<_>>();
    let scene = match method {
        TransparencyMethod::Unsorted => ordered::blended(glass, &list(), true),
        TransparencyMethod::DepthWriteOff => ordered::blended(glass, &list(), false),
        TransparencyMethod::Sorted => ordered::blended(glass, &ordered::by_object(glass), false),
        TransparencyMethod::SortedTriangles => {
            ordered::blended(glass, &ordered::by_triangle(glass), false)
        }
        TransparencyMethod::AlphaTest => ordered::alpha_test(glass, &list()),
        TransparencyMethod::FrontToBack => ordered::front_to_back(glass),
        TransparencyMethod::AlphaToCoverage => many_samples::alpha_to_coverage(glass, &list()),
        TransparencyMethod::Stochastic => many_samples::stochastic(glass, &list()),
        TransparencyMethod::Hashed => hashed::hashed(glass, &list()),
        TransparencyMethod::DepthPeeling => {
            peeling::depth_peeling(glass, &list(), layers.unwrap_or(PEELED_LAYERS))
        }
        TransparencyMethod::DualDepthPeeling => {
            peeling::dual_depth_peeling(glass, &list(), layers.unwrap_or(PEELED_LAYERS / 2))
        }
        TransparencyMethod::LinkedLists => {
            let nodes = layers.unwrap_or(PEELED_LAYERS);
            within("k", f64::from(nodes), 1.0..=MOST_NODES)?;
            lists::linked_lists(glass, &list(), nodes)
        }
        TransparencyMethod::NearestLayers => {
            let kept = layers.unwrap_or(PEELED_LAYERS);
            within("k", f64::from(kept), 1.0..=MOST_NODES)?;
            nearest::nearest_layers(glass, &list(), kept)
        }
        TransparencyMethod::MomentBased => moments::moment_based(glass, &list()),
        TransparencyMethod::WeightedBlended => weighted::weighted_blended(glass, &list()),
    };
    Ok(MethodScene {
        scene,
        truth: glass.truth(),
    })
}
