//! Viewport, scissor, topologies, indices and polygon modes.

use super::CheckEnd;
use crate::frames::{BLUE, Expect, GREEN, RED, color, texels};
use crate::scenes::{blue, full, over_blue, painted, rect, red_or_green, test, with};
use crate::subject::{CheckedBackend, Missing};
use etalon_frame::Frame;
use serde_json::{Value, json};

/// Draws red over a blue attachment of 16 by 16 texels.
fn drawn(s: &CheckedBackend, draw: Value) -> Result<Frame, Missing> {
    s.show(over_blue(with(draw, painted())))
}

/// Draws front faces red and back faces green over a blue attachment of 16 by 16 texels.
fn faces(s: &CheckedBackend, draw: Value) -> Result<Frame, Missing> {
    let facing = json!({ "shader": "front_facing", "params": red_or_green() });
    s.show(over_blue(with(draw, facing)))
}

/// Returns the mesh and topology of a rectangle between two corners in clip space.
fn clip(left: i32, bottom: i32, right: i32, top: i32) -> Value {
    let positions = [
        [left, top, 0],
        [left, bottom, 0],
        [right, top, 0],
        [right, bottom, 0],
    ];
    json!({ "topology": "triangle-strip", "mesh": { "kind": "vertices", "positions": positions } })
}

/// Returns a rectangle that covers exactly the viewport.
fn viewport_rect() -> Value {
    clip(-1, -1, 1, 1)
}

/// Returns the upper left quarter of clip space.
fn quarter() -> Value {
    clip(-1, 0, 0, 1)
}

fn viewport(draw: Value, rect: [i32; 4]) -> Value {
    with(
        draw,
        json!({ "viewport": { "rect": rect, "depth": [0, 1] } }),
    )
}

pub(crate) fn a_viewport_counts_from_the_top_left(s: &CheckedBackend) -> CheckEnd {
    let frame = drawn(s, viewport(viewport_rect(), [4, 2, 8, 4]))?;
    frame.is_red(|x, y| (4..12).contains(&x) && (2..6).contains(&y));
    let frame = drawn(s, viewport(quarter(), [4, 2, 8, 4]))?;
    frame.is_red(|x, y| (4..8).contains(&x) && (2..4).contains(&y));
    // Texel coordinates of a mesh are relative to the viewport's corner.
    let rect = json!({ "mesh": rect([0, 0, 4, 3]) });
    let frame = drawn(s, viewport(rect, [8, 4, 8, 12]))?;
    frame.is_red(|x, y| (8..12).contains(&x) && (4..7).contains(&y));
    Ok(())
}

pub(crate) fn a_viewport_moves_depths_in_its_corner(s: &CheckedBackend) -> CheckEnd {
    let frame = s.show(json!({
        "attachments": { "depth": { "format": "depth32float", "size": [8, 8], "clear": 1 } },
        "draws": [{ "mesh": { "kind": "columns", "values": [0, 0], "z": [0, 1] }, "shader": "flat_color",
                    "viewport": { "rect": [4, 0, 4, 4], "depth": [0.25, 0.75] },
                    "depth": test("always", true) }],
    }))?;
    frame.depth_is("depth", |x, y| match (x, y) {
        (4 | 5, 0..4) => 0.25,
        (6 | 7, 0..4) => 0.75,
        _ => 1.0,
    });
    Ok(())
}

/// With a negative height, the second number is the bottom, and faces show their other side.
pub(crate) fn a_viewport_of_negative_height_turns_the_picture_over(s: &CheckedBackend) -> CheckEnd {
    let frame = drawn(s, viewport(viewport_rect(), [4, 6, 8, -4]))?;
    frame.is_red(|x, y| (4..12).contains(&x) && (2..6).contains(&y));
    let frame = drawn(s, viewport(quarter(), [4, 6, 8, -4]))?;
    frame.is_red(|x, y| (4..8).contains(&x) && (4..6).contains(&y));
    for (rect, expected) in [([0, 0, 16, 16], RED), ([0, 16, 16, -16], GREEN)] {
        faces(s, viewport(viewport_rect(), rect))?.color_is("color", |_, _| expected);
    }
    Ok(())
}

pub(crate) fn a_viewport_may_reach_outside(s: &CheckedBackend) -> CheckEnd {
    let frame = drawn(s, viewport(viewport_rect(), [-8, -4, 16, 8]))?;
    frame.is_red(|x, y| x < 8 && y < 4);
    let frame = drawn(s, viewport(viewport_rect(), [12, 14, 100, 100]))?;
    frame.is_red(|x, y| x >= 12 && y >= 14);
    let frame = drawn(s, viewport(json!({ "mesh": full() }), [-16, -8, 32, 16]))?;
    frame.is_red(|_, y| y < 8);
    let mesh = json!({ "kind": "columns", "values": [[1, 0, 0, 1], [0, 1, 0, 1]] });
    let columns = json!({ "mesh": mesh, "shader": "flat_color" });
    let frame = s.show(over_blue(viewport(columns, [-4, -2, 8, 8])))?;
    frame.color_is("color", |x, y| if x < 4 && y < 6 { GREEN } else { BLUE });
    Ok(())
}

pub(crate) fn a_scissor_leaves_the_texels_inside(s: &CheckedBackend) -> CheckEnd {
    for [x0, y0, width, height] in [[5, 7, 1, 1], [3, 12, 1, 1], [0, 0, 0, 0], [3, 12, 0, 4]] {
        let scissor = json!({ "scissor": [x0, y0, width, height] });
        for draw in [viewport_rect(), json!({ "mesh": full() })] {
            let frame = drawn(s, with(draw, scissor.clone()))?;
            let inside =
                |position: u32, from: u32, length: u32| (from..from + length).contains(&position);
            frame.is_red(|x, y| inside(x, x0, width) && inside(y, y0, height));
        }
    }
    // The next draw has no scissor.
    let first = with(viewport_rect(), json!({ "scissor": [5, 1, 1, 1] }));
    let draws = [first, json!({ "mesh": rect([0, 0, 1, 1]) })];
    let frame = s.show(json!({
        "attachments": { "color": blue() },
        "draws": draws.map(|draw| with(draw, painted())),
    }))?;
    frame.is_red(|x, y| [(5, 1), (0, 0)].contains(&(x, y)));
    Ok(())
}

pub(crate) fn a_scissor_may_reach_outside(s: &CheckedBackend) -> CheckEnd {
    for [left, top, width, height] in [[12, 13, 100, 4_000_000_000], [12, 2, u32::MAX, u32::MAX]] {
        let scissor = json!({ "scissor": [left, top, width, height] });
        drawn(s, with(viewport_rect(), scissor))?.is_red(|x, y| x >= left && y >= top);
    }
    Ok(())
}

pub(crate) fn discarded_primitives_draw_nothing(s: &CheckedBackend) -> CheckEnd {
    let frame = drawn(
        s,
        with(viewport_rect(), json!({ "rasterizer_discard": true })),
    )?;
    frame.is_red(|_, _| false);
    let frame = s.show(json!({
        "attachments": { "depth": { "format": "depth32float", "clear": 0.125 } },
        "draws": [{ "mesh": { "kind": "full", "z": 0.5 }, "shader": "uniform_color",
                    "depth": test("always", true), "rasterizer_discard": true }],
    }))?;
    frame.depth_is("depth", |_, _| 0.125);
    Ok(())
}

/// Returns a mesh of vertices in texels, with a topology.
fn vertices(topology: &str, positions: &[[f64; 2]]) -> Value {
    let positions: Vec<_> = positions.iter().map(|[x, y]| [*x, *y, 0.0]).collect();
    json!({ "topology": topology,
            "mesh": { "kind": "vertices", "units": "texels", "positions": positions } })
}

/// Returns [`vertices`] with indices; null restarts the primitives.
fn indexed(topology: &str, positions: &[[f64; 2]], indices: Value) -> Value {
    let mut draw = vertices(topology, positions);
    draw["mesh"]["indices"] = indices;
    draw
}

pub(crate) fn points_cover_the_texel_they_lie_in(s: &CheckedBackend) -> CheckEnd {
    let points = vertices("point-list", &[[3.5, 4.5], [10.5, 0.5], [15.5, 15.5]]);
    drawn(s, points)?.is_red(|x, y| [(3, 4), (10, 0), (15, 15)].contains(&(x, y)));
    let positions = [[1.5, 2.5], [9.5, 4.5], [15.5, 15.5]];
    let points = indexed("point-list", &positions, json!([0, 2]));
    drawn(s, points)?.is_red(|x, y| [(1, 2), (15, 15)].contains(&(x, y)));
    Ok(())
}

/// Lines from edge to edge, and from centre to centre, where the diamond rule omits the last texel.
pub(crate) fn lines_through_centres_cover_their_texels(s: &CheckedBackend) -> CheckEnd {
    let lines = vertices(
        "line-list",
        &[[2.0, 5.5], [9.0, 5.5], [12.5, 3.0], [12.5, 8.0]],
    );
    // The bias applies only to triangles.
    let frame = drawn(s, with(lines, json!({ "depth_bias": { "constant": 4 } })))?;
    frame.is_red(|x, y| matches!((x, y), (2..9, 5) | (12, 3..8)));
    for topology in ["line-list", "line-strip"] {
        let line = indexed(topology, &[[2.5, 3.5], [10.5, 3.5]], json!([0, 1]));
        drawn(s, line)?.is_red(|x, y| (2..10).contains(&x) && y == 3);
    }
    let strip = vertices("line-strip", &[[1.0, 4.5], [3.0, 4.5], [5.0, 4.5]]);
    drawn(s, strip)?.is_red(|x, y| (1..5).contains(&x) && y == 4);
    Ok(())
}

/// The two parts of a list of points have different values.
pub(crate) fn points_and_lines_share_a_pass(s: &CheckedBackend) -> CheckEnd {
    let colored = |mut draw: Value, values: &[[u32; 4]]| {
        draw["mesh"]["values"] = json!(values);
        with(draw, json!({ "shader": "flat_color" }))
    };
    let (red, green) = ([1, 0, 0, 1], [0, 1, 0, 1]);
    let frame = s.show(json!({
        "attachments": { "color": blue() },
        "draws": [
            colored(vertices("point-list", &[[0.5, 0.5], [6.5, 7.5]]), &[red, green]),
            colored(vertices("line-list", &[[2.0, 2.5], [6.0, 2.5]]), &[red]),
            colored(vertices("line-strip", &[[1.0, 4.5], [3.0, 4.5], [5.0, 4.5]]), &[green])],
    }))?;
    frame.color_is("color", |x, y| match (x, y) {
        (0, 0) | (2..6, 2) => RED,
        (6, 7) | (1..5, 4) => GREEN,
        _ => BLUE,
    });
    Ok(())
}

/// Returns the corners of a rectangle, in the order of a strip.
fn strip([left, top, right, bottom]: [f64; 4]) -> [[f64; 2]; 4] {
    [[left, top], [left, bottom], [right, top], [right, bottom]]
}

/// Indices select the vertices, and primitives that a restart leaves incomplete are not drawn.
pub(crate) fn lists_are_indexed(s: &CheckedBackend) -> CheckEnd {
    let indices = json!([0, 1, null, 2, 1, 0, 2, 3, 1]);
    let list = indexed("triangle-list", &strip([1.0, 2.0, 5.0, 9.0]), indices);
    drawn(s, list)?.is_red(|x, y| (1..5).contains(&x) && (2..9).contains(&y));
    let positions = [
        [[0.0, 0.0], [0.0, 8.0], [2.25, 0.0], [2.0, 8.0]],
        [[5.0, 0.0], [5.0, 8.0], [8.25, 0.0], [8.0, 8.0]],
    ];
    let indices = json!([0, 1, 2, 2, 1, 3, 4, null, 5, 5, null, 6]);
    let list = indexed("triangle-list", &positions.concat(), indices);
    drawn(s, list)?.is_red(|x, y| x < 2 && y < 8);
    Ok(())
}

/// Two rectangles with a gap, which a strip without restart would fill. In some cases the second one is
/// wound the other way.
pub(crate) fn strips_begin_again(s: &CheckedBackend) -> CheckEnd {
    let two = |rectangles: [[f64; 4]; 2]| {
        let indices = json!([0, 1, 2, 3, null, 4, 5, 6, 7]);
        indexed("triangle-strip", &rectangles.map(strip).concat(), indices)
    };
    let frame = faces(s, two([[1.0, 2.0, 5.0, 9.0], [12.0, 2.0, 8.0, 9.0]]))?;
    frame.color_is("color", |x, y| match (x, y) {
        (1..5, 2..9) => RED,
        (8..12, 2..9) => GREEN,
        _ => BLUE,
    });
    let frame = drawn(s, two([[0.0, 0.0, 4.25, 4.0], [10.0, 10.0, 14.25, 14.0]]))?;
    frame.is_red(|x, y| matches!((x, y), (0..4, 0..4) | (10..14, 10..14)));
    // A strip joins points that a list leaves separate; its restart separates them again.
    let positions = [[2.0, 5.5], [5.0, 5.5], [9.0, 5.5], [12.5, 3.0], [12.5, 8.0]];
    let lines = indexed("line-strip", &positions, json!([0, 1, 2, null, 3, 4]));
    drawn(s, lines)?.is_red(|x, y| matches!((x, y), (2..9, 5) | (12, 3..8)));
    Ok(())
}

/// The fan's centre and its rim, counter-clockwise, without the top triangle. The texels on its diagonal
/// edges are not checked.
pub(crate) fn fans_turn_about_their_first_vertex(s: &CheckedBackend) -> CheckEnd {
    let rim = [
        [8.0, 8.0],
        [0.0, 0.0],
        [0.0, 16.0],
        [16.0, 16.0],
        [16.0, 0.0],
    ];
    for fan in [
        vertices("triangle-fan", &rim),
        indexed("triangle-fan", &rim, json!([0, 1, 2, null, 0, 2, 3, 4])),
    ] {
        let frame = faces(s, fan)?;
        for (x, y) in texels([16, 16]).filter(|(x, y)| x != y && x + y != 15) {
            let expected = if y < x && x + y < 15 { BLUE } else { RED };
            assert_eq!(
                color(&frame, "color").sample(x, y, 0),
                expected,
                "({x}, {y})"
            );
        }
    }
    let corners = [[0.0, 0.0], [8.0, 0.0], [8.0, 8.25], [0.0, 8.25]];
    let fan = indexed("triangle-fan", &corners, json!([0, 1, 2, 3]));
    drawn(s, fan)?.is_red(|x, y| x < 8 && y < 8);
    Ok(())
}

/// Texels on straight edges, away from their ends, are red; other texels inside and outside are not.
pub(crate) fn polygons_may_be_drawn_as_their_edges(s: &CheckedBackend) -> CheckEnd {
    let edges = |positions: &[[f64; 2]], red: &[(u32, u32)], blue: &[(u32, u32)]| -> CheckEnd {
        let line = json!({ "polygon_mode": "line" });
        let frame = drawn(s, with(vertices("triangle-list", positions), line))?;
        for (texels, expected) in [(red, RED), (blue, BLUE)] {
            for (x, y) in texels {
                assert_eq!(
                    color(&frame, "color").sample(*x, *y, 0),
                    expected,
                    "({x}, {y})"
                );
            }
        }
        Ok(())
    };
    let red: Vec<_> = (4..12)
        .flat_map(|coordinate| [(2, coordinate), (coordinate, 13), (coordinate, coordinate)])
        .collect();
    let blue = [(5, 10), (4, 8), (12, 3), (15, 15)];
    edges(&[[2.5, 2.5], [2.5, 13.5], [13.5, 13.5]], &red, &blue)?;
    let red: Vec<_> = (3..12)
        .flat_map(|coordinate| [(coordinate, 2), (2, coordinate)])
        .collect();
    let blue = [(4, 4), (5, 6), (13, 13)];
    edges(&[[2.5, 2.5], [2.5, 12.5], [12.5, 2.5]], &red, &blue)
}
