//! Bugs of clipping: vertices behind the eye, near its plane, and far beyond the picture.

use crate::list::{CONFUSION, List};
use crate::plant::{Plant, draws};
use etalon_scene::{Draw, PrimitiveTopology, Vertex};

/// True if a vertex does not lie in front of the eye.
fn is_behind(vertex: &Vertex) -> bool {
    vertex.position[3] <= 0.0
}

/// True if a vertex lies outside of the view volume.
fn is_outside(vertex: &Vertex) -> bool {
    let [x, y, z, w] = vertex.position;
    is_behind(vertex) || x.abs() > w || y.abs() > w || z < 0.0 || z > w
}

/// True if a vertex lies before the near or beyond the far plane, and not behind the eye.
fn is_beyond_planes(vertex: &Vertex) -> bool {
    let [.., z, w] = vertex.position;
    w > 0.0 && (z < 0.0 || z > w)
}

/// Changes the triangles without indices of which a vertex is of a kind.
fn triangles(which: fn(&Vertex) -> bool, bug: fn(&mut [Vertex])) -> Plant {
    draws(move |draw| {
        if draw.topology == PrimitiveTopology::TriangleList && draw.mesh.indices.is_none() {
            let all = draw.mesh.vertices.chunks_mut(3);
            all.filter(|t| t.iter().any(which)).for_each(bug);
        }
    })
}

/// Draws nothing of a primitive.
fn lose(vertices: &mut [Vertex]) {
    let first = vertices[0];
    vertices.fill(first);
}

/// Moves vertices in front of the eye, whose places are given in texels from the middle of the viewport.
fn places(draw: &mut Draw, moved: fn(f32) -> f32) {
    let [_, _, width, height] = draw.viewport.rect.map(|v| v / 2.0);
    for vertex in &mut draw.mesh.vertices {
        let [x, y, _, w] = &mut vertex.position;
        if *w > 0.0 {
            *x = moved(*x / *w * width) / width * *w;
            *y = moved(*y / *w * height) / height * *w;
        }
    }
}

/// Divides vertices behind the eye by their w.
fn mirrored(draw: &mut Draw) {
    let all = draw.mesh.vertices.iter_mut();
    let behind = all.filter(|v| v.position[3] < 0.0);
    behind.for_each(|v| v.position = v.position.map(|p| p / v.position[3]));
}

pub(super) fn add(list: &mut List) {
    list.class("clipping", "cull");
    eye(list);
    planes(list);
    far(list);
}

fn eye(list: &mut List) {
    list.bug("mirrored: Vertices behind the eye are drawn where the division by w puts them.")
        .draws(mirrored);
    list.bug("behind-lost: A triangle with a vertex behind the eye is lost whole.")
        .plant(triangles(is_behind, lose));
    list.bug("directions-lost: A triangle with a vertex of w 0 is lost.")
        .source("SwiftShader until 2021: triangles near w 0 culled")
        .plant(triangles(|v| v.position[3] == 0.0, lose));
    list.bug("tiny-lost: A triangle with a vertex of tiny w is lost.")
        .source("SwiftShader until 2021: triangles near w 0 culled")
        .plant(triangles(|v| v.position[3].abs() < 1e-3, lose));
    list.bug("huge-lost: A triangle with a vertex of huge w is lost.")
        .plant(triangles(|v| v.position[3].abs() > 1e3, lose));
    list.bug("absolute-w: The sign of w is lost.")
        .draws(|draw| {
            let all = draw.mesh.vertices.iter_mut();
            all.for_each(|v| v.position[3] = v.position[3].abs());
        });
    list.bug("behind-held: Vertices behind the eye are held to a small w.")
        .draws(|draw| {
            let behind = draw.mesh.vertices.iter_mut().filter(|v| is_behind(v));
            behind.for_each(|v| v.position[3] = 1e-3);
        });
    list.bug("turned: A triangle that reaches behind the eye faces the other way.")
        .plant(triangles(is_behind, |t| t.swap(1, 2)));
    list.bug("not-divided: x and y are not divided by w.")
        .draws(|draw| {
            for v in draw.mesh.vertices.iter_mut().filter(|v| !is_behind(v)) {
                let [x, y, _, w] = v.position;
                (v.position[0], v.position[1]) = (x * w, y * w);
            }
        });
    list.bug("depth-not-divided: Depths are not divided by w.")
        .draws(|draw| {
            for v in draw.mesh.vertices.iter_mut().filter(|v| !is_behind(v)) {
                v.position[2] *= v.position[3];
            }
        });
}

fn planes(list: &mut List) {
    list.bug("planes-ignored: Where w is not 1, the near and far planes clip nothing.")
        .when(|draw| draw.mesh.vertices.iter().any(|v| v.position[3] != 1.0))
        .draws(|draw| draw.depth_clamp = true);
    list.bug("behind-the-clamp: With depth clamped, nothing behind the eye is clipped.")
        .when(|draw| draw.depth_clamp)
        .draws(mirrored);
    list.bug("cut-lost: A triangle that the near or far plane cuts is lost whole.")
        .plant(triangles(is_beyond_planes, lose));
    list.bug("cut-turned: A triangle that the near or far plane cuts faces the other way.")
        .plant(triangles(is_beyond_planes, |t| t.swap(1, 2)));
    list.bug("cut-whole: A triangle that the near or far plane cuts is drawn whole.")
        .plant(triangles(is_beyond_planes, |t| {
            for v in t.iter_mut() {
                v.position[2] = v.position[2].clamp(0.0, v.position[3].max(0.0));
            }
        }));
    list.bug("flat-of-the-cut: A clipped triangle has the colour of its second vertex.")
        .source("a clipped triangle whose new vertices provoke")
        .plant(triangles(is_outside, |t| {
            let color = t.get(1).map_or([0.0; 4], |v| v.color);
            t.iter_mut().for_each(|v| v.color = color);
        }));
    list.bug("slope-lost: The slope of a clipped triangle biases nothing.")
        .when(|draw| draw.mesh.vertices.iter().any(is_outside))
        .draws(|draw| draw.depth_bias.slope = 0.0);
    list.bug("slope-of-the-piece: The slope of a clipped triangle counts twice.")
        .when(|draw| draw.mesh.vertices.iter().any(is_outside))
        .draws(|draw| draw.depth_bias.slope *= 2.0);
    list.bug("lines-whole: Lines are drawn to ends that the near and far planes clip.")
        .when(|draw| draw.topology == PrimitiveTopology::LineList)
        .draws(|draw| draw.depth_clamp = true);
    list.bug("points-before-near: Points before the near and beyond the far plane are drawn.")
        .when(|draw| draw.topology == PrimitiveTopology::PointList)
        .draws(|draw| draw.depth_clamp = true);
}

fn far(list: &mut List) {
    list.source("guard bands of 16-bit positions");
    list.bug("wraps: Places wrap around at 32,768 texels.")
        .draws(|draw| places(draw, |v| (v + 32768.0).rem_euclid(65536.0) - 32768.0));
    list.bug("held: Places are held to 32,767 texels.")
        .draws(|draw| places(draw, |v| v.clamp(-32767.0, 32767.0)));
    list.source(CONFUSION);
    list.bug("far-lost: A triangle with a vertex beyond 60,000 texels is lost.")
        .draws(|draw| {
            let half = draw.viewport.rect[2] / 2.0;
            let far = |v: &Vertex| (v.position[0] / v.position[3] * half).abs() > 60_000.0;
            if draw.topology == PrimitiveTopology::TriangleList && draw.mesh.indices.is_none() {
                let all = draw.mesh.vertices.chunks_mut(3);
                all.filter(|t| t.iter().any(far)).for_each(lose);
            }
        });
    list.bug("far-turned: A triangle with a vertex beyond 2,000 texels faces the other way.")
        .draws(|draw| {
            let half = draw.viewport.rect[2] / 2.0;
            let far = |v: &Vertex| (v.position[0] / v.position[3] * half).abs() > 2000.0;
            if draw.topology == PrimitiveTopology::TriangleList && draw.mesh.indices.is_none() {
                let all = draw.mesh.vertices.chunks_mut(3);
                all.filter(|t| t.iter().any(far)).for_each(|t| t.reverse());
            }
        });
}
