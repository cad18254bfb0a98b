//! Whole frames: the rasterizer's are legal, wider rules allow more, and exact inputs leave one value.

use crate::arithmetic::wider;
use crate::common::{APIS, config, draw, limits, scene};
use crate::scenes::{Inputs, body};
use crate::wide;
use etalon_frame::{
    Api, Aspect, ChannelEncoding, Frame, LegalSet, ReadPath, TexelSet, TextureFormat, compare,
};
use etalon_pipeline::{Arithmetic, Plain};
use etalon_reference::{Rules, judgements, legal_set};
use etalon_scene::Scene;
use proptest::prelude::*;

/// Returns the frame of an adapter that reads depth through a shader.
fn read_by_shader(mut frame: Frame) -> Frame {
    for image in &mut frame.images {
        if image.aspect == Aspect::Depth {
            let encoding = image.channels[0];
            for code in &mut image.codes {
                *code = Plain::<1>.decode(encoding, [*code])[0].to_bits();
            }
            image.channels = vec![ChannelEncoding::Float32];
            image.read = ReadPath::Shader;
        }
    }
    frame
}

/// Returns one sample's codes in the order of the group's channels.
fn orders(frame: &Frame, set: &LegalSet, group: usize, x: u32, y: u32) -> Vec<i64> {
    let mut orders = Vec::new();
    for (image, info) in frame.images.iter().zip(&set.images) {
        if info.group == group {
            let codes = image.sample(x, y, 0);
            orders.extend(
                codes
                    .iter()
                    .zip(&info.channels)
                    .map(|(c, e)| e.order_of_code(*c)),
            );
        }
    }
    orders
}

/// Returns codes that `tight` allows and `wide` forbids, among the ends of each box and the frame's codes
/// with their neighbours.
fn lost(tight: &TexelSet, wide: &TexelSet, drawn: &[i64]) -> Option<Vec<i64>> {
    let ends = tight.worlds.iter().flat_map(|w| {
        let low = w.channels.iter().map(|i| i.low).collect();
        let high = w.channels.iter().map(|i| i.high).collect();
        [low, high]
    });
    let near = (0..drawn.len()).flat_map(|c| {
        [-1, 0, 1].map(|step| {
            let mut codes = drawn.to_vec();
            codes[c] += step;
            codes
        })
    });
    ends.chain(near)
        .find(|codes| !tight.is_open() && tight.allows(codes) && !wide.allows(codes))
}

fn check_nested(scene: &Scene, pairs: &[(Rules, Rules)]) -> Result<(), TestCaseError> {
    let frame = draw(scene);
    let limits = limits(Api::Vulkan);
    for (tight_rules, wide_rules) in pairs {
        let tight = legal_set(scene, &limits, tight_rules);
        let wide = legal_set(scene, &limits, wide_rules);
        for (g, group) in tight.groups.iter().enumerate() {
            for y in 0..group.size[1] {
                for x in 0..group.size[0] {
                    let drawn = orders(&frame, &tight, g, x, y);
                    let found = lost(
                        group.sample(x, y, 0),
                        wide.groups[g].sample(x, y, 0),
                        &drawn,
                    );
                    prop_assert!(
                        found.is_none(),
                        "({x}, {y}): {found:?} is legal under {tight_rules:?} and not under {wide_rules:?}"
                    );
                }
            }
        }
    }
    Ok(())
}

proptest! {
    #![proptest_config(config(1000))]

    #[test]
    fn the_rasterizers_frames_are_legal_and_precise(body in body(Inputs::Any)) {
        let scene = scene(&body);
        let frame = draw(&scene);
        for api in APIS {
            for by_shader in [false, true] {
                let mut limits = limits(api);
                let mut frame = frame.clone();
                if by_shader {
                    for format in TextureFormat::ALL.into_iter().filter(|f| f.has_depth()) {
                        limits.formats.get_mut(&format).expect("listed").read = ReadPath::Shader;
                    }
                    frame = read_by_shader(frame);
                }
                for judgement in judgements(&scene, &limits) {
                    let found = compare(&frame, &judgement.legal, &judgement.yardstick, 2);
                    let found = found.expect("the images are those of the legal set");
                    prop_assert_eq!(
                        (found.texels.wrong, found.texels.imprecise), (0, 0),
                        "{} {:?}", api, found.wrong
                    );
                }
            }
        }
    }

    #[test]
    fn pinned_inputs_leave_one_value(body in body(Inputs::Pinned)) {
        let scene = scene(&body);
        let frame = draw(&scene);
        for api in APIS {
            for judgement in judgements(&scene, &limits(api)) {
                for set in [&judgement.legal, &judgement.yardstick] {
                    for (aspect, figures) in set.statistics() {
                        prop_assert_eq!(figures.exact, figures.channels, "{} {}", api, aspect);
                    }
                    let found = compare(&frame, set, set, 2).expect("the same images");
                    prop_assert_eq!(found.texels.wrong, 0, "{} {:?}", api, found.wrong);
                }
            }
        }
    }
}

proptest! {
    #![proptest_config(config(1500))]

    #[test]
    fn the_rasterizers_frames_of_the_whole_model_are_legal_and_precise(body in wide::body()) {
        let scene = scene(&body);
        let frame = draw(&scene);
        for api in APIS {
            for judgement in judgements(&scene, &limits(api)) {
                let found = compare(&frame, &judgement.legal, &judgement.yardstick, 2);
                let found = found.expect("the images are those of the legal set");
                prop_assert_eq!(
                    (found.texels.wrong, found.texels.imprecise), (0, 0),
                    "{} {:?}", api, found.wrong
                );
                prop_assert!(
                    found.counters.iter().all(|c| c.band.is_none()),
                    "{} {:?}", api, found.counters
                );
            }
        }
    }
}

proptest! {
    #![proptest_config(config(150))]

    #[test]
    fn wider_rules_forbid_nothing_that_tighter_ones_allow(body in body(Inputs::Any)) {
        check_nested(&scene(&body), &wider())?;
    }
}
