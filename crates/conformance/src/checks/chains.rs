//! Passes that read the results of earlier passes: drawn, resolved, cleared or uploaded.

use super::CheckEnd;
use crate::frames::{BLUE, Expect, GREEN, NONE, RED, check_near, color, texels, values};
use crate::scenes::{blend, corners, green, rect, red};
use crate::subject::CheckedBackend;
use etalon_frame::{ChannelEncoding, TextureFormat};
use serde_json::{Value, json};

/// The areas of a chain's draws, in turn: all of 5 by 4 texels, or a part.
const PARTS: [[u32; 4]; 6] = [
    [0, 0, 5, 4],
    [0, 0, 5, 4],
    [0, 0, 3, 2],
    [1, 1, 5, 4],
    [0, 0, 5, 3],
    [2, 0, 5, 4],
];

/// Returns a draw that fetches the texels of a texture.
fn fetch(texels: [u32; 4], texture: &str) -> Value {
    json!({ "mesh": rect(texels), "shader": "texel_color", "textures": [texture] })
}

/// Alternately adds one of two attachments to the other. The first pass reads an upload and draws to a
/// cleared attachment; later passes read what was drawn.
pub(crate) fn two_attachments_take_turns(s: &CheckedBackend) -> CheckEnd {
    let start = |x: u32, y: u32| [x + 5 * y, 1, 0, 2];
    let grid = [0, 1, 2, 3].map(|y| [0, 1, 2, 3, 4].map(|x| start(x, y)));
    for (format, passes) in [
        (TextureFormat::Rgba8Unorm, 6),
        (TextureFormat::R8Unorm, 6),
        (TextureFormat::Rgba16Float, 6),
        (TextureFormat::Rgba32Float, 24),
    ] {
        let part = |pass: usize| PARTS[pass % PARTS.len()];
        let pass = |pass: usize| {
            let (to, from) = [("b", "a"), ("a", "b")][pass % 2];
            let mut draw = fetch(part(pass), from);
            draw["blend"] = blend("add", "one", "one");
            json!({ "color": [to], "draws": [draw] })
        };
        let Ok(frame) = s.show(json!({
            "attachments": {
                "a": { "format": format, "size": [5, 4], "texels": { "kind": "grid", "values": grid } },
                "b": { "format": format } },
            "passes": (0..passes).map(pass).collect::<Vec<_>>(),
        })) else {
            continue;
        };
        for (name, which) in [("a", 0), ("b", 1)] {
            frame.color_is(name, |x, y| {
                let mut sums = [start(x, y), [0; 4]];
                // A channel that a format lacks reads as 0, or as 1 for alpha, and is not written.
                for pass in 0..passes {
                    let [left, top, right, bottom] = part(pass);
                    if (left..right).contains(&x) && (top..bottom).contains(&y) {
                        let from = sums[pass % 2];
                        let to = &mut sums[1 - pass % 2];
                        *to = [0, 1, 2, 3].map(|c| to[c] + from[c]);
                    }
                }
                let channels = format.color_channels().iter().zip(sums[which]);
                let code = |(encoding, sum): (&ChannelEncoding, u32)| match encoding {
                    ChannelEncoding::Unorm(_) => sum,
                    float => float.nearest_code(sum.into()),
                };
                channels.map(code).collect::<Vec<_>>()
            });
        }
    }
    Ok(())
}

/// An attachment that is read before anything is drawn to it has its clear value.
pub(crate) fn a_clear_is_read_before_the_first_draw(s: &CheckedBackend) -> CheckEnd {
    let frame = s.show(json!({
        "attachments": {
            "a": { "format": "rgba8unorm", "size": [5, 4] },
            "b": { "format": "rgba8unorm", "clear": [1, 0, 0, 1] },
            "never": { "format": "rgba32float", "clear": [0, 0, 1, 1] } },
        "passes": [
            { "color": ["a"], "draws": [fetch([0, 0, 5, 4], "b"), fetch([3, 0, 5, 3], "never")] },
            { "color": ["b"], "draws": [
                { "mesh": rect([0, 0, 2, 1]), "shader": "uniform_color", "params": green() }] }],
        "read": ["a", "b"],
    }))?;
    frame.color_is("a", |x, y| if x >= 3 && y < 3 { BLUE } else { RED });
    frame.color_is("b", |x, y| if x < 2 && y < 1 { GREEN } else { RED });
    Ok(())
}

/// Resolves and reads an attachment, draws to it again, and resolves and reads it again.
pub(crate) fn what_was_resolved_is_read(s: &CheckedBackend) -> CheckEnd {
    let many = |texels: [u32; 4], params: Value| {
        json!({ "color": ["many"], "resolve": ["one"], "draws": [
            { "mesh": corners(texels), "topology": "triangle-strip", "shader": "uniform_color",
              "params": params }] })
    };
    let read = |texels| json!({ "color": ["shown"], "draws": [fetch(texels, "one")] });
    let frame = s.show(json!({
        "attachments": {
            "many": { "format": "rgba8unorm", "size": [8, 8], "samples": 4 },
            "one": { "format": "rgba8unorm", "clear": [1, 1, 1, 1] },
            "shown": { "format": "rgba8unorm" } },
        "passes": [many([0, 0, 5, 3], red()), read([0, 0, 8, 3]),
                   many([2, 1, 8, 8], green()), read([0, 3, 8, 8])],
        "read": ["shown"],
    }))?;
    frame.color_is("shown", |x, y| match y {
        0..3 if x < 5 => RED,
        3.. if x >= 2 => GREEN,
        _ => NONE,
    });
    Ok(())
}

/// Each texel samples the corner that four texels of a larger attachment share.
pub(crate) fn a_larger_attachment_is_averaged(s: &CheckedBackend) -> CheckEnd {
    let columns = [0, 1, 2, 3, 4, 5, 6, 7];
    let grid = [0, 1, 2, 3].map(|y| columns.map(|x| [28 * x, 60 * y, 7, 255]));
    for format in ["rgba8unorm", "rgba16float"] {
        let Ok(frame) = s.show(json!({
            "attachments": {
                "large": { "format": format, "size": [8, 4] },
                "small": { "format": "rgba8unorm", "size": [4, 2] },
                "source": { "format": "rgba8unorm", "size": [8, 4],
                            "texels": { "kind": "grid", "values": grid } } },
            "passes": [
                { "color": ["large"], "draws": [fetch([0, 0, 8, 4], "source")] },
                { "color": ["small"], "draws": [{
                    "mesh": { "kind": "cover", "uv": [0, 0, 1, 1] }, "shader": "sampled_color",
                    "textures": ["large"],
                    "sampler": { "filter": "linear", "address": ["clamp-to-edge", "clamp-to-edge"] } }] }],
            "read": ["small"],
        })) else {
            continue;
        };
        for (x, y) in texels([4, 2]) {
            let expected = [56 * x + 14, 120 * y + 30, 7, 255].map(|v| f64::from(v) / 255.0);
            check_near(
                &values(color(&frame, "small"), x, y),
                &expected,
                1.01 / 255.0,
            );
        }
    }
    Ok(())
}

pub(crate) fn sampled_fragments_are_discarded(s: &CheckedBackend) -> CheckEnd {
    let rows = json!({ "kind": "rows", "values": [[1, 0, 0, 1], [0, 1, 0, 0.25]] });
    let frame = s.show(json!({
        "attachments": {
            "color": { "format": "rgba8unorm", "size": [4, 4], "clear": [0, 0, 1, 1] },
            "source": { "format": "rgba8unorm", "size": [2, 2] } },
        "passes": [
            { "color": ["source"], "draws": [{ "mesh": rows, "shader": "flat_color" }] },
            { "color": ["color"], "draws": [{
                "mesh": { "kind": "cover", "uv": [0, 0, 1, 1] }, "shader": "sampled_discard",
                "textures": ["source"], "params": { "color": [0, 0, 0, 0.5] },
                "sampler": { "filter": "nearest", "address": ["repeat", "repeat"] } }] }],
        "read": ["color"],
    }))?;
    frame.color_is("color", |_, y| if y < 2 { RED } else { BLUE });
    Ok(())
}

/// The statistics of all passes add up, and requesting them changes no picture.
pub(crate) fn invocations_of_all_passes_add_up(s: &CheckedBackend) -> CheckEnd {
    let drawn = |counters: Value, both: &[&str], second: &[&str]| {
        let pass = |to: &str, texels, from: &str, names: &[&str]| {
            let mut draw = fetch(texels, from);
            draw["counters"] = json!(names);
            json!({ "color": [to], "draws": [draw] })
        };
        s.show(json!({
            "attachments": {
                "a": { "format": "rgba8unorm", "size": [16, 16] },
                "b": { "format": "rgba8unorm", "clear": [1, 0, 0, 1] } },
            "passes": [pass("a", [0, 0, 16, 16], "b", both), pass("b", [0, 0, 16, 8], "a", second),
                       pass("a", [0, 0, 8, 8], "b", both)],
            "counters": counters,
        }))
    };
    let kind = "fragment-invocations";
    let counted = drawn(
        json!({ "both": kind, "second": kind }),
        &["both"],
        &["second"],
    )?;
    assert_eq!(counted.images, drawn(json!({}), &[], &[])?.images);
    let [both, second] = counted.counters[..] else {
        panic!("{:?}", counted.counters);
    };
    assert!((320..640).contains(&both), "{both}");
    assert!((128..256).contains(&second), "{second}");
    Ok(())
}
