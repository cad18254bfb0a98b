//! Methods of one pass that differ in order and depth.

use super::draws::{
    Ground, PICTURE, clear, copy, depths, ground, opaque, over_premultiplied, premultiplied,
};
use super::scenes::{GlassScene, Object};
use crate::polygon::{Polygon, mesh};
use crate::stage::{Stage, add, both, depth, draw, over};
use etalon_scene::{BlendFactor, BlendState, CompareFunction, Params, Scene, Shader};

/// Returns the polygons of all objects, the farthest object first.
pub(super) fn by_object(glass: &GlassScene) -> Vec<Polygon> {
    let mut objects: Vec<&Object> = glass.objects.iter().collect();
    objects.sort_by(|a, b| b.depth().total_cmp(&a.depth()));
    let polygons = objects.into_iter().flat_map(|o| &o.polygons);
    polygons.cloned().collect()
}

/// Returns the triangles of all objects, the farthest first.
pub(super) fn by_triangle(glass: &GlassScene) -> Vec<Polygon> {
    let mut triangles = Vec::new();
    for polygon in glass.polygons() {
        let corners = &polygon.corners;
        for i in 1..corners.len().saturating_sub(1) {
            let corners = vec![corners[0], corners[i], corners[i + 1]];
            triangles.push(Polygon::new(corners, polygon.color));
        }
    }
    let depth = |t: &Polygon| t.corners.iter().map(|c| c[2]).sum::<f64>();
    triangles.sort_by(|a, b| depth(b).total_cmp(&depth(a)));
    triangles
}

/// Blends the polygons in their order over the opaque ones.
pub(super) fn blended(glass: &GlassScene, polygons: &[Polygon], writes_depth: bool) -> Scene {
    let mut stage = Stage::new();
    let picture = stage.color("picture", PICTURE, glass.size, clear(glass));
    let depth_stencil = depths(&mut stage, glass, 1);
    let mut glassy = draw(Shader::FlatColor, mesh(glass.size, polygons));
    glassy.depth = depth(CompareFunction::Less, writes_depth);
    glassy.targets[0].blend = over();
    let draws = opaque(glass, Shader::FlatColor).into_iter().chain([glassy]);
    stage.pass(&[picture], Some(depth_stencil), draws.collect());
    stage.read(&[picture])
}

/// Draws the polygons with an alpha of at least a half as opaque, and no others.
pub(super) fn alpha_test(glass: &GlassScene, polygons: &[Polygon]) -> Scene {
    let mut stage = Stage::new();
    let picture = stage.color("picture", PICTURE, glass.size, clear(glass));
    let depth_stencil = depths(&mut stage, glass, 1);
    // With no steps of work, the shader only tests alpha.
    let mut tested = draw(Shader::ExpensiveDiscard, mesh(glass.size, polygons));
    tested.params = Params {
        color: [0.0, 0.0, 0.0, 0.5],
        back_color: [0.0; 4],
    };
    tested.depth = depth(CompareFunction::Less, true);
    let draws = opaque(glass, Shader::FlatColor).into_iter().chain([tested]);
    stage.pass(&[picture], Some(depth_stencil), draws.collect());
    stage.read(&[picture])
}

/// Returns the blend state that puts premultiplied colours under the picture, whose alpha is its coverage.
pub(super) fn under() -> Option<BlendState> {
    both(add(BlendFactor::OneMinusDstAlpha, BlendFactor::One))
}

/// Blends objects nearest first, each under those so far, and then all of them over the opaque polygons.
pub(super) fn front_to_back(glass: &GlassScene) -> Scene {
    let mut objects: Vec<&Object> = glass.objects.iter().collect();
    objects.sort_by(|a, b| a.depth().total_cmp(&b.depth()));
    let polygons = objects.into_iter().flat_map(|o| &o.polygons);
    let polygons: Vec<Polygon> = polygons.map(premultiplied).collect();
    let Ground {
        mut stage,
        picture,
        depth_stencil,
    } = ground(glass);
    let front = stage.color("front", PICTURE, glass.size, [0.0; 4]);
    let mut layers = draw(Shader::FlatColor, mesh(glass.size, &polygons));
    layers.depth = depth(CompareFunction::Less, false);
    layers.targets[0].blend = under();
    stage.pass(&[front], Some(depth_stencil), vec![layers]);
    stage.pass(&[picture], None, vec![copy(front, over_premultiplied())]);
    stage.read(&[picture])
}
