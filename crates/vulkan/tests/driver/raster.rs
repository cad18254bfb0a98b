//! Rasterization: viewport, scissor, depth range, bias, clamp and bounds, topologies, indices.

use crate::common::{
    BLACK, GREEN, RED, backend, check, draw, draw_if_there, image, one_draw, scene_of,
};
use etalon_frame::{Aspect, Image};
use etalon_scene::Scene;

/// A quadrilateral over exactly the viewport, as a strip.
const WHOLE: &str = r#""topology": "triangle-strip", "mesh": { "kind": "vertices",
    "positions": [[-1, 1, 0], [-1, -1, 0], [1, 1, 0], [1, -1, 0]] }"#;
const PAINT: &str = r#""shader": "uniform_color", "params": { "color": [1, 0, 0, 1] }"#;
const FACING: &str =
    r#""shader": "front_facing", "params": { "color": [1, 0, 0, 1], "back_color": [0, 1, 0, 1] }"#;

/// Holds `color` to be red where told and 0 elsewhere.
#[track_caller]
fn check_red(scene: &Scene, red: impl Fn(u32, u32) -> bool) {
    let backend = backend(true);
    if let Some(frame) = draw_if_there(&backend, scene) {
        check(image(&frame, "color", Aspect::Color), |x, y| {
            if red(x, y) { RED } else { BLACK }.to_vec()
        });
    }
}

#[test]
fn a_viewport_counts_from_the_top_left() {
    let viewport = r#""viewport": { "rect": [4, 2, 8, 4], "depth": [0, 1] }"#;
    let scene = one_draw(&format!("{WHOLE}, {PAINT}, {viewport}"));
    check_red(&scene, |x, y| (4..12).contains(&x) && (2..6).contains(&y));
    // The upper left quarter of clip space.
    let quarter = WHOLE.replace("-1, 0]", "0, 0]").replace("[1,", "[0,");
    let scene = one_draw(&format!("{quarter}, {PAINT}, {viewport}"));
    check_red(&scene, |x, y| (4..8).contains(&x) && (2..4).contains(&y));
}

/// Turned over, the second number is the bottom, and faces show their other side.
#[test]
fn a_viewport_of_negative_height_turns_the_picture_over() {
    let viewport = r#""viewport": { "rect": [4, 6, 8, -4], "depth": [0, 1] }"#;
    let scene = one_draw(&format!("{WHOLE}, {PAINT}, {viewport}"));
    check_red(&scene, |x, y| (4..12).contains(&x) && (2..6).contains(&y));
    // The upper left quarter of clip space.
    let quarter = WHOLE.replace("-1, 0]", "0, 0]").replace("[1,", "[0,");
    let scene = one_draw(&format!("{quarter}, {PAINT}, {viewport}"));
    check_red(&scene, |x, y| (4..8).contains(&x) && (4..6).contains(&y));
    for (rect, color) in [([0, 0, 16, 16], RED), ([0, 16, 16, -16], GREEN)] {
        let viewport = format!(r#""viewport": {{ "rect": {rect:?}, "depth": [0, 1] }}"#);
        let scene = one_draw(&format!("{WHOLE}, {FACING}, {viewport}"));
        let frame = draw(&backend(true), &scene);
        check(image(&frame, "color", Aspect::Color), |_, _| color.to_vec());
    }
}

#[test]
fn a_viewport_may_reach_outside() {
    let scene = one_draw(&format!(
        r#"{WHOLE}, {PAINT}, "viewport": {{ "rect": [-8, -4, 16, 8], "depth": [0, 1] }}"#
    ));
    check_red(&scene, |x, y| x < 8 && y < 4);
    let scene = one_draw(&format!(
        r#"{WHOLE}, {PAINT}, "viewport": {{ "rect": [12, 14, 100, 100], "depth": [0, 1] }}"#
    ));
    check_red(&scene, |x, y| x >= 12 && y >= 14);
}

#[test]
fn a_scissor_leaves_what_lies_in_it() {
    for (scissor, [left, top, right, bottom]) in [
        ("[5, 7, 1, 1]", [5, 7, 6, 8]),
        ("[0, 0, 0, 0]", [0; 4]),
        ("[12, 13, 100, 4000000000]", [12, 13, 16, 16]),
    ] {
        let scene = one_draw(&format!(r#"{WHOLE}, {PAINT}, "scissor": {scissor}"#));
        check_red(&scene, |x, y| {
            (left..right).contains(&x) && (top..bottom).contains(&y)
        });
    }
}

/// A scene that draws columns of vertex depths, always writing, into a cleared `depth32float`.
fn columns(z: &str, more: &str) -> Scene {
    scene_of(
        r#""color": { "format": "rgba8unorm" }, "depth": { "format": "depth32float", "clear": 0.125 }"#,
        &format!(
            r#"{{ "color": ["color"], "depth_stencil": "depth", "draws": [
                {{ "mesh": {{ "kind": "columns", "values": [0, 0], "z": {z} }}, {PAINT},
                   "depth": {{ "compare": "always", "write": true }}, {more} }} ] }}"#
        ),
        &["color", "depth"],
    )
}

/// The depths of the left and the right column.
fn depths(scene: &Scene) -> Option<[f32; 2]> {
    let frame = draw_if_there(&backend(true), scene)?;
    let depth = image(&frame, "depth", Aspect::Depth);
    let columns = [2, 12].map(|x| f32::from_bits(depth.sample(x, 9, 0)[0]));
    check(depth, |x, _| vec![columns[x as usize / 8].to_bits()]);
    Some(columns)
}

#[track_caller]
fn check_depths(scene: &Scene, due: [f32; 2]) {
    if let Some(depths) = depths(scene) {
        for (depth, due) in depths.into_iter().zip(due) {
            assert!((depth - due).abs() <= 1e-6, "{depths:?}, {due} is due");
        }
    }
}

fn range(depth: &str) -> String {
    format!(r#""viewport": {{ "rect": [0, 0, 16, 16], "depth": {depth} }}"#)
}

#[test]
fn a_viewport_moves_depths_into_its_range() {
    for (depth, due) in [
        ("[0, 1]", [0.0, 1.0]),
        ("[0.25, 0.75]", [0.25, 0.75]),
        ("[1, 0]", [1.0, 0.0]),
        ("[0.75, 0.5]", [0.75, 0.5]),
    ] {
        check_depths(&columns("[0, 1]", &range(depth)), due);
    }
}

#[test]
fn depths_outside_are_clipped_or_clamped() {
    for (clamp, due) in [("false", [0.125, 0.125]), ("true", [0.25, 0.75])] {
        let more = format!(r#"{}, "depth_clamp": {clamp}"#, range("[0.25, 0.75]"));
        check_depths(&columns("[-0.5, 1.5]", &more), due);
    }
    let more = format!(r#"{}, "depth_clamp": true"#, range("[0.75, 0.25]"));
    check_depths(&columns("[-0.5, 1.5]", &more), [0.75, 0.25]);
}

/// In 32-bit floats the least step follows the exponent of the largest depth: 2^-24 at 0.5 up to 1.
#[test]
fn a_constant_bias_counts_least_steps() {
    let bias = |more: &str| columns("[0.5, 0.75]", &format!(r#""depth_bias": {{ {more} }}"#));
    let plain = depths(&bias("")).unwrap();
    let raised = depths(&bias(r#""constant": 64"#)).unwrap();
    let lowered = depths(&bias(r#""constant": -64"#)).unwrap();
    for column in 0..2 {
        let steps = (raised[column] - plain[column]) * 2_f32.powi(24);
        assert!((32.0..=160.0).contains(&steps), "{steps}");
    }
    // At 0.75 the exponent is the same on both sides.
    let steps = (plain[1] - lowered[1]) * 2_f32.powi(24);
    assert!((32.0..=160.0).contains(&steps), "{steps}");
}

#[test]
fn a_bias_is_held_to_its_clamp() {
    let more = r#""depth_bias": { "constant": 4000000, "clamp": 0.0625 }"#;
    check_depths(&columns("[0.5, 0.75]", more), [0.5625, 0.8125]);
    let more = r#""depth_bias": { "constant": -4000000, "clamp": -0.0625 }"#;
    check_depths(&columns("[0.5, 0.75]", more), [0.4375, 0.6875]);
}

/// Depth grows by 1/16 per texel to the right, so a slope factor of 2 adds 1/8.
#[test]
fn a_slope_bias_counts_the_slope() {
    let backend = backend(true);
    let depth = |slope: f32| {
        let scene = scene_of(
            r#""color": { "format": "rgba8unorm" }, "depth": { "format": "depth32float", "clear": 0 }"#,
            &format!(
                r#"{{ "color": ["color"], "depth_stencil": "depth", "draws": [
                    {{ "topology": "triangle-strip", "mesh": {{ "kind": "vertices",
                         "positions": [[-1, 1, 0], [-1, -1, 0], [1, 1, 1], [1, -1, 1]] }}, {PAINT},
                       "depth": {{ "compare": "always", "write": true }},
                       "depth_bias": {{ "slope": {slope} }} }} ] }}"#
            ),
            &["depth"],
        );
        let frame = draw(&backend, &scene);
        f32::from_bits(image(&frame, "depth", Aspect::Depth).sample(4, 7, 0)[0])
    };
    let (plain, biased) = (depth(0.0), depth(2.0));
    assert!((plain - 4.5 / 16.0).abs() < 1e-5, "{plain}");
    assert!((biased - plain - 0.125).abs() < 1e-5, "{biased}");
}

/// The stored depths 0, 1/4, 1/2 and 3/4 lie in columns; the bounds let the middle ones through.
#[test]
fn depth_bounds_look_at_the_stored_depth() {
    let backend = backend(true);
    let scene = scene_of(
        r#""color": { "format": "rgba8unorm" }, "depth": { "format": "depth32float" }"#,
        &format!(
            r#"{{ "color": ["color"], "depth_stencil": "depth", "draws": [
                {{ "mesh": {{ "kind": "columns", "values": [0, 0.25, 0.5, 0.75] }}, "shader": "flat_color_depth",
                   "depth": {{ "compare": "always", "write": true }} }},
                {{ {WHOLE}, {PAINT}, "depth_bounds": [0.25, 0.5] }} ] }}"#
        ),
        &["color"],
    );
    let missing = etalon_frame::Requirement::Feature(etalon_frame::Feature::DepthBounds);
    let limits = etalon_backend::Backend::limits(&backend);
    if limits.missing(&[missing]).is_some() {
        let refused = etalon_backend::Backend::prepare(&backend, &scene).map(|_| ());
        let due = etalon_backend::BackendError::NotSupported(missing);
        assert_eq!(refused.unwrap_err(), due);
        eprintln!("not tested: there is no depth bounds test");
        return;
    }
    let frame = draw(&backend, &scene);
    check(image(&frame, "color", Aspect::Color), |x, _| {
        if (4..12).contains(&x) { RED } else { BLACK }.to_vec()
    });
}

#[test]
fn nothing_is_drawn_where_primitives_are_thrown_away() {
    let more = r#""rasterizer_discard": true"#;
    check_depths(&columns("[0.5, 0.5]", more), [0.125, 0.125]);
    let scene = one_draw(&format!("{WHOLE}, {PAINT}, {more}"));
    check_red(&scene, |_, _| false);
}

/// A mesh of vertices in texels.
fn texels(positions: &str, indices: &str) -> String {
    let indices = match indices {
        "" => String::new(),
        list => format!(r#", "indices": {list}"#),
    };
    format!(
        r#""mesh": {{ "kind": "vertices", "units": "texels", "positions": {positions} {indices} }}"#
    )
}

/// The fan's middle and its rim, counter-clockwise, the top triangle left out. Its edges run through
/// the texels of the diagonals, which are not looked at.
#[test]
fn a_fan_turns_about_its_first_vertex() {
    let backend = backend(true);
    let mesh = texels("[[8,8,0], [0,0,0], [0,16,0], [16,16,0], [16,0,0]]", "");
    let restarted = texels(
        "[[8,8,0], [0,0,0], [0,16,0], [16,16,0], [16,0,0]]",
        "[0, 1, 2, null, 0, 2, 3, 4]",
    );
    for mesh in [mesh, restarted] {
        let scene = one_draw(&format!(r#"{mesh}, "topology": "triangle-fan", {FACING}"#));
        let Some(frame) = draw_if_there(&backend, &scene) else {
            return;
        };
        let color = image(&frame, "color", Aspect::Color);
        for (x, y) in (0..16).flat_map(|y| (0..16).map(move |x| (x, y))) {
            if x != y && x + y != 15 {
                let is_top = y < x && x + y < 15;
                let due = if is_top { BLACK } else { RED };
                assert_eq!(color.sample(x, y, 0), due, "({x}, {y})");
            }
        }
    }
}

/// Two rectangles with a gap, which a strip without restart would fill; the second is wound the
/// other way.
#[test]
fn a_strip_is_restarted_by_its_index() {
    let backend = backend(true);
    let mesh = texels(
        "[[1,2,0], [1,9,0], [5,2,0], [5,9,0], [12,2,0], [12,9,0], [8,2,0], [8,9,0]]",
        "[0, 1, 2, 3, null, 4, 5, 6, 7]",
    );
    let scene = one_draw(&format!(
        r#"{mesh}, "topology": "triangle-strip", {FACING}"#
    ));
    let frame = draw(&backend, &scene);
    check(image(&frame, "color", Aspect::Color), |x, y| {
        match (x, y) {
            (1..5, 2..9) => RED,
            (8..12, 2..9) => GREEN,
            _ => BLACK,
        }
        .to_vec()
    });
}

/// Indices pick the vertices; what a restart leaves incomplete is not drawn.
#[test]
fn a_list_is_indexed() {
    let mesh = texels(
        "[[1,2,0], [1,9,0], [5,2,0], [5,9,0]]",
        "[0, 1, null, 2, 1, 0, 2, 3, 1]",
    );
    // The restart begins anew with [2, 1, 0], [2, 3, 1].
    let scene = one_draw(&format!("{mesh}, {PAINT}"));
    check_red(&scene, |x, y| (1..5).contains(&x) && (2..9).contains(&y));
}

#[test]
fn points_cover_the_texel_they_lie_in() {
    let mesh = texels("[[3.5,4.5,0], [10.5,0.5,0], [15.5,15.5,0]]", "");
    let scene = one_draw(&format!(r#"{mesh}, "topology": "point-list", {PAINT}"#));
    check_red(&scene, |x, y| [(3, 4), (10, 0), (15, 15)].contains(&(x, y)));
}

#[test]
fn lines_through_centres_cover_their_texels() {
    let mesh = texels("[[2,5.5,0], [9,5.5,0], [12.5,3,0], [12.5,8,0]]", "");
    let scene = one_draw(&format!(r#"{mesh}, "topology": "line-list", {PAINT}"#));
    let drawn =
        |x: u32, y: u32| (y == 5 && (2..9).contains(&x)) || (x == 12 && (3..8).contains(&y));
    check_red(&scene, drawn);
    // A strip joins what a list leaves apart, and its restart parts it again.
    let mesh = texels(
        "[[2,5.5,0], [5,5.5,0], [9,5.5,0], [12.5,3,0], [12.5,8,0]]",
        "[0, 1, 2, null, 3, 4]",
    );
    let scene = one_draw(&format!(r#"{mesh}, "topology": "line-strip", {PAINT}"#));
    check_red(&scene, drawn);
}

#[test]
fn polygons_may_be_drawn_as_their_edges() {
    let backend = backend(true);
    let mesh = texels("[[2.5,2.5,0], [2.5,13.5,0], [13.5,13.5,0]]", "");
    let scene = one_draw(&format!(r#"{mesh}, {PAINT}, "polygon_mode": "line""#));
    let Some(frame) = draw_if_there(&backend, &scene) else {
        return;
    };
    let color = image(&frame, "color", Aspect::Color);
    let texel = |color: &Image, x, y| color.sample(x, y, 0).to_vec();
    for at in 4..12 {
        assert_eq!(texel(color, 2, at), RED);
        assert_eq!(texel(color, at, 13), RED);
        assert_eq!(texel(color, at, at), RED);
    }
    for (x, y) in [(5, 10), (4, 8), (12, 3), (15, 15)] {
        assert_eq!(texel(color, x, y), BLACK, "({x}, {y})");
    }
}
