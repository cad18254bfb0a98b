//! The contexts under test. A missing driver is a failure: nothing would have been tested.

use etalon_backend::Backend;
use etalon_conformance::{
    Driver, GALLIUM_INSTALL, LLVMPIPE, SOFTPIPE, SOFTPIPE_DEFECTS, ZINK, variables,
};
use etalon_frame::Api;
use etalon_gl::{GlBackend, Options, Platform, Profile, open};

/// Opens a context, and holds that the driver is the one that was asked for.
pub(crate) fn context(profile: Profile, driver: &str) -> GlBackend {
    let options = Options {
        profile,
        platform: Platform::Surfaceless,
        library: None,
        debug: true,
        read_fault: None,
    };
    let backend = open("gl:test", &options)
        .unwrap_or_else(|e| panic!("{driver} cannot be opened: {e} ({GALLIUM_INSTALL})"));
    let info = backend.adapter();
    let device = info.device.to_lowercase();
    assert!(
        device.starts_with(driver),
        "{device} is not {driver} ({GALLIUM_INSTALL})"
    );
    assert!(info.software);
    let api = match profile {
        Profile::Core => Api::OpenGl,
        Profile::Es => Api::OpenGlEs,
    };
    assert_eq!(backend.limits().api, api);
    backend
}

pub(crate) fn is_softpipe(backend: &dyn Backend) -> bool {
    let device = backend.adapter().device.to_lowercase();
    device.starts_with("softpipe")
}

/// No driver of OpenGL stores blue first.
const CORE: &[&str] = &[
    "feature mirrored-viewport",
    "feature depth-bounds",
    "format bgra8unorm",
    // No fetch tells 24 bits for certain.
    "4 samples of depth24plus",
];

fn driver(
    environment: &'static [(&'static str, &'static str)],
    open: fn(bool) -> Box<dyn Backend>,
    lacks: &'static [&'static str],
) -> Driver<'static> {
    Driver {
        environment: variables(environment),
        open,
        lacks,
        defects: Vec::new(),
        tolerated: &[],
    }
}

pub(crate) fn llvmpipe() -> Driver<'static> {
    driver(
        LLVMPIPE,
        |_| Box::new(context(Profile::Core, "llvmpipe")),
        CORE,
    )
}

pub(crate) fn llvmpipe_es() -> Driver<'static> {
    driver(LLVMPIPE, |_| Box::new(context(Profile::Es, "llvmpipe")), ES)
}

pub(crate) fn softpipe() -> Driver<'static> {
    Driver {
        defects: defects(),
        ..driver(
            SOFTPIPE,
            |_| Box::new(context(Profile::Core, "softpipe")),
            SOFT,
        )
    }
}

pub(crate) fn softpipe_es() -> Driver<'static> {
    Driver {
        defects: defects(),
        ..driver(
            SOFTPIPE,
            |_| Box::new(context(Profile::Es, "softpipe")),
            SOFT_ES,
        )
    }
}

pub(crate) fn zink() -> Driver<'static> {
    driver(ZINK, |_| Box::new(context(Profile::Core, "zink")), CORE)
}

pub(crate) fn zink_es() -> Driver<'static> {
    driver(ZINK, |_| Box::new(context(Profile::Es, "zink")), ES)
}

const ES: &[&str] = &["feature", "format", "drawing", "4 samples"];
const SOFT: &[&str] = &["feature", "format", "4 samples"];
const SOFT_ES: &[&str] = &["feature", "format", "drawing", "4 samples"];

/// Those of softpipe, and those that it has under clip control.
fn defects() -> Vec<(&'static str, &'static str)> {
    let clamps = [
        ("depth::depths_outside_are_clamped", CLAMP),
        ("depth::depths_are_clamped_to_a_reversed_range", CLAMP),
    ];
    [SOFTPIPE_DEFECTS, &clamps].concat()
}

/// Near = translate - scale in `sp_quad_depth_test.c`.
const CLAMP: &str = "depths are clamped to the range that clip depths from -1 on would have";
