//! Drivers: how tests reach them, what they lack and what they are known to do wrong.

use crate::checks::{CHECKS, Check};
use crate::child::in_child;
use crate::subject::{Outcome, Subject};
use etalon_backend::Backend;
use etalon_frame::{Feature, Requirement};
use std::collections::BTreeSet;
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
/// Checks that softpipe fails through OpenGL, OpenGL ES and wgpu, each with its defect.
pub const SOFTPIPE_DEFECTS: &[(&str, &str)] = &[
    (
        "depth::a_slope_bias_counts_the_slope",
        "a bias that is not the slope times its factor",
    ),
    (
        "sampling::neighbours_in_the_mirror_are_averaged",
        "the wrong neighbour in the mirror",
    ),
    (
        "formats::uploads_are_fetched",
        "the lowest code of rgba8snorm, fetched as less than -1",
    ),
    ("counters::rejected_fragments_run", EARLY),
    ("counters::forced_tests_come_before_the_shader", EARLY),
];
const EARLY: &str = "fragments that are rejected before a shader that counts";
/// The environment of Mesa's zink over its software Vulkan.
pub const ZINK: &[(&str, &str)] = &[
    ("LIBGL_ALWAYS_SOFTWARE", "1"),
    ("MESA_LOADER_DRIVER_OVERRIDE", "zink"),
    ("GALLIUM_DRIVER", "zink"),
];
/// The remedy where these are missing.
pub const GALLIUM_INSTALL: &str = "apt-get install libegl1 libgl1-mesa-dri mesa-vulkan-drivers";

/// One way to a driver, and what the tests know of it.
pub struct Driver<'a> {
    /// Variables of the process that opens it; none where it is opened in this process.
    pub environment: Vec<(&'a str, String)>,
    /// Opens it, with validation where asked for. Panics where that fails: nothing would be tested.
    pub open: fn(bool) -> Box<dyn Backend>,
    /// Beginnings of the requirements that it may lack.
    pub lacks: &'a [&'a str],
    /// Names of checks that it fails, each with its defect. They are not run.
    pub defects: Vec<(&'a str, &'a str)>,
    /// Parts of messages of validation that are not the backend's fault.
    pub tolerated: &'a [&'a str],
}

/// Variables of an environment as a [`Driver`] has them.
pub fn variables<'a>(environment: &[(&'a str, &str)]) -> Vec<(&'a str, String)> {
    let owned = |(name, value): &(&'a str, &str)| (*name, (*value).to_owned());
    environment.iter().map(owned).collect()
}

/// The name of a defect of four samples: all scenes that need them are left out.
pub const FOUR_SAMPLES: &str = "four samples";
/// The name of a defect of shaders that count: all scenes that need them are left out.
pub const COUNTING_SHADERS: &str = "counting shaders";

impl<'a> Driver<'a> {
    /// Returns an open backend of this driver as the subject of checks.
    pub fn subject(&self, backend: &'a dyn Backend) -> Subject<'a> {
        let mut subject = Subject::new(backend, self.tolerated);
        for (name, defect) in &self.defects {
            subject = match *name {
                FOUR_SAMPLES => subject.without_four_samples(),
                COUNTING_SHADERS => subject.without_feature(Feature::StorageCounters),
                _ => continue,
            };
            println!("{name}: left out, for {defect}");
        }
        subject
    }
}

impl Driver<'_> {
    /// Runs checks, and returns the names of those that were skipped.
    fn run_each(
        &self,
        backend: &dyn Backend,
        chosen: impl Fn(&Check) -> bool,
    ) -> BTreeSet<&'static str> {
        let subject = self.subject(backend);
        subject.check_silence("opening");
        let (mut failed, mut skipped) = (Vec::new(), BTreeSet::new());
        for check in CHECKS.iter().filter(|check| chosen(check)) {
            match catch_unwind(AssertUnwindSafe(|| self.run(check, &subject))) {
                Ok(true) => {}
                Ok(false) => {
                    skipped.insert(check.name);
                }
                Err(_) => failed.push(check.name),
            }
        }
        assert!(failed.is_empty(), "these checks fail: {failed:#?}");
        skipped
    }

    /// Runs a check. Returns false where nothing was drawn.
    fn run(&self, check: &Check, subject: &Subject<'_>) -> bool {
        if let Some((_, defect)) = self.defects.iter().find(|d| d.0 == check.name) {
            println!("{}: skipped, for {defect}", check.name);
            return false;
        }
        let (ran, missing) = match check.run(subject) {
            Outcome::Passed(missing) => (true, missing),
            Outcome::Skipped(missing) => (false, missing),
        };
        let names: Vec<String> = missing.iter().map(Requirement::to_string).collect();
        match (ran, names.is_empty()) {
            (true, true) => println!("{}: ok", check.name),
            (true, false) => println!("{}: ok, but for {}", check.name, names.join(", ")),
            (false, _) => println!("{}: skipped, for lack of {}", check.name, names.join(", ")),
        }
        let known = |name: &String| self.lacks.iter().any(|l| name.starts_with(l));
        let unknown: Vec<_> = names.iter().filter(|name| !known(name)).collect();
        let adapter = &subject.adapter().name;
        assert!(unknown.is_empty(), "{adapter} must not lack {unknown:?}");
        ran
    }
}

/// Runs the checks of one subject on a driver, as the test of this path.
///
/// # Panics
/// When checks fail; after all have run, with their names.
pub fn run(test: &str, subject: &str, driver: &Driver<'_>) {
    in_driver(test, driver, |backend| {
        driver.run_each(backend, |check| check.subject == subject);
    });
}

/// Runs every check on one open backend, and holds where told that exactly these were skipped.
///
/// # Panics
/// When checks fail; after all have run, with their names.
pub fn run_all(backend: &dyn Backend, driver: &Driver<'_>, skipped: Option<&[&str]>) {
    let left_out = driver.run_each(backend, |_| true);
    if let Some(skipped) = skipped {
        assert_eq!(left_out, skipped.iter().copied().collect(), "skipped");
    }
}

/// Opens the driver in a process with its environment, as the test of this path.
pub fn in_driver(test: &str, driver: &Driver<'_>, body: impl FnOnce(&dyn Backend)) {
    let (_, test) = test.split_once("::").expect("a path within the crate");
    in_child(test, &driver.environment, || body(&*(driver.open)(false)));
}
