//! The suite of checks that every backend passes on every driver.
//!
//! Each check is written once, over [`etalon_backend::Backend`]: scenes whose outcome no rounding
//! touches, and the codes that must come back. A backend's tests describe the drivers that they
//! need as [`Driver`]s and name them in [`driver_tests!`], which makes a test of every check on
//! every driver. What software drivers lack is known by name: a check that is skipped for anything
//! else fails, and each check draws on one of them at least.
//!
//! This is a development dependency of the backends, so that only their tests see cases.
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

pub use checks::{CHECKS, Check};
pub use child::in_child;
pub use driver::{Driver, GALLIUM_INSTALL, LLVMPIPE, SOFTPIPE, VIRGL, ZINK};
pub use driver::{in_driver, run, run_all, variables};
pub use known::{
    COUNTING_SHADERS, Defect, FOUR_SAMPLES, KNOWN, Known, SOFTPIPE_CLEARS, SOFTPIPE_WRONG, known,
};
pub use lacks::{Lacks, Names};
pub use library::{Share, draw_area, draw_library};
pub use scenes::{scene, with};
pub use serde_json::{Value, json};
pub use subject::{CheckResult, Missing, Subject};
