//! Bugs of clipping: vertices behind or near the eye, and vertices far outside the picture.

use crate::fields::VERTICES;
use crate::list::{CONFUSION, bugs};
use crate::permission::under;
use crate::plant::{Plant, draws, each};
use etalon_scene::{Draw, PrimitiveTopology, Vertex};

/// Returns true if a vertex is not in front of the eye.
fn is_behind(vertex: &Vertex) -> bool {
    vertex.position[3] <= 0.0
}

/// Returns true if a vertex is outside the view volume.
fn is_outside(vertex: &Vertex) -> bool {
    let [x, y, z, w] = vertex.position;
    is_behind(vertex) || x.abs() > w || y.abs() > w || z < 0.0 || z > w
}

/// Returns true if a vertex is in front of the near plane or beyond the far plane, but not behind the eye.
fn is_beyond_planes(vertex: &Vertex) -> bool {
    let [.., z, w] = vertex.position;
    w > 0.0 && (z < 0.0 || z > w)
}

/// Changes the triangles without indices that have a vertex for which `which` is true.
fn triangles(which: fn(&Vertex) -> bool, bug: fn(&mut [Vertex])) -> Plant {
    draws(move |draw| change(draw, which, bug))
}

/// Changes the triangles without indices that have a vertex farther from the viewport's middle than this
/// many texels.
fn far(texels: f32, bug: fn(&mut [Vertex])) -> Plant {
    draws(move |draw| {
        let half = draw.viewport.rect[2] / 2.0;
        change(
            draw,
            |v| (v.position[0] / v.position[3] * half).abs() > texels,
            bug,
        );
    })
}

fn change(draw: &mut Draw, which: impl Fn(&Vertex) -> bool, bug: fn(&mut [Vertex])) {
    if draw.topology == PrimitiveTopology::TriangleList && draw.mesh.indices.is_none() {
        let triangles = draw.mesh.vertices.chunks_exact_mut(3);
        triangles.filter(|t| t.iter().any(&which)).for_each(bug);
    }
}

/// Makes a primitive degenerate, so that nothing is drawn.
fn lose(vertices: &mut [Vertex]) {
    let first = vertices[0];
    vertices.fill(first);
}

/// Moves vertices in front of the eye, given their positions in texels from the middle of the viewport.
fn places(moved: fn(f32) -> f32) -> Plant {
    draws(move |draw| {
        let [_, _, width, height] = draw.viewport.rect.map(|v| v / 2.0);
        for [x, y, _, w] in draw.mesh.vertices.iter_mut().map(|v| &mut v.position) {
            if *w > 0.0 {
                *x = moved(*x / *w * width) / width * *w;
                *y = moved(*y / *w * height) / height * *w;
            }
        }
    })
}

/// Divides the position of a vertex behind the eye by its w.
fn mirrored(vertex: &mut Vertex) {
    let w = vertex.position[3];
    if w < 0.0 {
        vertex.position = vertex.position.map(|p| p / w);
    }
}

bugs! {
    class "clipping", "cull";
    "mirrored: Vertices behind the eye are drawn where the division by w puts them." => each(VERTICES, mirrored);
    "behind-lost: A triangle with a vertex behind the eye is lost whole." => triangles(is_behind, lose);
    "directions-lost: A triangle with a vertex of w 0 is lost." =>
        triangles(|v| v.position[3] == 0.0, lose), source "SwiftShader until 2021: triangles near w 0 culled";
    "tiny-lost: A triangle with a vertex of tiny w is lost." =>
        triangles(|v| v.position[3].abs() < 1e-3, lose), source "SwiftShader until 2021: triangles near w 0 culled";
    "huge-lost: A triangle with a vertex of huge w is lost." => triangles(|v| v.position[3].abs() > 1e3, lose);
    "absolute-w: The sign of w is lost." => each(VERTICES, |v| v.position[3] = v.position[3].abs());
    "behind-held: Vertices behind the eye are held to a small w." =>
        each(VERTICES, |v| if is_behind(v) { v.position[3] = 1e-3 });
    "turned: A triangle that reaches behind the eye faces the other way." => triangles(is_behind, |t| t.swap(1, 2));
    "not-divided: x and y are not divided by w." =>
        each(VERTICES, |v| if !is_behind(v) {
            let [x, y, z, w] = v.position;
            v.position = [x * w, y * w, z, w];
        });
    "depth-not-divided: Depths are not divided by w." =>
        each(VERTICES, |v| if !is_behind(v) { v.position[2] *= v.position[3] });
    "planes-ignored: Where w is not 1, the near and far planes clip nothing." =>
        draws(|draw| draw.depth_clamp = true), when |draw| draw.mesh.vertices.iter().any(|v| v.position[3] != 1.0);
    "behind-the-clamp: With depth clamped, nothing behind the eye is clipped." =>
        each(VERTICES, mirrored), when |draw| draw.depth_clamp;
    "cut-lost: A triangle that the near or far plane cuts is lost whole." => triangles(is_beyond_planes, lose);
    "cut-turned: A triangle that the near or far plane cuts faces the other way." =>
        triangles(is_beyond_planes, |t| t.swap(1, 2));
    "cut-whole: A triangle that the near or far plane cuts is drawn whole." =>
        triangles(is_beyond_planes, |t| {
            for v in t.iter_mut() { v.position[2] = v.position[2].clamp(0.0, v.position[3].max(0.0)); }
        });
    "flat-of-the-cut: A clipped triangle has the colour of its second vertex." =>
        triangles(is_outside, |t| {
            let color = t.get(1).map_or([0.0; 4], |v| v.color);
            t.iter_mut().for_each(|v| v.color = color);
        }), source "a clipped triangle whose new vertices provoke";
    "slope-lost: The slope of a clipped triangle biases nothing." =>
        draws(|draw| draw.depth_bias.slope = 0.0), when |draw| draw.mesh.vertices.iter().any(is_outside);
    "slope-of-the-piece: The slope of a clipped triangle counts twice." =>
        draws(|draw| draw.depth_bias.slope *= 2.0), when |draw| draw.mesh.vertices.iter().any(is_outside);
    "lines-whole: Lines are drawn to ends that the near and far planes clip." =>
        draws(|draw| draw.depth_clamp = true), when |draw| draw.topology == PrimitiveTopology::LineList, permitted vec![under!(clips_lines_by_depth: false)];
    "points-before-near: Points before the near and beyond the far plane are drawn." =>
        draws(|draw| draw.depth_clamp = true), when |draw| draw.topology == PrimitiveTopology::PointList, permitted vec![under!(clips_points: false)];
    source "guard bands of 16-bit positions";
    "wraps: Places wrap around at 32,768 texels." =>
        places(|v| (v + 32768.0).rem_euclid(65536.0) - 32768.0);
    "held: Places are held to 32,767 texels." => places(|v| v.clamp(-32767.0, 32767.0));
    source CONFUSION;
    "far-lost: A triangle with a vertex beyond 60,000 texels is lost." => far(60_000.0, lose);
    "far-turned: A triangle with a vertex beyond 2,000 texels faces the other way." => far(2000.0, |t| t.reverse());
}
