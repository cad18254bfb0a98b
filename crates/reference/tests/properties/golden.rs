//! Textbook numbers and the specifications' own examples, in every API's legal set.

use crate::common::{APIS, all_rules, draw, limits, scene};
use etalon_frame::{Api, ChannelEncoding, CodeInterval, compare};
use etalon_pipeline::Arithmetic;
use etalon_reference::{Judging, Range, Rules, judgements, legal_set};

fn stored(rules: &Rules, encoding: ChannelEncoding, value: f32) -> CodeInterval {
    let mut a = Judging::new(rules);
    let value = a.constant(value);
    a.encode(encoding, value)
}

#[test]
fn floats_become_the_codes_of_the_conversion_rules() {
    let (u8_, u16_, u24) = (
        ChannelEncoding::Unorm(8),
        ChannelEncoding::Unorm(16),
        ChannelEncoding::Unorm(24),
    );
    let rows: [(ChannelEncoding, f32, i64, i64); 13] = [
        (u8_, 0.0, 0, 0),
        (u8_, 1.0, 255, 255),
        (u8_, 0.5, 127, 128),
        (u8_, -3.0, 0, 0),
        (u8_, 7.5, 255, 255),
        // 63.75 and 191.25: the yardstick requires the nearest.
        (u8_, 0.25, 63, 64),
        (u8_, 0.75, 191, 192),
        (u16_, 0.0, 0, 0),
        (u16_, 1.0, 65535, 65535),
        (u16_, 0.5, 32767, 32768),
        (u24, 0.0, 0, 0),
        (u24, 1.0, 0xff_ffff, 0xff_ffff),
        // 8388607.5, computed within 1 part in 10^5.
        (u24, 0.5, 8_388_523, 8_388_692),
    ];
    for (encoding, value, low, high) in rows {
        for api in APIS {
            let expected = CodeInterval::new(low, high);
            assert_eq!(
                stored(&Rules::of(&limits(api)), encoding, value),
                expected,
                "{api} {encoding} {value}"
            );
        }
    }
    let yardstick = Rules::yardstick(&limits(Api::Vulkan));
    for (value, low, high) in [
        (0.25, 64, 64),
        (0.75, 191, 191),
        (0.5, 127, 128),
        (0.2, 51, 51),
    ] {
        assert_eq!(
            stored(&yardstick, u8_, value),
            CodeInterval::new(low, high),
            "{value}"
        );
    }
}

#[test]
fn codes_become_the_fractions_that_they_stand_for() {
    for rules in all_rules() {
        let mut a = Judging::new(&rules);
        for (bits, code, value) in [
            (8, 51, 0.2),
            (8, 85, 1.0 / 3.0),
            (8, 128, 128.0 / 255.0),
            (16, 13107, 0.2),
            (16, 21845, 1.0 / 3.0),
            (24, 5_592_405, 1.0 / 3.0),
        ] {
            let range = a.decode(ChannelEncoding::Unorm(bits), CodeInterval::exact(code));
            assert!(
                range.float.contains(value),
                "{} {code} of {bits} bits",
                rules.name
            );
            assert!(range.float.high - range.float.low <= 3e-5, "{}", rules.name);
        }
        for (code, value) in [(0, 0.0), (255, 1.0)] {
            let range = a.decode(ChannelEncoding::Unorm(8), CodeInterval::exact(code));
            assert!(range == Range::exact(value), "{}", rules.name);
        }
    }
}

/// Blends one colour over uploaded codes and compares the legal sets with the expected codes: at most `most`
/// codes per channel are legal, and by the yardstick only the expected one.
fn blended(blend: &str, src: &str, dst: &str, expected: [i64; 4], most: u64) {
    let scene = scene(&format!(
        r#"{{"attachments":{{"color":{{"format":"rgba8unorm","size":[1,1],"texels":{{"kind":"rows","values":[{dst}]}}}}}},
           "passes":[{{"color":["color"],"draws":[{{"mesh":{{"kind":"full"}},"shader":"uniform_color",
           "params":{{"color":{src}}},"blend":{blend},"blend_constant":[0.2,0.4,0.6,0.8]}}]}}],"read":["color"]}}"#
    ));
    for api in APIS {
        for judgement in judgements(&scene, &limits(api)) {
            let legal = judgement.legal.groups[0].sample(0, 0, 0);
            assert!(legal.allows(&expected), "{api} {blend}: {legal:?}");
            for c in 0..4 {
                let count = legal.count(c);
                assert!(count <= most, "{api} {blend}, channel {c}: {count} codes");
            }
            let tight = judgement.yardstick.groups[0].sample(0, 0, 0);
            let exact = tight.worlds.len() == 1 && (0..4).all(|c| tight.count(c) == 1);
            assert!(exact && tight.allows(&expected), "{api} {blend}: {tight:?}");
        }
    }
}

fn both(operation: &str, src: &str, dst: &str) -> String {
    let part =
        format!(r#"{{"operation":"{operation}","src_factor":"{src}","dst_factor":"{dst}"}}"#);
    format!(r#"{{"color":{part},"alpha":{part}}}"#)
}

#[test]
fn over_gives_the_textbook_colour_within_seven_codes() {
    // 0.6 of blue over red: (0.4, 0, 0.6), and alpha 0.6 * 0.6 + 0.4 = 0.76.
    let over = both("add", "src-alpha", "one-minus-src-alpha");
    blended(&over, "[0,0,1,0.6]", "[255,0,0,255]", [102, 0, 153, 194], 7);
    // The same with the colour multiplied beforehand; alpha 0.6 + 0.4.
    let premultiplied = both("add", "one", "one-minus-src-alpha");
    blended(
        &premultiplied,
        "[0,0,0.6,0.6]",
        "[255,0,0,255]",
        [102, 0, 153, 255],
        7,
    );
}

#[test]
fn sums_and_differences_stop_at_the_ends() {
    blended(
        &both("add", "one", "one"),
        "[0.8,0.2,1,0]",
        "[200,51,255,0]",
        [255, 102, 255, 0],
        4,
    );
    let subtract = both("subtract", "one", "one");
    blended(
        &subtract,
        "[0.2,0.8,1,0]",
        "[102,51,0,255]",
        [0, 153, 255, 0],
        4,
    );
    let reverse = both("reverse-subtract", "one", "one");
    blended(
        &reverse,
        "[0.2,0.8,1,0]",
        "[102,51,0,255]",
        [51, 0, 0, 255],
        4,
    );
}

#[test]
fn products_constants_and_saturation_give_textbook_values() {
    // Multiply: 0.6 * 0.4 = 0.24, 0.2 * 1, 1 * 0.6, 0.
    blended(
        &both("add", "dst", "zero"),
        "[0.6,0.2,1,0]",
        "[102,255,153,255]",
        [61, 51, 153, 0],
        5,
    );
    // Screen: a + b - a b; 0.6 + 0.4 - 0.24 = 0.76.
    let screen = both("add", "one", "one-minus-src");
    blended(
        &screen,
        "[0.6,0,1,0.2]",
        "[102,77,200,0]",
        [194, 77, 255, 51],
        5,
    );
    blended(
        &both("add", "constant", "zero"),
        "[1,1,1,1]",
        "[9,9,9,9]",
        [51, 102, 153, 204],
        3,
    );
    let constant_alpha = both("add", "constant-alpha", "zero");
    blended(
        &constant_alpha,
        "[1,1,1,1]",
        "[9,9,9,9]",
        [204, 204, 204, 204],
        3,
    );
    // min(0.6, 1 - 0.8) = 0.2 for colour, 1 for alpha.
    let saturated = both("add", "src-alpha-saturated", "zero");
    blended(
        &saturated,
        "[1,0,1,0.6]",
        "[9,9,9,204]",
        [51, 0, 51, 153],
        4,
    );
    let darken = both("min", "zero", "zero");
    blended(
        &darken,
        "[0.2,0.8,0,1]",
        "[102,102,255,0]",
        [51, 102, 0, 0],
        3,
    );
    let lighten = both("max", "zero", "zero");
    blended(
        &lighten,
        "[0.2,0.8,0,1]",
        "[102,102,255,0]",
        [102, 204, 255, 255],
        3,
    );
}

#[test]
fn stencil_operations_are_integers_under_every_rule() {
    // Operation, stored, reference, write mask, result.
    let rows = [
        ("keep", 0x5a, 0x33, 0xff, 0x5a),
        ("zero", 0x5a, 0x33, 0xff, 0),
        ("zero", 0x5a, 0x33, 0x0f, 0x50),
        ("replace", 0x5a, 0x33, 0xff, 0x33),
        ("replace", 0x5a, 0x33, 0xf0, 0x3a),
        ("invert", 0x5a, 0x33, 0xff, 0xa5),
        ("invert", 0x5a, 0x33, 0x01, 0x5b),
        ("increment-clamp", 255, 0, 0xff, 255),
        ("increment-clamp", 254, 0, 0xff, 255),
        ("increment-wrap", 255, 0, 0xff, 0),
        ("increment-wrap", 0x0f, 0, 0x0f, 0),
        ("decrement-clamp", 0, 0, 0xff, 0),
        ("decrement-clamp", 1, 0, 0xff, 0),
        ("decrement-wrap", 0, 0, 0xff, 255),
        ("decrement-wrap", 0x10, 0, 0xf0, 0),
    ];
    for (operation, stored, reference, mask, expected) in rows {
        // Which of the three operations applies: the stencil test, then the depth test decides.
        for (key, function, depth) in [
            ("fail_op", "never", "always"),
            ("depth_fail_op", "always", "never"),
            ("pass_op", "always", "always"),
        ] {
            let scene = scene(&format!(
                r#"{{"attachments":{{"ds":{{"format":"depth24plus-stencil8","size":[1,1],"clear":{{"depth":1,"stencil":{stored}}}}}}},
                   "passes":[{{"depth_stencil":"ds","draws":[{{"mesh":{{"kind":"full"}},"shader":"uniform_color",
                   "depth":{{"compare":"{depth}","write":false}},
                   "stencil":{{"front":{{"compare":"{function}","{key}":"{operation}"}},"reference":{reference},"write_mask":{mask}}}}}]}}],
                   "read":["ds"]}}"#
            ));
            let frame = draw(&scene);
            assert_eq!(
                frame.images[1].codes,
                [expected],
                "{operation} of {stored} as {key}"
            );
            for rules in all_rules() {
                let set = legal_set(&scene, &limits(Api::Vulkan), &rules);
                assert_eq!(
                    set.groups[0].sample(0, 0, 0).count(1),
                    1,
                    "{operation} {}",
                    rules.name
                );
                let found = compare(&frame, &set, &set, 1).expect("the same images");
                assert_eq!(
                    found.texels.wrong, 0,
                    "{operation} of {stored} as {key}: {}",
                    rules.name
                );
            }
        }
    }
}
