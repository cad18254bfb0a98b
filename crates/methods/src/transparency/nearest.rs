//! The nearest layers of each texel, and the mean of all others (Maule, Comba, Torchelsen and Bastos 2013).

use super::draws::{PICTURE, clear, depths, opaque, sum_targets, sums};
use super::scenes::GlassScene;
use crate::polygon::{Polygon, cover, mesh};
use crate::stage::{Stage, add, depth, draw};
use etalon_scene::{
    BlendFactor, BlendState, CompareFunction, Draw, EarlyTests, Params, Pool, Scene, Shader,
};

/// Builds three passes for any number of layers. The first finds the `k` nearest depths of each texel, the
/// second stores their colours and sums up what is farther, the third composes both over the picture.
pub(super) fn nearest_layers(glass: &GlassScene, polygons: &[Polygon], k: u32) -> Scene {
    let mut stage = Stage::new();
    let picture = stage.color("picture", PICTURE, glass.size, clear(glass));
    let [sum, left] = sums(&mut stage, glass);
    let depth_stencil = depths(&mut stage, glass, 1);
    let [width, height] = glass.size;
    stage.pool(Pool {
        size: glass.size,
        nodes: k * width * height,
        layers: k,
    });
    let params = Params {
        color: [width as f32, height as f32, k as f32, 0.0],
        back_color: [0.0; 4],
    };
    let glassy = |shader| -> Draw {
        let mut draw = draw(shader, mesh(glass.size, polygons));
        draw.params = params;
        draw.depth = depth(CompareFunction::Less, false);
        // A fragment that fails the depth test must not become a layer, although the shader has side effects.
        draw.early_tests = EarlyTests::Forced;
        draw
    };
    let mut keep = glassy(Shader::NearestDepths);
    keep.targets[0].write_mask = 0;
    let draws = opaque(glass, Shader::FlatColor).into_iter().chain([keep]);
    stage.pass(&[picture], Some(depth_stencil), draws.collect());

    let mut fill = glassy(Shader::NearestColors);
    fill.targets = sum_targets();
    stage.pass(&[sum, left], Some(depth_stencil), vec![fill]);

    let mut compose = draw(Shader::NearestCompose, cover());
    compose.textures = vec![sum, left];
    compose.params = params;
    compose.targets[0].blend = Some(BlendState {
        color: add(BlendFactor::One, BlendFactor::SrcAlpha),
        alpha: add(BlendFactor::Zero, BlendFactor::One),
    });
    stage.pass(&[picture], None, vec![compose]);
    stage.read(&[picture])
}
