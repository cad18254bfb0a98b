//! Bugs of the vertex that provides the flat attributes of a primitive.

use crate::list::bugs;
use crate::plant::{draws, from_draw};
use PrimitiveTopology as T;
use etalon_scene::{Draw, PrimitiveTopology, ProvokingVertex, RESTART};

fn is(draw: &Draw, topology: PrimitiveTopology) -> bool {
    draw.topology == topology
}

/// Returns true if any vertex of a draw is outside the viewport.
fn is_clipped(draw: &Draw) -> bool {
    let outside = |v: f32| !(-1.0..=1.0).contains(&v);
    let mut vertices = draw.mesh.vertices.iter();
    vertices.any(|v| outside(v.position[0]) || outside(v.position[1]))
}

bugs! {
    class "provoking", "cull";
    let conventions = ProvokingVertex::ALL;
    for vertex in conventions {
        "always-the-{vertex}: The {vertex} vertex provokes, whatever is asked for." =>
            draws(|draw| draw.provoking = Some(*vertex)), when |draw| draw.provoking.is_some();
    }
    for (name, about, strikes as fn(&Draw) -> bool) in [
        ("", "", |_| true),
        ("-for-line-lists", " for lists of lines", |d| is(d, T::LineList)),
        ("-for-line-strips", " for strips of lines", |d| is(d, T::LineStrip)),
        ("-for-triangle-lists", " for lists of triangles", |d| is(d, T::TriangleList)),
        ("-for-triangle-strips", " for strips of triangles", |d| is(d, T::TriangleStrip)),
        ("-for-fans", " for fans", |d| is(d, T::TriangleFan)),
        ("-for-indices", " for draws with indices", |d| d.mesh.indices.is_some()),
        ("-when-clipped", " where a triangle is clipped", is_clipped),
    ] {
        "exchanged{name}: First and last are exchanged{about}." =>
            draws(|draw| {
                draw.provoking = draw.provoking.map(|vertex| match vertex {
                    ProvokingVertex::First => ProvokingVertex::Last,
                    ProvokingVertex::Last => ProvokingVertex::First,
                });
            }), when strikes;
    }
    "fan-from-its-hub: The hub of a fan provokes every triangle." =>
        draws(|draw| {
            let hub = draw.mesh.vertices[0].color;
            draw.mesh.vertices.iter_mut().for_each(|v| v.color = hub);
        }),
        source "a fan made into a list that starts each triangle with the hub",
        when |draw| draw.provoking.is_some() && is(draw, T::TriangleFan);
    "odd-strip-triangles-from-the-second: Odd triangles have their second vertex's colour." =>
        draws(|draw| {
            let first = draw.provoking == Some(ProvokingVertex::First);
            if first && is(draw, T::TriangleStrip) && draw.mesh.indices.is_none() {
                let colors: Vec<_> = draw.mesh.vertices.iter().map(|v| v.color).collect();
                for (i, two) in colors.windows(2).enumerate().filter(|(i, _)| i % 2 == 1) {
                    draw.mesh.vertices[i].color = two[1];
                }
            }
        }), source "a strip made into a list whose odd triangles exchange their first vertices";
    "second-run-reversed: After a restart the primitives are drawn from the other end." =>
        draws(|draw| {
            // The picture stays the same, but the ends are exchanged.
            let indices = draw.mesh.indices.iter_mut();
            let second = indices.flat_map(|strip| strip.split_mut(|i| *i == RESTART).nth(1));
            second.for_each(<[_]>::reverse);
        }), when |draw| draw.provoking.is_some();
    "kept-from-the-draw-before: The convention of the draw before holds." =>
        from_draw(|before, draw| if draw.provoking.is_some() { draw.provoking = before.provoking.or(draw.provoking) });
}
