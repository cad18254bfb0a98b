//! What holds on every driver.
#![expect(clippy::unwrap_used, reason = "these are tests")]

use super::help::{CLEAR, CORNER, GREEN, RED, SIZE, draw, each, scene};
use crate::GlBackend;
use etalon_backend::{Backend, BackendError};
use etalon_case::{Library, Profile};
use etalon_frame::{Aspect, ChannelEncoding, ReadPath, Requirement, TextureFormat};
use std::time::Instant;

/// All checks.
pub(super) fn all(backend: &GlBackend) {
    depth_is_read_as_the_limits_say(backend);
    a_rectangle_lands_in_the_top_left_corner(backend);
    columns_keep_their_colours(backend);
    depth_is_compared_and_stored(backend);
    stencil_faces_differ(backend);
    faces_are_told_apart(backend);
    texels_keep_their_places(backend);
    floats_come_back_bit_by_bit(backend);
    colours_are_blended(backend);
    channels_are_masked(backend);
    several_passes(backend);
    nothing_leaks_into_the_next_scene(backend);
    what_is_denied_is_named(backend);
    assert_eq!(backend.messages(), Vec::<String>::new());
}

/// Several adapters and several prepared scenes at once.
pub(super) fn interleaved(backends: &[&GlBackend]) {
    let red = scene(CORNER);
    let blue = scene(&CORNER.replace("[1,0,0,1]", "[0,1,0,1]"));
    let mut prepared = Vec::new();
    for backend in backends {
        for (scene, color) in [(&red, RED), (&blue, GREEN)] {
            prepared.push((backend.prepare(scene).unwrap(), color));
        }
    }
    for _ in 0..2 {
        for (one, _) in &mut prepared {
            one.submit().unwrap();
        }
    }
    for (one, color) in &mut prepared {
        let frame = one.read_back().unwrap();
        assert_eq!(frame.images[0].sample(0, 0, 0), *color);
        assert_eq!(frame.images[0].sample(15, 15, 0), CLEAR);
    }
}

fn depth_is_read_as_the_limits_say(backend: &GlBackend) {
    let depths = TextureFormat::ALL.into_iter().filter(|f| f.has_depth());
    for format in depths {
        let support = &backend.limits().formats[&format];
        let path = if backend.context.caps.es {
            ReadPath::Shader
        } else {
            ReadPath::Copy
        };
        assert_eq!(support.read, path, "{format}");
    }
}

fn a_rectangle_lands_in_the_top_left_corner(backend: &GlBackend) {
    let frame = draw(backend, CORNER);
    let inside = |x, y| if x < 5 && y < 3 { RED } else { CLEAR };
    each(&frame.images[0], |x, y| inside(x, y).to_vec());
}

fn columns_keep_their_colours(backend: &GlBackend) {
    let frame = draw(
        backend,
        r#"{"attachments": {"color": {"format":"rgba8unorm","size":[16,8]}},
        "passes": [{"color":["color"],"draws":[
            {"mesh":{"kind":"columns","values":[[1,0,0,1],[0,1,0,1],[0.2,0.4,0.6,0.8],[0,0,0,0]]},
             "shader":"flat_color"}]}],
        "read": ["color"]}"#,
    );
    let colors = [RED, GREEN, [51, 102, 153, 204], [0; 4]];
    each(&frame.images[0], |x, _| colors[x as usize / 4].to_vec());
}

/// What a stored depth reads as.
pub(super) fn depth_code(backend: &GlBackend, format: TextureFormat, value: f32) -> u32 {
    let support = &backend.limits().formats[&format];
    match (support.read, support.depth[0]) {
        (ReadPath::Shader, _) | (_, ChannelEncoding::Float32) => value.to_bits(),
        (_, encoding) => (f64::from(value) * encoding.max_order() as f64).round() as u32,
    }
}

fn depth_is_compared_and_stored(backend: &GlBackend) {
    for format in TextureFormat::ALL.into_iter().filter(|f| f.has_depth()) {
        let support = &backend.limits().formats[&format];
        let clear = |depth: &str| match format.has_stencil() {
            true => format!(r#"{{"depth":{depth},"stencil":90}}"#),
            false => depth.to_owned(),
        };
        for (compare, passes) in [
            ("less", [true, false, false]),
            ("equal", [false, true, false]),
            ("greater", [false, false, true]),
            ("always", [true, true, true]),
        ] {
            // A quarter is stored first; the columns then bring 0, 0.25, 1 and 1.
            let frame = draw(
                backend,
                &format!(
                    r#"{{"attachments": {{
                    "color": {{"format":"rgba8unorm","size":[16,16],"clear":[0,0,1,1]}},
                    "depth": {{"format":"{format}","clear":{}}}}},
                "passes": [{{"color":["color"],"depth_stencil":"depth","draws":[
                    {{"mesh":{{"kind":"full","value":0.25}},"shader":"flat_color_depth",
                      "params":{{"color":[0,0,1,1]}},"depth":{{"compare":"always","write":true}}}},
                    {{"mesh":{{"kind":"columns","values":[0,0.25,1,1]}},"shader":"flat_color_depth",
                      "params":{{"color":[1,0,0,1]}},"depth":{{"compare":"{compare}","write":true}}}},
                    {{"mesh":{{"kind":"rect","texels":[0,12,16,16],"value":0.5}},
                      "shader":"flat_color_depth","depth":{{"compare":"always","write":false}},
                      "write_mask":""}}]}}],
                "read": ["color","depth"]}}"#,
                    clear("1")
                ),
            );
            let passed = |x: u32| passes[(x as usize / 4).min(2)];
            let color = |x| if passed(x) { RED } else { CLEAR };
            each(&frame.images[0], |x, _| color(x).to_vec());
            let depth = &frame.images[1];
            assert_eq!((depth.aspect, depth.read), (Aspect::Depth, support.read));
            if support.read == ReadPath::Copy {
                assert_eq!(depth.channels, support.depth);
            } else {
                assert_eq!(depth.channels, [ChannelEncoding::Float32]);
            }
            let value = |x: u32| [0.0, 0.25, 1.0, 1.0][x as usize / 4];
            // A quarter is no code of a normalized format.
            let slack = match support.depth[0] {
                ChannelEncoding::Float32 => 0.0,
                e => 1.0 / e.max_order() as f64,
            };
            for y in 0..SIZE {
                for x in 0..SIZE {
                    let due = if passed(x) { value(x) } else { 0.25 };
                    let code = depth.sample(x, y, 0)[0];
                    if due == 0.25 {
                        let channel = depth.channels[0];
                        let seen = channel.value_of_order(channel.order_of_code(code));
                        assert!((seen - 0.25).abs() <= slack, "{format}: {seen} at {x} {y}");
                    } else {
                        assert_eq!(code, depth_code(backend, format, due), "{format} {x} {y}");
                    }
                }
            }
            if format.has_stencil() {
                assert_eq!(frame.images.len(), 3);
                assert_eq!(frame.images[2].aspect, Aspect::Stencil);
                each(&frame.images[2], |_, _| vec![90]);
            }
        }
    }
    // A float keeps any value, by clear and by vertex; clears alone suffice to be read.
    let frame = draw(
        backend,
        r#"{"attachments": {"a": {"format":"depth32float","size":[16,16],"clear":0.3}},
        "passes": [{"depth_stencil":"a","draws":[
            {"mesh":{"kind":"rect","texels":[8,0,16,16],"value":0.7},"shader":"flat_color_depth",
             "depth":{"compare":"always","write":true}}]}],
        "read": ["a"]}"#,
    );
    let due = |x| if x < 8 { 0.3_f32 } else { 0.7 };
    each(&frame.images[0], |x, _| vec![due(x).to_bits()]);
}

fn stencil_faces_differ(backend: &GlBackend) {
    for format in ["depth24plus-stencil8", "depth32float-stencil8", "stencil8"] {
        let clear = match format {
            "stencil8" => "5",
            _ => r#"{"depth":1,"stencil":5}"#,
        };
        // Front: 247 equals 5 under mask 13, so its low half replaces. Back: 9 never equals 5, so
        // the high half is inverted.
        let frame = draw(
            backend,
            &format!(
                r#"{{"attachments": {{
                "color": {{"format":"rgba8unorm","size":[16,16],"clear":[0,0,1,1]}},
                "s": {{"format":"{format}","clear":{clear}}}}},
            "passes": [{{"color":["color"],"depth_stencil":"s","draws":[
                {{"mesh":{{"kind":"columns","values":[0,0],"windings":["ccw","cw"]}},
                  "shader":"front_facing","params":{{"color":[1,0,0,1],"back_color":[0,1,0,1]}},
                  "stencil":{{
                    "front":{{"compare":"equal","fail_op":"zero","pass_op":"replace",
                              "read_mask":13,"write_mask":15,"reference":247}},
                    "back":{{"compare":"equal","fail_op":"invert","pass_op":"zero",
                             "read_mask":255,"write_mask":240,"reference":9}}}}}}]}}],
            "read": ["color","s"]}}"#
            ),
        );
        let color = |x| if x < 8 { RED } else { CLEAR };
        each(&frame.images[0], |x, _| color(x).to_vec());
        let stencil = frame.images.last().unwrap();
        assert_eq!(stencil.channels, [ChannelEncoding::Uint(8)]);
        assert_eq!(stencil.read, ReadPath::Copy);
        each(stencil, |x, _| vec![if x < 8 { 7 } else { 0xF5 }]);
    }
    // Depth failure has an operation of its own, and clamping differs from wrapping.
    let frame = draw(
        backend,
        r#"{"attachments": {"s": {"format":"depth24plus-stencil8","size":[16,16],
            "clear":{"depth":0,"stencil":255}}},
        "passes": [{"depth_stencil":"s","draws":[
            {"mesh":{"kind":"columns","values":[1,1],"windings":["ccw","cw"]},
             "shader":"flat_color_depth","depth":{"compare":"less","write":true},
             "stencil":{
               "front":{"compare":"always","depth_fail_op":"increment-clamp","pass_op":"zero"},
               "back":{"compare":"always","depth_fail_op":"increment-wrap","pass_op":"zero"}}}]}],
        "read": ["s"]}"#,
    );
    each(&frame.images[1], |x, _| vec![if x < 8 { 255 } else { 0 }]);
}

fn faces_are_told_apart(backend: &GlBackend) {
    for front_face in ["ccw", "cw"] {
        for cull in ["none", "front", "back", "front-and-back"] {
            let frame = draw(
                backend,
                &format!(
                    r#"{{"attachments": {{"color": {{"format":"rgba8unorm","size":[16,16],"clear":[0,0,1,1]}}}},
                "passes": [{{"color":["color"],"draws":[
                    {{"mesh":{{"kind":"columns","values":[0,0],"windings":["ccw","cw"]}},
                      "shader":"front_facing","cull":"{cull}","front_face":"{front_face}",
                      "params":{{"color":[1,0,0,1],"back_color":[0,1,0,1]}}}}]}}],
                "read": ["color"]}}"#
                ),
            );
            each(&frame.images[0], |x, _| {
                let front = (x < 8) == (front_face == "ccw");
                let color = match (cull, front) {
                    ("none" | "back", true) => RED,
                    ("none" | "front", false) => GREEN,
                    _ => CLEAR,
                };
                color.to_vec()
            });
        }
    }
    // Strips turn with every triangle but keep their sense. With y up this one is ccw.
    let frame = draw(
        backend,
        r#"{"attachments": {"color": {"format":"rgba8unorm","size":[16,16],"clear":[0,0,1,1]}},
        "passes": [{"color":["color"],"draws":[
            {"mesh":{"kind":"vertices","positions":[[-1,-1,0],[1,-1,0],[-1,1,0],[1,1,0]]},
             "topology":"triangle-strip","shader":"front_facing",
             "params":{"color":[1,0,0,1],"back_color":[0,1,0,1]}}]}],
        "read": ["color"]}"#,
    );
    each(&frame.images[0], |_, _| RED.to_vec());
}

fn texels_keep_their_places(backend: &GlBackend) {
    for (kind, along_x) in [("columns", true), ("rows", false)] {
        for (format, scale) in [("rgba8unorm", 1.0), ("rgba32float", 1.0 / 255.0)] {
            let value = |i: u32| [i * 16, 255 - i, i, 255];
            let values: Vec<[f64; 4]> = (0..SIZE)
                .map(|i| value(i).map(|v| f64::from(v) * scale))
                .collect();
            // One texture is only fetched from; the other is drawn over, in a corner.
            let frame = draw(
                backend,
                &format!(
                    r#"{{"attachments": {{
                    "a": {{"format":"rgba8unorm","size":[16,16]}},
                    "b": {{"format":"rgba8unorm","texels":{{"kind":"{kind}","values":{:?}}}}},
                    "t": {{"format":"{format}","texels":{{"kind":"{kind}","values":{values:?}}}}}}},
                "passes": [
                    {{"color":["a"],"draws":[
                        {{"mesh":{{"kind":"full"}},"shader":"texel_color","textures":["t"]}}]}},
                    {{"color":["b"],"draws":[
                        {{"mesh":{{"kind":"rect","texels":[0,0,4,2]}},"shader":"uniform_color",
                          "params":{{"color":[1,0,0,1]}}}}]}}],
                "read": ["a","b"]}}"#,
                    (0..SIZE).map(value).collect::<Vec<_>>()
                ),
            );
            let due = |x, y| value(if along_x { x } else { y }).to_vec();
            each(&frame.images[0], due);
            each(&frame.images[1], |x, y| match x < 4 && y < 2 {
                true => RED.to_vec(),
                false => due(x, y),
            });
        }
    }
}

fn floats_come_back_bit_by_bit(backend: &GlBackend) {
    let frame = draw(
        backend,
        r#"{"attachments": {
            "t": {"format":"rgba32float","size":[2,1],
                  "texels":{"kind":"columns","values":[[0.1,-3,1e30,0],[1,2.5,1e-30,7]]}}},
        "passes": [], "read": ["t"]}"#,
    );
    let due = [[0.1_f32, -3.0, 1e30, 0.0], [1.0, 2.5, 1e-30, 7.0]];
    each(&frame.images[0], |x, _| {
        due[x as usize].map(f32::to_bits).to_vec()
    });
}

fn colours_are_blended(backend: &GlBackend) {
    let blend = |state: &str, constant: &str| {
        let frame = draw(
            backend,
            &format!(
                r#"{{"attachments": {{"color": {{"format":"rgba8unorm","size":[16,16],"clear":[1,0,0,1]}}}},
            "passes": [{{"color":["color"],"draws":[
                {{"mesh":{{"kind":"full"}},"shader":"uniform_color","params":{{"color":[0,0,1,0.6]}},
                  "blend":{state},"blend_constant":{constant}}}]}}],
            "read": ["color"]}}"#
            ),
        );
        let color: [u32; 4] = frame.images[0].sample(8, 8, 0).try_into().unwrap();
        each(&frame.images[0], |_, _| color.to_vec());
        color
    };
    let over = r#"{"operation":"add","src_factor":"src-alpha","dst_factor":"one-minus-src-alpha"}"#;
    let both = |component: &str| format!(r#"{{"color":{component},"alpha":{component}}}"#);
    let near = |actual: [u32; 4], due: [u32; 4]| {
        let close = actual.iter().zip(due).all(|(a, d)| a.abs_diff(d) <= 1);
        assert!(close, "{actual:?}, due {due:?}");
    };
    near(blend(&both(over), "[0,0,0,0]"), [102, 0, 153, 194]);
    let constant = r#"{"operation":"add","src_factor":"constant-alpha","dst_factor":"constant"}"#;
    near(blend(&both(constant), "[0.2,0,0,0.4]"), [51, 0, 102, 163]);
    let max = r#"{"operation":"max","src_factor":"zero","dst_factor":"zero"}"#;
    near(blend(&both(max), "[0,0,0,0]"), [255, 0, 255, 255]);
    let reverse = r#"{"operation":"reverse-subtract","src_factor":"one","dst_factor":"one"}"#;
    near(blend(&both(reverse), "[0,0,0,0]"), [255, 0, 0, 102]);
}

fn channels_are_masked(backend: &GlBackend) {
    for bits in 0..16_usize {
        let mask: String = "rgba"
            .chars()
            .enumerate()
            .filter(|(i, _)| bits & (1 << i) != 0)
            .map(|(_, c)| c)
            .collect();
        let frame = draw(
            backend,
            &format!(
                r#"{{"attachments": {{"color": {{"format":"rgba8unorm","size":[16,16],"clear":[0,0,0,0]}}}},
            "passes": [{{"color":["color"],"draws":[
                {{"mesh":{{"kind":"full"}},"shader":"uniform_color","params":{{"color":[1,1,1,1]}},
                  "write_mask":"{mask}"}}]}}],
            "read": ["color"]}}"#
            ),
        );
        let due = |i: usize| if bits & (1 << i) != 0 { 255 } else { 0 };
        each(&frame.images[0], |_, _| (0..4).map(due).collect());
    }
}

fn several_passes(backend: &GlBackend) {
    // Depth from the first pass decides the second.
    let frame = draw(
        backend,
        r#"{"attachments": {
            "a": {"format":"rgba8unorm","size":[16,16],"clear":[0,0,1,1]},
            "d": {"format":"depth16unorm","clear":1}},
        "passes": [
            {"depth_stencil":"d","draws":[
                {"mesh":{"kind":"rect","texels":[0,0,16,4]},"shader":"flat_color_depth",
                 "depth":{"compare":"always","write":true}}]},
            {"color":["a"],"depth_stencil":"d","depth_stencil_read_only":true,"draws":[
                {"mesh":{"kind":"full","value":0.5},"shader":"flat_color_depth",
                 "params":{"color":[1,0,0,1]},"depth":{"compare":"less","write":false}}]}],
        "read": ["a","d"]}"#,
    );
    each(&frame.images[0], |_, y| {
        if y < 4 { CLEAR } else { RED }.to_vec()
    });
    let [zero, one] = [0.0, 1.0].map(|v| depth_code(backend, TextureFormat::Depth16Unorm, v));
    each(&frame.images[1], |_, y| {
        vec![if y < 4 { zero } else { one }]
    });
}

fn nothing_leaks_into_the_next_scene(backend: &GlBackend) {
    for _ in 0..2 {
        draw(
            backend,
            r#"{"attachments": {
                "color": {"format":"rgba8unorm","size":[16,16],"clear":[1,1,1,1]},
                "s": {"format":"depth24plus-stencil8","clear":{"depth":0.5,"stencil":255}}},
            "passes": [{"color":["color"],"depth_stencil":"s","draws":[
                {"mesh":{"kind":"full"},"shader":"flat_color","cull":"back","front_face":"cw",
                 "depth":{"compare":"never","write":false},"write_mask":"",
                 "blend":{"color":{"operation":"min","src_factor":"zero","dst_factor":"zero"},
                          "alpha":{"operation":"min","src_factor":"zero","dst_factor":"zero"}},
                 "stencil":{"write_mask":0,"front":{"compare":"never","fail_op":"zero"}}}]}],
            "read": ["color","s"]}"#,
        );
        let frame = draw(
            backend,
            r#"{"attachments": {
                "color": {"format":"rgba8unorm","size":[16,16],"clear":[0,0,1,1]},
                "s": {"format":"depth24plus-stencil8","clear":{"depth":1,"stencil":3}}},
            "passes": [{"color":["color"],"depth_stencil":"s","draws":[
                {"mesh":{"kind":"rect","texels":[0,0,16,8]},"shader":"uniform_color",
                 "params":{"color":[1,0,0,1]}}]}],
            "read": ["color","s"]}"#,
        );
        each(&frame.images[0], |_, y| {
            if y < 8 { RED } else { CLEAR }.to_vec()
        });
        let one = depth_code(backend, TextureFormat::Depth24PlusStencil8, 1.0);
        each(&frame.images[1], |_, _| vec![one]);
        each(&frame.images[2], |_, _| vec![3]);
    }
}

fn what_is_denied_is_named(backend: &GlBackend) {
    let denied = scene(
        r#"{"attachments": {"color": {"format":"rgba8unorm","size":[16,16],"samples":16}},
        "passes": [{"color":["color"],"draws":[]}], "read": ["color"]}"#,
    );
    let samples = Requirement::Samples(TextureFormat::Rgba8Unorm, 16);
    let error = backend.prepare(&denied).err();
    assert_eq!(error, Some(BackendError::NotSupported(samples)));
    let mut prepared = backend.prepare(&scene(CORNER)).unwrap();
    assert!(matches!(
        prepared.read_back(),
        Err(BackendError::Internal(_))
    ));
}

/// Not among [`all`]: on a driver that compiles, each new state costs some 20 ms.
pub(super) fn built_in_cases_are_drawn(backend: &GlBackend, profile: Profile) {
    let library = Library::built_in().unwrap();
    let (start, mut count) = (Instant::now(), 0);
    for case in library.cases(profile) {
        let case = case.build().unwrap();
        if let Some(missing) = backend.limits().missing(&case.scene.requirements()) {
            println!("{}: {missing}", case.id);
            continue;
        }
        let draw = || {
            let mut prepared = backend.prepare(&case.scene)?;
            prepared.submit()?;
            prepared.read_back()
        };
        draw().unwrap_or_else(|e: BackendError| panic!("{}: {e}", case.id));
        count += 1;
    }
    let ms = start.elapsed().as_secs_f64() * 1e3 / f64::from(count);
    println!("{count} built-in cases, {ms:.3} ms each");
    assert!(count > 0);
    assert_eq!(backend.messages(), Vec::<String>::new());
}
