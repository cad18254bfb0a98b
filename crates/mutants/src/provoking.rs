//! Bugs of the vertex whose attributes are flat over a primitive.

use crate::list::List;
use crate::plant::{Plant, draws, from_draw};
use etalon_scene::{Draw, PrimitiveTopology, ProvokingVertex, RESTART};

/// True of the draws that a bug strikes.
type Strikes = fn(&Draw) -> bool;

fn other(vertex: ProvokingVertex) -> ProvokingVertex {
    match vertex {
        ProvokingVertex::First => ProvokingVertex::Last,
        ProvokingVertex::Last => ProvokingVertex::First,
    }
}

/// Exchanges the conventions of the draws that a bug strikes.
fn exchanged(strikes: Strikes) -> Plant {
    draws(move |draw| {
        if strikes(draw) {
            draw.provoking = draw.provoking.map(other);
        }
    })
}

fn is(draw: &Draw, topology: PrimitiveTopology) -> bool {
    draw.topology == topology
}

/// True if a vertex lies outside of the viewport.
fn is_clipped(draw: &Draw) -> bool {
    let outside = |v: f32| !(-1.0..=1.0).contains(&v);
    let mut all = draw.mesh.vertices.iter();
    all.any(|v| outside(v.position[0]) || outside(v.position[1]))
}

/// Draws each run of vertices in the opposite direction, which leaves the picture and exchanges the ends.
fn reversed_runs(draw: &mut Draw) {
    if let Some(indices) = &mut draw.mesh.indices {
        let mut runs = indices.split_mut(|i| *i == RESTART);
        if let Some(run) = runs.nth(1) {
            run.reverse();
        }
    }
}

pub(super) fn add(list: &mut List) {
    use PrimitiveTopology as T;
    list.class("provoking", "cull");
    for vertex in ProvokingVertex::ALL {
        list.bug(format!(
            "always-the-{vertex}: The {vertex} vertex provokes, whatever is asked for."
        ))
        .when(|draw| draw.provoking.is_some())
        .draws(|draw| draw.provoking = Some(*vertex));
    }

    list.bug("exchanged: First and last are exchanged.")
        .plant(exchanged(|_| true));
    list.bug("exchanged-for-line-lists: First and last are exchanged for lists of lines.")
        .plant(exchanged(|draw| is(draw, T::LineList)));
    list.bug("exchanged-for-line-strips: First and last are exchanged for strips of lines.")
        .plant(exchanged(|draw| is(draw, T::LineStrip)));
    list.bug("exchanged-for-triangle-lists: First and last are exchanged for lists of triangles.")
        .plant(exchanged(|draw| is(draw, T::TriangleList)));
    list.bug(
        "exchanged-for-triangle-strips: First and last are exchanged for strips of triangles.",
    )
    .plant(exchanged(|draw| is(draw, T::TriangleStrip)));
    list.bug("exchanged-for-fans: First and last are exchanged for fans.")
        .plant(exchanged(|draw| is(draw, T::TriangleFan)));
    list.bug("exchanged-for-indices: First and last are exchanged for draws with indices.")
        .plant(exchanged(|draw| draw.mesh.indices.is_some()));
    list.bug("exchanged-when-clipped: First and last are exchanged where a triangle is clipped.")
        .plant(exchanged(is_clipped));
    list.bug("fan-from-its-hub: The hub of a fan provokes every triangle.")
        .source("a fan made into a list that starts each triangle with the hub")
        .when(|draw| draw.provoking.is_some() && is(draw, T::TriangleFan))
        .draws(|draw| {
            let hub = draw.mesh.vertices[0].color;
            draw.mesh.vertices.iter_mut().for_each(|v| v.color = hub);
        });
    list.bug(
        "odd-strip-triangles-from-the-second: Odd triangles have their second vertex's colour.",
    )
    .source("a strip made into a list whose odd triangles exchange their first vertices")
    .draws(|draw| {
        let first = draw.provoking == Some(ProvokingVertex::First);
        if first && is(draw, T::TriangleStrip) && draw.mesh.indices.is_none() {
            let colors: Vec<_> = draw.mesh.vertices.iter().map(|v| v.color).collect();
            for (i, two) in colors.windows(2).enumerate().filter(|(i, _)| i % 2 == 1) {
                draw.mesh.vertices[i].color = two[1];
            }
        }
    });
    list.bug("second-run-reversed: After a restart the primitives are drawn from the other end.")
        .when(|draw| draw.provoking.is_some())
        .draws(|draw| {
            reversed_runs(draw);
        });
    list.bug("kept-from-the-draw-before: The convention of the draw before holds.")
        .plant(from_draw(|before, draw| {
            if draw.provoking.is_some() {
                draw.provoking = before.provoking.or(draw.provoking);
            }
        }));
}
