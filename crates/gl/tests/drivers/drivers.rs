//! The contexts under test. A missing driver fails the test: without it nothing is tested.

use etalon_backend::Backend;
use etalon_conformance::{Driver, GALLIUM_INSTALL, LLVMPIPE, SOFTPIPE, ZINK, known, variables};
use etalon_frame::Api;
use etalon_gl::{GlBackend, Options, Platform, Profile, open};

/// Opens a context, and asserts that it has the requested driver.
pub(crate) fn context(profile: Profile, driver: &str) -> GlBackend {
    let options = Options {
        profile,
        platform: Platform::Surfaceless,
        library: None,
        debug: true,
        fault: None,
        record: false,
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

fn driver(
    name: &str,
    environment: &'static [(&'static str, &'static str)],
    open: fn(bool) -> Box<dyn Backend>,
) -> Driver<'static> {
    Driver {
        known: known(name),
        environment: variables(environment),
        open,
        tolerated: &[],
    }
}

pub(crate) fn llvmpipe() -> Driver<'static> {
    let open = |_| Box::new(context(Profile::Core, "llvmpipe")) as Box<dyn Backend>;
    driver("gl:llvmpipe", LLVMPIPE, open)
}

pub(crate) fn llvmpipe_es() -> Driver<'static> {
    let open = |_| Box::new(context(Profile::Es, "llvmpipe")) as Box<dyn Backend>;
    driver("gl:es:llvmpipe", LLVMPIPE, open)
}

pub(crate) fn softpipe() -> Driver<'static> {
    let open = |_| Box::new(context(Profile::Core, "softpipe")) as Box<dyn Backend>;
    driver("gl:softpipe", SOFTPIPE, open)
}

pub(crate) fn softpipe_es() -> Driver<'static> {
    let open = |_| Box::new(context(Profile::Es, "softpipe")) as Box<dyn Backend>;
    driver("gl:es:softpipe", SOFTPIPE, open)
}

pub(crate) fn zink() -> Driver<'static> {
    let open = |_| Box::new(context(Profile::Core, "zink")) as Box<dyn Backend>;
    driver("gl:zink", ZINK, open)
}

pub(crate) fn zink_es() -> Driver<'static> {
    let open = |_| Box::new(context(Profile::Es, "zink")) as Box<dyn Backend>;
    driver("gl:es:zink", ZINK, open)
}
