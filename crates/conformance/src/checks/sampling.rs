//! Textures sampled with filters and address modes.

use super::CheckEnd;
use crate::frames::{Expect, check_near, check_within_one, color, texels, values};
use crate::scenes::{blue, corners, rect, uploaded, with};
use crate::subject::{CheckedBackend, Missing};
use etalon_frame::Frame;
use etalon_scene::AddressMode;
use serde_json::{Value, json};

/// Returns a texture of 4 by 2 texels, all different.
fn eight() -> Value {
    let row = |red: u32| [red, red + 1, red + 2, red + 3].map(|red| [red, 0, 0, 255]);
    with(
        uploaded("grid", [row(1), row(11)]),
        json!({ "size": [4, 2] }),
    )
}

/// Returns the texel that an index across or down addresses.
fn addressed(mode: AddressMode, count: i32, texel: i32) -> i32 {
    match mode {
        AddressMode::ClampToEdge => texel.clamp(0, count - 1),
        AddressMode::Repeat => texel.rem_euclid(count),
        AddressMode::MirrorRepeat => {
            let texel = texel.rem_euclid(2 * count);
            texel.min(2 * count - 1 - texel)
        }
    }
}

/// Shows the part of a texture between texture coordinates in an attachment of this size.
fn sampled(
    s: &CheckedBackend,
    size: [u32; 2],
    source: Value,
    uv: [f32; 4],
    filter: &str,
    modes: [AddressMode; 2],
) -> Result<Frame, Missing> {
    s.show(json!({
        "attachments": { "a": with(blue(), json!({ "size": size })), "t": source },
        "draws": [{ "mesh": { "kind": "cover", "uv": uv }, "shader": "sampled_color", "textures": ["t"],
                    "sampler": { "filter": filter, "address": modes.map(AddressMode::name) } }],
        "read": ["a"],
    }))
}

/// Row 0 of a texture, the first that is uploaded, is at coordinate 0. Each texel is shown twice in either
/// direction, across three repetitions of the texture, or two from the middle of one.
pub(crate) fn the_nearest_texel_is_taken_from_where_the_address_leads(
    s: &CheckedBackend,
) -> CheckEnd {
    for (size, uv, origin) in [
        ([24, 12], [-1.0, -1.0, 2.0, 2.0], [-4, -2]),
        ([24, 8], [-1.0, -0.5, 2.0, 1.5], [-4, -1]),
    ] {
        for across in AddressMode::ALL.iter().copied() {
            for down in AddressMode::ALL.iter().copied() {
                let frame = sampled(s, size, eight(), uv, "nearest", [across, down])?;
                frame.color_is("a", |x, y| {
                    let column = addressed(across, 4, x as i32 / 2 + origin[0]);
                    let row = addressed(down, 2, y as i32 / 2 + origin[1]);
                    [(1 + column + 10 * row) as u32, 0, 0, 255]
                });
            }
        }
    }
    Ok(())
}

/// Four attachment texels per texel of the texture: the weights are multiples of an eighth.
fn weights(s: &CheckedBackend, mode: AddressMode) -> CheckEnd {
    let rows = [0, 1, 2, 3].map(|y| [0, 1, 2, 3].map(|x| [40 * x, 50 * y, 7, 255]));
    let source = with(uploaded("grid", rows), json!({ "size": [4, 4] }));
    let uv = [0.0, 0.0, 1.0, 1.0];
    let frame = sampled(s, [16, 16], source, uv, "linear", [mode; 2])?;
    let weighed = |texel: u32, step: f64| {
        let position = (f64::from(texel) + 0.5) / 4.0 - 0.5;
        let (below, weight) = (position.floor() as i32, position - position.floor());
        let value = |texel| step * f64::from(addressed(mode, 4, texel));
        value(below) * (1.0 - weight) + value(below + 1) * weight
    };
    for (x, y) in texels([16, 16]) {
        let texel = color(&frame, "a").sample(x, y, 0);
        let came = [texel[0], texel[1]].map(f64::from);
        check_near(&came, &[weighed(x, 40.0), weighed(y, 50.0)], 1.5);
        assert_eq!(texel[2..], [7, 255]);
    }
    Ok(())
}

/// In the middle between two texels both have equal weight; at a texel's centre only that texel counts.
fn middles(s: &CheckedBackend, mode: AddressMode, expected: [u32; 8]) -> CheckEnd {
    let columns = uploaded("columns", [[40, 0, 0, 255], [200, 0, 0, 255]]);
    let source = with(columns, json!({ "size": [2, 4] }));
    let modes = [mode, AddressMode::ClampToEdge];
    let uv = [-0.125, 0.0, 1.875, 1.0];
    let frame = sampled(s, [8, 4], source, uv, "linear", modes)?;
    let image = color(&frame, "a");
    for (x, y) in texels(image.size) {
        let came = image.sample(x, y, 0);
        assert_eq!(came, image.sample(x, 0, 0));
        assert_eq!(came[1..], [0, 0, 255]);
        check_within_one(came, [expected[x as usize], 0, 0, 255]);
    }
    Ok(())
}

const A: u32 = 40;
const M: u32 = 120;
const B: u32 = 200;

pub(crate) fn neighbours_are_averaged(s: &CheckedBackend) -> CheckEnd {
    middles(s, AddressMode::ClampToEdge, [A, A, M, B, B, B, B, B])?;
    weights(s, AddressMode::ClampToEdge)
}

pub(crate) fn neighbours_across_the_edge_are_averaged(s: &CheckedBackend) -> CheckEnd {
    middles(s, AddressMode::Repeat, [M, A, M, B, M, A, M, B])?;
    weights(s, AddressMode::Repeat)
}

pub(crate) fn neighbours_in_the_mirror_are_averaged(s: &CheckedBackend) -> CheckEnd {
    middles(s, AddressMode::MirrorRepeat, [A, A, M, B, B, B, M, A])?;
    weights(s, AddressMode::MirrorRepeat)
}

/// Weights may have only 8 bits.
pub(crate) fn averages_of_floats_are_floats(s: &CheckedBackend) -> CheckEnd {
    let grid = [[[0, 0, 0, 1], [1, 0, 0, 1]], [[0, 1, 0, 1], [1, 1, 0, 1]]];
    let frame = s.show(json!({
        "attachments": {
            "a": { "format": "rgba32float", "size": [8, 8] },
            "t": { "format": "rgba16float", "size": [2, 2], "texels": { "kind": "grid", "values": grid } } },
        "draws": [{ "mesh": { "kind": "cover", "uv": [0, 0, 1, 1] }, "shader": "sampled_color",
                    "textures": ["t"],
                    "sampler": { "filter": "linear", "address": ["clamp-to-edge", "repeat"] } }],
        "read": ["a"],
    }))?;
    for (x, y) in texels([8, 8]) {
        let position = |texel: u32| (f64::from(texel) + 0.5) / 4.0 - 0.5;
        let red = position(x).clamp(0.0, 1.0);
        // Beyond the ends are the texels of the other end.
        let green = position(y).abs().min(2.0 - position(y));
        let came = values(color(&frame, "a"), x, y);
        check_near(&came, &[red, green, 0.0, 1.0], 1.0 / 256.0);
    }
    Ok(())
}

/// The sampler of an earlier draw does not affect fetches.
pub(crate) fn fetches_need_no_sampler(s: &CheckedBackend) -> CheckEnd {
    let floats = [[0, 1, 0, 1], [1, 0, 0, 1], [0, 0, 1, 1], [1, 1, 1, 1]];
    let frame = s.show(json!({
        "attachments": {
            "a": blue(), "t": eight(),
            "f": { "format": "rgba32float", "texels": { "kind": "columns", "values": floats } } },
        "draws": [
            { "mesh": { "kind": "cover", "uv": [0, 0, 1, 1] }, "shader": "sampled_color",
              "textures": ["t"], "sampler": { "filter": "linear", "address": ["repeat", "repeat"] } },
            { "mesh": rect([0, 0, 4, 1]), "shader": "texel_color", "textures": ["f"] }],
    }))?;
    frame.color_is("a", |x, y| match y {
        0 => floats[x as usize].map(|value| value * 255),
        // The middle of a texel has that texel's value.
        _ => [11 + x, 0, 0, 255],
    });
    frame.color_is("t", |x, y| [1 + x + 10 * y, 0, 0, 255]);
    Ok(())
}

/// Draws in one pass, each with its own sampler and texture.
pub(crate) fn each_draw_has_its_own_sampler(s: &CheckedBackend) -> CheckEnd {
    let draw = |texels: [u32; 4], texture: &str, filter: &str| {
        json!({ "mesh": with(corners(texels), json!({ "uv": [[0.5, 0.5]] })),
                "topology": "triangle-strip", "shader": "sampled_color", "textures": [texture],
                "sampler": { "filter": filter, "address": ["repeat", "repeat"] } })
    };
    let two = uploaded("grid", [[[0, 0, 0, 0], [200, 100, 0, 0]]]);
    let single = uploaded("grid", [[[1, 2, 3, 4]]]);
    let frame = s.show(json!({
        "attachments": {
            "a": { "format": "rgba8unorm", "size": [16, 16] },
            "two": with(two, json!({ "size": [2, 1] })),
            "one": with(single, json!({ "size": [1, 1] })) },
        "draws": [draw([0, 0, 4, 16], "two", "linear"), draw([4, 0, 8, 16], "one", "linear"),
                  draw([8, 0, 16, 16], "one", "nearest")],
        "read": ["a"],
    }))?;
    let image = color(&frame, "a");
    check_within_one(image.sample(1, 1, 0), [100, 50, 0, 0]);
    for x in 4..16 {
        assert_eq!(image.sample(x, 3, 0), [1, 2, 3, 4]);
    }
    Ok(())
}
