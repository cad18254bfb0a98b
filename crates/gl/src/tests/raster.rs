//! Viewport, scissor, depth, topologies and polygon modes.

use super::checks::depth_code;
use super::help::{CLEAR, RED, draw, each, scene};
use crate::GlBackend;
use etalon_backend::{Backend, BackendError};
use etalon_frame::{Feature, Frame, TextureFormat};

pub(super) fn all(backend: &GlBackend) {
    viewport_and_scissor(backend);
    depth_ranges(backend);
    depth_bias(backend);
    depth_clamp_and_bounds(backend);
    topologies(backend);
    polygon_mode_and_discard(backend);
}

fn has(backend: &GlBackend, feature: Feature) -> bool {
    backend.limits().features.contains(&feature)
}

/// Red over a blue image of 16 by 16, with more state for the draw.
fn red(backend: &GlBackend, mesh: &str, state: &str) -> Frame {
    draw(
        backend,
        &format!(
            r#"{{"attachments": {{"color": {{"format":"rgba8unorm","size":[16,16],"clear":[0,0,1,1]}}}},
            "passes": [{{"color":["color"],"draws":[
                {{"mesh":{mesh},"shader":"uniform_color","params":{{"color":[1,0,0,1]}}{state}}}]}}],
            "read": ["color"]}}"#
        ),
    )
}

fn red_where(frame: &Frame, inside: impl Fn(u32, u32) -> bool) {
    each(&frame.images[0], |x, y| {
        if inside(x, y) { RED } else { CLEAR }.to_vec()
    });
}

const FULL: &str = r#"{"kind":"full"}"#;

fn viewport_and_scissor(backend: &GlBackend) {
    // A quarter at the bottom right: what clip space's top left becomes.
    let viewport = r#","viewport":{"rect":[8,4,8,12],"depth":[0,1]}"#;
    let frame = red(backend, r#"{"kind":"rect","texels":[0,0,4,3]}"#, viewport);
    red_where(&frame, |x, y| (8..12).contains(&x) && (4..7).contains(&y));
    let outside = r#","viewport":{"rect":[-16,-8,32,16],"depth":[0,1]}"#;
    let frame = red(backend, FULL, outside);
    red_where(&frame, |_, y| y < 8);
    a_viewport_between_texels_is_kept_or_refused(backend);
    let frame = red(backend, FULL, r#","scissor":[3,12,1,1]"#);
    red_where(&frame, |x, y| x == 3 && y == 12);
    let frame = red(backend, FULL, r#","scissor":[12,2,4294967295,4294967295]"#);
    red_where(&frame, |x, y| x >= 12 && y >= 2);
    let frame = red(backend, FULL, r#","scissor":[3,12,0,4]"#);
    red_where(&frame, |_, _| false);
}

/// GL may round it where it keeps no bits below the texel, and then it must not be drawn.
fn a_viewport_between_texels_is_kept_or_refused(backend: &GlBackend) {
    let bits = backend.context.caps.viewport_bits;
    println!("viewport bits {bits:?}");
    let scene = scene(
        r#"{"attachments": {"color": {"format":"rgba8unorm","size":[16,16],"clear":[0,0,1,1]}},
        "passes": [{"color":["color"],"draws":[
            {"mesh":{"kind":"full"},"shader":"uniform_color",
             "viewport":{"rect":[0,0,8.5,16],"depth":[0,1]}}]}],
        "read": ["color"]}"#,
    );
    let refused = matches!(
        backend.prepare(&scene).err(),
        Some(BackendError::NotSupported(_))
    );
    assert_eq!(refused, bits.unwrap_or(0) == 0);
}

/// The depths that a draw stores in `depth32float` over 0.5.
fn depths(backend: &GlBackend, z: &str, state: &str) -> Frame {
    draw(
        backend,
        &format!(
            r#"{{"attachments": {{"d": {{"format":"depth32float","size":[16,16],"clear":0.5}}}},
            "passes": [{{"depth_stencil":"d","draws":[
                {{"mesh":{{"kind":"columns","values":[0,0],"z":{z}}},"shader":"uniform_color",
                  "depth":{{"compare":"always","write":true}}{state}}}]}}],
            "read": ["d"]}}"#
        ),
    )
}

fn stored(backend: &GlBackend, frame: &Frame, left: f32, right: f32) {
    let [left, right] = [left, right].map(|v| depth_code(backend, TextureFormat::Depth32Float, v));
    each(&frame.images[0], |x, _| {
        vec![if x < 8 { left } else { right }]
    });
}

fn depth_ranges(backend: &GlBackend) {
    let viewport = |depth| format!(r#","viewport":{{"rect":[0,0,16,16],"depth":{depth}}}"#);
    let frame = depths(backend, "[0,1]", &viewport("[0.25,0.75]"));
    stored(backend, &frame, 0.25, 0.75);
    let frame = depths(backend, "[0,1]", &viewport("[1,0]"));
    stored(backend, &frame, 1.0, 0.0);
    let frame = depths(backend, "[0,1]", "");
    stored(backend, &frame, 0.0, 1.0);
}

fn depth_bias(backend: &GlBackend) {
    // The least step at a depth of 1/2 is 2^-1 * 2^-23, at most twice that (OpenGL 4.6, 14.6.5).
    let step = 2_f32.powi(-24);
    let frame = depths(backend, "[0.5,0.5]", r#","depth_bias":{"constant":1024}"#);
    let depth = f32::from_bits(frame.images[0].sample(3, 3, 0)[0]);
    let steps = (depth - 0.5) / step;
    assert!((1024.0..=2048.0).contains(&steps), "{steps} steps");
    let frame = depths(backend, "[0.5,0.5]", r#","depth_bias":{"constant":0}"#);
    stored(backend, &frame, 0.5, 0.5);
    if has(backend, Feature::DepthBiasClamp) {
        let state = r#","depth_bias":{"constant":16777216,"clamp":0.125}"#;
        let frame = depths(backend, "[0.5,0.25]", state);
        stored(backend, &frame, 0.625, 0.375);
    }
}

fn depth_clamp_and_bounds(backend: &GlBackend) {
    let frame = depths(backend, "[-1,2]", "");
    stored(backend, &frame, 0.5, 0.5);
    // softpipe clamps to the range that clip depths from -1 on would have, even under clip control
    // (near = translate - scale in sp_quad_depth_test.c): the driver's bug, and for cases to find.
    let softpipe = backend.adapter().device == "softpipe" && backend.context.caps.clip_control;
    if has(backend, Feature::DepthClamp) && !softpipe {
        let frame = depths(backend, "[-1,2]", r#","depth_clamp":true"#);
        stored(backend, &frame, 0.0, 1.0);
        let state = r#","depth_clamp":true,"viewport":{"rect":[0,0,16,16],"depth":[0.25,0.75]}"#;
        let frame = depths(backend, "[-1,2]", state);
        stored(backend, &frame, 0.25, 0.75);
    }
    if has(backend, Feature::DepthBounds) {
        for (bounds, due) in [("[0.5,0.75]", [0.0, 1.0]), ("[0.625,1]", [0.5, 0.5])] {
            let state = format!(r#","depth_bounds":{bounds}"#);
            let frame = depths(backend, "[0,1]", &state);
            stored(backend, &frame, due[0], due[1]);
        }
    }
}

fn topologies(backend: &GlBackend) {
    let vertices = |positions: &str, indices: &str| {
        format!(
            r#"{{"kind":"vertices","units":"texels","positions":{positions},"indices":{indices}}}"#
        )
    };
    let topology = |name| format!(r#","topology":"{name}""#);
    let points = vertices("[[1.5,2.5,0],[9.5,4.5,0],[15.5,15.5,0]]", "[0,2]");
    let frame = red(backend, &points, &topology("point-list"));
    red_where(&frame, |x, y| [(1, 2), (15, 15)].contains(&(x, y)));
    // From centre to centre; the diamond rule leaves the last texel out.
    let line = vertices("[[2.5,3.5,0],[10.5,3.5,0]]", "[0,1]");
    for name in ["line-list", "line-strip"] {
        let frame = red(backend, &line, &topology(name));
        red_where(&frame, |x, y| (2..10).contains(&x) && y == 3);
    }
    let corners = "[[0,0,0],[8,0,0],[8,8.25,0],[0,8.25,0]]";
    let fan = vertices(corners, "[0,1,2,3]");
    let frame = red(backend, &fan, &topology("triangle-fan"));
    red_where(&frame, |x, y| x < 8 && y < 8);
    // Two strips; without the restart the texels between them would be red.
    let strips = vertices(
        "[[0,0,0],[0,4,0],[4.25,0,0],[4.25,4,0],[10,10,0],[10,14,0],[14.25,10,0],[14.25,14,0]]",
        "[0,1,2,3,null,4,5,6,7]",
    );
    let frame = red(backend, &strips, &topology("triangle-strip"));
    let inside = |x: u32, y: u32| x < 4 && y < 4;
    red_where(&frame, |x, y| {
        inside(x, y) || (x >= 10 && y >= 10 && inside(x - 10, y - 10))
    });
    // Indices count from the draw's own first vertex.
    let frame = draw(
        backend,
        &format!(
            r#"{{"attachments": {{"color": {{"format":"rgba8unorm","size":[16,16],"clear":[0,0,1,1]}}}},
            "passes": [{{"color":["color"],"draws":[
                {{"mesh":{},"topology":"point-list","shader":"flat_color"}},
                {{"mesh":{},"topology":"triangle-strip","shader":"uniform_color",
                  "params":{{"color":[1,0,0,1]}}}}]}}],
            "read": ["color"]}}"#,
            points, strips
        ),
    );
    assert_eq!(frame.images[0].sample(0, 0, 0), RED);
    assert_eq!(frame.images[0].sample(15, 15, 0), [0; 4]);
}

fn polygon_mode_and_discard(backend: &GlBackend) {
    let frame = red(backend, FULL, r#","rasterizer_discard":true"#);
    red_where(&frame, |_, _| false);
    if has(backend, Feature::PolygonModeLine) {
        let triangle = r#"{"kind":"vertices","units":"texels",
            "positions":[[2.5,2.5,0],[2.5,12.5,0],[12.5,2.5,0]]}"#;
        let frame = red(backend, triangle, r#","polygon_mode":"line""#);
        let image = &frame.images[0];
        for at in 3..12 {
            assert_eq!(image.sample(at, 2, 0), RED);
            assert_eq!(image.sample(2, at, 0), RED);
        }
        for inside in [[4, 4], [5, 6]] {
            assert_eq!(image.sample(inside[0], inside[1], 0), CLEAR);
        }
    }
}
