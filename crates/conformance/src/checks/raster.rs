//! Viewport, scissor, topologies, indices and polygon modes.

use super::Checked;
use crate::frames::{BLUE, GREEN, RED, check, check_red, color, depth, texels};
use crate::scenes::{FACING, PAINT, WHOLE, one_draw, over_blue, scene_of};
use crate::subject::Subject;
use etalon_frame::Frame;

/// Draws red over a blue image of 16 by 16.
fn painted(s: &Subject, mesh: &str, state: &str) -> Result<Frame, crate::Missing> {
    s.draw(&one_draw(&format!("{mesh}, {PAINT} {state}")))
}

fn viewport(rect: &str) -> String {
    format!(r#", "viewport": {{ "rect": {rect}, "depth": [0, 1] }}"#)
}

/// The upper left quarter of clip space.
fn quarter() -> String {
    WHOLE.replace("-1, 0]", "0, 0]").replace("[1,", "[0,")
}

pub(crate) fn a_viewport_counts_from_the_top_left(s: &Subject) -> Checked {
    let inside = viewport("[4, 2, 8, 4]");
    let frame = painted(s, WHOLE, &inside)?;
    check_red(&frame, |x, y| (4..12).contains(&x) && (2..6).contains(&y));
    let frame = painted(s, &quarter(), &inside)?;
    check_red(&frame, |x, y| (4..8).contains(&x) && (2..4).contains(&y));
    // Texels of a mesh count from the viewport's corner.
    let rect = r#""mesh": { "kind": "rect", "texels": [0, 0, 4, 3] }"#;
    let frame = painted(s, rect, &viewport("[8, 4, 8, 12]"))?;
    check_red(&frame, |x, y| (8..12).contains(&x) && (4..7).contains(&y));
    Ok(())
}

pub(crate) fn a_viewport_moves_depths_in_its_corner(s: &Subject) -> Checked {
    let frame = s.draw(&scene_of(
        r#""depth": { "format": "depth32float", "size": [8, 8], "clear": 1 }"#,
        r#"{ "depth_stencil": "depth", "draws": [
             { "mesh": { "kind": "columns", "values": [0, 0], "z": [0, 1] }, "shader": "flat_color",
               "viewport": { "rect": [4, 0, 4, 4], "depth": [0.25, 0.75] },
               "depth": { "compare": "always", "write": true } } ] }"#,
        &["depth"],
    ))?;
    check(depth(&frame, "depth"), |x, y| {
        let due: f32 = match (x, y) {
            (4 | 5, 0..4) => 0.25,
            (6 | 7, 0..4) => 0.75,
            _ => 1.0,
        };
        [due.to_bits()]
    });
    Ok(())
}

/// Turned over, the second number is the bottom, and faces show their other side.
pub(crate) fn a_viewport_of_negative_height_turns_the_picture_over(s: &Subject) -> Checked {
    let inside = viewport("[4, 6, 8, -4]");
    let frame = painted(s, WHOLE, &inside)?;
    check_red(&frame, |x, y| (4..12).contains(&x) && (2..6).contains(&y));
    let frame = painted(s, &quarter(), &inside)?;
    check_red(&frame, |x, y| (4..8).contains(&x) && (4..6).contains(&y));
    for (rect, due) in [("[0, 0, 16, 16]", RED), ("[0, 16, 16, -16]", GREEN)] {
        let frame = s.draw(&one_draw(&format!("{WHOLE}, {FACING} {}", viewport(rect))))?;
        check(color(&frame, "color"), |_, _| due);
    }
    Ok(())
}

pub(crate) fn a_viewport_may_reach_outside(s: &Subject) -> Checked {
    let frame = painted(s, WHOLE, &viewport("[-8, -4, 16, 8]"))?;
    check_red(&frame, |x, y| x < 8 && y < 4);
    let frame = painted(s, WHOLE, &viewport("[12, 14, 100, 100]"))?;
    check_red(&frame, |x, y| x >= 12 && y >= 14);
    let frame = painted(
        s,
        r#""mesh": { "kind": "full" }"#,
        &viewport("[-16, -8, 32, 16]"),
    )?;
    check_red(&frame, |_, y| y < 8);
    let columns = r#""mesh": { "kind": "columns", "values": [[1, 0, 0, 1], [0, 1, 0, 1]] }, "shader": "flat_color""#;
    let frame = s.draw(&one_draw(&format!(
        "{columns} {}",
        viewport("[-4, -2, 8, 8]")
    )))?;
    check(color(&frame, "color"), |x, y| {
        if x < 4 && y < 6 { GREEN } else { BLUE }
    });
    Ok(())
}

pub(crate) fn a_scissor_leaves_the_texels_inside(s: &Subject) -> Checked {
    for [x0, y0, width, height] in [[5, 7, 1, 1], [3, 12, 1, 1], [0, 0, 0, 0], [3, 12, 0, 4]] {
        let scissor = format!(r#", "scissor": [{x0}, {y0}, {width}, {height}]"#);
        for mesh in [WHOLE, r#""mesh": { "kind": "full" }"#] {
            let frame = painted(s, mesh, &scissor)?;
            check_red(&frame, |x, y| {
                (x0..x0 + width).contains(&x) && (y0..y0 + height).contains(&y)
            });
        }
    }
    // The next draw has none.
    let first = format!(r#"{{ {WHOLE}, {PAINT}, "scissor": [5, 1, 1, 1] }}"#);
    let second = format!(r#"{{ "mesh": {{ "kind": "rect", "texels": [0, 0, 1, 1] }}, {PAINT} }}"#);
    let frame = s.draw(&over_blue(&[first, second]))?;
    check_red(&frame, |x, y| [(5, 1), (0, 0)].contains(&(x, y)));
    Ok(())
}

pub(crate) fn a_scissor_may_reach_outside(s: &Subject) -> Checked {
    for (scissor, [left, top]) in [
        ("[12, 13, 100, 4000000000]", [12, 13]),
        ("[12, 2, 4294967295, 4294967295]", [12, 2]),
    ] {
        let frame = painted(s, WHOLE, &format!(r#", "scissor": {scissor}"#))?;
        check_red(&frame, |x, y| x >= left && y >= top);
    }
    Ok(())
}

pub(crate) fn discarded_primitives_draw_nothing(s: &Subject) -> Checked {
    let frame = painted(s, WHOLE, r#", "rasterizer_discard": true"#)?;
    check_red(&frame, |_, _| false);
    let frame = s.draw(&scene_of(
        r#""depth": { "format": "depth32float", "clear": 0.125 }"#,
        r#"{ "depth_stencil": "depth", "draws": [ { "mesh": { "kind": "full", "z": 0.5 }, "shader": "uniform_color",
             "depth": { "compare": "always", "write": true }, "rasterizer_discard": true } ] }"#,
        &["depth"],
    ))?;
    check(depth(&frame, "depth"), |_, _| [0.125_f32.to_bits()]);
    Ok(())
}

/// A mesh of vertices in texels, and the topology that joins them.
fn vertices(topology: &str, positions: &str, indices: &str) -> String {
    let indices = match indices {
        "" => String::new(),
        list => format!(r#", "indices": {list}"#),
    };
    format!(
        r#""topology": "{topology}", "mesh": {{ "kind": "vertices", "units": "texels",
            "positions": {positions} {indices} }}"#
    )
}

pub(crate) fn points_cover_the_texel_they_lie_in(s: &Subject) -> Checked {
    let mesh = vertices(
        "point-list",
        "[[3.5, 4.5, 0], [10.5, 0.5, 0], [15.5, 15.5, 0]]",
        "",
    );
    let frame = painted(s, &mesh, "")?;
    check_red(&frame, |x, y| [(3, 4), (10, 0), (15, 15)].contains(&(x, y)));
    let mesh = vertices(
        "point-list",
        "[[1.5, 2.5, 0], [9.5, 4.5, 0], [15.5, 15.5, 0]]",
        "[0, 2]",
    );
    let frame = painted(s, &mesh, "")?;
    check_red(&frame, |x, y| [(1, 2), (15, 15)].contains(&(x, y)));
    Ok(())
}

/// From edge to edge and from centre to centre, where the diamond rule leaves the last texel out.
pub(crate) fn lines_through_centres_cover_their_texels(s: &Subject) -> Checked {
    let mesh = vertices(
        "line-list",
        "[[2, 5.5, 0], [9, 5.5, 0], [12.5, 3, 0], [12.5, 8, 0]]",
        "",
    );
    // A bias of triangles alone.
    let frame = painted(s, &mesh, r#", "depth_bias": { "constant": 4 }"#)?;
    check_red(&frame, |x, y| {
        (y == 5 && (2..9).contains(&x)) || (x == 12 && (3..8).contains(&y))
    });
    for topology in ["line-list", "line-strip"] {
        let mesh = vertices(topology, "[[2.5, 3.5, 0], [10.5, 3.5, 0]]", "[0, 1]");
        let frame = painted(s, &mesh, "")?;
        check_red(&frame, |x, y| (2..10).contains(&x) && y == 3);
    }
    let mesh = vertices("line-strip", "[[1, 4.5, 0], [3, 4.5, 0], [5, 4.5, 0]]", "");
    let frame = painted(s, &mesh, "")?;
    check_red(&frame, |x, y| (1..5).contains(&x) && y == 4);
    Ok(())
}

/// The two parts of a list of points are drawn with values of their own.
pub(crate) fn points_and_lines_share_a_pass(s: &Subject) -> Checked {
    let draw = |topology: &str, values: &str, positions: &str| {
        format!(
            r#"{{ "mesh": {{ "kind": "vertices", "units": "texels", "values": {values}, "positions": {positions} }},
                "topology": "{topology}", "shader": "flat_color" }}"#
        )
    };
    let (red, green) = ("[1, 0, 0, 1]", "[0, 1, 0, 1]");
    let frame = s.draw(&over_blue(&[
        draw(
            "point-list",
            &format!("[{red}, {green}]"),
            "[[0.5, 0.5, 0], [6.5, 7.5, 0]]",
        ),
        draw(
            "line-list",
            &format!("[{red}]"),
            "[[2, 2.5, 0], [6, 2.5, 0]]",
        ),
        draw(
            "line-strip",
            &format!("[{green}]"),
            "[[1, 4.5, 0], [3, 4.5, 0], [5, 4.5, 0]]",
        ),
    ]))?;
    check(color(&frame, "color"), |x, y| match (x, y) {
        (0, 0) | (2..6, 2) => RED,
        (6, 7) | (1..5, 4) => GREEN,
        _ => BLUE,
    });
    Ok(())
}

/// Indices pick the vertices; what a restart leaves incomplete is not drawn.
pub(crate) fn lists_are_indexed(s: &Subject) -> Checked {
    let mesh = vertices(
        "triangle-list",
        "[[1, 2, 0], [1, 9, 0], [5, 2, 0], [5, 9, 0]]",
        "[0, 1, null, 2, 1, 0, 2, 3, 1]",
    );
    let frame = painted(s, &mesh, "")?;
    check_red(&frame, |x, y| (1..5).contains(&x) && (2..9).contains(&y));
    let mesh = vertices(
        "triangle-list",
        "[[0, 0, 0], [0, 8, 0], [2.25, 0, 0], [2, 8, 0], [5, 0, 0], [5, 8, 0], [8.25, 0, 0], [8, 8, 0]]",
        "[0, 1, 2, 2, 1, 3, 4, null, 5, 5, null, 6]",
    );
    let frame = painted(s, &mesh, "")?;
    check_red(&frame, |x, y| x < 2 && y < 8);
    Ok(())
}

/// Two rectangles with a gap, which a strip without restart would fill; the second of some is wound
/// the other way.
pub(crate) fn strips_begin_again(s: &Subject) -> Checked {
    let indices = "[0, 1, 2, 3, null, 4, 5, 6, 7]";
    let mesh = vertices(
        "triangle-strip",
        "[[1, 2, 0], [1, 9, 0], [5, 2, 0], [5, 9, 0], [12, 2, 0], [12, 9, 0], [8, 2, 0], [8, 9, 0]]",
        indices,
    );
    let frame = s.draw(&one_draw(&format!("{mesh}, {FACING}")))?;
    check(color(&frame, "color"), |x, y| match (x, y) {
        (1..5, 2..9) => RED,
        (8..12, 2..9) => GREEN,
        _ => BLUE,
    });
    let mesh = vertices(
        "triangle-strip",
        "[[0, 0, 0], [0, 4, 0], [4.25, 0, 0], [4.25, 4, 0], [10, 10, 0], [10, 14, 0], [14.25, 10, 0], [14.25, 14, 0]]",
        indices,
    );
    let frame = painted(s, &mesh, "")?;
    let inside = |x: u32, y: u32| x < 4 && y < 4;
    check_red(&frame, |x, y| {
        inside(x, y) || (x >= 10 && y >= 10 && inside(x - 10, y - 10))
    });
    // A strip joins what a list leaves apart, and its restart parts it again.
    let mesh = vertices(
        "line-strip",
        "[[2, 5.5, 0], [5, 5.5, 0], [9, 5.5, 0], [12.5, 3, 0], [12.5, 8, 0]]",
        "[0, 1, 2, null, 3, 4]",
    );
    let frame = painted(s, &mesh, "")?;
    check_red(&frame, |x, y| {
        (y == 5 && (2..9).contains(&x)) || (x == 12 && (3..8).contains(&y))
    });
    Ok(())
}

/// The fan's middle and its rim, counter-clockwise, the top triangle left out. Its edges run through
/// the texels of the diagonals, which are not looked at.
pub(crate) fn fans_turn_about_their_first_vertex(s: &Subject) -> Checked {
    let rim = "[[8, 8, 0], [0, 0, 0], [0, 16, 0], [16, 16, 0], [16, 0, 0]]";
    for indices in ["", "[0, 1, 2, null, 0, 2, 3, 4]"] {
        let mesh = vertices("triangle-fan", rim, indices);
        let frame = s.draw(&one_draw(&format!("{mesh}, {FACING}")))?;
        for (x, y) in texels([16, 16]).filter(|(x, y)| x != y && x + y != 15) {
            let is_top = y < x && x + y < 15;
            let due = if is_top { BLUE } else { RED };
            assert_eq!(color(&frame, "color").sample(x, y, 0), due, "({x}, {y})");
        }
    }
    let corners = "[[0, 0, 0], [8, 0, 0], [8, 8.25, 0], [0, 8.25, 0]]";
    let frame = painted(s, &vertices("triangle-fan", corners, "[0, 1, 2, 3]"), "")?;
    check_red(&frame, |x, y| x < 8 && y < 8);
    Ok(())
}

/// Texels on the straight edges and off their ends are red, others inside and outside are not.
pub(crate) fn polygons_may_be_drawn_as_their_edges(s: &Subject) -> Checked {
    let line = r#", "polygon_mode": "line""#;
    let triangle = |positions: &str| painted(s, &vertices("triangle-list", positions, ""), line);
    let frame = triangle("[[2.5, 2.5, 0], [2.5, 13.5, 0], [13.5, 13.5, 0]]")?;
    let image = color(&frame, "color");
    for at in 4..12 {
        assert_eq!(image.sample(2, at, 0), RED);
        assert_eq!(image.sample(at, 13, 0), RED);
        assert_eq!(image.sample(at, at, 0), RED);
    }
    for (x, y) in [(5, 10), (4, 8), (12, 3), (15, 15)] {
        assert_eq!(image.sample(x, y, 0), BLUE, "({x}, {y})");
    }
    let frame = triangle("[[2.5, 2.5, 0], [2.5, 12.5, 0], [12.5, 2.5, 0]]")?;
    let image = color(&frame, "color");
    for at in 3..12 {
        assert_eq!([image.sample(at, 2, 0), image.sample(2, at, 0)], [RED; 2]);
    }
    for (x, y) in [(4, 4), (5, 6), (13, 13)] {
        assert_eq!(image.sample(x, y, 0), BLUE, "({x}, {y})");
    }
    Ok(())
}
