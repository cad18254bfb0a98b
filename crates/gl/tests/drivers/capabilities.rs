//! Formats and read paths of OpenGL's drivers, and the ways to them.

use crate::drivers::{self, context, is_softpipe};
use etalon_backend::Backend;
use etalon_conformance::{CHECKS, Driver, LLVMPIPE, in_child, run_all, variables};
use etalon_frame::{Api, Feature, ReadPath, TextureFormat};
use etalon_gl::{Options, Platform, Profile, enumerate, open};

/// Holds a driver to what it is known to offer; a check skipped for lack of it would pass.
pub(crate) fn offers(backend: &dyn Backend) {
    let limits = backend.limits();
    for (format, support) in &limits.formats {
        let es = limits.api == Api::OpenGlEs;
        let path = if es && format.has_depth() {
            ReadPath::Shader
        } else {
            ReadPath::Copy
        };
        assert_eq!(support.read, path, "{format}");
    }
    assert!(!limits.formats.contains_key(&TextureFormat::Bgra8Unorm));
    for format in [
        TextureFormat::R8Unorm,
        TextureFormat::Rg8Unorm,
        TextureFormat::Rgba8Unorm,
        TextureFormat::Rgba8UnormSrgb,
        TextureFormat::Rgb10a2Unorm,
        TextureFormat::Rg11b10Ufloat,
        TextureFormat::Rgba16Float,
        TextureFormat::Rgba32Float,
    ] {
        let support = &limits.formats[&format];
        let drawn = support.samples.contains(&1) && support.blendable;
        assert!(drawn && support.read == ReadPath::Copy, "{format}");
    }
    let softpipe = is_softpipe(backend);
    let several = &limits.formats[&TextureFormat::Rgba8Unorm].samples[1..];
    assert_eq!(several, if softpipe { &[][..] } else { &[4] });
    assert!(softpipe || limits.features.contains(&Feature::CentroidInterpolation));
}

#[test]
fn devices_are_enumerated_and_open() {
    let test = "capabilities::devices_are_enumerated_and_open";
    in_child(test, &variables(LLVMPIPE), || {
        let devices = enumerate().expect("EGL enumerates devices");
        println!("{devices:?}");
        let software = devices.iter().find(|d| d.software);
        let software = software.expect("Mesa's software device");
        let options = Options {
            profile: Profile::Core,
            platform: Platform::Device(software.index),
            library: None,
            debug: false,
            read_fault: None,
        };
        let backend = open("gl:device", &options).expect("the software device opens");
        // Through a device it has four samples of fewer formats.
        let driver = Driver {
            lacks: &["feature", "format bgra8unorm", "4 samples of"],
            ..drivers::llvmpipe()
        };
        run_all(&backend, &driver, Some(SKIPPED));
        let none = Options {
            platform: Platform::Device(devices.len()),
            ..options
        };
        assert!(open("gl:none", &none).is_err());
    });
}

/// On llvmpipe's core profile, every other check draws.
const SKIPPED: &[&str] = &[
    "depth::bounds_reject_by_the_stored_depth",
    "raster::a_viewport_of_negative_height_turns_the_picture_over",
];

#[test]
fn two_adapters_take_turns() {
    let test = "capabilities::two_adapters_take_turns";
    in_child(test, &variables(LLVMPIPE), || {
        let core = context(Profile::Core, "llvmpipe");
        let es = context(Profile::Es, "llvmpipe");
        let scene = |color: &str| {
            etalon_conformance::scene(&format!(
                r#"{{ "attachments": {{ "color": {{ "format": "rgba8unorm", "clear": [0, 0, 1, 1] }} }},
                    "passes": [ {{ "color": ["color"], "draws": [ {{ "shader": "uniform_color",
                        "mesh": {{ "kind": "rect", "texels": [0, 0, 5, 3] }}, "params": {{ "color": {color} }} }} ] }} ],
                    "read": ["color"] }}"#
            ))
        };
        let red = (scene("[1, 0, 0, 1]"), [255, 0, 0, 255]);
        let green = (scene("[0, 1, 0, 1]"), [0, 255, 0, 255]);
        let turns = |backends: &[&dyn Backend]| {
            let mut prepared = Vec::new();
            for backend in backends {
                for (scene, color) in [&red, &green] {
                    prepared.push((backend.prepare(scene).expect("it is prepared"), color));
                }
            }
            for _ in 0..2 {
                for (one, _) in &mut prepared {
                    one.submit().expect("it is drawn");
                }
            }
            for (one, color) in &mut prepared {
                let frame = one.read_back().expect("it is read back");
                assert_eq!(frame.images[0].sample(0, 0, 0), *color);
                assert_eq!(frame.images[0].sample(15, 15, 0), [0, 0, 255, 255]);
            }
        };
        turns(&[&core, &es]);
        drop(core);
        turns(&[&es]);
    });
}

#[test]
fn checks_known_to_fail_exist() {
    for driver in [drivers::softpipe(), drivers::softpipe_es()] {
        for (name, _) in &driver.defects {
            assert!(CHECKS.iter().any(|check| check.name == *name), "{name}");
        }
    }
}
