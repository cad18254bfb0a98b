//! Moment-based order-independent transparency (Münstermann, Krumpen, Klein and Peters 2018).

use super::draws::{PICTURE, clear, depths, opaque_color, opaque_depth};
use super::scenes::GlassScene;
use crate::polygon::{Polygon, cover, mesh};
use crate::stage::{SIZE, Stage, add, both, depth, draw};
use etalon_frame::TextureFormat;
use etalon_scene::{BlendFactor, BlendState, CompareFunction, Draw, Scene, Shader};

/// The format of the summed textures. The transmittance comes from differences of nearly equal moments, which
/// need all bits of 32-bit floats.
const SUMS: TextureFormat = TextureFormat::Rgba32Float;

/// Builds three passes for any number of layers: absorbance and its moments, then colours by transmittance,
/// then their mean over the background.
pub(super) fn moment_based(glass: &GlassScene, polygons: &[Polygon]) -> Scene {
    let mut stage = Stage::new();
    let picture = stage.color("picture", PICTURE, SIZE, clear(glass));
    let [absorbance, moments, sum] =
        ["absorbance", "moments", "sum"].map(|name| stage.color(name, SUMS, SIZE, [0.0; 4]));
    let depth_stencil = depths(&mut stage, 1);
    let glassy = |shader, textures: &[usize]| -> Draw {
        let mut draw = draw(shader, mesh(SIZE, polygons));
        draw.textures = textures.to_vec();
        draw.depth = depth(CompareFunction::Less, false);
        draw.targets[0].blend = both(add(BlendFactor::One, BlendFactor::One));
        draw
    };
    let draws = opaque_depth(glass, Shader::MomentAbsorbance)
        .into_iter()
        .chain([glassy(Shader::MomentAbsorbance, &[])]);
    stage.pass(&[absorbance, moments], Some(depth_stencil), draws.collect());
    let shown = glassy(Shader::MomentTransmittance, &[absorbance, moments]);
    stage.pass(&[sum], Some(depth_stencil), vec![shown]);

    let mut resolve = draw(Shader::MomentResolve, cover());
    resolve.textures = vec![sum, absorbance];
    resolve.targets[0].blend = Some(BlendState {
        color: add(BlendFactor::OneMinusSrcAlpha, BlendFactor::SrcAlpha),
        alpha: add(BlendFactor::Zero, BlendFactor::One),
    });
    let draws = opaque_color(glass).into_iter().chain([resolve]);
    stage.pass(&[picture], None, draws.collect());
    stage.read(&[picture])
}
