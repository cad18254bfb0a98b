//! Passes that read what earlier passes left: drawn, resolved to, cleared or uploaded.

use super::Checked;
use crate::frames::{BLUE, GREEN, NONE, RED, check, check_near, color, values};
use crate::scenes::{scene, scene_of};
use crate::subject::Subject;
use etalon_frame::{ChannelEncoding, TextureFormat};

/// The draws of a chain, by turns: all of 5 by 4 texels, or a part.
const PARTS: [[u32; 4]; 6] = [
    [0, 0, 5, 4],
    [0, 0, 5, 4],
    [0, 0, 3, 2],
    [1, 1, 5, 4],
    [0, 0, 5, 3],
    [2, 0, 5, 4],
];

fn fetch(texels: [u32; 4], texture: &str, more: &str) -> String {
    format!(
        r#"{{ "mesh": {{ "kind": "rect", "texels": {texels:?} }}, "shader": "texel_color",
            "textures": ["{texture}"] {more} }}"#
    )
}

/// By turns each of two attachments is added to the other: the first pass reads an upload and draws
/// to a clear, all others read what was drawn.
pub(crate) fn two_attachments_take_turns(s: &Subject) -> Checked {
    let both = r#"{ "operation": "add", "src_factor": "one", "dst_factor": "one" }"#;
    let blend = format!(r#", "blend": {{ "color": {both}, "alpha": {both} }}"#);
    let start = |x: u32, y: u32| [x + 5 * y, 1, 0, 2];
    for (format, passes) in [
        (TextureFormat::Rgba8Unorm, 6),
        (TextureFormat::R8Unorm, 6),
        (TextureFormat::Rgba16Float, 6),
        (TextureFormat::Rgba32Float, 24),
    ] {
        let row = |y| [0, 1, 2, 3, 4].map(|x| start(x, y));
        let part = |pass: usize| PARTS[pass % PARTS.len()];
        let pass = |pass: usize| {
            let (to, from) = [("b", "a"), ("a", "b")][pass % 2];
            let draw = fetch(part(pass), from, &blend);
            format!(r#"{{ "color": ["{to}"], "draws": [ {draw} ] }}"#)
        };
        let scene = scene_of(
            &format!(
                r#""a": {{ "format": "{format}", "size": [5, 4], "texels": {{ "kind": "grid", "values": {:?} }} }},
                   "b": {{ "format": "{format}", "size": [5, 4], "clear": [0, 0, 0, 0] }}"#,
                [0, 1, 2, 3].map(row)
            ),
            &(0..passes).map(pass).collect::<Vec<_>>().join(","),
            &["a", "b"],
        );
        let Ok(frame) = s.draw(&scene) else {
            continue;
        };
        for (name, which) in [("a", 0), ("b", 1)] {
            check(color(&frame, name), |x, y| {
                let mut sums = [start(x, y), [0; 4]];
                // A channel that a format lacks reads as 0, alpha as 1, and is not written.
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

/// An attachment that is read before it is drawn to holds its clear value.
pub(crate) fn a_clear_is_read_before_the_first_draw(s: &Subject) -> Checked {
    let scene = scene_of(
        r#""a": { "format": "rgba8unorm", "size": [5, 4] },
           "b": { "format": "rgba8unorm", "size": [5, 4], "clear": [1, 0, 0, 1] },
           "never": { "format": "rgba32float", "size": [5, 4], "clear": [0, 0, 1, 1] }"#,
        &format!(
            r#"{{ "color": ["a"], "draws": [ {}, {} ] }},
               {{ "color": ["b"], "draws": [ {{ "mesh": {{ "kind": "rect", "texels": [0, 0, 2, 1] }},
                  "shader": "uniform_color", "params": {{ "color": [0, 1, 0, 1] }} }} ] }}"#,
            fetch([0, 0, 5, 4], "b", ""),
            fetch([3, 0, 5, 3], "never", ""),
        ),
        &["a", "b"],
    );
    let frame = s.draw(&scene)?;
    check(
        color(&frame, "a"),
        |x, y| {
            if x >= 3 && y < 3 { BLUE } else { RED }
        },
    );
    check(
        color(&frame, "b"),
        |x, y| {
            if x < 2 && y < 1 { GREEN } else { RED }
        },
    );
    Ok(())
}

/// Resolved, read, and both again with more drawn.
pub(crate) fn what_was_resolved_is_read(s: &Subject) -> Checked {
    // Edges between texels, which have all samples of a texel on the same side.
    let many = |[left, top, right, bottom]: [u32; 4], color: &str| {
        let corners = [[left, top], [left, bottom], [right, top], [right, bottom]];
        let positions = corners.map(|[x, y]| [x, y, 0]);
        format!(
            r#"{{ "color": ["many"], "resolve": ["one"], "draws": [ {{ "shader": "uniform_color",
                "mesh": {{ "kind": "vertices", "units": "texels", "positions": {positions:?} }},
                "topology": "triangle-strip", "params": {{ "color": {color} }} }} ] }}"#
        )
    };
    let read = |texels| {
        let draw = fetch(texels, "one", "");
        format!(r#"{{ "color": ["shown"], "draws": [ {draw} ] }}"#)
    };
    let scene = scene_of(
        r#""many": { "format": "rgba8unorm", "size": [8, 8], "samples": 4 },
           "one": { "format": "rgba8unorm", "size": [8, 8], "clear": [1, 1, 1, 1] },
           "shown": { "format": "rgba8unorm", "size": [8, 8] }"#,
        &[
            many([0, 0, 5, 3], "[1, 0, 0, 1]"),
            read([0, 0, 8, 3]),
            many([2, 1, 8, 8], "[0, 1, 0, 1]"),
            read([0, 3, 8, 8]),
        ]
        .join(","),
        &["shown"],
    );
    let frame = s.draw(&scene)?;
    check(color(&frame, "shown"), |x, y| match y {
        0..3 if x < 5 => RED,
        3.. if x >= 2 => GREEN,
        _ => NONE,
    });
    Ok(())
}

/// Each texel samples the corner that four texels of a larger attachment share.
pub(crate) fn a_larger_attachment_is_averaged(s: &Subject) -> Checked {
    let value = |x: u32, y: u32| [28 * x, 60 * y, 7, 255];
    for format in ["rgba8unorm", "rgba16float"] {
        let row = |y| [0, 1, 2, 3, 4, 5, 6, 7].map(|x| value(x, y));
        let scene = scene_of(
            &format!(
                r#""large": {{ "format": "{format}", "size": [8, 4] }},
                   "small": {{ "format": "rgba8unorm", "size": [4, 2] }},
                   "source": {{ "format": "rgba8unorm", "size": [8, 4],
                                "texels": {{ "kind": "grid", "values": {:?} }} }}"#,
                [0, 1, 2, 3].map(row)
            ),
            &format!(
                r#"{{ "color": ["large"], "draws": [ {} ] }},
                   {{ "color": ["small"], "draws": [ {{ "mesh": {{ "kind": "cover", "uv": [0, 0, 1, 1] }},
                      "shader": "sampled_color", "textures": ["large"],
                      "sampler": {{ "filter": "linear", "address": ["clamp-to-edge", "clamp-to-edge"] }} }} ] }}"#,
                fetch([0, 0, 8, 4], "source", "")
            ),
            &["small"],
        );
        let Ok(frame) = s.draw(&scene) else {
            continue;
        };
        for (x, y) in (0..2).flat_map(|y| (0..4).map(move |x| (x, y))) {
            let due = [56 * x + 14, 120 * y + 30, 7, 255].map(|v| f64::from(v) / 255.0);
            check_near(&values(color(&frame, "small"), x, y), &due, 1.01 / 255.0);
        }
    }
    Ok(())
}

pub(crate) fn sampled_fragments_are_discarded(s: &Subject) -> Checked {
    let scene = scene_of(
        r#""color": { "format": "rgba8unorm", "size": [4, 4], "clear": [0, 0, 1, 1] },
           "source": { "format": "rgba8unorm", "size": [2, 2] }"#,
        r#"{ "color": ["source"], "draws": [
             { "mesh": { "kind": "rows", "values": [[1, 0, 0, 1], [0, 1, 0, 0.25]] }, "shader": "flat_color" } ] },
           { "color": ["color"], "draws": [ { "mesh": { "kind": "cover", "uv": [0, 0, 1, 1] },
             "shader": "sampled_discard", "textures": ["source"], "params": { "color": [0, 0, 0, 0.5] },
             "sampler": { "filter": "nearest", "address": ["repeat", "repeat"] } } ] }"#,
        &["color"],
    );
    let frame = s.draw(&scene)?;
    check(
        color(&frame, "color"),
        |_, y| {
            if y < 2 { RED } else { BLUE }
        },
    );
    Ok(())
}

/// Statistics of all passes add up, and asking for them changes no picture.
pub(crate) fn invocations_of_all_passes_add_up(s: &Subject) -> Checked {
    let text = |counters: &str, both: &str, second: &str| {
        format!(
            r#"{{ "attachments": {{ "a": {{ "format": "rgba8unorm", "size": [16, 16] }},
                    "b": {{ "format": "rgba8unorm", "size": [16, 16], "clear": [1, 0, 0, 1] }} }},
                "passes": [ {{ "color": ["a"], "draws": [ {} ] }}, {{ "color": ["b"], "draws": [ {} ] }},
                            {{ "color": ["a"], "draws": [ {} ] }} ],
                "read": ["a", "b"] {counters} }}"#,
            fetch([0, 0, 16, 16], "b", both),
            fetch([0, 0, 16, 8], "a", second),
            fetch([0, 0, 8, 8], "b", both),
        )
    };
    let counted = text(
        r#", "counters": { "both": "fragment-invocations", "second": "fragment-invocations" }"#,
        r#", "counters": ["both"]"#,
        r#", "counters": ["second"]"#,
    );
    let (counted, plain) = (
        s.draw(&scene(&counted))?,
        s.draw(&scene(&text("", "", "")))?,
    );
    assert_eq!(counted.images, plain.images);
    let [both, second] = counted.counters[..] else {
        panic!("{:?}", counted.counters);
    };
    assert!(
        (320..640).contains(&both) && (128..256).contains(&second),
        "{both} {second}"
    );
    Ok(())
}
