//! Texels that are uploaded, fetched and drawn over.

use super::Checked;
use crate::frames::{RED, check, color};
use crate::scenes::scene_of;
use crate::subject::Subject;

/// One texture is only fetched from; another is drawn over, in a corner.
pub(crate) fn texels_keep_their_places(s: &Subject) -> Checked {
    for (kind, across) in [("columns", true), ("rows", false)] {
        for (format, scale) in [("rgba8unorm", 1.0), ("rgba32float", 1.0 / 255.0)] {
            let value = |i: u32| [i * 16, 255 - i, i, 255];
            let values: Vec<_> = (0..16)
                .map(|i| value(i).map(|v| f64::from(v) * scale))
                .collect();
            let bytes: Vec<_> = (0..16).map(value).collect();
            let frame = s.draw(&scene_of(
                &format!(
                    r#""a": {{ "format": "rgba8unorm" }},
                       "b": {{ "format": "rgba8unorm", "texels": {{ "kind": "{kind}", "values": {bytes:?} }} }},
                       "t": {{ "format": "{format}", "texels": {{ "kind": "{kind}", "values": {values:?} }} }}"#
                ),
                r#"{ "color": ["a"], "draws": [
                     { "mesh": { "kind": "full" }, "shader": "texel_color", "textures": ["t"] } ] },
                   { "color": ["b"], "draws": [
                     { "mesh": { "kind": "rect", "texels": [0, 0, 4, 2] }, "shader": "uniform_color",
                       "params": { "color": [1, 0, 0, 1] } } ] }"#,
                &["a", "b", "t"],
            ))?;
            let along = |x, y| if across { x } else { y };
            check(color(&frame, "a"), |x, y| value(along(x, y)));
            check(color(&frame, "b"), |x, y| match x < 4 && y < 2 {
                true => RED,
                false => value(along(x, y)),
            });
            check(color(&frame, "t"), |x, y| match format {
                "rgba8unorm" => value(along(x, y)),
                _ => values[along(x, y) as usize].map(|v| (v as f32).to_bits()),
            });
        }
    }
    Ok(())
}

pub(crate) fn floats_are_clamped_where_they_are_drawn(s: &Subject) -> Checked {
    let frame = s.draw(&scene_of(
        r#""color": { "format": "rgba8unorm", "size": [4, 4], "clear": [0, 0, 0, 0] },
           "float": { "format": "rgba32float", "texels": { "kind": "rows",
             "values": [[0, 0, 1, 1], [1, 0, 0, 1], [0, 1, 0, 1], [7, -3, 0, 0]] } },
           "unorm": { "format": "rgba8unorm", "texels": { "kind": "columns",
             "values": [[1, 2, 3, 4], [5, 6, 7, 8], [250, 251, 252, 253], [0, 255, 0, 255]] } }"#,
        r#"{ "color": ["color"], "draws": [
             { "mesh": { "kind": "full" }, "shader": "texel_color", "textures": ["unorm"] },
             { "mesh": { "kind": "rect", "texels": [0, 1, 2, 4] }, "shader": "texel_color", "textures": ["float"] } ] }"#,
        &["color", "float", "unorm"],
    ))?;
    let unorm = [
        [1, 2, 3, 4],
        [5, 6, 7, 8],
        [250, 251, 252, 253],
        [0, 255, 0, 255],
    ];
    let float = [
        [0.0, 0.0, 1.0, 1.0],
        [1.0, 0.0, 0.0, 1.0],
        [0.0, 1.0, 0.0, 1.0],
        [7.0_f32, -3.0, 0.0, 0.0],
    ];
    check(color(&frame, "color"), |x, y| {
        if x < 2 && y > 0 {
            float[y as usize].map(|v| if v >= 1.0 { 255 } else { 0 })
        } else {
            unorm[x as usize]
        }
    });
    check(color(&frame, "unorm"), |x, _| unorm[x as usize]);
    check(color(&frame, "float"), |_, y| {
        float[y as usize].map(f32::to_bits)
    });
    Ok(())
}

pub(crate) fn floats_come_back_bit_by_bit(s: &Subject) -> Checked {
    let frame = s.draw(&scene_of(
        r#""t": { "format": "rgba32float", "size": [2, 1], "texels": { "kind": "columns",
             "values": [[0.1, -3, 1e30, 0], [1, 2.5, 1e-30, 7]] } }"#,
        "",
        &["t"],
    ))?;
    let due = [[0.1_f32, -3.0, 1e30, 0.0], [1.0, 2.5, 1e-30, 7.0]];
    check(color(&frame, "t"), |x, _| due[x as usize].map(f32::to_bits));
    Ok(())
}

pub(crate) fn floats_are_cleared_and_drawn_exactly(s: &Subject) -> Checked {
    let values = [0.1_f32, -2.5, 1e30, 1.0 / 3.0];
    let frame = s.draw(&scene_of(
        &format!(
            r#""cleared": {{ "format": "rgba32float", "size": [4, 4], "clear": {values:?} }},
               "drawn": {{ "format": "rgba32float" }}"#
        ),
        &format!(
            r#"{{ "color": ["drawn"], "draws": [ {{ "mesh": {{ "kind": "full" }},
                "shader": "uniform_color", "params": {{ "color": {values:?} }} }} ] }}"#
        ),
        &["cleared", "drawn"],
    ))?;
    for image in &frame.images {
        check(image, |_, _| values.map(f32::to_bits));
    }
    Ok(())
}

/// Each of two thresholds, between the texels' alphas.
pub(crate) fn fragments_are_discarded_below_a_threshold(s: &Subject) -> Checked {
    let frame = s.draw(&scene_of(
        r#""color": { "format": "rgba8unorm", "size": [4, 4], "clear": [0, 0, 1, 1] },
           "source": { "format": "rgba8unorm", "texels": { "kind": "columns", "values":
             [[10, 20, 30, 0], [11, 21, 31, 127], [12, 22, 32, 129], [13, 23, 33, 255]] } }"#,
        r#"{ "color": ["color"], "draws": [
             { "mesh": { "kind": "rect", "texels": [0, 0, 4, 2] }, "shader": "texel_discard",
               "textures": ["source"], "params": { "color": [0, 0, 0, 0.5] } },
             { "mesh": { "kind": "rect", "texels": [0, 2, 4, 3] }, "shader": "texel_discard",
               "textures": ["source"], "params": { "color": [0, 0, 0, 0.75] } } ] }"#,
        &["color"],
    ))?;
    check(color(&frame, "color"), |x, y| match (x, y) {
        (2, 0..2) => [12, 22, 32, 129],
        (3, 0..3) => [13, 23, 33, 255],
        _ => crate::frames::BLUE,
    });
    Ok(())
}
