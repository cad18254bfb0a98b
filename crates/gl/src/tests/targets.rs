//! Several colour attachments, two sources and logic operations.

use super::help::{CLEAR, GREEN, draw, each};
use crate::GlBackend;
use etalon_backend::Backend;
use etalon_frame::Feature;
use etalon_scene::LogicOperation;

pub(super) fn all(backend: &GlBackend) {
    let features = &backend.limits().features;
    images_of_all_targets_agree(backend);
    if features.contains(&Feature::IndependentBlend) {
        targets_differ(backend);
    }
    if features.contains(&Feature::DualSourceBlending) {
        two_sources(backend);
    }
    if features.contains(&Feature::LogicOperations) {
        logic(backend);
    }
}

const TEXELS: &str =
    r#"{"kind":"rows","values":[[255,0,255,0],[0,255,51,255],[255,255,0,0],[0,0,0,255]]}"#;
const ROWS: [[u32; 4]; 4] = [
    [255, 0, 255, 0],
    [0, 255, 51, 255],
    [255, 255, 0, 0],
    [0, 0, 0, 255],
];

fn images_of_all_targets_agree(backend: &GlBackend) {
    assert!(backend.limits().max_color_attachments >= 4);
    let frame = draw(
        backend,
        &format!(
            r#"{{"attachments": {{
                "a": {{"format":"rgba8unorm","size":[4,4]}}, "b": {{"format":"rgba8unorm"}},
                "c": {{"format":"rgba8unorm"}}, "d": {{"format":"rgba8unorm"}},
                "t": {{"format":"rgba8unorm","texels":{TEXELS}}}}},
            "passes": [{{"color":["a","b","c","d"],"draws":[
                {{"mesh":{{"kind":"full"}},"shader":"texel_color_all","textures":["t"]}}]}}],
            "read": ["a","b","c","d"]}}"#
        ),
    );
    for image in &frame.images {
        each(image, |_, y| ROWS[y as usize].to_vec());
    }
}

fn targets_differ(backend: &GlBackend) {
    let add = r#"{"operation":"add","src_factor":"one","dst_factor":"one"}"#;
    let subtract = r#"{"operation":"reverse-subtract","src_factor":"one","dst_factor":"one"}"#;
    let frame = draw(
        backend,
        &format!(
            r#"{{"attachments": {{
                "a": {{"format":"rgba8unorm","size":[4,4],"clear":[0,0,1,1]}},
                "b": {{"format":"rgba8unorm","clear":[0,0,1,1]}},
                "c": {{"format":"rgba8unorm","clear":[0,0,1,1]}},
                "t": {{"format":"rgba8unorm","texels":{TEXELS}}}}},
            "passes": [{{"color":["a","b","c"],"draws":[
                {{"mesh":{{"kind":"full"}},"shader":"texel_color_all","textures":["t"],"targets":[
                    {{"blend":{{"color":{add},"alpha":{subtract}}}}},
                    {{"write_mask":"gb"}},
                    {{"blend":{{"color":{subtract},"alpha":{add}}},"write_mask":"rba"}}]}},
                {{"mesh":{{"kind":"rect","texels":[0,3,4,4]}},"shader":"texel_color_all",
                  "textures":["t"],"write_mask":""}}]}}],
            "read": ["a","b","c"]}}"#
        ),
    );
    let row = |y: u32| ROWS[y as usize];
    each(&frame.images[0], |_, y| {
        let [r, g, _, a] = row(y);
        vec![r, g, 255, 255 - a]
    });
    each(&frame.images[1], |_, y| {
        let [_, g, b, _] = row(y);
        vec![0, g, b, 255]
    });
    each(&frame.images[2], |_, y| {
        let [_, _, b, _] = row(y);
        vec![0, 0, 255 - b, 255]
    });
}

fn two_sources(backend: &GlBackend) {
    let component = |src: &str, dst: &str| {
        format!(r#"{{"operation":"add","src_factor":"{src}","dst_factor":"{dst}"}}"#)
    };
    let frame = |color: String, alpha: String| {
        draw(
            backend,
            &format!(
                r#"{{"attachments": {{
                    "a": {{"format":"rgba8unorm","size":[4,4],"clear":[1,1,0,1]}},
                    "s": {{"format":"rgba8unorm","texels":{{"kind":"rows","values":[
                        [255,255,255,255],[255,255,255,255],[0,0,0,0],[0,0,0,0]]}}}},
                    "t": {{"format":"rgba8unorm","texels":{TEXELS}}}}},
                "passes": [{{"color":["a"],"draws":[
                    {{"mesh":{{"kind":"full"}},"shader":"texel_dual_source","textures":["s","t"],
                      "blend":{{"color":{color},"alpha":{alpha}}}}}]}}],
                "read": ["a"]}}"#
            ),
        )
    };
    let source = |y: u32| if y < 2 { 255 } else { 0 };
    let of = |a: u32, b: u32| a * b / 255;
    let drawn = frame(component("src1", "zero"), component("src1-alpha", "zero"));
    each(&drawn.images[0], |_, y| {
        ROWS[y as usize].map(|v| of(source(y), v)).to_vec()
    });
    let drawn = frame(
        component("zero", "one-minus-src1"),
        component("zero", "one-minus-src1-alpha"),
    );
    each(&drawn.images[0], |_, y| {
        let [r, g, _, a] = ROWS[y as usize];
        vec![255 - r, 255 - g, 0, 255 - a]
    });
    // Factors that name the second source do not stay.
    images_of_all_targets_agree(backend);
}

fn logic(backend: &GlBackend) {
    // Every pair of bits stands in 0011 and 0101.
    let (s, d) = (0b0011_1100_u32, 0b0101_1010_u32);
    for operation in LogicOperation::ALL {
        let due = match operation {
            LogicOperation::Clear => 0,
            LogicOperation::And => s & d,
            LogicOperation::AndReverse => s & !d,
            LogicOperation::Copy => s,
            LogicOperation::AndInverted => !s & d,
            LogicOperation::Noop => d,
            LogicOperation::Xor => s ^ d,
            LogicOperation::Or => s | d,
            LogicOperation::Nor => !(s | d),
            LogicOperation::Equivalent => !(s ^ d),
            LogicOperation::Invert => !d,
            LogicOperation::OrReverse => s | !d,
            LogicOperation::CopyInverted => !s,
            LogicOperation::OrInverted => !s | d,
            LogicOperation::Nand => !(s & d),
            LogicOperation::Set => 255,
        } & 255;
        let texels = |v: u32| {
            format!(r#"{{"kind":"columns","values":[[{v},{v},{v},{v}],[{v},{v},0,255]]}}"#)
        };
        let frame = draw(
            backend,
            &format!(
                r#"{{"attachments": {{
                    "a": {{"format":"rgba8unorm","size":[2,1],"texels":{}}},
                    "t": {{"format":"rgba8unorm","texels":{}}}}},
                "passes": [{{"color":["a"],"draws":[
                    {{"mesh":{{"kind":"full"}},"shader":"texel_color","textures":["t"],
                      "logic":"{}"}}]}}],
                "read": ["a"]}}"#,
                texels(d),
                texels(s),
                operation.name()
            ),
        );
        assert_eq!(frame.images[0].sample(0, 0, 0), [due; 4], "{operation:?}");
    }
    // Nothing of it is left for the next scene.
    let frame = draw(
        backend,
        r#"{"attachments": {"a": {"format":"rgba8unorm","size":[16,16],"clear":[0,0,1,1]}},
        "passes": [{"color":["a"],"draws":[
            {"mesh":{"kind":"rect","texels":[0,0,4,16]},"shader":"uniform_color",
             "params":{"color":[0,1,0,1]}}]}],
        "read": ["a"]}"#,
    );
    each(&frame.images[0], |x, _| {
        if x < 4 { GREEN } else { CLEAR }.to_vec()
    });
}
