//! Methods of one pass that differ in order and depth.

use super::draws::{PICTURE, clear, depths, opaque, premultiplied};
use super::scenes::{GlassScene, Object};
use crate::polygon::{Polygon, mesh};
use crate::stage::{SIZE, Stage, add, both, depth, draw, over};
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
    let picture = stage.color("picture", PICTURE, SIZE, clear(glass));
    let depth_stencil = depths(&mut stage, 1);
    let mut glassy = draw(Shader::FlatColor, mesh(SIZE, polygons));
    glassy.depth = depth(CompareFunction::Less, writes_depth);
    glassy.targets[0].blend = over();
    let draws = opaque(glass, Shader::FlatColor).into_iter().chain([glassy]);
    stage.pass(&[picture], Some(depth_stencil), draws.collect());
    stage.read(&[picture])
}

/// Draws the polygons with an alpha of at least a half as opaque, and no others.
pub(super) fn alpha_test(glass: &GlassScene, polygons: &[Polygon]) -> Scene {
    let mut stage = Stage::new();
    let picture = stage.color("picture", PICTURE, SIZE, clear(glass));
    let depth_stencil = depths(&mut stage, 1);
    // With no steps of work, the shader only tests alpha.
    let mut tested = draw(Shader::ExpensiveDiscard, mesh(SIZE, polygons));
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

/// Returns the opaque polygons and the background, nearest first, to be drawn under the glass.
pub(super) fn behind(glass: &GlassScene) -> Vec<Polygon> {
    let mut polygons = glass.opaque.clone();
    polygons.sort_by(|a, b| a.corners[0][2].total_cmp(&b.corners[0][2]));
    let everywhere = [0.0, 0.0, f64::from(SIZE[0]), f64::from(SIZE[1])];
    polygons.push(Polygon::rect(everywhere, 1.0, clear(glass)));
    polygons
}

/// Blends objects nearest first. This needs no depth, since nothing shows through opaque polygons.
pub(super) fn front_to_back(glass: &GlassScene) -> Scene {
    let mut objects = glass.objects.clone();
    objects.extend(behind(glass).into_iter().map(|polygon| Object {
        polygons: vec![polygon],
    }));
    objects.sort_by(|a, b| a.depth().total_cmp(&b.depth()));
    let polygons = objects.iter().flat_map(|o| &o.polygons);
    let polygons: Vec<Polygon> = polygons.map(premultiplied).collect();
    let mut stage = Stage::new();
    let picture = stage.color("picture", PICTURE, SIZE, [0.0; 4]);
    let mut layers = draw(Shader::FlatColor, mesh(SIZE, &polygons));
    layers.targets[0].blend = under();
    stage.pass(&[picture], None, vec![layers]);
    stage.read(&[picture])
}
