//! Weighted blended order-independent transparency (McGuire and Bavoil 2013).

use super::draws::{Ground, ground, sum_targets, sums};
use super::scenes::GlassScene;
use crate::polygon::{Polygon, cover, mesh};
use crate::stage::{add, depth, draw};
use etalon_scene::{BlendFactor, BlendState, CompareFunction, Scene, Shader};

/// Builds two passes after that of the opaque polygons, for any number of layers. The first computes weighted sums and
/// the background's visibility, the second blends the mean over the background.
pub(super) fn weighted_blended(glass: &GlassScene, polygons: &[Polygon]) -> Scene {
    let Ground {
        mut stage,
        picture,
        depth_stencil,
    } = ground(glass);
    let [sum, left] = sums(&mut stage, glass);
    let mut accumulate = draw(Shader::WeightedAccumulate, mesh(glass.size, polygons));
    accumulate.depth = depth(CompareFunction::Less, false);
    accumulate.targets = sum_targets();
    stage.pass(&[sum, left], Some(depth_stencil), vec![accumulate]);

    let mut resolve = draw(Shader::WeightedResolve, cover());
    resolve.textures = vec![sum, left];
    resolve.targets[0].blend = Some(BlendState {
        color: add(BlendFactor::OneMinusSrcAlpha, BlendFactor::SrcAlpha),
        alpha: add(BlendFactor::Zero, BlendFactor::One),
    });
    stage.pass(&[picture], None, vec![resolve]);
    stage.read(&[picture])
}
