//! Bugs of clip distances.

use super::list::{CONFUSION, List, Row};
use super::plant::{Plant, draws, from_draw};
use etalon_scene::{Draw, PrimitiveTopology, Shader, Vertex};

/// Changes the vertices of the draws that have clip distances.
fn vertices(bug: fn(&mut Vertex)) -> Plant {
    draws(move |draw| {
        if draw.shader.clip_distances() > 0 {
            draw.mesh.vertices.iter_mut().for_each(bug);
        }
    })
}

/// Makes all distances of a vertex positive where the shader has two.
fn unclipped(draw: &mut Draw) {
    if draw.shader == Shader::ClipFlat {
        draw.mesh.vertices.iter_mut().for_each(|v| v.uv = [1.0; 2]);
    }
    draw.clip_distances = 0;
}

pub(super) fn add(list: &mut List) {
    use PrimitiveTopology as T;
    list.class("clip-distance", "scissor");
    let rows: [Row<fn(&mut Draw)>; 15] = [
        ("ignored", "Nothing is clipped by distances.", |draw| {
            draw.clip_distances = 0
        }),
        (
            "first-only",
            "Distances beyond the first do not clip.",
            |draw| draw.clip_distances &= 1,
        ),
        (
            "first-four-only",
            "Distances beyond the fourth do not clip.",
            |draw| draw.clip_distances &= 0xf,
        ),
        (
            "first-six-only",
            "Distances beyond the sixth do not clip.",
            |draw| draw.clip_distances &= 0x3f,
        ),
        (
            "last-ignored",
            "The eighth distance does not clip.",
            |draw| draw.clip_distances &= 0x7f,
        ),
        (
            "enables-ignored",
            "Distances that are switched off clip.",
            |draw| draw.clip_distances = u8::MAX,
        ),
        (
            "enables-reversed",
            "Distances are switched on in the opposite order.",
            |draw| {
                if draw.clip_distances != u8::MAX {
                    draw.clip_distances = draw.clip_distances.reverse_bits();
                }
            },
        ),
        (
            "enables-shifted",
            "Each distance is switched on with its neighbour.",
            |draw| draw.clip_distances = draw.clip_distances.rotate_left(1),
        ),
        (
            "enables-as-a-count",
            "The lowest distances clip, as many as are switched on.",
            |draw| {
                let count = draw.clip_distances.count_ones();
                draw.clip_distances = ((1_u32 << count) - 1) as u8;
            },
        ),
        ("points-not-clipped", "Points are not clipped.", |draw| {
            if draw.topology == T::PointList {
                unclipped(draw);
            }
        }),
        ("lines-not-clipped", "Lines are not clipped.", |draw| {
            if draw.topology == T::LineList {
                unclipped(draw);
            }
        }),
        (
            "triangles-whole-or-not",
            "A triangle is dropped whole if one of its vertices is clipped.",
            |draw| {
                if draw.shader == Shader::ClipFlat && draw.topology == T::TriangleList {
                    for own in draw.mesh.vertices.chunks_mut(3) {
                        if own.iter().any(|v| v.uv[0] < 0.0 || v.uv[1] < 0.0) {
                            own.iter_mut().for_each(|v| v.uv = [-1.0; 2]);
                        }
                    }
                }
            },
        ),
        (
            "only-whole-triangles",
            "Only triangles that lie wholly behind a plane are clipped.",
            |draw| {
                if draw.shader == Shader::ClipFlat && draw.topology == T::TriangleList {
                    for own in draw.mesh.vertices.chunks_mut(3) {
                        let out = [0, 1].map(|n| own.iter().all(|v| v.uv[n] < 0.0));
                        let uv = if out.contains(&true) { -1.0 } else { 1.0 };
                        own.iter_mut().for_each(|v| v.uv = [uv; 2]);
                    }
                }
            },
        ),
        (
            "clipped-colour-of-another-vertex",
            "A clipped triangle has the flat colour of its second vertex.",
            |draw| {
                if draw.shader == Shader::ClipFlat && draw.topology == T::TriangleList {
                    for own in draw.mesh.vertices.chunks_mut(3) {
                        if own.iter().any(|v| v.uv[0] < 0.0 || v.uv[1] < 0.0) {
                            let color = own.get(1).map_or([0.0; 4], |v| v.color);
                            own.iter_mut().for_each(|v| v.color = color);
                        }
                    }
                }
            },
        ),
        (
            "ignored-with-a-depth-test",
            "Draws with a depth test are not clipped.",
            |draw| {
                if draw.depth.is_some() {
                    unclipped(draw);
                }
            },
        ),
    ];
    list.rows(CONFUSION, draws, &rows);
    let rows: [Row<fn(&mut Vertex)>; 6] = [
        ("zero-is-outside", "A distance of 0 is outside.", |v| {
            for value in v.uv.iter_mut().filter(|c| **c == 0.0) {
                *value = -1.0;
            }
        }),
        (
            "sign-inverted",
            "The other side of the planes is clipped.",
            |v| v.uv = v.uv.map(|c| -c),
        ),
        (
            "first-two-exchanged",
            "The first two distances are exchanged.",
            |v| v.color.swap(0, 1),
        ),
        (
            "of-the-second-slot-exchanged",
            "The fifth and the sixth distance are exchanged.",
            |v| v.uv.swap(0, 1),
        ),
        (
            "slots-exchanged",
            "The first and the fifth distance are exchanged.",
            |v| std::mem::swap(&mut v.color[0], &mut v.uv[0]),
        ),
        ("rounded", "Distances are rounded to multiples of 4.", |v| {
            let rough = |c: f32| (c / 4.0).round() * 4.0;
            v.uv = v.uv.map(rough);
            let [r, g, b, a] = v.color;
            v.color = [rough(r), rough(g), rough(b), rough(a)];
        }),
    ];
    list.rows(CONFUSION, vertices, &rows);
    list.add(
        "kept-from-the-draw-before",
        CONFUSION,
        "The distances that the draw before switched on hold.",
        from_draw(|before, draw| draw.clip_distances = before.clip_distances),
    );
}
