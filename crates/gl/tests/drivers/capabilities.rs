//! Formats and read paths of OpenGL drivers.

use crate::drivers::{self, context, is};
use etalon_backend::Backend;
use etalon_conformance::{LLVMPIPE, in_child, json, run_all, variables};
use etalon_frame::{Api, ReadPath, TextureFormat};
use etalon_gl::{GlOptions, Platform, Profile, enumerate, open};

/// Depths of OpenGL ES are read by a shader, all else by a copy.
pub(crate) fn offers(backend: &dyn Backend) {
    let limits = backend.limits();
    for (format, support) in &limits.formats {
        let shader = limits.api == Api::OpenGlEs && format.has_depth();
        let expected = [ReadPath::Copy, ReadPath::Shader][usize::from(shader)];
        assert_eq!(support.read, expected, "{format}");
    }
    let rgba8 = &limits.formats[&TextureFormat::Rgba8Unorm];
    let expected: &[u32] = if is(backend, "softpipe") {
        &[1]
    } else if is(backend, "virgl") {
        &[1, 2, 4]
    } else {
        &[1, 4]
    };
    assert_eq!(rgba8.samples, expected);
}

#[test]
fn devices_are_enumerated_and_open() {
    let test = "capabilities::devices_are_enumerated_and_open";
    in_child(test, &variables(LLVMPIPE), || {
        let devices = enumerate().expect("EGL enumerates devices");
        println!("{devices:?}");
        let software = devices.iter().find(|d| d.software);
        let software = software.expect("Mesa's software device");
        let options = GlOptions {
            profile: Profile::Core,
            platform: Platform::Device(software.index),
            library: None,
            debug: false,
            fault: None,
            record: false,
        };
        let backend = open("gl:device", &options).expect("the software device opens");
        run_all(&backend, &drivers::llvmpipe());
        let none = GlOptions {
            platform: Platform::Device(devices.len()),
            ..options
        };
        assert!(open("gl:none", &none).is_err());
    });
}

#[test]
fn two_adapters_take_turns() {
    let test = "capabilities::two_adapters_take_turns";
    in_child(test, &variables(LLVMPIPE), || {
        let core = context(Profile::Core, "llvmpipe");
        let es = context(Profile::Es, "llvmpipe");
        let scene = |color: [u32; 4]| {
            etalon_conformance::scene(json!({
                "attachments": { "color": { "format": "rgba8unorm", "clear": [0, 0, 1, 1] } },
                "passes": [{ "color": ["color"], "draws": [{ "shader": "uniform_color",
                    "mesh": { "kind": "rect", "texels": [0, 0, 5, 3] }, "params": { "color": color } }] }],
                "read": ["color"],
            }))
        };
        let red = (scene([1, 0, 0, 1]), [255, 0, 0, 255]);
        let green = (scene([0, 1, 0, 1]), [0, 255, 0, 255]);
        let turns = |backends: &[&dyn Backend]| {
            let mut prepared = Vec::new();
            for backend in backends {
                for (scene, color) in [&red, &green] {
                    prepared.push((backend.prepare(scene).expect("it is prepared"), color));
                }
            }
            for _ in 0..2 {
                for (drawn, _) in &mut prepared {
                    drawn.submit().expect("it is drawn");
                }
            }
            for (drawn, color) in &mut prepared {
                let frame = drawn.read_back().expect("it is read back");
                assert_eq!(frame.images[0].sample(0, 0, 0), *color);
                assert_eq!(frame.images[0].sample(15, 15, 0), [0, 0, 255, 255]);
            }
        };
        turns(&[&core, &es]);
        drop(core);
        turns(&[&es]);
    });
}
