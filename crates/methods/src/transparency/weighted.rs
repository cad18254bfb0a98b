//! Weighted blended order-independent transparency (McGuire and Bavoil 2013).

use super::draws::{PICTURE, clear, depths, opaque_color, opaque_depth};
use super::scenes::GlassScene;
use crate::polygon::{Polygon, cover, mesh};
use crate::stage::{SIZE, Stage, add, both, depth, draw};
use etalon_frame::TextureFormat;
use etalon_scene::{BlendFactor, BlendState, ColorTarget, CompareFunction, Scene, Shader};

/// Builds two passes for any number of layers. The first computes weighted sums and the background's
/// visibility, the second blends the mean over the background.
pub(super) fn weighted_blended(glass: &GlassScene, polygons: &[Polygon]) -> Scene {
    let mut stage = Stage::new();
    let picture = stage.color("picture", PICTURE, SIZE, clear(glass));
    let sum = stage.color("sum", TextureFormat::Rgba16Float, SIZE, [0.0; 4]);
    let left = stage.color("left", TextureFormat::R8Unorm, SIZE, [1.0; 4]);
    let depth_stencil = depths(&mut stage, 1);
    let mut accumulate = draw(Shader::WeightedAccumulate, mesh(SIZE, polygons));
    accumulate.depth = depth(CompareFunction::Less, false);
    accumulate.targets = [
        add(BlendFactor::One, BlendFactor::One),
        add(BlendFactor::Zero, BlendFactor::OneMinusSrc),
    ]
    .map(|component| ColorTarget {
        blend: both(component),
        ..ColorTarget::default()
    })
    .to_vec();
    let draws = opaque_depth(glass, Shader::WeightedAccumulate)
        .into_iter()
        .chain([accumulate]);
    stage.pass(&[sum, left], Some(depth_stencil), draws.collect());

    let mut resolve = draw(Shader::WeightedResolve, cover());
    resolve.textures = vec![sum, left];
    resolve.targets[0].blend = Some(BlendState {
        color: add(BlendFactor::OneMinusSrcAlpha, BlendFactor::SrcAlpha),
        alpha: add(BlendFactor::Zero, BlendFactor::One),
    });
    let draws = opaque_color(glass).into_iter().chain([resolve]);
    stage.pass(&[picture], None, draws.collect());
    stage.read(&[picture])
}
