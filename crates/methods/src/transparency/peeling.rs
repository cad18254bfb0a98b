//! Depth peeling, from the front or from both sides.

use super::draws::{
    Ground, PICTURE, copy, ground, opaque_depth, over_premultiplied, premultiplied,
};
use super::ordered::under;
use super::scenes::GlassScene;
use crate::polygon::{Polygon, cover, mesh};
use crate::stage::{both, depth, draw, over};
use etalon_frame::TextureFormat;
use etalon_scene::{BlendComponent, BlendFactor, BlendOperation, CompareFunction, Scene, Shader};

/// The format of peeled depths: that of the depth attachment, as a texture.
const PEELED: TextureFormat = TextureFormat::Rgba32Float;

/// Peels `k` layers, each the nearest one behind the previous layer, and composes each under those so far, at the end all
/// of them over the opaque polygons (Everitt 2001).
pub(super) fn depth_peeling(glass: &GlassScene, polygons: &[Polygon], k: u32) -> Scene {
    let Ground {
        mut stage,
        picture,
        depth_stencil,
    } = ground(glass);
    let front = stage.color("front", PICTURE, glass.size, [0.0; 4]);
    let layer = stage.color("layer", PICTURE, glass.size, [0.0; 4]);
    let nothing = stage.color("nothing", TextureFormat::R8Unorm, glass.size, [0.0; 4]);
    let peeled: Vec<usize> = (0..k.min(2))
        .map(|i| stage.color(format!("peeled_{i}"), PEELED, glass.size, [1.0; 4]))
        .collect();
    let glassy: Vec<Polygon> = polygons.iter().map(premultiplied).collect();
    let glassy = mesh(glass.size, &glassy);
    let mut before = nothing;
    for i in 0..k {
        let into = peeled[i as usize % peeled.len()];
        let mut draws = Vec::new();
        if i > 0 {
            // The same contents as before the first layer: clears, and the depths of the opaque polygons.
            let mut clear = draw(Shader::Peel, far_cover(glass.size));
            clear.textures = vec![nothing];
            clear.depth = depth(CompareFunction::Always, true);
            draws.push(clear);
            if let Some(mut hidden) = opaque_depth(glass, Shader::Peel) {
                hidden.textures = vec![nothing];
                draws.push(hidden);
            }
        }
        let mut peel = draw(Shader::Peel, glassy.clone());
        peel.textures = vec![before];
        peel.depth = depth(CompareFunction::Less, true);
        draws.push(peel);
        stage.pass(&[layer, into], Some(depth_stencil), draws);
        stage.pass(&[front], None, vec![copy(layer, under())]);
        before = into;
    }
    stage.pass(&[picture], None, vec![copy(front, over_premultiplied())]);
    stage.read(&[picture])
}

/// Returns a mesh over the whole picture at the farthest depth, without colour.
fn far_cover(size: [u32; 2]) -> etalon_scene::Mesh {
    let [width, height] = size.map(f64::from);
    let everywhere = [0.0, 0.0, width, height];
    mesh(size, &[Polygon::rect(everywhere, 1.0, [0.0; 4])])
}

/// Peels `k` times the nearest and the farthest remaining layer: the nearest is composed under the front
/// layers, the farthest over the back layers (Bavoil and Myers 2008).
pub(super) fn dual_depth_peeling(glass: &GlassScene, polygons: &[Polygon], k: u32) -> Scene {
    let Ground {
        mut stage,
        picture,
        depth_stencil,
    } = ground(glass);
    let ranges = [0, 1].map(|i| stage.color(format!("range_{i}"), PEELED, glass.size, [-1.0; 4]));
    let fronts = [0, 1].map(|i| stage.color(format!("front_{i}"), PICTURE, glass.size, [0.0; 4]));
    let back = stage.color("back", PICTURE, glass.size, [0.0; 4]);
    let glassy = |shader| {
        let mut draw = draw(shader, mesh(glass.size, polygons));
        draw.depth = depth(CompareFunction::Less, false);
        draw.targets[0].blend = both(BlendComponent {
            operation: BlendOperation::Max,
            src_factor: BlendFactor::One,
            dst_factor: BlendFactor::One,
        });
        draw
    };
    let range = glassy(Shader::DepthRange);
    stage.pass(&[ranges[0]], Some(depth_stencil), vec![range]);
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
        let mut draws = vec![copy(back, over())];
        if i + 1 == k as usize {
            draws.push(copy(fronts[to], over_premultiplied()));
        }
        stage.pass(&[picture], None, draws);
    }
    stage.read(&[picture])
}
