//! A depth bias has one step for all of a fixed-point attachment: what one column of a frame shows of it
//! applies to the others.

use crate::common::{draw, limits};
use etalon_case::{Library, Profile};
use etalon_frame::{Api, Aspect, Frame, accuracy, compare};
use etalon_reference::{Geometries, Texels, judgements, shared_sets};
use etalon_scene::Scene;

/// The constants of the scene's columns, left to right, two texels wide each.
const CONSTANTS: [u32; 8] = [1, 3, 10, 100, 1000, 4000, 12000, 30000];

/// The code of the depth below them, 0.0015.
const UNBIASED: u32 = 98;

fn linear() -> Scene {
    let library = Library::built_in();
    let id = "depth/bias-linear/format=depth16unorm";
    let case = library.cases(Profile::Full).find(|c| c.id() == id);
    case.expect("the case").build().expect("it builds").scene
}

/// Returns the rasterizer's frame with other depths in the upper half, by column.
fn with_depths(scene: &Scene, code: impl Fn(usize, u32) -> u32) -> Frame {
    let mut frame = draw(scene);
    let mut images = frame.images.iter_mut();
    let depth = images.find(|i| i.aspect == Aspect::Depth).expect("a depth");
    for y in 0..8 {
        for x in 0..16 {
            let stored = &mut depth.codes[y * 16 + x];
            *stored = code(x / 2, *stored);
        }
    }
    frame
}

/// Returns the number of refused samples without and with knowledge of the step.
fn wrong(scene: &Scene, api: Api, frame: &Frame) -> (u64, u64) {
    let judgement = judgements(scene, &limits(api)).remove(0);
    let count = |legal| {
        compare(frame, legal, legal, 0)
            .expect("its frame")
            .texels
            .wrong
    };
    let fitted = judgement
        .fitted(
            scene,
            frame,
            &shared_sets(scene, Texels::All, &Geometries::default()),
        )
        .expect("its frame");
    (count(&judgement.legal), count(&fitted.legal))
}

#[test]
fn the_usual_step_is_found_and_leaves_few_codes() {
    let scene = linear();
    let frame = draw(&scene);
    for api in [Api::Vulkan, Api::OpenGl, Api::OpenGlEs, Api::WebGpu] {
        assert_eq!(wrong(&scene, api, &frame), (0, 0), "{api}");
        let judgement = judgements(&scene, &limits(api)).remove(0);
        let fitted = judgement
            .fitted(
                &scene,
                &frame,
                &shared_sets(&scene, Texels::All, &Geometries::default()),
            )
            .expect("its frame");
        for (aspect, figures) in fitted.legal.statistics() {
            let mean = figures.codes as f64 / figures.channels as f64;
            assert!(mean < 4.0, "{api} {aspect}: {mean}");
        }
    }
}

/// Returns a depth with one and a half steps per unit.
fn larger(column: usize, code: u32) -> u32 {
    code + CONSTANTS[column] / 2
}

/// Returns a frame of [`larger`] steps, in the lower half too.
fn with_larger_steps(scene: &Scene) -> Frame {
    let mut stepped = with_depths(scene, larger);
    let mut images = stepped.images.iter_mut();
    let depth = images.find(|i| i.aspect == Aspect::Depth).expect("a depth");
    for code in &mut depth.codes[8 * 16..] {
        *code -= 1000;
    }
    stepped
}

#[test]
fn the_step_that_a_driver_chose_is_no_inaccuracy() {
    let scene = linear();
    let stepped = with_larger_steps(&scene);
    for api in [Api::Vulkan, Api::OpenGl, Api::OpenGlEs] {
        let geometries = Geometries::default();
        let sets = shared_sets(&scene, Texels::All, &geometries);
        let judgement = judgements(&scene, &limits(api)).remove(0);
        let fitted = judgement.fitted(&scene, &stepped, &sets);
        let fitted = fitted.expect("its frame");
        let depth = |frame: &Frame| {
            let figures = accuracy(frame, &fitted.legal, &fitted.ideal).expect("its frame");
            *figures
                .iter()
                .find(|a| a.aspect == Aspect::Depth)
                .expect("a depth")
        };
        let found = depth(&stepped);
        // The frame was made in whole codes, so it misses the middle by a few.
        assert!(found.channels >= 192 && found.max < 4.0, "{api}: {found:?}");
        // The frame with the yardstick's step is illegal under this one, and far away.
        let usual = depth(&draw(&scene));
        assert!(usual.max > 10_000.0, "{api}: {usual:?}");
    }
}

#[test]
fn another_bias_step_is_legal_only_if_all_columns_have_it() {
    let scene = linear();
    let stepped = with_larger_steps(&scene);
    for api in [Api::Vulkan, Api::OpenGl, Api::OpenGlEs] {
        assert_eq!(wrong(&scene, api, &stepped), (0, 0), "{api}");
    }
    for odd in 3..8 {
        let one_column = with_depths(&scene, |column, code| {
            if column == odd {
                larger(column, code)
            } else {
                code
            }
        });
        for api in [Api::Vulkan, Api::OpenGl, Api::OpenGlEs] {
            let (before, after) = wrong(&scene, api, &one_column);
            assert_eq!(before, 0, "{api} column {odd}");
            assert!(after >= 16, "{api} column {odd}: {after}");
        }
    }
}

#[test]
fn a_step_beyond_what_vulkan_allows_is_refused_there_and_legal_in_opengl() {
    let scene = linear();
    let mut frame = with_depths(&scene, |column, _| UNBIASED + CONSTANTS[column] * 17 / 8);
    let mut images = frame.images.iter_mut();
    let depth = images.find(|i| i.aspect == Aspect::Depth).expect("a depth");
    for code in &mut depth.codes[8 * 16..] {
        *code -= 2250;
    }
    assert!(wrong(&scene, Api::Vulkan, &frame).0 > 0);
    assert_eq!(wrong(&scene, Api::OpenGl, &frame), (0, 0));
}

#[test]
fn half_a_float_bias_step_is_refused_and_webgpu_has_two_readings() {
    let scene = crate::common::scene(
        r#"{"attachments":{"depth":{"format":"depth32float","size":[4,4],"clear":0}},
            "passes":[{"color":[],"depth_stencil":"depth","draws":[
            {"mesh":{"kind":"columns","values":[0],"z":[0.625]},"shader":"uniform_color",
             "depth_bias":{"constant":10000},"depth":{"compare":"always","write":true}}]}],
            "read":["depth"]}"#,
    );
    let frame = draw(&scene);
    let with = |bits: u32| {
        let mut frame = frame.clone();
        frame.images[0].codes.fill(bits);
        frame
    };
    let expected = frame.images[0].codes[0];
    for api in [Api::Vulkan, Api::OpenGl, Api::OpenGlEs, Api::WebGpu] {
        assert_eq!(wrong(&scene, api, &frame).1, 0, "{api}");
        for constant in [5000, 7500, 9500, 10500, 20000] {
            let other = with(expected + constant - 10000);
            assert!(wrong(&scene, api, &other).1 > 0, "{api} {constant}");
        }
    }
    // By the letter of WebGPU's text the bias is 5000 whole depths.
    let letter = with(1.0_f32.to_bits());
    assert_eq!(wrong(&scene, Api::WebGpu, &letter).1, 0);
    assert!(wrong(&scene, Api::Vulkan, &letter).1 > 0);
}
