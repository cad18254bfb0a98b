//! Outlines: each object is drawn into the stencil, then drawn again, larger, outside its stencil area.

use super::shown::{ShownEffect, except, mark, opaque};
use crate::grid::settle;
use crate::polygon::Polygon;
use crate::stage::{self, SIZE};
use etalon_scene::CompareFunction;
use glam::DVec2;
use schemars::JsonSchema;
use serde::Deserialize;

/// Which objects have an outline of their own.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, JsonSchema)]
pub enum OutlineMethod {
    /// One outline around all objects, which share a stencil value.
    #[serde(rename = "outline-merged")]
    Merged,
    /// An outline around each object, even in front of another object: each object has its own stencil
    /// value, and its outline has the object's depth.
    #[serde(rename = "outline-separate")]
    Separate,
}

/// Returns convex shapes with their depth and colour, clockwise in texels with y down, back to front.
fn objects() -> [(Vec<DVec2>, f64, [f64; 4]); 3] {
    let shape = |corners: &[[f64; 2]]| corners.iter().map(|c| DVec2::from(*c)).collect();
    let hexagon = shape(&[
        [31.0, 30.0],
        [59.0, 27.0],
        [76.0, 50.0],
        [64.0, 78.0],
        [36.0, 80.0],
        [20.0, 56.0],
    ]);
    let slab = shape(&[[52.0, 46.0], [104.0, 60.0], [98.0, 88.0], [46.0, 74.0]]);
    let triangle = shape(&[[80.0, 40.0], [106.0, 102.0], [58.0, 98.0]]);
    [
        (hexagon, 0.7, [0.85, 0.4, 0.3, 1.0]),
        (slab, 0.5, [0.35, 0.65, 0.4, 1.0]),
        (triangle, 0.3, [0.4, 0.5, 0.9, 1.0]),
    ]
}

/// Returns the convex shape with each edge moved outwards.
fn larger(corners: &[DVec2], by: f64) -> Vec<DVec2> {
    let count = corners.len();
    // The outward normal of an edge, for a clockwise shape with y down.
    let normal = |i: usize| {
        let along = (corners[(i + 1) % count] - corners[i]).normalize();
        DVec2::new(along.y, -along.x)
    };
    let corner = |i: usize| {
        let [m, n] = [normal((i + count - 1) % count), normal(i)];
        // The point that is `by` outside both edges.
        corners[i] + (m + n) * (by / (1.0 + m.dot(n)))
    };
    (0..count).map(corner).collect()
}

fn polygon(corners: &[DVec2], depth: f64, color: [f64; 4]) -> Vec<Polygon> {
    // Counter-clockwise: front faces.
    let corners = corners.iter().rev().map(|c| [c.x, c.y, depth]);
    settle(SIZE, &[Polygon::new(corners.collect(), color)])
}

pub(super) fn show(method: OutlineMethod, width: f64) -> ShownEffect {
    let outline = [1.0, 0.95, 0.8, 1.0];
    let mut draws = Vec::new();
    let mut outlines = Vec::new();
    let mut surfaces = Vec::new();
    for (i, (corners, depth, color)) in objects().into_iter().enumerate() {
        let separate = method == OutlineMethod::Separate;
        let reference = if separate { i as u8 + 1 } else { 1 };
        let object = polygon(&corners, depth, color);
        let mut draw = opaque(&object);
        draw.stencil = mark(reference);
        draws.push(draw);
        // A shared outline is behind all objects.
        let behind = if separate { depth } else { 0.9 };
        let around = polygon(&larger(&corners, width), behind, outline);
        let mut draw = opaque(&around);
        draw.stencil = except(reference);
        draw.depth = if separate {
            stage::depth(CompareFunction::LessEqual, true)
        } else {
            None
        };
        outlines.push(draw);
        // At equal depths, the later surface is in front.
        surfaces.extend(around.iter().chain(&object).map(Polygon::surface));
    }
    draws.extend(outlines);
    ShownEffect {
        background: [0.16, 0.18, 0.24],
        draws,
        surfaces,
    }
}
