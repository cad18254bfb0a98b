//! Anti-aliasing.
//!
//! Each scene is a ground on texel borders and pieces with slanted edges on it, everything opaque.

mod claims;
mod lessons;
mod pieces;
mod scenes;
#[cfg(test)]
mod tests;
mod wire;

pub(crate) use claims::CLAIMS;
pub(crate) use lessons::LESSONS;
pub(crate) use wire::Wire;

use crate::error::ParameterError;
use crate::method_scene::MethodScene;
use crate::polygon::{Polygon, cover, mesh};
use crate::stage::{SIZE, Stage, draw, over};
use etalon_frame::TextureFormat;
use etalon_scene::{AddressMode, Contents, FilterMode, Sampler, Scene, Shader};
use scenes::Edges;
use wire::MethodName;

/// Draws the scene by the method.
///
/// # Errors
/// If a parameter is out of its range.
pub(crate) fn make(wire: &Wire) -> Result<MethodScene, ParameterError> {
    let edges = Edges::new(wire)?;
    let scene = match wire.method {
        MethodName::None => plain(&edges),
        MethodName::Msaa2 => multisampled(&edges, 2),
        MethodName::Msaa4 => multisampled(&edges, 4),
        MethodName::Msaa8 => multisampled(&edges, 8),
        MethodName::Msaa16 => multisampled(&edges, 16),
        MethodName::Supersampling2x2 => supersampled(&edges, 1),
        MethodName::Supersampling4x4 => supersampled(&edges, 2),
        MethodName::CoverageToAlpha => coverage_to_alpha(&edges),
        MethodName::CoverageToAlphaOverlap => coverage_to_alpha_overlap(&edges),
    };
    Ok(MethodScene {
        scene,
        truth: edges.truth(),
    })
}

/// The format of pictures.
const PICTURE: TextureFormat = TextureFormat::Rgba8Unorm;

fn clear(edges: &Edges) -> [f64; 4] {
    let [r, g, b] = edges.background;
    [r, g, b, 1.0]
}

fn plain(edges: &Edges) -> Scene {
    let mut stage = Stage::new();
    let picture = stage.color("picture", PICTURE, SIZE, clear(edges));
    let all = draw(Shader::FlatColor, mesh(SIZE, &edges.polygons()));
    stage.pass(&[picture], None, vec![all]);
    stage.read(&[picture])
}

fn multisampled(edges: &Edges, count: u32) -> Scene {
    let mut stage = Stage::new();
    let picture = stage.color("picture", PICTURE, SIZE, clear(edges));
    let contents = Contents::Color(clear(edges).map(|c| c as f32));
    let samples = stage.attachment("samples", PICTURE, SIZE, count, contents);
    let all = draw(Shader::FlatColor, mesh(SIZE, &edges.polygons()));
    stage.resolving_pass(&[samples], vec![Some(picture)], None, vec![all]);
    stage.read(&[picture])
}

/// Draws a picture whose sides are doubled so often, and halves it again.
fn supersampled(edges: &Edges, doublings: u32) -> Scene {
    let mut stage = Stage::new();
    let picture = stage.color("picture", PICTURE, SIZE, clear(edges));
    let mut from = 0;
    for step in (1..=doublings).rev() {
        let size = SIZE.map(|s| s << step);
        let large = stage.color(format!("large_{step}"), PICTURE, size, clear(edges));
        let draws = if step == doublings {
            // Meshes know nothing of texels: the same one fills an attachment of any size.
            vec![draw(Shader::FlatColor, mesh(SIZE, &edges.polygons()))]
        } else {
            vec![halved(from)]
        };
        stage.pass(&[large], None, draws);
        from = large;
    }
    stage.pass(&[picture], None, vec![halved(from)]);
    stage.read(&[picture])
}

/// A texture at half its size: a linear filter right between four texels is their mean.
fn halved(texture: usize) -> etalon_scene::Draw {
    let mut draw = draw(Shader::SampledColor, cover());
    draw.textures = vec![texture];
    draw.sampler = Some(Sampler {
        filter: FilterMode::Linear,
        address: [AddressMode::ClampToEdge; 2],
    });
    draw
}

fn coverage_to_alpha(edges: &Edges) -> Scene {
    let mut stage = Stage::new();
    let picture = stage.color("picture", PICTURE, SIZE, clear(edges));
    let mut draws = Vec::new();
    if !edges.ground.is_empty() {
        draws.push(draw(Shader::FlatColor, mesh(SIZE, &edges.ground)));
    }
    let smooth = edges.front.iter().flat_map(|piece| piece.smooth(false));
    draws.push(smoothed(&smooth.collect::<Vec<_>>()));
    stage.pass(&[picture], None, draws);
    stage.read(&[picture])
}

fn coverage_to_alpha_overlap(edges: &Edges) -> Scene {
    let mut stage = Stage::new();
    let picture = stage.color("picture", PICTURE, SIZE, clear(edges));
    let pieces = edges.back.iter().chain(&edges.front);
    let smooth: Vec<Polygon> = pieces.flat_map(|piece| piece.smooth(true)).collect();
    stage.pass(&[picture], None, vec![smoothed(&smooth)]);
    stage.read(&[picture])
}

fn smoothed(polygons: &[Polygon]) -> etalon_scene::Draw {
    let mut draw = draw(Shader::EdgeAlpha, mesh(SIZE, polygons));
    draw.targets[0].blend = over();
    draw
}
