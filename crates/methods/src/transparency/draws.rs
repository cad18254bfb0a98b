//! Attachments and draws that several methods share.

use super::scenes::GlassScene;
use crate::polygon::{Polygon, cover, mesh};
use crate::stage::{DEPTHS, NEARER, Stage, add, both, draw};
use etalon_frame::TextureFormat;
use etalon_scene::{BlendFactor, BlendState, ColorTarget, Draw, Shader};

/// The format of pictures.
pub(super) const PICTURE: TextureFormat = TextureFormat::Rgba8Unorm;

/// Returns the background's colour, opaque.
pub(super) fn clear(glass: &GlassScene) -> [f64; 4] {
    let [r, g, b] = glass.background;
    [r, g, b, 1.0]
}

/// Adds a cleared depth attachment.
pub(super) fn depths(stage: &mut Stage, glass: &GlassScene, samples: u32) -> usize {
    stage.depth("depth", DEPTHS, glass.size, samples, 1.0)
}

/// Adds the attachments of a weighted mean: the sums of colours, and what the layers leave of the background.
pub(super) fn sums(stage: &mut Stage, glass: &GlassScene) -> [usize; 2] {
    [
        stage.color("sum", TextureFormat::Rgba16Float, glass.size, [0.0; 4]),
        stage.color("left", TextureFormat::R8Unorm, glass.size, [1.0; 4]),
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
    let mut draw = draw(shader, mesh(glass.size, &glass.opaque));
    draw.depth = NEARER;
    Some(draw)
}

/// The opaque polygons, drawn in a first pass.
pub(super) struct Ground {
    pub(super) stage: Stage,
    /// The attachment with their colours over the background.
    pub(super) picture: usize,
    /// The attachment with their depths.
    pub(super) depth_stencil: usize,
}

/// Draws the opaque polygons with depth over the background.
pub(super) fn ground(glass: &GlassScene) -> Ground {
    let mut stage = Stage::new();
    let picture = stage.color("picture", PICTURE, glass.size, clear(glass));
    let depth_stencil = depths(&mut stage, glass, 1);
    if let Some(opaque) = opaque(glass, Shader::FlatColor) {
        stage.pass(&[picture], Some(depth_stencil), vec![opaque]);
    }
    Ground {
        stage,
        picture,
        depth_stencil,
    }
}

/// Returns a draw that copies a texture.
pub(super) fn copy(texture: usize, blend: Option<BlendState>) -> Draw {
    let mut copy = draw(Shader::TexelColor, cover());
    copy.textures = vec![texture];
    copy.targets[0].blend = blend;
    copy
}

/// Returns the blend state `over` for premultiplied colours.
pub(super) fn over_premultiplied() -> Option<BlendState> {
    both(add(BlendFactor::One, BlendFactor::OneMinusSrcAlpha))
}

/// Returns a draw of the opaque polygons that writes only depth.
pub(super) fn opaque_depth(glass: &GlassScene, shader: Shader) -> Option<Draw> {
    let mut draw = opaque(glass, shader)?;
    for target in &mut draw.targets {
        target.write_mask = 0;
    }
    Some(draw)
}

/// Returns the polygon with its colour multiplied by its alpha.
pub(super) fn premultiplied(polygon: &Polygon) -> Polygon {
    let [r, g, b, a] = polygon.color;
    Polygon {
        color: [r * a, g * a, b * a, a],
        ..polygon.clone()
    }
}
