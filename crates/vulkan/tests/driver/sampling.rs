//! Textures sampled with filters and address modes; attributes interpolated inside primitives.

use crate::common::{BLACK, RED, backend, check, draw_if_there, image, scene_of};
use etalon_frame::Aspect;
use etalon_scene::Scene;

/// A texture of 4 by 4 texels, each different in red and green.
fn texture() -> String {
    let texel = |x: u32, y: u32| format!("[{}, {}, 7, 255]", 40 * x, 50 * y);
    let row = |y| (0..4).map(|x| texel(x, y)).collect::<Vec<_>>().join(",");
    let rows: Vec<_> = (0..4).map(|y| format!("[{}]", row(y))).collect();
    format!(
        r#""source": {{ "format": "rgba8unorm", "size": [4, 4], "texels": {{ "kind": "grid", "values": [{}] }} }}"#,
        rows.join(",")
    )
}

/// A scene of 16 by 16 texels that show the texture between texture coordinates.
fn sampled(uv: [f32; 4], filter: &str, address: [&str; 2]) -> Scene {
    scene_of(
        &format!(
            r#""color": {{ "format": "rgba8unorm", "size": [16, 16] }}, {}"#,
            texture()
        ),
        &format!(
            r#"{{ "color": ["color"], "draws": [ {{ "mesh": {{ "kind": "cover", "uv": {uv:?} }},
                "shader": "sampled_color", "textures": ["source"],
                "sampler": {{ "filter": "{filter}", "address": {address:?} }} }} ] }}"#
        ),
        &["color"],
    )
}

/// The texel that a number across or down stands for in an address mode.
fn addressed(mode: &str, at: i32) -> u32 {
    let at = match mode {
        "clamp-to-edge" => at.clamp(0, 3),
        "repeat" => at.rem_euclid(4),
        _ => {
            let at = at.rem_euclid(8);
            at.min(7 - at)
        }
    };
    at as u32
}

/// Texels of the attachment are half as wide as those of the texture, which begins in its middle.
#[test]
fn the_nearest_texel_is_taken_from_where_the_address_leads() {
    let modes = ["clamp-to-edge", "repeat", "mirror-repeat"];
    for across in modes {
        for down in modes {
            let scene = sampled([-1.0, -0.5, 1.0, 1.5], "nearest", [across, down]);
            let Some(frame) = draw_if_there(&backend(true), &scene) else {
                return;
            };
            check(image(&frame, "color", Aspect::Color), |x, y| {
                let column = addressed(across, x as i32 / 2 - 4);
                let row = addressed(down, y as i32 / 2 - 2);
                vec![40 * column, 50 * row, 7, 255]
            });
        }
    }
}

/// Four attachment texels to each of the texture: weights of eighths.
#[test]
fn the_linear_filter_weighs_four_texels() {
    let modes = ["clamp-to-edge", "repeat", "mirror-repeat"];
    for mode in modes {
        let scene = sampled([0.0, 0.0, 1.0, 1.0], "linear", [mode, mode]);
        let Some(frame) = draw_if_there(&backend(true), &scene) else {
            return;
        };
        let image = image(&frame, "color", Aspect::Color);
        let weighed = |at: u32, step: f64| {
            let position = (f64::from(at) + 0.5) / 4.0 - 0.5;
            let (below, weight) = (position.floor() as i32, position - position.floor());
            let value = |at| step * f64::from(addressed(mode, at));
            value(below) * (1.0 - weight) + value(below + 1) * weight
        };
        for (x, y) in (0..16).flat_map(|y| (0..16).map(move |x| (x, y))) {
            let texel = image.sample(x, y, 0);
            for (code, due) in texel.iter().zip([weighed(x, 40.0), weighed(y, 50.0)]) {
                let near = (f64::from(*code) - due).abs() <= 1.5;
                assert!(near, "{mode} ({x}, {y}): {code}, and {due} is due");
            }
            assert_eq!(texel[2..], [7, 255]);
        }
    }
}

/// Two draws with samplers and textures of their own in one pass.
#[test]
fn each_draw_has_its_own_sampler() {
    let draw = |texels: [u32; 4], texture: &str, filter: &str| {
        let [left, top, right, bottom] = texels;
        let corners = [[left, top], [left, bottom], [right, top], [right, bottom]];
        let positions = corners.map(|[x, y]| [x, y, 0]);
        format!(
            r#"{{ "mesh": {{ "kind": "vertices", "units": "texels", "positions": {positions:?},
                  "uv": [[0.5, 0.5]] }}, "topology": "triangle-strip", "shader": "sampled_color",
                "textures": ["{texture}"],
                "sampler": {{ "filter": "{filter}", "address": ["repeat", "repeat"] }} }}"#
        )
    };
    let scene = scene_of(
        r#""color": { "format": "rgba8unorm", "size": [16, 16] },
           "a": { "format": "rgba8unorm", "size": [2, 1], "texels": { "kind": "grid", "values": [[[0,0,0,0],[200,100,0,0]]] } },
           "b": { "format": "rgba8unorm", "size": [1, 1], "texels": { "kind": "grid", "values": [[[1,2,3,4]]] } }"#,
        &format!(
            r#"{{ "color": ["color"], "draws": [ {}, {}, {} ] }}"#,
            draw([0, 0, 4, 16], "a", "linear"),
            draw([4, 0, 8, 16], "b", "linear"),
            draw([8, 0, 16, 16], "b", "nearest"),
        ),
        &["color"],
    );
    let Some(frame) = draw_if_there(&backend(true), &scene) else {
        return;
    };
    let image = image(&frame, "color", Aspect::Color);
    let mixed = image.sample(1, 1, 0);
    assert!(
        (99..=101).contains(&mixed[0]) && (49..=51).contains(&mixed[1]),
        "{mixed:?}"
    );
    for x in 4..16 {
        assert_eq!(image.sample(x, 3, 0), [1, 2, 3, 4]);
    }
}

/// The coordinate is 0 on the slanted edge and grows inside.
#[test]
fn centroids_lie_inside_the_primitive() {
    let scene = scene_of(
        r#""color": { "format": "rgba8unorm", "samples": 4, "clear": [0, 0, 0, 0] }"#,
        r#"{ "color": ["color"], "draws": [ { "mesh": { "kind": "vertices", "units": "texels",
             "positions": [[3, 0, 0], [9, 16, 0], [16, 8, 0]], "uv": [[0, 0], [0, 0], [1, 0]] },
             "shader": "centroid", "params": { "color": [1, 0, 0, 1], "back_color": [0, 1, 0, 1] } } ] }"#,
        &["color"],
    );
    let Some(frame) = draw_if_there(&backend(true), &scene) else {
        return;
    };
    let image = image(&frame, "color", Aspect::Color);
    let mut partly = 0;
    for texel in image.codes.chunks(16) {
        let samples: Vec<_> = texel.chunks(4).collect();
        let covered = samples.iter().filter(|s| **s == RED).count();
        let empty = samples.iter().filter(|s| **s == BLACK).count();
        assert_eq!(covered + empty, 4, "{texel:?}");
        partly += usize::from(covered > 0 && empty > 0);
    }
    assert!(partly > 8, "{partly}");
}
