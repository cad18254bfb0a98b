//! Bugs of the vertex whose attributes are flat over a primitive.

use super::list::{CONFUSION, List, Row};
use super::plant::{Plant, draws, from_draw};
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
        list.add(
            &format!("always-the-{vertex}"),
            CONFUSION,
            format!("The {vertex} vertex provokes, whatever is asked for."),
            draws(|draw| {
                if draw.provoking.is_some() {
                    draw.provoking = Some(*vertex);
                }
            }),
        );
    }
    let rows: [Row<Strikes>; 8] = [
        ("exchanged", "First and last are exchanged.", |_| true),
        (
            "exchanged-for-line-lists",
            "First and last are exchanged for lists of lines.",
            |draw| is(draw, T::LineList),
        ),
        (
            "exchanged-for-line-strips",
            "First and last are exchanged for strips of lines.",
            |draw| is(draw, T::LineStrip),
        ),
        (
            "exchanged-for-triangle-lists",
            "First and last are exchanged for lists of triangles.",
            |draw| is(draw, T::TriangleList),
        ),
        (
            "exchanged-for-triangle-strips",
            "First and last are exchanged for strips of triangles.",
            |draw| is(draw, T::TriangleStrip),
        ),
        (
            "exchanged-for-fans",
            "First and last are exchanged for fans.",
            |draw| is(draw, T::TriangleFan),
        ),
        (
            "exchanged-for-indices",
            "First and last are exchanged for draws with indices.",
            |draw| draw.mesh.indices.is_some(),
        ),
        (
            "exchanged-when-clipped",
            "First and last are exchanged where the view volume cuts a triangle.",
            is_clipped,
        ),
    ];
    list.rows(CONFUSION, exchanged, &rows);
    list.add(
        "fan-from-its-hub",
        "a fan made into a list that starts each triangle with the hub",
        "The hub of a fan provokes every triangle.",
        draws(|draw| {
            if draw.provoking.is_some() && is(draw, T::TriangleFan) {
                let hub = draw.mesh.vertices[0].color;
                draw.mesh.vertices.iter_mut().for_each(|v| v.color = hub);
            }
        }),
    );
    list.add(
        "odd-strip-triangles-from-the-second",
        "a strip made into a list whose odd triangles exchange their first vertices",
        "Odd triangles of a strip have the colour of their second vertex instead of the first.",
        draws(|draw| {
            let first = draw.provoking == Some(ProvokingVertex::First);
            if first && is(draw, T::TriangleStrip) && draw.mesh.indices.is_none() {
                let colors: Vec<_> = draw.mesh.vertices.iter().map(|v| v.color).collect();
                for (i, two) in colors.windows(2).enumerate().filter(|(i, _)| i % 2 == 1) {
                    draw.mesh.vertices[i].color = two[1];
                }
            }
        }),
    );
    list.add(
        "second-run-reversed",
        CONFUSION,
        "After a restart the primitives are drawn from the other end.",
        draws(|draw| {
            if draw.provoking.is_some() {
                reversed_runs(draw);
            }
        }),
    );
    list.add(
        "kept-from-the-draw-before",
        CONFUSION,
        "The convention of the draw before holds.",
        from_draw(|before, draw| {
            if draw.provoking.is_some() {
                draw.provoking = before.provoking.or(draw.provoking);
            }
        }),
    );
}
