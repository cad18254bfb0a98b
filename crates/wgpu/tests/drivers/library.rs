//! Draws a sample of the built-in cases, and all of them again with validation. `ETALON_TESTS=all` draws all
//! cases.

use crate::drivers;
use etalon_backend::Backend;
use etalon_case::Profile;
use etalon_conformance::{Share, TestedDriver, draw_library, in_child, run_all};

pub(crate) fn sample(backend: &dyn Backend) {
    let driver = match backend.adapter().name.as_str() {
        "wgpu:gl:softpipe" => drivers::softpipe(),
        "wgpu:gl:llvmpipe" => drivers::llvmpipe(),
        _ => drivers::lavapipe(),
    };
    let driver = TestedDriver {
        tolerated: &[],
        ..driver
    };
    draw_library(&driver.subject(backend), Profile::Quick, Share::sample(2));
}

/// Draws with validation: all checks, then cases of every file. OpenGL has no layers, only debug output.
fn validated(driver: &str, described: &TestedDriver<'_>, per_file: usize) {
    let test = format!("library::validation_of_{driver}_is_silent");
    in_child(&test, &described.environment, || {
        let backend = (described.open)(true);
        run_all(&*backend, described);
        let subject = described.subject(&*backend);
        draw_library(&subject, Profile::Quick, Share::sample(per_file));
    });
}

#[test]
fn validation_of_lavapipe_is_silent() {
    validated("lavapipe", &drivers::lavapipe(), 2);
}

#[test]
fn validation_of_llvmpipe_is_silent() {
    validated("llvmpipe", &drivers::llvmpipe(), 1);
}

#[test]
fn validation_of_softpipe_is_silent() {
    validated("softpipe", &drivers::softpipe(), 1);
}
