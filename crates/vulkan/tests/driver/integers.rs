//! Attachments that hold integers: cleared, uploaded, drawn, taken one sample of.

use crate::common::{backend, check, draw_if_there, image, scene_of};
use etalon_backend::Backend;
use etalon_frame::{Aspect, TextureFormat};

#[test]
fn integers_are_cleared_and_uploaded_as_they_are() {
    let rows: Vec<_> = (0..16).map(|y| [y, 255 - y, 7 * y, 128]).collect();
    let scene = scene_of(
        &format!(
            r#""cleared": {{ "format": "rgba8uint", "clear": [1, 254, 0, 255] }},
               "source": {{ "format": "rgba8uint", "texels": {{ "kind": "rows", "values": {rows:?} }} }}"#
        ),
        "",
        &["cleared", "source"],
    );
    let Some(frame) = draw_if_there(&backend(true), &scene) else {
        return;
    };
    check(image(&frame, "cleared", Aspect::Color), |_, _| {
        vec![1, 254, 0, 255]
    });
    check(image(&frame, "source", Aspect::Color), |_, y| {
        rows[y as usize].to_vec()
    });
}

#[test]
fn integers_are_drawn_through_the_write_mask() {
    let scene = scene_of(
        r#""color": { "format": "rgba8uint", "clear": [9, 9, 9, 9] }"#,
        r#"{ "color": ["color"], "draws": [
             { "mesh": { "kind": "rect", "texels": [2, 3, 9, 12] }, "shader": "uint_color",
               "params": { "color": [200, 3, 255, 0] }, "write_mask": "rba" } ] }"#,
        &["color"],
    );
    let Some(frame) = draw_if_there(&backend(true), &scene) else {
        return;
    };
    check(image(&frame, "color", Aspect::Color), |x, y| {
        if (2..9).contains(&x) && (3..12).contains(&y) {
            vec![200, 9, 255, 0]
        } else {
            vec![9; 4]
        }
    });
}

/// Samples differ, and the one that is taken is one of them: here the first, which was asked for.
#[test]
fn one_sample_of_integers_is_taken() {
    let backend = backend(true);
    let support = &backend.limits().formats[&TextureFormat::Rgba8Uint];
    for samples in support.samples.iter().filter(|s| **s > 1) {
        for mask in [1, 2] {
            let scene = scene_of(
                &format!(
                    r#""color": {{ "format": "rgba8uint", "samples": {samples}, "clear": [1, 2, 3, 4] }},
                       "one": {{ "format": "rgba8uint", "clear": [7, 7, 7, 7] }}"#
                ),
                &format!(
                    r#"{{ "color": ["color"], "resolve": ["one"], "draws": [
                         {{ "mesh": {{ "kind": "cover" }}, "shader": "uint_color",
                           "params": {{ "color": [200, 100, 50, 25] }}, "multisample": {{ "mask": {mask} }} }} ] }}"#
                ),
                &["color", "one"],
            );
            let Some(frame) = draw_if_there(&backend, &scene) else {
                return;
            };
            let color = image(&frame, "color", Aspect::Color);
            let one = image(&frame, "one", Aspect::Color);
            for (x, y) in (0..16).flat_map(|y| (0..16).map(move |x| (x, y))) {
                for sample in 0..*samples {
                    let drawn = mask >> sample & 1 == 1;
                    let due = if drawn {
                        [200, 100, 50, 25]
                    } else {
                        [1, 2, 3, 4]
                    };
                    assert_eq!(color.sample(x, y, sample), due, "({x}, {y}), {sample}");
                }
                assert_eq!(one.sample(x, y, 0), color.sample(x, y, 0), "({x}, {y})");
            }
        }
    }
    if support.samples.len() < 2 {
        eprintln!(
            "not tested: {} has one sample of integers",
            backend.adapter().name
        );
    }
}
