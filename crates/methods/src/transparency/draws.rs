//! Attachments and draws that several methods share.

use super::scenes::GlassScene;
use crate::polygon::{Polygon, mesh};
use crate::stage::{SIZE, Stage, add, both, depth, draw};
use etalon_frame::TextureFormat;
use etalon_scene::{BlendFactor, ColorTarget, CompareFunction, Draw, Shader};

/// The format of pictures.
pub(super) const PICTURE: TextureFormat = TextureFormat::Rgba8Unorm;

/// The format of depths.
pub(super) const DEPTH: TextureFormat = TextureFormat::Depth32Float;

/// Returns the background's colour, opaque.
pub(super) fn clear(glass: &GlassScene) -> [f64; 4] {
    let [r, g, b] = glass.background;
    [r, g, b, 1.0]
}

/// Adds a cleared depth attachment.
pub(super) fn depths(stage: &mut Stage, samples: u32) -> usize {
    stage.depth("depth", DEPTH, SIZE, samples, 1.0)
}

/// Adds the attachments of a weighted mean: the sums of colours, and what the layers leave of the background.
pub(super) fn sums(stage: &mut Stage) -> [usize; 2] {
    [
        stage.color("sum", TextureFormat::Rgba16Float, SIZE, [0.0; 4]),
        stage.color("left", TextureFormat::R8Unorm, SIZE, [1.0; 4]),
    ]
}

/// Returns the targets of these attachments: colours add up, and alphas multiply what is left.
pub(super) fn sum_targets() -> Vec<ColorTarget> {
    let components = [
        add(BlendFactor::One, BlendFactor::One),
        add(BlendFactor::Zero, BlendFactor::OneMinusSrc),
    ];
    let targets = components.map(|component| ColorTarget {
        blend: both(component),
        ..ColorTarget::default()
    });
    targets.to_vec()
}

/// Returns a draw of the opaque polygons, with depth; `None` if the scene has no opaque polygons.
pub(super) fn opaque(glass: &GlassScene, shader: Shader) -> Option<Draw> {
    if glass.opaque.is_empty() {
        return None;
    }
    let mut draw = draw(shader, mesh(SIZE, &glass.opaque));
    draw.depth = depth(CompareFunction::Less, true);
    Some(draw)
}

/// Returns a draw of the opaque polygons that writes only depth.
pub(super) fn opaque_depth(glass: &GlassScene, shader: Shader) -> Option<Draw> {
    let mut draw = opaque(glass, shader)?;
    for target in &mut draw.targets {
        target.write_mask = 0;
    }
    Some(draw)
}

/// Returns a draw of the opaque polygons' colours, the farthest first, without a depth test.
pub(super) fn opaque_color(glass: &GlassScene) -> Option<Draw> {
    let mut polygons = glass.opaque.clone();
    polygons.sort_by(|a, b| b.corners[0][2].total_cmp(&a.corners[0][2]));
    let some = !polygons.is_empty();
    some.then(|| draw(Shader::FlatColor, mesh(SIZE, &polygons)))
}

/// Returns the polygon with its colour multiplied by its alpha.
pub(super) fn premultiplied(polygon: &Polygon) -> Polygon {
    let [r, g, b, a] = polygon.color;
    Polygon {
        color: [r * a, g * a, b * a, a],
        ..polygon.clone()
    }
}
