//! Reproducers of driver bugs that need nothing of the suite: a program printed from the calls that a
//! backend made, and a report to send with it.
//!
//! All inputs are data: the recorded calls, the wrong texels with their permitted values, and the device.
//! Names and ids come from users, so they are quoted before they reach C code or a shell.

#![cfg_attr(
    test,
    expect(clippy::unwrap_used, reason = "a test that panics has failed")
)]

mod archive;
mod c;
mod check;
mod declarations;
mod due;
mod error;
mod gl;
mod head;
mod language;
mod print;
mod program;
mod report;
mod table;
mod vulkan;
mod wgpu;
mod wrap;

pub use archive::{File, WriteError, Written, free, write};
pub use due::{Due, DueChannel, DueCounter, DueTexel};
pub use error::BundleError;
pub use gl::Trim;
pub use head::Head;
pub use language::Language;
pub use print::program;
pub use program::Program;
pub use report::{BadReleases, Checks, Report, WrongValue};
