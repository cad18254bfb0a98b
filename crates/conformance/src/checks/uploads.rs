//! Texels that are uploaded, fetched and drawn over.

use super::CheckEnd;
use crate::frames::{BLUE, Expect, RED, check};
use crate::scenes::{blue, full, rect, red, uploaded, with};
use crate::subject::CheckedBackend;
use serde_json::json;

/// One texture is only fetched from; another is drawn over in a corner.
pub(crate) fn texels_keep_their_places(subject: &CheckedBackend) -> CheckEnd {
    let value = |i: u32| [i * 16, 255 - i, i, 255];
    let bytes: Vec<_> = (0..16).map(value).collect();
    for (kind, across) in [("columns", true), ("rows", false)] {
        for (format, scale) in [("rgba8unorm", 1.0), ("rgba32float", 1.0 / 255.0)] {
            let scaled = |i: u32| value(i).map(|v| f64::from(v) * scale);
            let values: Vec<_> = (0..16).map(scaled).collect();
            let frame = subject.show(json!({
                "attachments": {
                    "a": { "format": "rgba8unorm" },
                    "b": uploaded(kind, &bytes[..]),
                    "t": { "format": format, "texels": { "kind": kind, "values": values } } },
                "passes": [
                    { "color": ["a"], "draws": [
                        { "mesh": full(), "shader": "texel_color", "textures": ["t"] }] },
                    { "color": ["b"], "draws": [
                        { "mesh": rect([0, 0, 4, 2]), "shader": "uniform_color", "params": red() }] }],
            }))?;
            let expected = |x, y| value(if across { x } else { y });
            frame.color_is("a", expected);
            frame.color_is(
                "b",
                |x, y| if x < 4 && y < 2 { RED } else { expected(x, y) },
            );
            frame.color_is("t", |x, y| match format {
                "rgba8unorm" => expected(x, y),
                _ => scaled(if across { x } else { y }).map(|v| (v as f32).to_bits()),
            });
        }
    }
    Ok(())
}

/// Floats beyond 0 and 1 are clamped by the 8-bit attachment that they are drawn to, and not in their texture.
pub(crate) fn floats_are_clamped_where_they_are_drawn(subject: &CheckedBackend) -> CheckEnd {
    let unorm = [
        [1, 2, 3, 4],
        [5, 6, 7, 8],
        [250, 251, 252, 253],
        [0, 255, 0, 255],
    ];
    let float = [[0, 0, 1, 1], [1, 0, 0, 1], [0, 1, 0, 1], [7, -3, 0, 0]];
    let frame = subject.show(json!({
        "attachments": {
            "color": { "format": "rgba8unorm", "size": [4, 4] },
            "float": { "format": "rgba32float", "texels": { "kind": "rows", "values": float } },
            "unorm": uploaded("columns", unorm) },
        "draws": [
            { "mesh": full(), "shader": "texel_color", "textures": ["unorm"] },
            { "mesh": rect([0, 1, 2, 4]), "shader": "texel_color", "textures": ["float"] }],
    }))?;
    frame.color_is("color", |x, y| {
        if x < 2 && y > 0 {
            float[y as usize].map(|v| if v >= 1 { 255 } else { 0 })
        } else {
            unorm[x as usize]
        }
    });
    frame.color_is("unorm", |x, _| unorm[x as usize]);
    frame.color_is("float", |_, y| {
        float[y as usize].map(|v| (v as f32).to_bits())
    });
    Ok(())
}

/// Values without a short binary form, very large and very small ones are uploaded and read back without a draw.
pub(crate) fn floats_come_back_bit_by_bit(subject: &CheckedBackend) -> CheckEnd {
    let expected = [[0.1_f32, -3.0, 1e30, 0.0], [1.0, 2.5, 1e-30, 7.0]];
    let texels = json!({ "kind": "columns", "values": expected });
    let frame = subject.show(json!({
        "attachments": { "t": { "format": "rgba32float", "size": [2, 1], "texels": texels } },
        "passes": [],
    }))?;
    frame.color_is("t", |x, _| expected[x as usize].map(f32::to_bits));
    Ok(())
}

/// A clear value and a uniform reach a float attachment without clamping or rounding.
pub(crate) fn floats_are_cleared_and_drawn_exactly(subject: &CheckedBackend) -> CheckEnd {
    let values = [0.1_f32, -2.5, 1e30, 1.0 / 3.0];
    let frame = subject.show(json!({
        "attachments": {
            "cleared": { "format": "rgba32float", "size": [4, 4], "clear": values },
            "drawn": { "format": "rgba32float" } },
        "passes": [{ "color": ["drawn"], "draws": [
            { "mesh": full(), "shader": "uniform_color", "params": { "color": values } }] }],
    }))?;
    for image in &frame.images {
        check(image, |_, _| values.map(f32::to_bits));
    }
    Ok(())
}

/// Two thresholds, each between two of the texels' alphas.
pub(crate) fn fragments_are_discarded_below_a_threshold(subject: &CheckedBackend) -> CheckEnd {
    let texels = [
        [10, 20, 30, 0],
        [11, 21, 31, 127],
        [12, 22, 32, 129],
        [13, 23, 33, 255],
    ];
    let frame = subject.show(json!({
        "attachments": { "color": with(blue(), json!({ "size": [4, 4] })),
                         "source": uploaded("columns", texels) },
        "draws": [
            { "mesh": rect([0, 0, 4, 2]), "shader": "texel_discard", "textures": ["source"],
              "params": { "color": [0, 0, 0, 0.5] } },
            { "mesh": rect([0, 2, 4, 3]), "shader": "texel_discard", "textures": ["source"],
              "params": { "color": [0, 0, 0, 0.75] } }],
    }))?;
    frame.color_is("color", |x, y| match (x, y) {
        (2, 0..2) | (3, 0..3) => texels[x as usize],
        _ => BLUE,
    });
    Ok(())
}
