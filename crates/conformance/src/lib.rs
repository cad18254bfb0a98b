//! The suite of checks that every backend passes on every driver.
//!
//! Each check is written once, against [`etalon_backend::Backend`]: scenes whose result does not depend on
//! rounding, and the codes that must come back. A backend's tests describe the drivers that they need as
//! [`TestedDriver`]s and list them in [`driver_tests!`], which runs every check on every driver.
//! The features that software drivers lack are listed by name: a check that is skipped for anything else
//! fails, and each check draws on at least one of the drivers.
//!
//! The backends use this only as a development dependency, so that only their tests see cases. `etalon conformance` runs
//! the same checks on any adapter ([`check_each()`]), and [`first_topic()`] says what its author should fix first.
#![expect(clippy::unwrap_used, reason = "a check fails by panicking")]

mod checks;
mod child;
mod driver;
mod driver_tests;
mod frames;
mod known;
mod lacks;
mod library;
mod prediction;
mod scenes;
mod subject;
mod topics;

pub use checks::{CHECKS, DriverCheck};
pub use child::in_child;
pub use driver::{GALLIUM_INSTALL, LLVMPIPE, SOFTPIPE, TestedDriver, VIRGL, ZINK};
pub use driver::{in_driver, run_all, variables};
pub use known::{
    COUNTING_SHADERS, Defect, FOUR_SAMPLES, KNOWN, KnownFaults, SOFTPIPE_CLEARS, SOFTPIPE_WRONG,
    known,
};
pub use lacks::{LackNames, Lacks};
pub use library::{Share, draw_area, draw_library};
pub use scenes::{scene, with};
pub use serde_json::{Value, json};
pub use subject::{CheckResult, CheckedBackend, Missing};
pub use topics::{Topic, check_each, first_topic};
