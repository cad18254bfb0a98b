//! Every check on every software driver, each driver in a process of its own: the environment
//! chooses it before libEGL is loaded.

mod chains;
mod checks;
mod counting;
mod formats;
mod help;
mod layers;
mod raster;
mod samples;
mod sampling;
mod shaders;
mod targets;

use crate::{GlBackend, Options, Platform, Profile, Tuning, open_with};
use etalon_backend::Backend;
use etalon_frame::Api;
use std::process::Command;

const CHILD: &str = "ETALON_GL_TEST_CHILD";
const INSTALL: &str = "apt-get install libegl1 libgl1-mesa-dri mesa-vulkan-drivers";

const LLVMPIPE: &[(&str, &str)] = &[
    ("LIBGL_ALWAYS_SOFTWARE", "1"),
    ("GALLIUM_DRIVER", "llvmpipe"),
];
const SOFTPIPE: &[(&str, &str)] = &[
    ("LIBGL_ALWAYS_SOFTWARE", "1"),
    ("GALLIUM_DRIVER", "softpipe"),
];
const ZINK: &[(&str, &str)] = &[
    ("LIBGL_ALWAYS_SOFTWARE", "1"),
    ("MESA_LOADER_DRIVER_OVERRIDE", "zink"),
    ("GALLIUM_DRIVER", "zink"),
];

/// Runs the body in a process with this environment: the test of this name, once more.
fn in_child(test: &str, environment: &[(&str, &str)], body: fn()) {
    if std::env::var_os(CHILD).is_some() {
        body();
        return;
    }
    let program = std::env::current_exe().expect("the test's own path");
    let output = Command::new(program)
        .args([&format!("tests::{test}"), "--exact", "--nocapture"])
        .env(CHILD, "1")
        .envs(environment.iter().copied())
        .output()
        .expect("the test starts itself");
    let text = format!(
        "{}{}",
        String::from_utf8_lossy(&output.stdout),
        String::from_utf8_lossy(&output.stderr)
    );
    assert!(
        output.status.success(),
        "{test} with {environment:?}:\n{text}"
    );
    assert!(text.contains("1 passed"), "{test} did not run:\n{text}");
    print!("{text}");
}

/// Opens an adapter and holds that the driver is the one that was asked for.
fn adapter(profile: Profile, driver: &str, clip_control: bool) -> GlBackend {
    let options = Options {
        profile,
        platform: Platform::Surfaceless,
        library: None,
        debug: true,
    };
    let backend = match open_with("gl:test", &options, Tuning { clip_control }) {
        Ok(backend) => backend,
        Err(e) => panic!("{driver} cannot be opened: {e} ({INSTALL})"),
    };
    let info = backend.adapter();
    println!("{info:?}\n{:?}", backend.limits());
    let device = info.device.to_lowercase();
    assert!(
        device.starts_with(driver),
        "{device} is not {driver} ({INSTALL})"
    );
    assert!(info.software);
    assert_eq!(backend.context.caps.clip_control, clip_control);
    let expected = match profile {
        Profile::Core => Api::OpenGl,
        Profile::Es => Api::OpenGlEs,
    };
    assert_eq!(backend.limits().api, expected);
    backend
}

/// What every check asks for, debug-clean.
fn all(backend: &GlBackend) {
    checks::all(backend);
    formats::all(backend);
    raster::all(backend);
    targets::all(backend);
    samples::all(backend);
    counting::all(backend);
    sampling::all(backend);
    chains::all(backend);
    layers::all(backend);
    shaders::all(backend);
    assert_eq!(backend.messages(), Vec::<String>::new());
}

fn everything(backend: &GlBackend) {
    all(backend);
    // What compiles every state takes minutes for all cases.
    let fast = backend.adapter().device.starts_with("softpipe");
    let profile = if fast {
        etalon_case::Profile::Full
    } else {
        etalon_case::Profile::Quick
    };
    checks::built_in_cases_are_drawn(backend, profile);
}

#[test]
fn llvmpipe() {
    in_child("llvmpipe", LLVMPIPE, || {
        everything(&adapter(Profile::Core, "llvmpipe", true));
    });
}

#[test]
fn llvmpipe_es() {
    in_child("llvmpipe_es", LLVMPIPE, || {
        everything(&adapter(Profile::Es, "llvmpipe", true));
    });
}

#[test]
fn llvmpipe_without_clip_control() {
    in_child("llvmpipe_without_clip_control", LLVMPIPE, || {
        all(&adapter(Profile::Core, "llvmpipe", false));
        all(&adapter(Profile::Es, "llvmpipe", false));
    });
}

#[test]
fn softpipe() {
    in_child("softpipe", SOFTPIPE, || {
        everything(&adapter(Profile::Core, "softpipe", true));
    });
}

#[test]
fn softpipe_es() {
    in_child("softpipe_es", SOFTPIPE, || {
        everything(&adapter(Profile::Es, "softpipe", true));
    });
}

#[test]
fn softpipe_without_clip_control() {
    in_child("softpipe_without_clip_control", SOFTPIPE, || {
        all(&adapter(Profile::Core, "softpipe", false));
        all(&adapter(Profile::Es, "softpipe", false));
    });
}

#[test]
fn zink() {
    in_child("zink", ZINK, || {
        everything(&adapter(Profile::Core, "zink", true));
    });
}

#[test]
fn zink_es() {
    in_child("zink_es", ZINK, || {
        everything(&adapter(Profile::Es, "zink", true));
    });
}

#[test]
fn devices_are_enumerated_and_open() {
    in_child("devices_are_enumerated_and_open", LLVMPIPE, || {
        let devices = crate::enumerate().expect("EGL enumerates devices");
        println!("{devices:?}");
        let software = devices
            .iter()
            .find(|d| d.software)
            .expect("Mesa's software device");
        let options = Options {
            profile: Profile::Core,
            platform: Platform::Device(software.index),
            library: None,
            debug: false,
        };
        let backend = crate::open("gl:device", &options).expect("the software device opens");
        checks::all(&backend);
        let none = Options {
            platform: Platform::Device(devices.len()),
            ..options
        };
        assert!(crate::open("gl:none", &none).is_err());
    });
}

/// Debug output listens: without this, its silence elsewhere would prove nothing.
#[test]
fn a_planted_mistake_is_told() {
    for (test, environment) in [("llvmpipe", LLVMPIPE), ("softpipe", SOFTPIPE)] {
        // The child knows its driver by its environment.
        in_child("a_planted_mistake_is_told", environment, || {
            let driver = std::env::var("GALLIUM_DRIVER").expect("set by the parent");
            for profile in [Profile::Core, Profile::Es] {
                let backend = adapter(profile, &driver, true);
                assert_eq!(backend.messages(), Vec::<String>::new());
                // SAFETY: the context is current; the call is a mistake that GL defines.
                unsafe { glow::HasContext::enable(&backend.context.gl, 0xFFFF) };
                let messages = backend.messages();
                assert_eq!(messages.len(), 1, "{messages:?}");
                assert!(messages[0].starts_with("error "), "{messages:?}");
                assert!(backend.context.check("the mistake").is_err());
                assert_eq!(backend.messages(), Vec::<String>::new());
            }
        });
        println!("{test} tells");
    }
}

#[test]
fn two_adapters_take_turns() {
    in_child("two_adapters_take_turns", LLVMPIPE, || {
        let core = adapter(Profile::Core, "llvmpipe", true);
        let es = adapter(Profile::Es, "llvmpipe", true);
        checks::interleaved(&[&core, &es]);
        drop(core);
        checks::interleaved(&[&es]);
    });
}
