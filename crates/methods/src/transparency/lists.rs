//! Per-pixel linked lists (Yang, Hensley, Grün and Thibieroz 2010).

use super::draws::{PICTURE, clear, depths, opaque};
use super::scenes::GlassScene;
use crate::polygon::{Polygon, cover, mesh};
use crate::stage::{Stage, add, depth, draw};
use etalon_scene::{
    BlendFactor, BlendState, CompareFunction, EarlyTests, Params, Pool, Scene, Shader,
};

/// Builds two passes for any number of layers. The first adds every fragment in front of the opaque
/// polygons to its texel's list; the second sorts the lists and composes them over the picture. The pool
/// has `nodes` nodes per texel, on average.
pub(super) fn linked_lists(glass: &GlassScene, polygons: &[Polygon], nodes: u32) -> Scene {
    let mut stage = Stage::new();
    let picture = stage.color("picture", PICTURE, glass.size, clear(glass));
    let depth_stencil = depths(&mut stage, glass, 1);
    let [width, height] = glass.size;
    stage.pool(Pool {
        size: glass.size,
        nodes: nodes * width * height,
        layers: 0,
    });
    let params = Params {
        color: [width as f32, height as f32, 0.0, 0.0],
        back_color: [0.0; 4],
    };
    let mut append = draw(Shader::ListAppend, mesh(glass.size, polygons));
    append.params = params;
    append.depth = depth(CompareFunction::Less, false);
    // A fragment that fails the depth test must not become a node, although the shader has side effects.
    append.early_tests = EarlyTests::Forced;
    append.targets[0].write_mask = 0;
    let draws = opaque(glass, Shader::FlatColor).into_iter().chain([append]);
    stage.pass(&[picture], Some(depth_stencil), draws.collect());

    let mut compose = draw(Shader::ListCompose, cover());
    compose.params = params;
    compose.targets[0].blend = Some(BlendState {
        color: add(BlendFactor::One, BlendFactor::SrcAlpha),
        alpha: add(BlendFactor::Zero, BlendFactor::One),
    });
    stage.pass(&[picture], None, vec![compose]);
    stage.read(&[picture])
}
