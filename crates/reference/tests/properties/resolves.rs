//! Resolves, by rule: Vulkan's passes average, OpenGL's blits and WebGPU's targets need not.

use crate::common::{draw, limits, scene};
use etalon_frame::{Api, CodeInterval};
use etalon_reference::judgements;
use etalon_scene::Scene;

/// A texel with one sample in four 1 and the others 0.
fn quarter(format: &str) -> Scene {
    scene(&format!(
        r#"{{"attachments":{{"many":{{"format":"{format}","size":[2,2],"samples":4,"clear":[0,0,0,0]}},
            "one":{{"format":"{format}","size":[2,2]}}}},
            "passes":[{{"color":["many"],"resolve":["one"],"draws":[
            {{"mesh":{{"kind":"cover"}},"shader":"uniform_color","params":{{"color":[1,1,1,1]}},
              "multisample":{{"mask":4}}}}]}}],
            "read":["one"]}}"#
    ))
}

fn hull(scene: &Scene, api: Api, channel: usize) -> (CodeInterval, usize) {
    let judgement = judgements(scene, &limits(api)).remove(0);
    let set = judgement.legal.groups[0].sample(0, 0, 0);
    (set.hull(channel).expect("asserted"), set.worlds.len())
}

#[test]
fn vulkan_averages_within_a_code_for_each_halving() {
    let (red, worlds) = hull(&quarter("rgba8unorm"), Api::Vulkan, 0);
    // 63.75, rounded twice.
    assert_eq!((red, worlds), (CodeInterval::new(61, 66), 1));
    let half = hull(&quarter("rgba16float"), Api::Vulkan, 0).0;
    let expected = i64::from(0x3400_u16);
    assert!(half.contains(expected) && half.count() < 40, "{half:?}");
    for api in [Api::OpenGl, Api::OpenGlEs, Api::WebGpu] {
        let (red, _) = hull(&quarter("rgba8unorm"), api, 0);
        assert_eq!(red, CodeInterval::new(0, 255), "{api}");
    }
}

#[test]
fn srgb_is_averaged_linear_or_as_codes_and_not_between() {
    let scene = quarter("rgba8unorm-srgb");
    let judgement = judgements(&scene, &limits(Api::Vulkan)).remove(0);
    let set = judgement.legal.groups[0].sample(0, 0, 0);
    let allows = |red: i64| set.allows(&[red, red, red, 64]);
    assert!(allows(137) && allows(64) && !allows(100) && !allows(0) && !allows(255));
    // All channels are rounded in the same way.
    assert!(!set.allows(&[137, 64, 137, 64]));
    let frame = draw(&scene);
    assert!(allows(i64::from(frame.images[0].codes[0])));
}

#[test]
fn integers_resolve_to_the_first_sample_in_vulkan_and_to_any_elsewhere() {
    let scene = scene(
        r#"{"attachments":{"many":{"format":"rgba8uint","size":[2,2],"samples":4,"clear":[1,2,3,4]},
            "one":{"format":"rgba8uint","size":[2,2]}},
            "passes":[{"color":["many"],"resolve":["one"],"draws":[
            {"mesh":{"kind":"cover"},"shader":"uint_color","params":{"color":[9,8,7,6]},
              "multisample":{"mask":4}}]}],
            "read":["one"]}"#,
    );
    for (api, other) in [
        (Api::Vulkan, false),
        (Api::OpenGl, true),
        (Api::WebGpu, true),
    ] {
        let judgement = judgements(&scene, &limits(api)).remove(0);
        let set = judgement.legal.groups[0].sample(0, 0, 0);
        assert!(set.allows(&[1, 2, 3, 4]), "{api}");
        assert_eq!(set.allows(&[9, 8, 7, 6]), other, "{api}");
    }
}
