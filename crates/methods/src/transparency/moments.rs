//! Moment-based order-independent transparency (Münstermann, Krumpen, Klein and Peters 2018).

use super::draws::{Ground, ground};
use super::scenes::GlassScene;
use crate::polygon::{Polygon, cover, mesh};
use crate::stage::{add, both, depth, draw};
use etalon_frame::TextureFormat;
use etalon_scene::{BlendFactor, BlendState, CompareFunction, Draw, Scene, Shader};

/// The format of the summed textures. The transmittance comes from differences of nearly equal moments, which
/// need all bits of 32-bit floats.
const SUMS: TextureFormat = TextureFormat::Rgba32Float;

/// Builds three passes after that of the opaque polygons, for any number of layers: absorbance and its moments, then
/// colours by transmittance, then their mean over the background.
pub(super) fn moment_based(glass: &GlassScene, polygons: &[Polygon]) -> Scene {
    let Ground {
        mut stage,
        picture,
        depth_stencil,
    } = ground(glass);
    let [absorbance, moments, sum] =
        ["absorbance", "moments", "sum"].map(|name| stage.color(name, SUMS, glass.size, [0.0; 4]));
    let glassy = |shader, textures: &[usize]| -> Draw {
        let mut draw = draw(shader, mesh(glass.size, polygons));
        draw.textures = textures.to_vec();
        draw.depth = depth(CompareFunction::Less, false);
        draw.targets[0].blend = both(add(BlendFactor::One, BlendFactor::One));
        draw
    };
    let absorb = glassy(Shader::MomentAbsorbance, &[]);
    stage.pass(&[absorbance, moments], Some(depth_stencil), vec![absorb]);
    let shown = glassy(Shader::MomentTransmittance, &[absorbance, moments]);
    stage.pass(&[sum], Some(depth_stencil), vec![shown]);

    let mut resolve = draw(Shader::MomentResolve, cover());
    resolve.textures = vec![sum, absorbance];
    resolve.targets[0].blend = Some(BlendState {
        color: add(BlendFactor::OneMinusSrcAlpha, BlendFactor::SrcAlpha),
        alpha: add(BlendFactor::Zero, BlendFactor::One),
    });
    stage.pass(&[picture], None, vec![resolve]);
    stage.read(&[picture])
}
