//! Prepared scenes: again, side by side, after one another, and refused.

use super::Checked;
use crate::frames::{BLUE, GREEN, RED, check, check_red, color, depth, stencil};
use crate::scenes::{PAINT, one_draw, scene, scene_of};
use crate::subject::Subject;
use etalon_backend::{BackendError, Prepared};
use etalon_frame::{Feature, Frame, Requirement, TextureFormat};

/// Two passes, blending onto what is there, an upload, depth and stencil that change.
const BUSY: &str = r#"{
    "attachments": {
        "color": { "format": "rgba8unorm", "clear": [0.5, 0, 0, 0.5] },
        "ds": { "format": "depth32float-stencil8", "clear": { "depth": 1, "stencil": 1 } },
        "source": { "format": "rgba8unorm", "texels": { "kind": "columns", "values": [
            [1,2,3,4],[1,2,3,4],[1,2,3,4],[1,2,3,4],[1,2,3,4],[1,2,3,4],[1,2,3,4],[1,2,3,4],
            [9,2,3,4],[9,2,3,4],[9,2,3,4],[9,2,3,4],[9,2,3,4],[9,2,3,4],[9,2,3,4],[9,2,3,4]] } } },
    "passes": [
        { "color": ["color"], "depth_stencil": "ds", "draws": [
            { "mesh": { "kind": "columns", "values": [0, 0.5, 1] }, "shader": "flat_color_depth",
              "params": { "color": [0, 1, 0, 0.5] }, "depth": { "compare": "less", "write": true },
              "blend": { "color": { "operation": "add", "src_factor": "one", "dst_factor": "one" },
                         "alpha": { "operation": "max", "src_factor": "one", "dst_factor": "one" } },
              "stencil": { "front": { "compare": "always", "pass_op": "increment-clamp" } } } ] },
        { "color": ["color"], "draws": [
            { "mesh": { "kind": "rect", "texels": [2, 3, 7, 9] }, "shader": "texel_color", "textures": ["source"],
              "blend": { "color": { "operation": "add", "src_factor": "one", "dst_factor": "one" },
                         "alpha": { "operation": "add", "src_factor": "one", "dst_factor": "one" } } } ] },
        { "depth_stencil": "ds", "draws": [
            { "mesh": { "kind": "full" }, "shader": "uniform_color",
              "stencil": { "front": { "compare": "equal", "pass_op": "increment-clamp", "reference": 2 } } } ] } ],
    "read": ["color", "ds", "source"] }"#;

fn read(prepared: &mut Box<dyn Prepared + '_>) -> Frame {
    prepared.read_back().expect("the frame is read back")
}

pub(crate) fn a_second_submit_gives_the_same_frame(s: &Subject) -> Checked {
    let scene = scene(BUSY);
    let mut prepared = s.prepare(&scene)?;
    prepared.submit().expect("the scene is drawn");
    let first = read(&mut prepared);
    assert_eq!(read(&mut prepared), first);
    for _ in 0..3 {
        let time = prepared.submit().expect("the scene is drawn");
        assert!(time.cpu <= time.wall, "{time:?}");
        if let Some(gpu) = time.gpu {
            // Two clocks, of which either may jump; a wrong unit is a factor of 1,000.
            assert!(gpu <= 100 * time.wall, "{time:?}");
        }
    }
    assert_eq!(read(&mut prepared), first);
    drop(prepared);
    // From reused images and buffers too.
    assert_eq!(s.draw(&scene)?, first);
    Ok(())
}

pub(crate) fn prepared_scenes_do_not_disturb_each_other(s: &Subject) -> Checked {
    let one = scene(BUSY);
    let other = scene(&BUSY.replace("[0.5, 0, 0, 0.5]", "[0, 0, 1, 1]"));
    let (due_one, due_other) = (s.draw(&one)?, s.draw(&other)?);
    assert_ne!(due_one, due_other);
    let (mut a, mut b) = (s.prepare(&one)?, s.prepare(&other)?);
    assert!(a.read_back().is_err(), "nothing was submitted");
    a.submit().expect("the scene is drawn");
    b.submit().expect("the scene is drawn");
    a.submit().expect("the scene is drawn");
    assert_eq!(read(&mut b), due_other);
    assert_eq!(read(&mut a), due_one);
    drop(a);
    b.submit().expect("the scene is drawn");
    assert_eq!(read(&mut b), due_other);
    drop(b);
    s.check_silence("scenes side by side");
    Ok(())
}

/// Scenes of different colours, submitted one after the other and read in the same order.
pub(crate) fn scenes_are_submitted_in_turns(s: &Subject) -> Checked {
    let corner = |shader: &str| {
        one_draw(&format!(
            r#""mesh": {{ "kind": "rect", "texels": [0, 0, 5, 3] }}, {shader}"#
        ))
    };
    let red = corner(PAINT);
    let green = corner(&PAINT.replace("[1, 0, 0, 1]", "[0, 1, 0, 1]"));
    let mut prepared = [(s.prepare(&red)?, RED), (s.prepare(&green)?, GREEN)];
    for _ in 0..2 {
        for (one, _) in &mut prepared {
            one.submit().expect("the scene is drawn");
        }
    }
    for (one, due) in &mut prepared {
        check(color(&read(one), "color"), |x, y| {
            if x < 5 && y < 3 { *due } else { BLUE }
        });
    }
    Ok(())
}

pub(crate) fn reading_before_drawing_is_an_error(s: &Subject) -> Checked {
    let scene = scene(BUSY);
    let error = s.prepare(&scene)?.read_back().unwrap_err();
    assert!(matches!(error, BackendError::Internal(_)), "{error}");
    Ok(())
}

/// States that write nothing and compare with never, then a plain scene; twice.
pub(crate) fn nothing_leaks_into_the_next_scene(s: &Subject) -> Checked {
    let ds = |depth: f32, stencil: u32| {
        format!(
            r#""color": {{ "format": "rgba8unorm", "clear": [0, 0, 1, 1] }},
               "s": {{ "format": "depth24plus-stencil8", "clear": {{ "depth": {depth}, "stencil": {stencil} }} }}"#
        )
    };
    for _ in 0..2 {
        // The factors that are not the default, where the driver has a say in them.
        let factor = match s.offers(Feature::MinMaxBlendFactors) {
            true => "zero",
            false => "one",
        };
        let min = format!(
            r#"{{ "operation": "min", "src_factor": "{factor}", "dst_factor": "{factor}" }}"#
        );
        s.draw(&scene_of(
            &ds(0.5, 255),
            &format!(
                r#"{{ "color": ["color"], "depth_stencil": "s", "draws": [ {{ "mesh": {{ "kind": "full" }}, "shader": "flat_color",
                    "cull": "back", "front_face": "cw", "depth": {{ "compare": "never", "write": false }}, "write_mask": "",
                    "blend": {{ "color": {min}, "alpha": {min} }},
                    "stencil": {{ "write_mask": 0, "front": {{ "compare": "never", "fail_op": "zero" }} }} }} ] }}"#
            ),
            &["color", "s"],
        ))?;
        let frame = s.draw(&scene_of(
            &ds(1.0, 3),
            &format!(
                r#"{{ "color": ["color"], "depth_stencil": "s", "draws": [
                    {{ "mesh": {{ "kind": "rect", "texels": [0, 0, 16, 8] }}, {PAINT} }} ] }}"#
            ),
            &["color", "s"],
        ))?;
        check_red(&frame, |_, y| y < 8);
        let one = depth(&frame, "s").channels[0].nearest_code(1.0);
        check(depth(&frame, "s"), |_, _| [one]);
        check(stencil(&frame, "s"), |_, _| [3]);
    }
    Ok(())
}

/// More texels than the limits have, and more samples than any driver.
pub(crate) fn denials_are_named(s: &Subject) -> Checked {
    let mut large = scene(BUSY);
    let size = s.limits().max_size + 1;
    large.attachments[0].size = [size, 1];
    let mut many = one_draw(&format!(r#""mesh": {{ "kind": "full" }}, {PAINT}"#));
    many.attachments[0].samples = 64;
    for (scene, due) in [
        (large, Requirement::Size(size)),
        (many, Requirement::Samples(TextureFormat::Rgba8Unorm, 64)),
    ] {
        let error = s.backend.prepare(&scene).err();
        assert_eq!(error, Some(BackendError::NotSupported(due)));
    }
    Ok(())
}
