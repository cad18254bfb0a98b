//! Depth: cleared, written, compared and stored.

use super::Checked;
use crate::frames::{BLUE, RED, check, check_red, color, depth, stencil, texels, values};
use crate::scenes::{WHOLE, scene_of};
use crate::subject::Subject;
use etalon_frame::{ChannelEncoding, Image, ReadPath, TextureFormat};

/// Every format with depth; all backends must have them all.
fn formats(s: &Subject) -> impl Iterator<Item = TextureFormat> {
    let all = TextureFormat::ALL.iter().copied();
    let formats: Vec<_> = all.filter(|f| f.has_depth()).collect();
    for format in &formats {
        assert!(s.limits().formats.contains_key(format), "{format}");
    }
    formats.into_iter()
}

fn clear(format: TextureFormat, depth: f64) -> String {
    if format.has_stencil() {
        format!(r#"{{ "depth": {depth}, "stencil": 93 }}"#)
    } else {
        depth.to_string()
    }
}

/// Holds an image against stored depths: 0 and 1 exactly, others to a step of the format.
#[track_caller]
fn check_stored(s: &Subject, format: TextureFormat, image: &Image, due: impl Fn(u32) -> f64) {
    let support = &s.limits().formats[&format];
    assert_eq!(image.read, support.read, "{format}");
    match image.read {
        ReadPath::Copy => assert_eq!(image.channels, support.depth, "{format}"),
        ReadPath::Shader => assert_eq!(image.channels, [ChannelEncoding::Float32]),
    }
    for (x, y) in texels(image.size) {
        let (due, came) = (due(x), values(image, x, y)[0]);
        let exact = due == 0.0 || due == 1.0;
        let step = match support.depth[0] {
            encoding if exact => {
                assert!(
                    image.channels != [encoding]
                        || image.sample(x, y, 0) == [encoding.nearest_code(due)]
                );
                0.0
            }
            ChannelEncoding::Float32 => 0.0,
            encoding => 1.0 / encoding.max_order() as f64,
        };
        let near = (came - due).abs() <= step;
        assert!(near, "{format}: {came} at ({x}, {y}), and {due} is due");
    }
}

pub(crate) fn depths_start_from_their_clear(s: &Subject) -> Checked {
    for format in formats(s) {
        for value in [0.0, 1.0] {
            let clear = clear(format, value);
            let frame = s.draw(&scene_of(
                &format!(r#""d": {{ "format": "{format}", "size": [3, 5], "clear": {clear} }}"#),
                "",
                &["d"],
            ))?;
            check_stored(s, format, depth(&frame, "d"), |_| value);
        }
    }
    Ok(())
}

/// A quarter is stored first; the columns then bring 0, 1/4, 1 and 1, and a last draw, which may not
/// write, nothing.
pub(crate) fn depths_are_compared_with_the_stored_one(s: &Subject) -> Checked {
    for format in formats(s) {
        for (compare, passes) in [
            ("less", [true, false, false]),
            ("equal", [false, true, false]),
            ("greater", [false, false, true]),
            ("always", [true, true, true]),
        ] {
            let clear = clear(format, 1.0);
            let frame = s.draw(&scene_of(
                &format!(
                    r#""color": {{ "format": "rgba8unorm", "clear": [0, 0, 1, 1] }},
                       "depth": {{ "format": "{format}", "clear": {clear} }}"#
                ),
                &format!(
                    r#"{{ "color": ["color"], "depth_stencil": "depth", "draws": [
                        {{ "mesh": {{ "kind": "full", "value": 0.25 }}, "shader": "flat_color_depth",
                          "params": {{ "color": [0, 0, 1, 1] }}, "depth": {{ "compare": "always", "write": true }} }},
                        {{ "mesh": {{ "kind": "columns", "values": [0, 0.25, 1, 1] }}, "shader": "flat_color_depth",
                          "params": {{ "color": [1, 0, 0, 1] }}, "depth": {{ "compare": "{compare}", "write": true }} }},
                        {{ "mesh": {{ "kind": "rect", "texels": [0, 12, 16, 16], "value": 0.5 }},
                          "shader": "flat_color_depth", "depth": {{ "compare": "always", "write": false }},
                          "write_mask": "" }} ] }}"#
                ),
                &["depth", "color"],
            ))?;
            let passed = |x: u32| passes[(x as usize / 4).min(2)];
            check_red(&frame, |x, _| passed(x));
            check_stored(s, format, depth(&frame, "depth"), |x| {
                let written = [0.0, 0.25, 1.0, 1.0][x as usize / 4];
                if passed(x) { written } else { 0.25 }
            });
            if format.has_stencil() {
                let stencil = stencil(&frame, "depth");
                assert_eq!(stencil.read, ReadPath::Copy);
                assert_eq!(stencil.channels, [ChannelEncoding::Uint(8)]);
                check(stencil, |_, _| [93]);
            }
        }
    }
    Ok(())
}

/// Columns of 0, 1, 1/4 and 1/2 against a clear of 1.
pub(crate) fn written_depths_are_stored_where_they_pass(s: &Subject) -> Checked {
    for format in formats(s) {
        for (compare, write, passes) in [
            ("always", true, [true; 4]),
            ("less", true, [true, false, true, true]),
            ("greater-equal", false, [false, true, false, false]),
        ] {
            let clear = clear(format, 1.0);
            let frame = s.draw(&scene_of(
                &format!(
                    r#""color": {{ "format": "rgba8unorm", "size": [8, 4], "clear": [0, 0, 1, 1] }},
                       "depth": {{ "format": "{format}", "clear": {clear} }}"#
                ),
                &format!(
                    r#"{{ "color": ["color"], "depth_stencil": "depth", "draws": [
                        {{ "mesh": {{ "kind": "columns", "values": [0, 1, 0.25, 0.5] }}, "shader": "flat_color_depth",
                          "params": {{ "color": [1, 0, 0, 1] }},
                          "depth": {{ "compare": "{compare}", "write": {write} }} }} ] }}"#
                ),
                &["depth", "color"],
            ))?;
            let passed = |x: u32| passes[x as usize / 2];
            check_red(&frame, |x, _| passed(x));
            check_stored(s, format, depth(&frame, "depth"), |x| {
                let written = [0.0, 1.0, 0.25, 0.5][x as usize / 2];
                if write && passed(x) { written } else { 1.0 }
            });
        }
    }
    Ok(())
}

/// Clears and draws alone, and depths that no normalized format has.
pub(crate) fn floats_keep_any_depth(s: &Subject) -> Checked {
    let frame = s.draw(&scene_of(
        r#""d": { "format": "depth32float", "size": [10, 4], "clear": 0.3 }"#,
        r#"{ "depth_stencil": "d", "draws": [
             { "mesh": { "kind": "columns", "values": [0.1, 0.3333333, 1e-7, 0.9999999, 0.7] },
               "scissor": [0, 0, 10, 2], "shader": "flat_color_depth",
               "depth": { "compare": "always", "write": true } } ] }"#,
        &["d"],
    ))?;
    let written = [0.1_f32, 0.333_333_3, 1e-7, 0.999_999_9, 0.7];
    check(depth(&frame, "d"), |x, y| {
        let due = if y < 2 { written[x as usize / 2] } else { 0.3 };
        [due.to_bits()]
    });
    Ok(())
}

pub(crate) fn a_draw_without_a_depth_test_neither_tests_nor_writes(s: &Subject) -> Checked {
    let draws = r#""draws": [ { "mesh": { "kind": "full", "value": 1 }, "shader": "flat_color_depth",
        "params": { "color": [1, 0, 0, 1] } } ]"#;
    let frame = s.draw(&scene_of(
        r#""alone": { "format": "rgba8unorm" }, "color": { "format": "rgba8unorm" },
           "depth": { "format": "depth32float", "clear": 0 }"#,
        &format!(
            r#"{{ "color": ["color"], "depth_stencil": "depth", {draws} }}, {{ "color": ["alone"], {draws} }}"#
        ),
        &["alone", "color", "depth"],
    ))?;
    check(color(&frame, "color"), |_, _| RED);
    check(color(&frame, "alone"), |_, _| RED);
    check(depth(&frame, "depth"), |_, _| [0]);
    Ok(())
}

pub(crate) fn depth_and_stencil_may_be_read_only(s: &Subject) -> Checked {
    let frame = s.draw(&scene_of(
        r#""color": { "format": "rgba8unorm", "size": [4, 4], "clear": [0, 0, 1, 1] },
           "ds": { "format": "depth32float-stencil8", "clear": { "depth": 0.5, "stencil": 7 } }"#,
        r#"{ "color": ["color"], "depth_stencil": "ds", "depth_stencil_read_only": true, "draws": [
             { "mesh": { "kind": "columns", "values": [0, 0], "z": [0.25, 0.75] }, "shader": "uniform_color",
               "params": { "color": [1, 0, 0, 1] }, "depth": { "compare": "less", "write": false },
               "stencil": { "reference": 7, "front": { "compare": "equal" } } } ] }"#,
        &["color", "ds"],
    ))?;
    check_red(&frame, |x, _| x < 2);
    assert_eq!(depth(&frame, "ds").channels, [ChannelEncoding::Float32]);
    check(depth(&frame, "ds"), |_, _| [0.5_f32.to_bits()]);
    check(stencil(&frame, "ds"), |_, _| [7]);
    Ok(())
}

/// Written, tested without a right to write, and written again.
pub(crate) fn passes_that_write_take_turns_with_passes_that_do_not(s: &Subject) -> Checked {
    const GREEN: [u32; 4] = crate::frames::GREEN;
    for format in [
        TextureFormat::Depth32FloatStencil8,
        TextureFormat::Depth24PlusStencil8,
        TextureFormat::Depth16Unorm,
        TextureFormat::Stencil8,
    ] {
        let depths = |json: &str| if format.has_depth() { json } else { "" }.to_owned();
        let stencils = |json: &str| if format.has_stencil() { json } else { "" }.to_owned();
        let write = depths(r#", "depth": { "compare": "always", "write": true }"#)
            + &stencils(
                r#", "stencil": { "front": { "compare": "always", "pass_op": "increment-clamp" } }"#,
            );
        let test = depths(r#", "depth": { "compare": "equal", "write": false }"#)
            + &stencils(
                r#", "stencil": { "front": { "compare": "equal", "pass_op": "zero" }, "reference": 1, "write_mask": 0 }"#,
            );
        let frame = s.draw(&scene_of(
            &format!(r#""color": {{ "format": "rgba8unorm", "clear": [0, 0, 1, 1] }}, "ds": {{ "format": "{format}" }}"#),
            &format!(
                r#"{{ "depth_stencil": "ds", "draws": [ {{ "mesh": {{ "kind": "columns", "values": [0, 1] }},
                        "shader": "flat_color_depth" {write} }} ] }},
                   {{ "color": ["color"], "depth_stencil": "ds", "depth_stencil_read_only": true, "draws": [
                        {{ "mesh": {{ "kind": "full", "value": 1 }}, "shader": "flat_color_depth",
                           "params": {{ "color": [1, 0, 0, 1] }} {test} }} ] }},
                   {{ "depth_stencil": "ds", "draws": [
                        {{ "mesh": {{ "kind": "rect", "texels": [0, 0, 16, 8] }}, "shader": "flat_color_depth" {write} }} ] }},
                   {{ "color": ["color"], "depth_stencil": "ds", "depth_stencil_read_only": true, "draws": [
                        {{ "mesh": {{ "kind": "rect", "texels": [0, 8, 4, 16] }}, "shader": "uniform_color",
                           "params": {{ "color": [0, 1, 0, 1] }} }} ] }}"#
            ),
            &["color", "ds"],
        ))?;
        check(color(&frame, "color"), |x, y| match (x, y) {
            (0..4, 8..) => GREEN,
            (8.., _) => RED,
            _ if !format.has_depth() => RED,
            _ => BLUE,
        });
        if format.has_stencil() {
            check(stencil(&frame, "ds"), |_, y| [if y < 8 { 2 } else { 1 }]);
        }
        if format.has_depth() {
            let depth = depth(&frame, "ds");
            let one = depth.channels[0].nearest_code(1.0);
            check(depth, |x, y| [if x >= 8 && y >= 8 { one } else { 0 }]);
        }
    }
    Ok(())
}

/// A scene that stores columns of vertex depths in `depth32float`, cleared to 1/2, or keeps them.
fn columns(z: &str, state: &str) -> etalon_scene::Scene {
    scene_of(
        r#""color": { "format": "rgba8unorm", "clear": [0, 0, 1, 1] }, "depth": { "format": "depth32float", "clear": 0.5 }"#,
        &format!(
            r#"{{ "color": ["color"], "depth_stencil": "depth", "draws": [
                {{ "mesh": {{ "kind": "columns", "values": [0, 0], "z": {z} }}, "shader": "uniform_color",
                   "params": {{ "color": [1, 0, 0, 1] }}, "depth": {{ "compare": "always", "write": true }} {state} }} ] }}"#
        ),
        &["color", "depth"],
    )
}

/// Draws columns, and returns the depths of both.
fn depths(s: &Subject, z: &str, state: &str) -> Result<[f32; 2], crate::Missing> {
    let frame = s.draw(&columns(z, state))?;
    let depth = depth(&frame, "depth");
    let columns = [2, 12].map(|x| f32::from_bits(depth.sample(x, 9, 0)[0]));
    check(depth, |x, _| [columns[x as usize / 8].to_bits()]);
    Ok(columns)
}

fn range(depth: &str) -> String {
    format!(r#", "viewport": {{ "rect": [0, 0, 16, 16], "depth": {depth} }}"#)
}

pub(crate) fn a_viewport_moves_depths_into_its_range(s: &Subject) -> Checked {
    assert_eq!(depths(s, "[0, 1]", "")?, [0.0, 1.0]);
    for (range_of, due) in [("[0, 1]", [0.0, 1.0]), ("[0.25, 0.75]", [0.25, 0.75])] {
        assert_eq!(depths(s, "[0, 1]", &range(range_of))?, due, "{range_of}");
    }
    Ok(())
}

pub(crate) fn a_range_of_depths_may_be_reversed(s: &Subject) -> Checked {
    for (range_of, due) in [("[1, 0]", [1.0, 0.0]), ("[0.75, 0.5]", [0.75, 0.5])] {
        assert_eq!(depths(s, "[0, 1]", &range(range_of))?, due, "{range_of}");
    }
    Ok(())
}

pub(crate) fn depths_outside_are_clipped(s: &Subject) -> Checked {
    for z in ["[-1, 2]", "[-0.5, 1.5]"] {
        for state in ["", &range("[0.25, 0.75]")] {
            let frame = s.draw(&columns(z, state))?;
            check_red(&frame, |_, _| false);
            check(depth(&frame, "depth"), |_, _| [0.5_f32.to_bits()]);
        }
    }
    Ok(())
}

pub(crate) fn depths_outside_are_clamped(s: &Subject) -> Checked {
    for z in ["[-1, 2]", "[-0.5, 1.5]"] {
        for (range_of, due) in [("[0, 1]", [0.0, 1.0_f32]), ("[0.25, 0.75]", [0.25, 0.75])] {
            let state = format!(r#", "depth_clamp": true {}"#, range(range_of));
            let frame = s.draw(&columns(z, &state))?;
            check_red(&frame, |_, _| true);
            check(depth(&frame, "depth"), |x, _| {
                [due[x as usize / 8].to_bits()]
            });
        }
    }
    Ok(())
}

pub(crate) fn depths_are_clamped_to_a_reversed_range(s: &Subject) -> Checked {
    let state = format!(r#", "depth_clamp": true {}"#, range("[0.75, 0.25]"));
    assert_eq!(depths(s, "[-0.5, 1.5]", &state)?, [0.75, 0.25]);
    Ok(())
}

/// In 32-bit floats the least step follows the exponent of the largest depth: 2^-24 from 0.5 to 1,
/// and up to twice that (OpenGL 4.6, 14.6.5).
pub(crate) fn a_constant_bias_counts_least_steps(s: &Subject) -> Checked {
    let bias = |constant: i32| {
        let state = format!(r#", "depth_bias": {{ "constant": {constant} }}"#);
        depths(s, "[0.5, 0.75]", &state)
    };
    let plain = depths(s, "[0.5, 0.75]", r#", "depth_bias": {}"#)?;
    assert_eq!(plain, [0.5, 0.75]);
    assert_eq!(bias(0)?, plain);
    let steps = |from: f32, to: f32| (to - from) * 2_f32.powi(24);
    for (count, least, most) in [(1024, 1024.0, 2048.0), (64, 32.0, 160.0)] {
        let (raised, lowered) = (bias(count)?, bias(-count)?);
        for column in 0..2 {
            let steps = steps(plain[column], raised[column]);
            assert!((least..=most).contains(&steps), "{steps} of {count}");
        }
        // At 0.75 the exponent is the same on both sides.
        let steps = steps(lowered[1], plain[1]);
        assert!((least..=most).contains(&steps), "{steps} of -{count}");
    }
    Ok(())
}

pub(crate) fn a_bias_is_held_to_its_clamp(s: &Subject) -> Checked {
    for (constant, clamp) in [
        (16_777_216, 0.125),
        (4_000_000, 0.0625),
        (-4_000_000, -0.0625),
    ] {
        let state = format!(r#", "depth_bias": {{ "constant": {constant}, "clamp": {clamp} }}"#);
        let due = [0.5 + clamp, 0.25 + clamp];
        assert_eq!(depths(s, "[0.5, 0.25]", &state)?, due);
    }
    Ok(())
}

/// Depth grows by 1/16 per texel to the right, so a slope factor of 2 adds 1/8.
pub(crate) fn a_slope_bias_counts_the_slope(s: &Subject) -> Checked {
    let at_4 = |slope: u32| -> Result<f32, crate::Missing> {
        let frame = s.draw(&scene_of(
            r#""depth": { "format": "depth32float", "clear": 0 }"#,
            &format!(
                r#"{{ "depth_stencil": "depth", "draws": [ {{ "topology": "triangle-strip",
                    "mesh": {{ "kind": "vertices", "positions": [[-1, 1, 0], [-1, -1, 0], [1, 1, 1], [1, -1, 1]] }},
                    "shader": "uniform_color", "depth": {{ "compare": "always", "write": true }},
                    "depth_bias": {{ "slope": {slope} }} }} ] }}"#
            ),
            &["depth"],
        ))?;
        Ok(f32::from_bits(depth(&frame, "depth").sample(4, 7, 0)[0]))
    };
    let (plain, biased) = (at_4(0)?, at_4(2)?);
    assert!((plain - 4.5 / 16.0).abs() < 1e-5, "{plain}");
    assert!((biased - plain - 0.125).abs() < 1e-5, "{biased}");
    Ok(())
}

/// The depth of the fragment plays no part.
pub(crate) fn bounds_reject_by_the_stored_depth(s: &Subject) -> Checked {
    for (bounds, due) in [("[0.5, 0.75]", [0.0, 1.0]), ("[0.625, 1]", [0.5, 0.5])] {
        let state = format!(r#", "depth_bounds": {bounds}"#);
        assert_eq!(depths(s, "[0, 1]", &state)?, due, "{bounds}");
    }
    let frame = s.draw(&scene_of(
        r#""color": { "format": "rgba8unorm", "clear": [0, 0, 1, 1] }, "depth": { "format": "depth32float" }"#,
        &format!(
            r#"{{ "color": ["color"], "depth_stencil": "depth", "draws": [
                {{ "mesh": {{ "kind": "columns", "values": [0, 0.25, 0.5, 0.75] }}, "shader": "flat_color_depth",
                   "params": {{ "color": [0, 0, 1, 1] }}, "depth": {{ "compare": "always", "write": true }} }},
                {{ {WHOLE}, {}, "depth_bounds": [0.25, 0.5] }} ] }}"#,
            crate::scenes::PAINT
        ),
        &["color"],
    ))?;
    check_red(&frame, |x, _| (4..12).contains(&x));
    Ok(())
}
