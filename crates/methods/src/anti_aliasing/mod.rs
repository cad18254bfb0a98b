//! Anti-aliasing.
//!
//! Each scene has a ground whose borders are on texel borders, and pieces with slanted edges on it.
//! Everything is opaque. A scene of one's own has solid polygons instead, which hide each other by their depths.

mod claims;
mod jittered;
mod lessons;
mod pieces;
mod scenes;
#[cfg(test)]
mod tests;
mod wire;

pub(crate) use claims::CLAIMS;
pub(crate) use lessons::LESSONS;
pub(crate) use wire::AntiAliasingWire;

use crate::error::{ParameterError, within};
use crate::method_scene::MethodScene;
use crate::polygon::{Polygon, cover, mesh};
use crate::seen_model::{SeenModel, named};
use crate::stage::{NEARER, Stage, draw, over};
use etalon_scene::{AddressMode, AttachmentContents, Draw, FilterMode, Sampler, Scene, Shader};
use scenes::{EdgeScene, PICTURE};
use wire::AntiAliasingMethod;

/// Draws the scene by the method.
///
/// # Errors
/// If a parameter is out of its range.
pub(crate) fn make(wire: &AntiAliasingWire) -> Result<MethodScene, ParameterError> {
    let edges = EdgeScene::new(wire)?;
    let speed = within("speed", wire.speed.unwrap_or(0.0), 0.0..=4.0)?;
    Ok(drawn(&edges, wire.method, speed))
}

/// The methods that draw a model. They need no distance from an edge.
pub(crate) const MODEL_METHODS: [&str; 11] = [
    "none",
    "msaa-2",
    "msaa-4",
    "msaa-8",
    "msaa-16",
    "supersampling-2x2",
    "supersampling-4x4",
    "jittered-4",
    "jittered-8",
    "jittered-16",
    "fxaa",
];

/// Draws what a model's camera sees by the method of this name; `None` if there is no such method.
pub(crate) fn of_model(seen: &SeenModel, method: &str) -> Option<MethodScene> {
    let method = MODEL_METHODS.contains(&method).then(|| named(method))??;
    Some(drawn(&EdgeScene::of_model(seen), method, 0.0))
}

fn drawn(edges: &EdgeScene, method: AntiAliasingMethod, speed: f64) -> MethodScene {
    let scene = match method {
        AntiAliasingMethod::None => plain(edges),
        AntiAliasingMethod::Msaa2 => multisampled(edges, 2),
        AntiAliasingMethod::Msaa4 => multisampled(edges, 4),
        AntiAliasingMethod::Msaa8 => multisampled(edges, 8),
        AntiAliasingMethod::Msaa16 => multisampled(edges, 16),
        AntiAliasingMethod::Supersampling2x2 => supersampled(edges, 1),
        AntiAliasingMethod::Supersampling4x4 => supersampled(edges, 2),
        AntiAliasingMethod::Jittered4 => jittered::jittered(edges, 4, speed),
        AntiAliasingMethod::Jittered8 => jittered::jittered(edges, 8, speed),
        AntiAliasingMethod::Jittered16 => jittered::jittered(edges, 16, speed),
        AntiAliasingMethod::Fxaa => fxaa(edges),
        AntiAliasingMethod::CoverageToAlpha => coverage_to_alpha(edges),
        AntiAliasingMethod::CoverageToAlphaOverlap => coverage_to_alpha_overlap(edges),
    };
    MethodScene {
        scene,
        truth: edges.truth(),
    }
}

/// Returns a draw of everything with one sample per texel or more, tested against depths if there is need.
fn everything(edges: &EdgeScene) -> Draw {
    let mut drawn = draw(Shader::FlatColor, mesh(edges.size, &edges.polygons()));
    drawn.depth = NEARER.filter(|_| edges.needs_depth());
    drawn
}

fn plain(edges: &EdgeScene) -> Scene {
    let mut stage = Stage::new();
    let picture = stage.color("picture", PICTURE, edges.size, edges.clear());
    let depth_stencil = edges.depths(&mut stage, 1);
    stage.pass(&[picture], depth_stencil, vec![everything(edges)]);
    stage.read(&[picture])
}

fn multisampled(edges: &EdgeScene, count: u32) -> Scene {
    let mut stage = Stage::new();
    let picture = stage.color("picture", PICTURE, edges.size, edges.clear());
    let contents = AttachmentContents::Color(edges.clear().map(|c| c as f32));
    let samples = stage.attachment("samples", PICTURE, edges.size, count, contents);
    let depth_stencil = edges.depths(&mut stage, count);
    let drawn = vec![everything(edges)];
    stage.resolving_pass(&[samples], vec![Some(picture)], depth_stencil, drawn);
    stage.read(&[picture])
}

fn supersampled(edges: &EdgeScene, doublings: u32) -> Scene {
    let mut stage = Stage::new();
    let picture = stage.color("picture", PICTURE, edges.size, edges.clear());
    stage.supersampled(picture, edges.clear(), doublings, everything(edges));
    stage.read(&[picture])
}

/// The least contrast of an edge: relative to the brightest neighbour, and absolute (Lottes 2009).
const CONTRAST: [f32; 2] = [1.0 / 6.0, 1.0 / 12.0];
/// The weight of single texels that stand out (the default of version 3.11).
const SINGLE: f32 = 0.75;

/// Draws with one sample, then blends along the picture's edges in a second pass.
fn fxaa(edges: &EdgeScene) -> Scene {
    let mut stage = Stage::new();
    let picture = stage.color("picture", PICTURE, edges.size, edges.clear());
    let jagged = stage.color("jagged", PICTURE, edges.size, edges.clear());
    let depth_stencil = edges.depths(&mut stage, 1);
    stage.pass(&[jagged], depth_stencil, vec![everything(edges)]);
    let mut over_edges = draw(Shader::Fxaa, cover());
    over_edges.textures = vec![jagged];
    over_edges.sampler = Some(Sampler {
        filter: FilterMode::Linear,
        address: [AddressMode::ClampToEdge; 2],
    });
    let [width, height] = edges.size.map(|s| 1.0 / s as f32);
    over_edges.params.color = [width, height, CONTRAST[0], CONTRAST[1]];
    over_edges.params.back_color[0] = SINGLE;
    stage.pass(&[picture], None, vec![over_edges]);
    stage.read(&[picture])
}

fn coverage_to_alpha(edges: &EdgeScene) -> Scene {
    let mut stage = Stage::new();
    let picture = stage.color("picture", PICTURE, edges.size, edges.clear());
    let mut draws = Vec::new();
    if !edges.ground.is_empty() {
        draws.push(draw(Shader::FlatColor, mesh(edges.size, &edges.ground)));
    }
    let smooth = edges.front.iter().flat_map(|piece| piece.smooth(false));
    draws.push(smoothed(edges.size, &smooth.collect::<Vec<_>>()));
    stage.pass(&[picture], None, draws);
    stage.read(&[picture])
}

fn coverage_to_alpha_overlap(edges: &EdgeScene) -> Scene {
    let mut stage = Stage::new();
    let picture = stage.color("picture", PICTURE, edges.size, edges.clear());
    let pieces = edges.back.iter().chain(&edges.front);
    let smooth: Vec<Polygon> = pieces.flat_map(|piece| piece.smooth(true)).collect();
    stage.pass(&[picture], None, vec![smoothed(edges.size, &smooth)]);
    stage.read(&[picture])
}

fn smoothed(size: [u32; 2], polygons: &[Polygon]) -> Draw {
    let mut draw = draw(Shader::EdgeAlpha, mesh(size, polygons));
    draw.targets[0].blend = over();
    draw
}
