//! Bugs of clip distances.

use crate::list::List;
use crate::plant::{Plant, draws, from_draw};
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

    list.bug("ignored: Nothing is clipped by distances.")
        .draws(|draw| draw.clip_distances = 0);
    list.bug("first-only: Distances beyond the first do not clip.")
        .draws(|draw| draw.clip_distances &= 1);
    list.bug("first-four-only: Distances beyond the fourth do not clip.")
        .draws(|draw| draw.clip_distances &= 0xf);
    list.bug("first-six-only: Distances beyond the sixth do not clip.")
        .draws(|draw| draw.clip_distances &= 0x3f);
    list.bug("last-ignored: The eighth distance does not clip.")
        .draws(|draw| draw.clip_distances &= 0x7f);
    list.bug("enables-ignored: Distances that are switched off clip.")
        .draws(|draw| draw.clip_distances = u8::MAX);
    list.bug("enables-reversed: Distances are switched on in the opposite order.")
        .when(|draw| draw.clip_distances != u8::MAX)
        .draws(|draw| draw.clip_distances = draw.clip_distances.reverse_bits());
    list.bug("enables-shifted: Each distance is switched on with its neighbour.")
        .draws(|draw| draw.clip_distances = draw.clip_distances.rotate_left(1));
    list.bug("enables-as-a-count: The lowest distances clip, as many as are switched on.")
        .draws(|draw| {
            let count = draw.clip_distances.count_ones();
            draw.clip_distances = ((1_u32 << count) - 1) as u8;
        });
    list.bug("points-not-clipped: Points are not clipped.")
        .when(|draw| draw.topology == T::PointList)
        .draws(|draw| {
            unclipped(draw);
        });
    list.bug("lines-not-clipped: Lines are not clipped.")
        .when(|draw| draw.topology == T::LineList)
        .draws(|draw| {
            unclipped(draw);
        });
    list.bug("triangles-whole-or-not: A triangle is dropped whole if a vertex is clipped.")
        .when(|draw| draw.shader == Shader::ClipFlat && draw.topology == T::TriangleList)
        .draws(|draw| {
            for own in draw.mesh.vertices.chunks_mut(3) {
                if own.iter().any(|v| v.uv[0] < 0.0 || v.uv[1] < 0.0) {
                    own.iter_mut().for_each(|v| v.uv = [-1.0; 2]);
                }
            }
        });
    list.bug("only-whole-triangles: Only triangles that lie wholly behind a plane are clipped.")
        .when(|draw| draw.shader == Shader::ClipFlat && draw.topology == T::TriangleList)
        .draws(|draw| {
            for own in draw.mesh.vertices.chunks_mut(3) {
                let out = [0, 1].map(|n| own.iter().all(|v| v.uv[n] < 0.0));
                let uv = if out.contains(&true) { -1.0 } else { 1.0 };
                own.iter_mut().for_each(|v| v.uv = [uv; 2]);
            }
        });
    list.bug(
        "clipped-colour-of-another-vertex: A clipped triangle has its second vertex's colour.",
    )
    .when(|draw| draw.shader == Shader::ClipFlat && draw.topology == T::TriangleList)
    .draws(|draw| {
        for own in draw.mesh.vertices.chunks_mut(3) {
            if own.iter().any(|v| v.uv[0] < 0.0 || v.uv[1] < 0.0) {
                let color = own.get(1).map_or([0.0; 4], |v| v.color);
                own.iter_mut().for_each(|v| v.color = color);
            }
        }
    });
    list.bug("ignored-with-a-depth-test: Draws with a depth test are not clipped.")
        .when(|draw| draw.depth.is_some())
        .draws(|draw| {
            unclipped(draw);
        });

    list.bug("zero-is-outside: A distance of 0 is outside.")
        .plant(vertices(|v| {
            for value in v.uv.iter_mut().filter(|c| **c == 0.0) {
                *value = -1.0;
            }
        }));
    list.bug("sign-inverted: The other side of the planes is clipped.")
        .plant(vertices(|v| v.uv = v.uv.map(|c| -c)));
    list.bug("first-two-exchanged: The first two distances are exchanged.")
        .plant(vertices(|v| v.color.swap(0, 1)));
    list.bug("of-the-second-slot-exchanged: The fifth and the sixth distance are exchanged.")
        .plant(vertices(|v| v.uv.swap(0, 1)));
    list.bug("slots-exchanged: The first and the fifth distance are exchanged.")
        .plant(vertices(|v| std::mem::swap(&mut v.color[0], &mut v.uv[0])));
    list.bug("rounded: Distances are rounded to multiples of 4.")
        .plant(vertices(|v| {
            let rough = |c: f32| (c / 4.0).round() * 4.0;
            v.uv = v.uv.map(rough);
            let [r, g, b, a] = v.color;
            v.color = [rough(r), rough(g), rough(b), rough(a)];
        }));
    list.bug("kept-from-the-draw-before: The distances that the draw before switched on hold.")
        .plant(from_draw(|before, draw| {
            draw.clip_distances = before.clip_distances
        }));
}
