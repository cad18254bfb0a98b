//! Bugs of clip distances.

use crate::fields::FieldPlaces;
use crate::list::bugs;
use crate::permission::under;
use crate::plant::{Plant, draws, each, from_draw, set};
use PrimitiveTopology as T;
use etalon_scene::{Draw, PrimitiveTopology, Shader, Vertex};

/// The vertices of draws that have clip distances.
const VERTICES: FieldPlaces<Vertex> = |d| {
    let clips = d.shader.clip_distances() > 0;
    d.mesh.vertices.iter_mut().filter(|_| clips).collect()
};

/// The bits that enable clip distances.
const ENABLES: FieldPlaces<u8> = |d| vec![&mut d.clip_distances];

/// Disables clipping. If the shader has two distances, they become positive.
fn unclipped(draw: &mut Draw) {
    if draw.shader == Shader::ClipFlat {
        draw.mesh.vertices.iter_mut().for_each(|v| v.uv = [1.0; 2]);
    }
    draw.clip_distances = 0;
}

/// Changes each triangle of a list whose shader has two distances.
fn triangles(bug: fn(&mut [Vertex])) -> Plant {
    draws(move |draw| {
        let triangles = draw.topology == PrimitiveTopology::TriangleList;
        if triangles && draw.shader == Shader::ClipFlat {
            draw.mesh.vertices.chunks_exact_mut(3).for_each(bug);
        }
    })
}

fn is_cut(triangle: &[Vertex]) -> bool {
    triangle.iter().any(|v| v.uv[0] < 0.0 || v.uv[1] < 0.0)
}

bugs! {
    class "clip-distance", "scissor";
    "ignored: Nothing is clipped by distances." => set(ENABLES, 0);
    "first-only: Distances beyond the first do not clip." => each(ENABLES, |bits| *bits &= 1);
    "first-four-only: Distances beyond the fourth do not clip." => each(ENABLES, |bits| *bits &= 0xf);
    "first-six-only: Distances beyond the sixth do not clip." => each(ENABLES, |bits| *bits &= 0x3f);
    "last-ignored: The eighth distance does not clip." => each(ENABLES, |bits| *bits &= 0x7f);
    "enables-ignored: Distances that are switched off clip." => set(ENABLES, u8::MAX);
    "enables-reversed: Distances are switched on in the opposite order." =>
        each(ENABLES, |bits| *bits = bits.reverse_bits()), when |draw| draw.clip_distances != u8::MAX;
    "enables-shifted: Each distance is switched on with its neighbour." =>
        each(ENABLES, |bits| *bits = bits.rotate_left(1));
    "enables-as-a-count: The lowest distances clip, as many as are switched on." =>
        each(ENABLES, |bits| *bits = ((1_u32 << bits.count_ones()) - 1) as u8);
    "points-not-clipped: Points are not clipped." => draws(unclipped), when |draw| draw.topology == T::PointList;
    "lines-not-clipped: Lines are not clipped." => draws(unclipped), when |draw| draw.topology == T::LineList, permitted vec![under!(clips_lines_by_distance: false)];
    "triangles-whole-or-not: A triangle is dropped whole if a vertex is clipped." =>
        triangles(|triangle| { if is_cut(triangle) { triangle.iter_mut().for_each(|v| v.uv = [-1.0; 2]); } });
    "only-whole-triangles: Only triangles that lie wholly behind a plane are clipped." =>
        triangles(|triangle| {
            let out = [0, 1].map(|n| triangle.iter().all(|v| v.uv[n] < 0.0));
            let uv = if out.contains(&true) { -1.0 } else { 1.0 };
            triangle.iter_mut().for_each(|v| v.uv = [uv; 2]);
        });
    "clipped-colour-of-another-vertex: A clipped triangle has its second vertex's colour." =>
        triangles(|triangle| {
            if is_cut(triangle) {
                let color = triangle.get(1).map_or([0.0; 4], |v| v.color);
                triangle.iter_mut().for_each(|v| v.color = color);
            }
        });
    "ignored-with-a-depth-test: Draws with a depth test are not clipped." =>
        draws(unclipped), when |draw| draw.depth.is_some();
    "zero-is-outside: A distance of 0 is outside." =>
        each(VERTICES, |v| v.uv = v.uv.map(|c| if c == 0.0 { -1.0 } else { c }));
    "sign-inverted: The other side of the planes is clipped." => each(VERTICES, |v| v.uv = v.uv.map(|c| -c));
    "first-two-exchanged: The first two distances are exchanged." => each(VERTICES, |v| v.color.swap(0, 1));
    "of-the-second-slot-exchanged: The fifth and the sixth distance are exchanged." =>
        each(VERTICES, |v| v.uv.swap(0, 1));
    "slots-exchanged: The first and the fifth distance are exchanged." =>
        each(VERTICES, |v| std::mem::swap(&mut v.color[0], &mut v.uv[0]));
    "rounded: Distances are rounded to multiples of 4." =>
        each(VERTICES, |v| {
            let rough = |c: f32| (c / 4.0).round() * 4.0;
            (v.uv, v.color) = (v.uv.map(rough), v.color.map(rough));
        });
    "kept-from-the-draw-before: The distances that the draw before switched on hold." =>
        from_draw(|before, draw| draw.clip_distances = before.clip_distances);
}
