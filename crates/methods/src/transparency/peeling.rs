//! Depth peeling, from the front or from both sides.

use super::draws::{PICTURE, clear, depths, opaque_color, opaque_depth, premultiplied};
use super::ordered::{behind, under};
use super::scenes::GlassScene;
use crate::polygon::{Polygon, cover, mesh};
use crate::stage::{SIZE, Stage, add, both, depth, draw, over};
use etalon_frame::TextureFormat;
use etalon_scene::{
    BlendComponent, BlendFactor, BlendOperation, BlendState, CompareFunction, Draw, Scene, Shader,
};

/// The format of peeled depths: that of the depth attachment, as a texture.
const PEELED: TextureFormat = TextureFormat::Rgba32Float;

/// Returns a draw that copies a texture.
fn copy(texture: usize, blend: Option<BlendState>) -> Draw {
    let mut copy = draw(Shader::TexelColor, cover());
    copy.textures = vec![texture];
    copy.targets[0].blend = blend;
    copy
}

/// Peels `k` layers, each the nearest one behind the previous layer, and composes each under the picture so far
/// (Everitt 2001).
pub(super) fn depth_peeling(glass: &GlassScene, polygons: &[Polygon], k: u32) -> Scene {
    let mut stage = Stage::new();
    let picture = stage.color("picture", PICTURE, SIZE, [0.0; 4]);
    let layer = stage.color("layer", PICTURE, SIZE, [0.0; 4]);
    let nothing = stage.color("nothing", TextureFormat::R8Unorm, SIZE, [0.0; 4]);
    let depth_stencil = depths(&mut stage, 1);
    let peeled: Vec<usize> = (0..k.min(2))
        .map(|i| stage.color(format!("peeled_{i}"), PEELED, SIZE, [1.0; 4]))
        .collect();
    let glassy: Vec<Polygon> = polygons.iter().map(premultiplied).collect();
    let glassy = mesh(SIZE, &glassy);
    let mut before = nothing;
    for i in 0..k {
        let into = peeled[i as usize % peeled.len()];
        let mut draws = Vec::new();
        if i > 0 {
            // The same as the clear that the first pass's attachments have.
            let mut clear = draw(Shader::Peel, far_cover());
            clear.textures = vec![nothing];
            clear.depth = depth(CompareFunction::Always, true);
            draws.push(clear);
        }
        if let Some(mut hidden) = opaque_depth(glass, Shader::Peel) {
            hidden.textures = vec![nothing];
            draws.push(hidden);
        }
        let mut peel = draw(Shader::Peel, glassy.clone());
        peel.textures = vec![before];
        peel.depth = depth(CompareFunction::Less, true);
        draws.push(peel);
        stage.pass(&[layer, into], Some(depth_stencil), draws);
        let mut draws = vec![copy(layer, under())];
        if i + 1 == k {
            let mut rest = draw(Shader::FlatColor, mesh(SIZE, &behind(glass)));
            rest.targets[0].blend = under();
            draws.push(rest);
        }
        stage.pass(&[picture], None, draws);
        before = into;
    }
    stage.read(&[picture])
}

/// Returns a mesh over the whole picture at the farthest depth, without colour.
fn far_cover() -> etalon_scene::Mesh {
    let everywhere = [0.0, 0.0, f64::from(SIZE[0]), f64::from(SIZE[1])];
    mesh(SIZE, &[Polygon::rect(everywhere, 1.0, [0.0; 4])])
}

/// Peels `k` times the nearest and the farthest remaining layer: the nearest is composed under the front
/// layers, the farthest over the back layers (Bavoil and Myers 2008).
pub(super) fn dual_depth_peeling(glass: &GlassScene, polygons: &[Polygon], k: u32) -> Scene {
    let mut stage = Stage::new();
    let picture = stage.color("picture", PICTURE, SIZE, clear(glass));
    let depth_stencil = depths(&mut stage, 1);
    let ranges = [0, 1].map(|i| stage.color(format!("range_{i}"), PEELED, SIZE, [-1.0; 4]));
    let fronts = [0, 1].map(|i| stage.color(format!("front_{i}"), PICTURE, SIZE, [0.0; 4]));
    let back = stage.color("back", PICTURE, SIZE, [0.0; 4]);
    let glassy = |shader| {
        let mut draw = draw(shader, mesh(SIZE, polygons));
        draw.depth = depth(CompareFunction::Less, false);
        draw.targets[0].blend = both(BlendComponent {
            operation: BlendOperation::Max,
            src_factor: BlendFactor::One,
            dst_factor: BlendFactor::One,
        });
        draw
    };
    let first = opaque_depth(glass, Shader::DepthRange);
    let draws = first.into_iter().chain([glassy(Shader::DepthRange)]);
    stage.pass(&[ranges[0]], Some(depth_stencil), draws.collect());
    for i in 0..k as usize {
        let (from, to) = (i % 2, (i + 1) % 2);
        let textures = vec![ranges[from], fronts[from]];
        // Drawn in front of all remaining layers; the shader clears depths and back, and keeps the front.
        let mut clear = draw(Shader::DualPeel, cover());
        clear.textures = textures.clone();
        let mut peel = glassy(Shader::DualPeel);
        peel.textures = textures;
        let color = [ranges[to], fronts[to], back];
        stage.pass(&color, Some(depth_stencil), vec![clear, peel]);
        let mut draws = Vec::new();
        if i == 0 {
            draws.extend(opaque_color(glass));
        }
        draws.push(copy(back, over()));
        if i + 1 == k as usize {
            let premultiplied = add(BlendFactor::One, BlendFactor::OneMinusSrcAlpha);
            draws.push(copy(fronts[to], both(premultiplied)));
        }
        stage.pass(&[picture], None, draws);
    }
    stage.read(&[picture])
}
