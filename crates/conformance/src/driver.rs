//! Drivers: how tests reach them, and how checks run on them.

use crate::checks::{CHECKS, DriverCheck};
use crate::child::in_child;
use crate::known::{KnownFaults, WHOLE};
use crate::prediction::{Prediction, predict};
use crate::subject::{CheckResult, CheckedBackend};
use etalon_backend::Backend;
use etalon_frame::Requirement;
use std::panic::{AssertUnwindSafe, catch_unwind};

/// The environment of Mesa's llvmpipe.
pub const LLVMPIPE: &[(&str, &str)] = &[
    ("LIBGL_ALWAYS_SOFTWARE", "1"),
    ("GALLIUM_DRIVER", "llvmpipe"),
];
/// The environment of Mesa's softpipe.
pub const SOFTPIPE: &[(&str, &str)] = &[
    ("LIBGL_ALWAYS_SOFTWARE", "1"),
    ("GALLIUM_DRIVER", "softpipe"),
];
/// The environment of Mesa's zink over its software Vulkan.
pub const ZINK: &[(&str, &str)] = &[
    ("LIBGL_ALWAYS_SOFTWARE", "1"),
    ("MESA_LOADER_DRIVER_OVERRIDE", "zink"),
    ("GALLIUM_DRIVER", "zink"),
];
/// The environment of Mesa's virgl, whose server is one of virglrenderer.
pub const VIRGL: &[(&str, &str)] = &[
    ("LIBGL_ALWAYS_SOFTWARE", "1"),
    ("GALLIUM_DRIVER", "virpipe"),
];
/// The remedy where these are missing.
pub const GALLIUM_INSTALL: &str =
    "apt-get install libegl1 libgl1-mesa-dri mesa-vulkan-drivers virgl-server";

/// A driver as tests open it, with its known defects.
pub struct TestedDriver<'a> {
    /// The driver's missing features and known faults.
    pub known: KnownFaults,
    /// Environment variables of the process that opens the driver. If empty, this process opens it.
    pub environment: Vec<(&'a str, String)>,
    /// Opens it, with validation if requested. Panics on failure, since nothing would be tested.
    pub open: fn(bool) -> Box<dyn Backend>,
    /// Parts of validation messages that are not the backend's fault.
    pub tolerated: &'a [&'a str],
}

/// Converts the variables of an environment for [`TestedDriver::environment`].
pub fn variables<'a>(environment: &[(&'a str, &str)]) -> Vec<(&'a str, String)> {
    let owned = |(name, value): &(&'a str, &str)| (*name, (*value).to_owned());
    environment.iter().map(owned).collect()
}

impl<'a> TestedDriver<'a> {
    /// Returns an open backend of this driver as the subject of checks.
    pub fn subject(&self, backend: &'a dyn Backend) -> CheckedBackend<'a> {
        for (name, defect) in self.known.defects.iter().copied().flatten() {
            if WHOLE.contains(name) {
                println!("{name}: left out, for {defect}");
            }
        }
        self.known.subject(backend, self.tolerated)
    }
}

impl TestedDriver<'_> {
    /// Runs a check, and asserts that it draws if the driver's description says so.
    fn run(&self, check: &DriverCheck, subject: &CheckedBackend<'_>) {
        let mut defects = self.known.defects.iter().copied().flatten();
        if let Some((_, defect)) = defects.find(|d| d.0 == check.name) {
            println!("{}: skipped, for {defect}", check.name);
            return;
        }
        let (ran, missing) = match check.run(subject) {
            CheckResult::Passed(missing) => (true, missing),
            CheckResult::Skipped(missing) => (false, missing),
        };
        let names: Vec<String> = missing.iter().map(Requirement::to_string).collect();
        match (ran, names.is_empty()) {
            (true, true) => println!("{}: ok", check.name),
            (true, false) => println!("{}: ok, but for {}", check.name, names.join(", ")),
            (false, _) => println!("{}: skipped, for lack of {}", check.name, names.join(", ")),
        }
        if let Some(lacks) = &self.known.lacks {
            let expected = lacks.limits(subject.limits().api);
            // The driver supports features that the tests leave out.
            let denied = |r: &&Requirement| subject.backend.limits().missing(&[**r]).is_some();
            let unknown = missing.iter().filter(denied);
            let unknown = unknown.filter(|r| expected.missing(&[**r]).is_none());
            let unknown: Vec<_> = unknown.map(Requirement::to_string).collect();
            assert!(
                unknown.is_empty(),
                "{} must not lack {unknown:?}",
                self.known.name
            );
        }
        if let Some(expected) = predict(check, &self.known) {
            let skips = expected == Prediction::Skips;
            assert_eq!(ran, !skips, "{} on {}", check.name, self.known.name);
        }
    }
}

/// Runs every check on one open backend.
///
/// # Panics
/// If checks fail; after all have run, with their names.
pub fn run_all(backend: &dyn Backend, driver: &TestedDriver<'_>) {
    if let Some(lacks) = &driver.known.lacks {
        lacks.check(backend.limits());
    }
    let subject = driver.subject(backend);
    subject.check_silence("opening");
    let fails = |check: &&DriverCheck| {
        catch_unwind(AssertUnwindSafe(|| driver.run(check, &subject))).is_err()
    };
    let failed: Vec<_> = CHECKS
        .iter()
        .filter(fails)
        .map(|check| check.name)
        .collect();
    assert!(failed.is_empty(), "these checks fail: {failed:#?}");
}

/// Opens the driver in a process with its environment, as part of the test with this path.
pub fn in_driver(test: &str, driver: &TestedDriver<'_>, body: impl FnOnce(&dyn Backend)) {
    let (_, test) = test.split_once("::").expect("a path within the crate");
    in_child(test, &driver.environment, || body(&*(driver.open)(false)));
}
