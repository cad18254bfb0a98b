//! The contexts under test. A missing driver fails the test: without it nothing is tested.

use etalon_backend::Backend;
use etalon_conformance::{
    GALLIUM_INSTALL, LLVMPIPE, SOFTPIPE, TestedDriver, VIRGL, Value, ZINK, known, variables,
};
use etalon_frame::Api;
use etalon_gl::{GlBackend, GlOptions, Platform, Profile, open};
use etalon_keeper::{Served, Server, keep};
use std::io::{BufReader, stdin};
use std::process::Command;
use std::sync::OnceLock;

/// The adapters as `etalon` starts them.
const ADAPTERS: &str = include_str!("../../../adapters/adapters.json");

/// The server of virgl, which ends with this process.
static SERVED: OnceLock<Served> = OnceLock::new();

/// The process that keeps a server; started by the tests alone.
#[test]
#[ignore = "a process of the other tests"]
fn keeper() {
    keep(BufReader::new(stdin()), None).expect("the server is kept");
}

/// Opens a context of virgl, whose server is started for it.
fn virgl_context(profile: Profile) -> Box<dyn Backend> {
    let adapters: Vec<Value> = serde_json::from_str(ADAPTERS).expect("the built-in file is JSON");
    let virgl = adapters.iter().find(|entry| entry["name"] == "gl:virgl");
    let server = virgl.expect("virgl is built in")["server"].clone();
    let server: Server = serde_json::from_value(server).expect("a server");
    let program = std::env::current_exe().expect("this program has a path");
    let mut keeper = Command::new(program);
    keeper.args(["--exact", "drivers::keeper", "--ignored", "--nocapture"]);
    let served = server.start(keeper);
    let mut served = served.unwrap_or_else(|e| panic!("{e} ({GALLIUM_INSTALL})"));
    let backend = context(profile, "virgl");
    served.connected();
    assert!(SERVED.set(served).is_ok(), "a process opens virgl once");
    Box::new(backend)
}

/// Opens a context, and asserts that it has the requested driver.
pub(crate) fn context(profile: Profile, driver: &str) -> GlBackend {
    let options = GlOptions {
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

/// True if the device is this driver's.
pub(crate) fn is(backend: &dyn Backend, driver: &str) -> bool {
    let device = backend.adapter().device.to_lowercase();
    device.starts_with(driver)
}

fn driver(
    name: &str,
    environment: &'static [(&'static str, &'static str)],
    open: fn(bool) -> Box<dyn Backend>,
) -> TestedDriver<'static> {
    TestedDriver {
        known: known(name),
        environment: variables(environment),
        open,
        tolerated: &[],
    }
}

pub(crate) fn llvmpipe() -> TestedDriver<'static> {
    let open = |_| Box::new(context(Profile::Core, "llvmpipe")) as Box<dyn Backend>;
    driver("gl:llvmpipe", LLVMPIPE, open)
}

pub(crate) fn llvmpipe_es() -> TestedDriver<'static> {
    let open = |_| Box::new(context(Profile::Es, "llvmpipe")) as Box<dyn Backend>;
    driver("gl:es:llvmpipe", LLVMPIPE, open)
}

pub(crate) fn softpipe() -> TestedDriver<'static> {
    let open = |_| Box::new(context(Profile::Core, "softpipe")) as Box<dyn Backend>;
    driver("gl:softpipe", SOFTPIPE, open)
}

pub(crate) fn softpipe_es() -> TestedDriver<'static> {
    let open = |_| Box::new(context(Profile::Es, "softpipe")) as Box<dyn Backend>;
    driver("gl:es:softpipe", SOFTPIPE, open)
}

pub(crate) fn zink() -> TestedDriver<'static> {
    let open = |_| Box::new(context(Profile::Core, "zink")) as Box<dyn Backend>;
    driver("gl:zink", ZINK, open)
}

pub(crate) fn zink_es() -> TestedDriver<'static> {
    let open = |_| Box::new(context(Profile::Es, "zink")) as Box<dyn Backend>;
    driver("gl:es:zink", ZINK, open)
}

pub(crate) fn virgl() -> TestedDriver<'static> {
    driver("gl:virgl", VIRGL, |_| virgl_context(Profile::Core))
}

pub(crate) fn virgl_es() -> TestedDriver<'static> {
    driver("gl:es:virgl", VIRGL, |_| virgl_context(Profile::Es))
}
