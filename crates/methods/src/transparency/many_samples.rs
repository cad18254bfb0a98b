//! Methods that spread transparent surfaces over four samples.

use super::draws::{PICTURE, clear, depths, opaque};
use super::scenes::GlassScene;
use crate::noise::Noise;
use crate::polygon::{Polygon, mesh};
use crate::stage::{Stage, depth, draw};
use etalon_frame::TextureFormat;
use etalon_scene::{AttachmentContents, CompareFunction, Draw, Scene, Shader};

/// Samples per texel, which the shader `stochastic` assumes.
const SAMPLES: u32 = 4;

/// Covers a number of samples that follows alpha.
pub(super) fn alpha_to_coverage(glass: &GlassScene, polygons: &[Polygon]) -> Scene {
    let mut glassy = draw(Shader::FlatColor, mesh(glass.size, polygons));
    glassy.multisample.alpha_to_coverage = true;
    resolved(glass, Stage::new(), vec![glassy])
}

/// Draws each sample if its threshold is below alpha. Polygons that overlap have different thresholds.
pub(super) fn stochastic(glass: &GlassScene, polygons: &[Polygon]) -> Scene {
    let mut alphas: Vec<f64> = polygons.iter().map(|p| p.color[3]).collect();
    alphas.sort_by(f64::total_cmp);
    alphas.dedup();
    let mut stage = Stage::new();
    let mut draws = Vec::new();
    for (i, layer) in layers(polygons).iter().enumerate() {
        let contents = AttachmentContents::Texels(thresholds(glass.size, i as u64, &alphas));
        let format = TextureFormat::Rgba8Unorm;
        let texture = stage.attachment(format!("thresholds_{i}"), format, glass.size, 1, contents);
        let mut glassy = draw(Shader::Stochastic, mesh(glass.size, layer));
        glassy.textures = vec![texture];
        draws.push(glassy);
    }
    resolved(glass, stage, draws)
}

/// Draws the glass with depth over the opaque polygons, then takes the mean of the samples.
fn resolved(glass: &GlassScene, mut stage: Stage, mut glassy: Vec<Draw>) -> Scene {
    let picture = stage.color("picture", PICTURE, glass.size, clear(glass));
    let contents = AttachmentContents::Color(clear(glass).map(|c| c as f32));
    let samples = stage.attachment("samples", PICTURE, glass.size, SAMPLES, contents);
    let depth_stencil = depths(&mut stage, glass, SAMPLES);
    for draw in &mut glassy {
        draw.depth = depth(CompareFunction::Less, true);
    }
    let first = opaque(glass, Shader::FlatColor);
    let draws = first.into_iter().chain(glassy).collect();
    stage.resolving_pass(&[samples], vec![Some(picture)], Some(depth_stencil), draws);
    stage.read(&[picture])
}

/// The largest number of polygons that are compared with each other, and the number of groups of more polygons.
const COMPARED: usize = 512;
const GROUPS: usize = 8;

/// Groups polygons by first fit, so that no two in a group overlap. Polygons that do not overlap can share
/// their thresholds. Many polygons take turns between a few groups; one of `GROUPS` pairs that overlap then shares them.
pub(super) fn layers(polygons: &[Polygon]) -> Vec<Vec<Polygon>> {
    if polygons.len() > COMPARED {
        let group = |first: usize| polygons[first..].iter().step_by(GROUPS).cloned().collect();
        return (0..GROUPS).map(group).collect();
    }
    let mut layers: Vec<Vec<Polygon>> = Vec::new();
    for polygon in polygons {
        let free = |layer: &&mut Vec<Polygon>| !layer.iter().any(|other| overlap(polygon, other));
        match layers.iter_mut().find(free) {
            Some(layer) => layer.push(polygon.clone()),
            None => layers.push(vec![polygon.clone()]),
        }
    }
    layers
}

/// Returns true if two convex polygons share a point of the picture: no edge of either separates them.
fn overlap(a: &Polygon, b: &Polygon) -> bool {
    let range = |polygon: &Polygon, [x, y]: [f64; 2]| {
        let along = polygon.corners.iter().map(|c| c[0] * x + c[1] * y);
        along.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), v| {
            (low.min(v), high.max(v))
        })
    };
    let separates = |normal: [f64; 2]| {
        let ((low_a, high_a), (low_b, high_b)) = (range(a, normal), range(b, normal));
        high_a < low_b || high_b < low_a
    };
    let normals = |polygon: &Polygon| {
        let corners = &polygon.corners;
        let next = corners.iter().cycle().skip(1);
        let edges = corners.iter().zip(next);
        edges
            .map(|(p, q)| [p[1] - q[1], q[0] - p[0]])
            .collect::<Vec<_>>()
    };
    !normals(a).into_iter().chain(normals(b)).any(separates)
}

/// Returns a threshold code for each sample of each texel. No code is so close to an alpha that rounding
/// decides, and each is below exactly the alphas that its random number is below.
pub(super) fn thresholds([width, height]: [u32; 2], seed: u64, alphas: &[f64]) -> Vec<u32> {
    let mut noise = Noise::new(seed);
    let count = width * height * SAMPLES;
    let mut threshold = || {
        let number = noise.next();
        let mut code = (number * 255.0).round();
        for alpha in alphas {
            let close = (code / 255.0 - alpha).abs() < 0.1 / 255.0;
            if close || (code / 255.0 < *alpha) != (number < *alpha) {
                let boundary = alpha * 255.0;
                code = if number < *alpha {
                    (boundary - 0.1).floor()
                } else {
                    (boundary + 0.1).ceil()
                };
            }
        }
        code as u32
    };
    (0..count).map(|_| threshold()).collect()
}
