//! The suite of checks that every backend passes on every driver.
//!
//! Each check is written once, over [`etalon_backend::Backend`]: scenes whose outcome no rounding
//! touches, and the codes that must come back. A backend's tests describe the drivers that they
//! need as [`Driver`]s and name them in [`driver_tests!`], which makes a test of every check on
//! every driver. A check says which requirement kept it from drawing, and the description of the
//! driver must allow for that: a check that is skipped never passes silently.
//!
//! This is a development dependency of the backends, so that only their tests see cases.
#![expect(clippy::unwrap_used, reason = "a check fails by panicking")]

mod checks;
mod child;
mod driver;
mod driver_tests;
mod frames;
mod library;
mod scenes;
mod subject;

pub use checks::{CHECKS, Check};
pub use child::in_child;
pub use driver::{
    COUNTING_SHADERS, Driver, FOUR_SAMPLES, GALLIUM_INSTALL, LLVMPIPE, SOFTPIPE, SOFTPIPE_DEFECTS,
    ZINK, in_driver, run, run_all, variables,
};
pub use library::{Share, draw_library};
pub use scenes::scene;
pub use subject::{Missing, Outcome, Subject};
