//! Blends by version of the specification and by evidence.

use crate::common::{limits, scene};
use crate::evidence::{ALWAYS, DISPUTED, NEVER, allowed, version};
use etalon_frame::Api;
use etalon_scene::Scene;

/// Returns a scene that blends a colour by its alpha over a clear colour.
fn over(format: &str, clear: &str, color: &str) -> Scene {
    let by_alpha =
        r#"{"operation":"add","src_factor":"src-alpha","dst_factor":"one-minus-src-alpha"}"#;
    scene(&format!(
        r#"{{"attachments":{{"c":{{"format":"{format}","size":[4,4],"clear":{clear}}}}},
            "passes":[{{"color":["c"],"draws":[{{"mesh":{{"kind":"full"}},"shader":"uniform_color",
              "params":{{"color":{color}}},"blend":{{"color":{by_alpha},"alpha":{by_alpha}}}}}]}}],
            "read":["c"]}}"#
    ))
}

#[test]
fn a_blend_into_32_bit_floats_has_their_precision() {
    let scene = over("rgba32float", "[0.3,0.3,0.3,0.3]", "[0.7,0.7,0.7,0.3]");
    let order = |value: f32, codes: i64| i64::from(value.to_bits()) + codes;
    let orders = |codes| {
        let color = order(0.7 * 0.3 + 0.3 * 0.7, codes);
        [color, color, color, order(0.3 * 0.3 + 0.3 * 0.7, 0)]
    };
    for limits in [
        version(Api::Vulkan, 1, 3),
        version(Api::OpenGl, 4, 6),
        version(Api::OpenGlEs, 3, 2),
    ] {
        assert_eq!(allowed(&scene, &limits, 0, &orders(2)), ALWAYS);
        assert_eq!(allowed(&scene, &limits, 0, &orders(50)), NEVER);
    }
    for limits in [version(Api::OpenGl, 3, 3), limits(Api::WebGpu)] {
        assert_eq!(allowed(&scene, &limits, 0, &orders(50)), DISPUTED);
        assert_eq!(allowed(&scene, &limits, 0, &orders(500)), NEVER);
    }
}

/// 1000 + (0.24 - 1000) × 0.75 is 250.5 in 16-bit floats, and 0.18 + 250 is 250.125 or 250.25.
#[test]
fn only_webgpu_lets_a_blend_into_floats_be_computed_from_the_difference() {
    let scene = over("rgba16float", "[1000,1000,1000,1]", "[0.24,0.24,0.24,0.75]");
    let order = |eighths: i64| (22 << 10) + eighths - 1024;
    let orders = |eighths| [order(eighths), order(eighths), order(eighths), 0x3a80];
    let [in_order, by_difference, beyond] = [2001, 2004, 2008].map(orders);
    for limits in [
        version(Api::Vulkan, 1, 3),
        version(Api::OpenGl, 4, 6),
        version(Api::OpenGlEs, 3, 2),
    ] {
        assert_eq!(allowed(&scene, &limits, 0, &in_order), ALWAYS);
        assert_eq!(allowed(&scene, &limits, 0, &by_difference), DISPUTED);
        assert_eq!(allowed(&scene, &limits, 0, &beyond), NEVER);
    }
    let webgpu = limits(Api::WebGpu);
    assert_eq!(allowed(&scene, &webgpu, 0, &by_difference), ALWAYS);
    assert_eq!(allowed(&scene, &webgpu, 0, &beyond), NEVER);
}

#[test]
fn that_an_alpha_of_2_bits_weighs_a_colour_of_10_is_disputed() {
    let scene = over("rgb10a2unorm", "[0,0,0,0]", "[1,1,1,0.5]");
    let orders = |color| [color, color, color, 1];
    for limits in [
        version(Api::Vulkan, 1, 3),
        version(Api::OpenGl, 4, 6),
        version(Api::OpenGlEs, 3, 2),
        limits(Api::WebGpu),
    ] {
        assert_eq!(allowed(&scene, &limits, 0, &orders(511)), ALWAYS);
        assert_eq!(allowed(&scene, &limits, 0, &orders(341)), DISPUTED);
        assert_eq!(allowed(&scene, &limits, 0, &orders(100)), NEVER);
    }
}

/// Between planes at one distance the linear depth is 0 / 0. No specification says what a clamp makes of it, and what
/// is added to it stays as open.
#[test]
fn what_is_not_a_number_is_blended_into_any_code() {
    for (format, greatest) in [("rgba8unorm", 255), ("rgba8snorm", 127)] {
        for operation in ["add", "min", "max"] {
            let equation =
                format!(r#"{{"operation":"{operation}","src_factor":"one","dst_factor":"one"}}"#);
            let scene = scene(&format!(
                r#"{{"attachments":{{"c":{{"format":"{format}","size":[4,4],"clear":[0.25,0.25,0.25,0.25]}}}},
                    "passes":[{{"color":["c"],"draws":[{{"mesh":{{"kind":"full"}},"shader":"depth_linearized",
                      "params":{{"color":[0.25,0.25,0,0]}},"blend":{{"color":{equation},"alpha":{{"operation":"add","src_factor":"one","dst_factor":"zero"}}}}}}]}}],
                    "read":["c"]}}"#
            ));
            for limits in [
                version(Api::Vulkan, 1, 3),
                version(Api::OpenGl, 4, 6),
                limits(Api::WebGpu),
            ] {
                for code in [0, 64, greatest] {
                    assert_eq!(
                        allowed(&scene, &limits, 0, &[code, code, code, greatest]),
                        ALWAYS
                    );
                }
            }
        }
    }
}
