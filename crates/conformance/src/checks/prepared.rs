//! Prepared scenes: drawn repeatedly, side by side and one after another, and refused.

use super::CheckEnd;
use crate::frames::{BLUE, Expect, GREEN, RED};
use crate::scenes::{
    blend, component, full, green, over_blue, painted, rect, red, scene, test, uploaded, with,
};
use crate::subject::CheckedBackend;
use etalon_backend::{BackendError, Prepared};
use etalon_frame::{Feature, Frame, Requirement, TextureFormat};
use etalon_scene::Scene;
use serde_json::json;

/// Returns a scene with two passes, blending over existing contents, an upload, and changing depth and
/// stencil.
fn busy(clear: [f64; 4]) -> Scene {
    let columns = [[[1, 2, 3, 4]; 8], [[9, 2, 3, 4]; 8]].concat();
    let max = component("max", "one", "one");
    scene(json!({
        "attachments": {
            "color": { "format": "rgba8unorm", "clear": clear },
            "ds": { "format": "depth32float-stencil8", "clear": { "depth": 1, "stencil": 1 } },
            "source": uploaded("columns", columns) },
        "passes": [
            { "color": ["color"], "depth_stencil": "ds", "draws": [{
                "mesh": { "kind": "columns", "values": [0, 0.5, 1] }, "shader": "flat_color_depth",
                "params": { "color": [0, 1, 0, 0.5] }, "depth": test("less", true),
                "blend": { "color": component("add", "one", "one"), "alpha": max },
                "stencil": { "front": { "compare": "always", "pass_op": "increment-clamp" } } }] },
            { "color": ["color"], "draws": [{
                "mesh": rect([2, 3, 7, 9]), "shader": "texel_color", "textures": ["source"],
                "blend": blend("add", "one", "one") }] },
            { "depth_stencil": "ds", "draws": [{
                "mesh": full(), "shader": "uniform_color", "stencil": { "front": {
                    "compare": "equal", "pass_op": "increment-clamp", "reference": 2 } } }] }],
    }))
}

const CLEAR: [f64; 4] = [0.5, 0.0, 0.0, 0.5];

fn read(prepared: &mut Box<dyn Prepared + '_>) -> Frame {
    prepared.read_back().expect("the frame is read back")
}

pub(crate) fn a_second_submit_gives_the_same_frame(s: &CheckedBackend) -> CheckEnd {
    let scene = busy(CLEAR);
    let mut prepared = s.prepare(&scene)?;
    s.submit(prepared.as_mut())?;
    let first = read(&mut prepared);
    assert_eq!(read(&mut prepared), first);
    for _ in 0..3 {
        let time = s.submit(prepared.as_mut())?;
        assert!(time.cpu <= time.wall, "{time:?}");
        if let Some(gpu) = time.gpu {
            // Either of the two clocks can jump; a wrong unit would be a factor of 1,000.
            assert!(gpu <= 100 * time.wall, "{time:?}");
        }
    }
    assert_eq!(read(&mut prepared), first);
    drop(prepared);
    // Reused images and buffers give the same frame.
    assert_eq!(s.draw(&scene)?, first);
    Ok(())
}

pub(crate) fn prepared_scenes_do_not_disturb_each_other(s: &CheckedBackend) -> CheckEnd {
    let (first, second) = (busy(CLEAR), busy([0.0, 0.0, 1.0, 1.0]));
    let (expected_first, expected_second) = (s.draw(&first)?, s.draw(&second)?);
    assert_ne!(expected_first, expected_second);
    let (mut a, mut b) = (s.prepare(&first)?, s.prepare(&second)?);
    assert!(a.read_back().is_err(), "nothing was submitted");
    s.submit(a.as_mut())?;
    s.submit(b.as_mut())?;
    s.submit(a.as_mut())?;
    assert_eq!(read(&mut b), expected_second);
    assert_eq!(read(&mut a), expected_first);
    drop(a);
    s.submit(b.as_mut())?;
    assert_eq!(read(&mut b), expected_second);
    drop(b);
    s.check_silence("scenes side by side");
    Ok(())
}

/// Scenes of different colours, submitted one after another and read in the same order.
pub(crate) fn scenes_are_submitted_in_turns(s: &CheckedBackend) -> CheckEnd {
    let [red, green] = [red(), green()].map(|params| {
        let mesh = rect([0, 0, 5, 3]);
        scene(over_blue(
            json!({ "mesh": mesh, "shader": "uniform_color", "params": params }),
        ))
    });
    let mut prepared = [(s.prepare(&red)?, RED), (s.prepare(&green)?, GREEN)];
    for _ in 0..2 {
        for (drawn, _) in &mut prepared {
            s.submit(drawn.as_mut())?;
        }
    }
    for (drawn, expected) in &mut prepared {
        read(drawn).color_is(
            "color",
            |x, y| if x < 5 && y < 3 { *expected } else { BLUE },
        );
    }
    Ok(())
}

pub(crate) fn reading_before_drawing_is_an_error(s: &CheckedBackend) -> CheckEnd {
    let error = s.prepare(&busy(CLEAR))?.read_back().unwrap_err();
    assert_eq!(
        error,
        BackendError::internal("read back before anything was drawn")
    );
    Ok(())
}

/// Draws a scene whose states write nothing and whose tests never pass, then a plain scene, and both again.
pub(crate) fn nothing_leaks_into_the_next_scene(s: &CheckedBackend) -> CheckEnd {
    // A factor other than one, if the driver allows it with min.
    let factor = if s.offers(Feature::MinMaxBlendFactors) {
        "zero"
    } else {
        "one"
    };
    for _ in 0..2 {
        let drawn = |depth: f64, stencil: u32, draw| {
            let mut scene = over_blue(draw);
            let clear = json!({ "depth": depth, "stencil": stencil });
            scene["attachments"]["s"] = json!({ "format": "depth24plus-stencil8", "clear": clear });
            s.show(scene)
        };
        let idle = json!({
            "mesh": full(), "shader": "flat_color", "cull": "back", "front_face": "cw",
            "depth": test("never", false), "write_mask": "", "blend": blend("min", factor, factor),
            "stencil": { "write_mask": 0, "front": { "compare": "never", "fail_op": "zero" } } });
        drawn(0.5, 255, idle)?;
        let half = json!({ "mesh": rect([0, 0, 16, 8]) });
        let frame = drawn(1.0, 3, with(half, painted()))?;
        frame.is_red(|_, y| y < 8);
        frame.depth_is("s", |_, _| 1.0);
        frame.stencil_is("s", |_, _| 3);
    }
    Ok(())
}

/// A size above the limits, and more samples than any driver has.
pub(crate) fn denials_are_named(s: &CheckedBackend) -> CheckEnd {
    let mut large = busy(CLEAR);
    let size = s.limits().max_size + 1;
    large.attachments[0].size = [size, 1];
    let mut many = scene(over_blue(with(json!({ "mesh": full() }), painted())));
    many.attachments[0].samples = 64;
    for (scene, expected) in [
        (large, Requirement::Size(size)),
        (many, Requirement::Samples(TextureFormat::Rgba8Unorm, 64)),
    ] {
        // The scene can need something else that is denied.
        let needed = scene.requirements();
        assert!(needed.contains(&expected), "{expected}");
        let denied = s.backend.limits().missing(&needed);
        let error = s.backend.prepare(&scene).err();
        assert_eq!(error, denied.map(BackendError::NotSupported));
    }
    Ok(())
}
