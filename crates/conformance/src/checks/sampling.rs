//! Textures sampled with filters and address modes.

use super::Checked;
use crate::frames::{check, check_near, check_within_one, color, texels, values};
use crate::scenes::scene_of;
use crate::subject::Subject;
use etalon_frame::Frame;
use etalon_scene::AddressMode;

/// A texture of 4 by 2 texels, each different.
const TEXELS: &str = r#"{ "kind": "grid", "values": [
    [[1, 0, 0, 255], [2, 0, 0, 255], [3, 0, 0, 255], [4, 0, 0, 255]],
    [[11, 0, 0, 255], [12, 0, 0, 255], [13, 0, 0, 255], [14, 0, 0, 255]] ] }"#;

/// The texel that a number across or down stands for.
fn addressed(mode: AddressMode, count: i32, at: i32) -> i32 {
    match mode {
        AddressMode::ClampToEdge => at.clamp(0, count - 1),
        AddressMode::Repeat => at.rem_euclid(count),
        AddressMode::MirrorRepeat => {
            let at = at.rem_euclid(2 * count);
            at.min(2 * count - 1 - at)
        }
    }
}

/// Shows a texture between texture coordinates in so many texels.
fn sampled(
    s: &Subject,
    size: [u32; 2],
    source: &str,
    uv: [f32; 4],
    filter: &str,
    modes: [AddressMode; 2],
) -> Result<Frame, crate::Missing> {
    let modes = modes.map(AddressMode::name);
    s.draw(&scene_of(
        &format!(
            r#""a": {{ "format": "rgba8unorm", "size": {size:?}, "clear": [0, 0, 1, 1] }}, "t": {{ "format": "rgba8unorm", {source} }}"#
        ),
        &format!(
            r#"{{ "color": ["a"], "draws": [ {{ "mesh": {{ "kind": "cover", "uv": {uv:?} }}, "shader": "sampled_color",
                "textures": ["t"], "sampler": {{ "filter": "{filter}", "address": {modes:?} }} }} ] }}"#
        ),
        &["a"],
    ))
}

/// Row 0 of a texture, the first that is uploaded, lies at coordinate 0. Each texel is shown twice
/// in either direction, from three textures around or from the middle of one on.
pub(crate) fn the_nearest_texel_is_taken_from_where_the_address_leads(s: &Subject) -> Checked {
    let source = format!(r#""size": [4, 2], "texels": {TEXELS}"#);
    for (size, uv, origin) in [
        ([24, 12], [-1.0, -1.0, 2.0, 2.0], [-4, -2]),
        ([24, 8], [-1.0, -0.5, 2.0, 1.5], [-4, -1]),
    ] {
        for across in AddressMode::ALL.iter().copied() {
            for down in AddressMode::ALL.iter().copied() {
                let frame = sampled(s, size, &source, uv, "nearest", [across, down])?;
                check(color(&frame, "a"), |x, y| {
                    let column = addressed(across, 4, x as i32 / 2 + origin[0]);
                    let row = addressed(down, 2, y as i32 / 2 + origin[1]);
                    [(1 + column + 10 * row) as u32, 0, 0, 255]
                });
            }
        }
    }
    Ok(())
}

/// Four attachment texels to each of the texture: weights of eighths.
fn weights(s: &Subject, mode: AddressMode) -> Checked {
    let texel = |x: u32, y: u32| [40 * x, 50 * y, 7, 255];
    let rows = [0, 1, 2, 3].map(|y| [0, 1, 2, 3].map(|x| texel(x, y)));
    let source = format!(r#""size": [4, 4], "texels": {{ "kind": "grid", "values": {rows:?} }}"#);
    let frame = sampled(
        s,
        [16, 16],
        &source,
        [0.0, 0.0, 1.0, 1.0],
        "linear",
        [mode; 2],
    )?;
    let weighed = |at: u32, step: f64| {
        let position = (f64::from(at) + 0.5) / 4.0 - 0.5;
        let (below, weight) = (position.floor() as i32, position - position.floor());
        let value = |at| step * f64::from(addressed(mode, 4, at));
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

/// At the middle between two texels both have equal weight, at a texel's centre it is alone.
fn middles(s: &Subject, mode: AddressMode, due: [u32; 8]) -> Checked {
    let source = r#""size": [2, 4], "texels": { "kind": "columns", "values": [[40, 0, 0, 255], [200, 0, 0, 255]] }"#;
    let modes = [mode, AddressMode::ClampToEdge];
    let uv = [-0.125, 0.0, 1.875, 1.0];
    let frame = sampled(s, [8, 4], source, uv, "linear", modes)?;
    let image = color(&frame, "a");
    for (x, y) in texels(image.size) {
        let came = image.sample(x, y, 0);
        assert_eq!(came, image.sample(x, 0, 0));
        assert_eq!(came[1..], [0, 0, 255]);
        check_within_one(came, [due[x as usize], 0, 0, 255]);
    }
    Ok(())
}

const A: u32 = 40;
const M: u32 = 120;
const B: u32 = 200;

pub(crate) fn neighbours_are_averaged(s: &Subject) -> Checked {
    middles(s, AddressMode::ClampToEdge, [A, A, M, B, B, B, B, B])?;
    weights(s, AddressMode::ClampToEdge)
}

pub(crate) fn neighbours_across_the_edge_are_averaged(s: &Subject) -> Checked {
    middles(s, AddressMode::Repeat, [M, A, M, B, M, A, M, B])?;
    weights(s, AddressMode::Repeat)
}

pub(crate) fn neighbours_in_the_mirror_are_averaged(s: &Subject) -> Checked {
    middles(s, AddressMode::MirrorRepeat, [A, A, M, B, B, B, M, A])?;
    weights(s, AddressMode::MirrorRepeat)
}

/// Weights may have no more than 8 bits.
pub(crate) fn averages_of_floats_are_floats(s: &Subject) -> Checked {
    let frame = s.draw(&scene_of(
        r#""a": { "format": "rgba32float", "size": [8, 8] },
           "t": { "format": "rgba16float", "size": [2, 2], "texels": { "kind": "grid", "values": [
             [[0, 0, 0, 1], [1, 0, 0, 1]], [[0, 1, 0, 1], [1, 1, 0, 1]] ] } }"#,
        r#"{ "color": ["a"], "draws": [ { "mesh": { "kind": "cover", "uv": [0, 0, 1, 1] },
             "shader": "sampled_color", "textures": ["t"],
             "sampler": { "filter": "linear", "address": ["clamp-to-edge", "repeat"] } } ] }"#,
        &["a"],
    ))?;
    for (x, y) in texels([8, 8]) {
        let position = |at: u32| (f64::from(at) + 0.5) / 4.0 - 0.5;
        let red = position(x).clamp(0.0, 1.0);
        // Beyond the ends lie the texels of the other end.
        let green = position(y).abs().min(2.0 - position(y));
        let came = values(color(&frame, "a"), x, y);
        check_near(&came, &[red, green, 0.0, 1.0], 1.0 / 256.0);
    }
    Ok(())
}

/// A sampler that an earlier draw used has no say in fetches.
pub(crate) fn fetches_need_no_sampler(s: &Subject) -> Checked {
    let frame = s.draw(&scene_of(
        &format!(
            r#""a": {{ "format": "rgba8unorm", "size": [4, 2], "clear": [0, 0, 1, 1] }},
               "t": {{ "format": "rgba8unorm", "texels": {TEXELS} }},
               "f": {{ "format": "rgba32float", "texels": {{ "kind": "columns", "values": [
                    [0, 1, 0, 1], [1, 0, 0, 1], [0, 0, 1, 1], [1, 1, 1, 1]] }} }}"#
        ),
        r#"{ "color": ["a"], "draws": [
             { "mesh": { "kind": "cover", "uv": [0, 0, 1, 1] }, "shader": "sampled_color", "textures": ["t"],
               "sampler": { "filter": "linear", "address": ["repeat", "repeat"] } },
             { "mesh": { "kind": "rect", "texels": [0, 0, 4, 1] }, "shader": "texel_color", "textures": ["f"] } ] }"#,
        &["a", "t", "f"],
    ))?;
    let fetched = [
        [0, 255, 0, 255],
        [255, 0, 0, 255],
        [0, 0, 255, 255],
        [255; 4],
    ];
    check(color(&frame, "a"), |x, y| match y {
        0 => fetched[x as usize],
        // The middle of a texel is that texel.
        _ => [11 + x, 0, 0, 255],
    });
    check(color(&frame, "t"), |x, y| [1 + x + 10 * y, 0, 0, 255]);
    Ok(())
}

/// Draws with samplers and textures of their own in one pass.
pub(crate) fn each_draw_has_its_own_sampler(s: &Subject) -> Checked {
    let draw = |[left, top, right, bottom]: [u32; 4], texture: &str, filter: &str| {
        let corners = [[left, top], [left, bottom], [right, top], [right, bottom]];
        let positions = corners.map(|[x, y]| [x, y, 0]);
        format!(
            r#"{{ "mesh": {{ "kind": "vertices", "units": "texels", "positions": {positions:?},
                  "uv": [[0.5, 0.5]] }}, "topology": "triangle-strip", "shader": "sampled_color",
                "textures": ["{texture}"],
                "sampler": {{ "filter": "{filter}", "address": ["repeat", "repeat"] }} }}"#
        )
    };
    let frame = s.draw(&scene_of(
        r#""a": { "format": "rgba8unorm", "size": [16, 16] },
           "two": { "format": "rgba8unorm", "size": [2, 1], "texels": { "kind": "grid", "values": [[[0, 0, 0, 0], [200, 100, 0, 0]]] } },
           "one": { "format": "rgba8unorm", "size": [1, 1], "texels": { "kind": "grid", "values": [[[1, 2, 3, 4]]] } }"#,
        &format!(
            r#"{{ "color": ["a"], "draws": [ {}, {}, {} ] }}"#,
            draw([0, 0, 4, 16], "two", "linear"),
            draw([4, 0, 8, 16], "one", "linear"),
            draw([8, 0, 16, 16], "one", "nearest"),
        ),
        &["a"],
    ))?;
    let image = color(&frame, "a");
    check_within_one(image.sample(1, 1, 0), [100, 50, 0, 0]);
    for x in 4..16 {
        assert_eq!(image.sample(x, 3, 0), [1, 2, 3, 4]);
    }
    Ok(())
}
