//! Samples: masks, alpha to coverage and to one, shaders that run per sample, averages.

use crate::common::{BLACK, RED, backend, draw_if_there, image, scene_of};
use etalon_frame::{Aspect, Frame};
use etalon_scene::Scene;

/// A scene of one draw over four samples, cleared to 0.
fn four_samples(draw: &str) -> Scene {
    scene_of(
        r#""color": { "format": "rgba8unorm", "samples": 4, "clear": [0, 0, 0, 0] }"#,
        &format!(
            r#"{{ "color": ["color"], "draws": [ {{ "mesh": {{ "kind": "full" }}, {draw} }} ] }}"#
        ),
        &["color"],
    )
}

/// Holds every sample against what is due for its number. Meshes reach over texel centres, and not
/// over all samples of the texels on their border, which are left out.
#[track_caller]
fn check_samples(frame: &Frame, due: impl Fn(u32) -> [u32; 4]) {
    let image = image(frame, "color", Aspect::Color);
    for (x, y) in (1..15).flat_map(|y| (1..15).map(move |x| (x, y))) {
        for sample in 0..image.samples {
            let codes = image.sample(x, y, sample);
            assert_eq!(codes, due(sample), "({x}, {y}), sample {sample}");
        }
    }
}

#[test]
fn a_mask_lets_its_samples_through() {
    let backend = backend(true);
    for mask in [0, 0b0101, 0b1010, 0b1000, 0b1111, u32::MAX] {
        let scene = four_samples(&format!(
            r#""shader": "uniform_color", "params": {{ "color": [1, 0, 0, 1] }}, "multisample": {{ "mask": {mask} }}"#
        ));
        let Some(frame) = draw_if_there(&backend, &scene) else {
            return;
        };
        check_samples(&frame, |s| if mask >> s & 1 == 1 { RED } else { BLACK });
    }
}

#[test]
fn a_shader_that_asks_for_its_sample_runs_for_each() {
    let backend = backend(true);
    let scene = four_samples(r#""shader": "sample_index""#);
    let Some(frame) = draw_if_there(&backend, &scene) else {
        return;
    };
    check_samples(&frame, |s| [s & 1, s >> 1 & 1, 0, 1].map(|c| c * 255));
}

/// Each sample's depth is its own.
#[test]
fn a_shader_that_runs_for_each_sample_writes_each_depth() {
    let backend = backend(true);
    let scene = scene_of(
        r#""color": { "format": "rgba8unorm", "samples": 4, "clear": [0, 0, 0, 0] },
           "depth": { "format": "depth32float", "samples": 4, "clear": 1 }"#,
        r#"{ "color": ["color"], "depth_stencil": "depth", "draws": [
             { "mesh": { "kind": "cover", "z": 0.5 }, "shader": "sample_depth",
               "params": { "color": [1, 0, 0, 1] }, "depth": { "compare": "less", "write": true } } ] }"#,
        &["color", "depth"],
    );
    let Some(frame) = draw_if_there(&backend, &scene) else {
        return;
    };
    check_samples(&frame, |_| RED);
    let depth = image(&frame, "depth", Aspect::Depth);
    for at in 0..16 {
        for sample in 0..4 {
            let due = (sample as f32 + 1.0) / 32.0;
            assert_eq!(depth.sample(at, at, sample), [due.to_bits()], "{sample}");
        }
    }
}

/// Two of four samples are red and opaque, the others 0.
#[test]
fn samples_are_averaged_at_the_end_of_a_pass() {
    let backend = backend(true);
    let four = r#""format": "rgba8unorm", "samples": 4, "clear": [0, 0, 0, 0]"#;
    let scene = scene_of(
        &format!(
            r#""color": {{ {four} }}, "other": {{ {four} }}, "mean": {{ "format": "rgba8unorm", "clear": [0, 1, 0, 1] }},
               "red": {{ "format": "rgba8unorm", "texels": {{ "kind": "rows", "values": {:?} }} }}"#,
            [RED; 16]
        ),
        r#"{ "color": ["other", "color"], "resolve": [null, "mean"], "draws": [
             { "mesh": { "kind": "rect", "texels": [0, 0, 8, 16] }, "shader": "texel_color_all",
               "textures": ["red"], "multisample": { "mask": 5 } } ] }"#,
        &["color", "mean", "other"],
    );
    let Some(frame) = draw_if_there(&backend, &scene) else {
        return;
    };
    let mean = image(&frame, "mean", Aspect::Color);
    for x in (1..7).chain(9..15) {
        let texel = mean.sample(x, x, 0);
        let range = if x < 8 { 127..=128 } else { 0..=0 };
        assert!(
            range.contains(&texel[0]) && range.contains(&texel[3]),
            "{texel:?}"
        );
        assert_eq!(texel[1..3], [0, 0]);
    }
    for name in ["color", "other"] {
        let image = image(&frame, name, Aspect::Color);
        assert_eq!(image.sample(3, 3, 2), RED);
        assert_eq!(image.sample(3, 3, 3), BLACK);
    }
}

/// What a pass drew over an average stays there, and a later pass averages anew.
#[test]
fn averages_are_drawn_over_and_taken_again() {
    let backend = backend(true);
    let scene = scene_of(
        r#""color": { "format": "rgba8unorm", "samples": 4, "clear": [0, 0, 0, 0] },
           "first": { "format": "rgba8unorm", "clear": [0, 0, 0, 0] },
           "second": { "format": "rgba8unorm", "clear": [0, 0, 0, 0] }"#,
        r#"{ "color": ["color"], "resolve": ["first"], "draws": [
             { "mesh": { "kind": "full" }, "shader": "uniform_color", "params": { "color": [1, 0, 0, 1] } } ] },
           { "color": ["first"], "draws": [
             { "mesh": { "kind": "rect", "texels": [0, 0, 4, 4] }, "shader": "uniform_color", "params": { "color": 0 } } ] },
           { "color": ["color"], "resolve": ["second"], "draws": [] }"#,
        &["first", "second"],
    );
    let Some(frame) = draw_if_there(&backend, &scene) else {
        return;
    };
    let texel = |name, at| image(&frame, name, Aspect::Color).sample(at, at, 0);
    for at in 1..15 {
        assert_eq!(texel("first", at), if at < 4 { BLACK } else { RED });
        assert_eq!(texel("second", at), RED);
    }
}

#[test]
fn alpha_counts_as_one_where_asked() {
    let backend = backend(true);
    for (to_one, alpha) in [(false, 0), (true, 255)] {
        let scene = four_samples(&format!(
            r#""shader": "uniform_color", "params": {{ "color": [1, 0, 0, 0] }},
               "multisample": {{ "alpha_to_one": {to_one} }}"#
        ));
        let Some(frame) = draw_if_there(&backend, &scene) else {
            return;
        };
        check_samples(&frame, |_| [255, 0, 0, alpha]);
    }
}

#[test]
fn alpha_takes_all_samples_or_none_away() {
    let backend = backend(true);
    for (alpha, mask, covered) in [(0, 15, 0), (1, 15, 15), (1, 6, 6)] {
        let scene = four_samples(&format!(
            r#""shader": "uniform_color", "params": {{ "color": [1, 0, 0, {alpha}] }},
               "multisample": {{ "mask": {mask}, "alpha_to_coverage": true }}"#
        ));
        let Some(frame) = draw_if_there(&backend, &scene) else {
            return;
        };
        check_samples(&frame, |s| if covered >> s & 1 == 1 { RED } else { BLACK });
    }
}
