//! Attachments with several samples.
#![expect(clippy::unwrap_used, reason = "these are tests")]

use super::help::{CLEAR, RED, draw};
use crate::GlBackend;
use etalon_backend::Backend;
use etalon_frame::{ChannelEncoding, Feature, Frame, Image, ReadPath, TextureFormat};

pub(super) fn all(backend: &GlBackend) {
    let support = &backend.limits().formats[&TextureFormat::Rgba8Unorm];
    assert_eq!(support.samples[0], 1);
    let several = &support.samples[1..];
    println!(
        "samples {several:?}: {:?}",
        backend.limits().sample_positions
    );
    let software = backend.adapter().device.to_lowercase();
    assert_eq!(
        several,
        if software.starts_with("softpipe") {
            &[][..]
        } else {
            &[4]
        }
    );
    if several.contains(&4) {
        positions_are_where_they_are_said_to_be(backend);
        samples_are_masked(backend);
        alpha_and_samples(backend);
        every_format_keeps_its_samples(backend);
        samples_are_shaded(backend);
        shaders_write_the_depth_of_each_sample(backend);
        attributes_are_taken_inside_the_primitive(backend);
    }
}

fn has(backend: &GlBackend, feature: Feature) -> bool {
    backend.limits().features.contains(&feature)
}

fn each_sample(image: &Image, expected: impl Fn(u32, u32, u32) -> [u32; 4]) {
    assert_eq!(image.codes.len(), image.expected_len());
    for y in 0..image.size[1] {
        for x in 0..image.size[0] {
            for s in 0..image.samples {
                let due = expected(x, y, s);
                let due = &due[..image.channels.len()];
                let name = &image.attachment;
                assert_eq!(image.sample(x, y, s), due, "{name} at {x} {y}, sample {s}");
            }
        }
    }
}

/// Draws over four blue samples and their average.
fn four(backend: &GlBackend, mesh: &str, shader: &str, state: &str) -> Frame {
    draw(
        backend,
        &format!(
            r#"{{"attachments": {{
                "m": {{"format":"rgba8unorm","size":[16,16],"samples":4,"clear":[0,0,1,1]}},
                "r": {{"format":"rgba8unorm","size":[16,16],"clear":[0,1,0,0]}}}},
            "passes": [{{"color":["m"],"resolve":["r"],"draws":[
                {{"mesh":{mesh},"shader":"{shader}"{state}}}]}}],
            "read": ["m","r"]}}"#
        ),
    )
}

/// One triangle over all samples of all texels.
fn full(value: &str) -> String {
    format!(r#"{{"kind":"vertices","values":[{value}],"positions":[[-1,-1,0],[3,-1,0],[-1,3,0]]}}"#)
}

const VALUE: &str = "[1,0,0,1]";

/// A rectangle whose edges cut through texels covers the samples inside it.
fn positions_are_where_they_are_said_to_be(backend: &GlBackend) {
    let positions = &backend.limits().sample_positions[&4];
    assert_eq!(positions.len(), 4);
    for (dx, dy) in [(64, 0), (192, 0), (0, 64), (0, 192), (128, 0), (0, 128)] {
        // From this corner on to beyond the bottom right one, in a single triangle.
        let (x, y) = (f64::from(dx) / 256.0, f64::from(dy) / 256.0);
        let mesh = format!(
            r#"{{"kind":"vertices","units":"texels","values":[[1,0,0,1]],
                "positions":[[{x},{y},0],[{x},64,0],[64,{y},0]]}}"#
        );
        let frame = four(backend, &mesh, "flat_color", "");
        each_sample(&frame.images[0], |px, py, s| {
            let [sx, sy] = positions[s as usize];
            let inside = px * 256 + u32::from(sx) > dx && py * 256 + u32::from(sy) > dy;
            if inside { RED } else { CLEAR }
        });
    }
}

fn samples_are_masked(backend: &GlBackend) {
    let state = r#","multisample":{"mask":5}"#;
    let frame = four(backend, &full(VALUE), "flat_color", state);
    let image = &frame.images[0];
    assert_eq!((image.samples, image.read), (4, ReadPath::Copy));
    each_sample(image, |_, _, s| if s % 2 == 0 { RED } else { CLEAR });
    each_sample(&frame.images[1], |x, y, _| {
        let sample: [u32; 4] = frame.images[1].sample(x, y, 0).try_into().unwrap();
        let due = [128, 0, 128, 255_u32];
        let near = sample.iter().zip(due).all(|(a, d)| a.abs_diff(d) <= 1);
        assert!(near, "{sample:?}, due {due:?}");
        sample
    });
    let frame = four(
        backend,
        &full(VALUE),
        "flat_color",
        r#","multisample":{"mask":0}"#,
    );
    each_sample(&frame.images[0], |_, _, _| CLEAR);
    let state = r#","scissor":[0,0,8,16]"#;
    let frame = four(backend, &full(VALUE), "flat_color", state);
    for image in &frame.images {
        // The average is taken of all, whatever the draws' scissor.
        each_sample(image, |x, _, _| if x < 8 { RED } else { CLEAR });
    }
}

fn alpha_and_samples(backend: &GlBackend) {
    let value = |alpha: &str| full(&format!("[1,0,0,{alpha}]"));
    let coverage = r#","multisample":{"alpha_to_coverage":true}"#;
    let frame = four(backend, &value("0"), "flat_color", coverage);
    each_sample(&frame.images[0], |_, _, _| CLEAR);
    let frame = four(backend, &value("1"), "flat_color", coverage);
    each_sample(&frame.images[0], |_, _, _| RED);
    if has(backend, Feature::AlphaToOne) {
        let one = r#","multisample":{"alpha_to_one":true}"#;
        let frame = four(backend, &value("0.25"), "flat_color", one);
        each_sample(&frame.images[0], |_, _, _| RED);
    }
}

fn samples_are_shaded(backend: &GlBackend) {
    if has(backend, Feature::SampleShading) {
        let frame = four(backend, &full(VALUE), "sample_index", "");
        each_sample(&frame.images[0], |_, _, s| {
            [s & 1, s >> 1 & 1, s >> 2 & 1, 1].map(|bit| bit * 255)
        });
    }
}

fn shaders_write_the_depth_of_each_sample(backend: &GlBackend) {
    if !has(backend, Feature::SampleShading) {
        return;
    }
    let frame = draw(
        backend,
        &format!(
            r#"{{"attachments": {{
                "c": {{"format":"rgba8unorm","size":[8,8],"samples":4,"clear":[0,0,1,1]}},
                "d": {{"format":"depth32float","size":[8,8],"samples":4,"clear":0.078125}}}},
            "passes": [{{"color":["c"],"depth_stencil":"d","draws":[
                {{"mesh":{},"shader":"sample_depth","params":{{"color":[1,0,0,1]}},
                  "depth":{{"compare":"less","write":true}}}}]}}],
            "read": ["c","d"]}}"#,
            full("0")
        ),
    );
    // The last two are not below what is stored.
    each_sample(&frame.images[0], |_, _, s| if s < 2 { RED } else { CLEAR });
    each_sample(&frame.images[1], |_, _, s| {
        let depth = [1.0_f32, 2.0, 2.5, 2.5][s as usize] / 32.0;
        [depth.to_bits(); 4]
    });
}

/// The triangle covers half of a texel's samples and not its centre, where the texture coordinate
/// would be negative.
fn attributes_are_taken_inside_the_primitive(backend: &GlBackend) {
    assert!(has(backend, Feature::CentroidInterpolation));
    let mesh = r#"{"kind":"vertices","units":"texels",
        "positions":[[4.5625,-16,0],[4.5625,48,0],[68.5625,-16,0]],"uv":[[0,0],[0,0],[64,0]]}"#;
    let params = r#","params":{"color":[1,0,0,1],"back_color":[0,1,0,1]}"#;
    let frame = four(backend, mesh, "centroid", params);
    let positions = &backend.limits().sample_positions[&4];
    each_sample(&frame.images[0], |x, _, s| {
        let [across, _] = positions[s as usize];
        let inside = x * 256 + u32::from(across) > 4 * 256 + 144;
        if inside { RED } else { CLEAR }
    });
}

/// Colours and depths of one and zero, and stencil values, in two samples of four.
fn every_format_keeps_its_samples(backend: &GlBackend) {
    for (format, support) in &backend.limits().formats {
        if !support.samples.contains(&4) {
            println!("{format} has not four samples");
            continue;
        }
        if format.is_color() {
            let frame = draw(
                backend,
                &format!(
                    r#"{{"attachments": {{
                        "m": {{"format":"{format}","size":[8,8],"samples":4,"clear":[0,0,1,1]}},
                        "r": {{"format":"{format}","size":[8,8]}}}},
                    "passes": [{{"color":["m"],"resolve":["r"],"draws":[
                        {{"mesh":{},"scissor":[0,0,4,8],"shader":"{}","params":{{"color":[1,1,0,0]}},
                          "multisample":{{"mask":6}}}}]}}],
                    "read": ["m","r"]}}"#,
                    full("[1,1,0,0]"),
                    if format.is_integer() {
                        "uint_color"
                    } else {
                        "flat_color"
                    }
                ),
            );
            let channels = format.color_channels();
            let one = |c: usize| channels.get(c).map_or(0, |e| e.nearest_code(1.0));
            let code = |on: [bool; 4]| [0, 1, 2, 3].map(|c| if on[c] { one(c) } else { 0 });
            let blue = [false, false, true, true];
            each_sample(&frame.images[0], |x, _, s| {
                let drawn = x < 4 && [1, 2].contains(&s);
                code(if drawn { blue.map(|on| !on) } else { blue })
            });
            each_sample(&frame.images[1], |x, y, _| {
                let found = frame.images[1].sample(x, y, 0);
                let mut result = [0; 4];
                result[..found.len()].copy_from_slice(found);
                assert!(x < 4 || result == code(blue), "{format}: {found:?}");
                // Integers are not averaged: one of the samples is taken.
                let one = [code(blue), code(blue.map(|on| !on))].contains(&result);
                assert!(!format.is_integer() || one, "{format}: {found:?}");
                result
            });
            continue;
        }
        let clear = match (format.has_depth(), format.has_stencil()) {
            (true, true) => r#"{"depth":1,"stencil":90}"#,
            (true, false) => "1",
            _ => "90",
        };
        let stencil = match format.has_stencil() {
            true => {
                r#","stencil":{"reference":7,"front":{"compare":"always","pass_op":"replace"}}"#
            }
            false => "",
        };
        let depth = match format.has_depth() {
            true => r#","depth":{"compare":"less","write":true}"#,
            false => "",
        };
        let frame = draw(
            backend,
            &format!(
                r#"{{"attachments": {{
                    "d": {{"format":"{format}","size":[8,8],"samples":4,"clear":{clear}}}}},
                "passes": [{{"depth_stencil":"d","draws":[
                    {{"mesh":{},"scissor":[0,0,8,4],"shader":"flat_color_depth",
                      "multisample":{{"mask":6}}{depth}{stencil}}}]}}],
                "read": ["d"]}}"#,
                full("0")
            ),
        );
        for image in &frame.images {
            let [off, on] = match image.channels[0] {
                ChannelEncoding::Uint(8) => [90, 7],
                encoding => [encoding.nearest_code(1.0), 0],
            };
            each_sample(image, |_, y, s| {
                [if y < 4 && [1, 2].contains(&s) {
                    on
                } else {
                    off
                }; 4]
            });
        }
    }
}
