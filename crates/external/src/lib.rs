//! The backend of the open protocol: any program that reads scenes and writes frames.
//!
//! The worker starts the program and exchanges lines of JSON with it, through the program's standard input and output.
//! The program first describes its device in a [`message::Hello`]. Then the worker sends a [`scene::Request`] for each
//! drawing, and the program answers each with one [`message::Answer`]. `ci/adapters/external.md` is the page for authors of
//! such programs, and [`schema()`] the JSON schema of all messages.
//!
//! [`files`] has frames in files instead, whose texels have the same bytes.
//!
//! A program can do no more than a driver: whatever it sends becomes a frame of the expected size, or an error. It runs
//! in the worker's process group and ends with the worker.

mod backend;
pub mod files;
mod limits;
pub mod message;
mod npy;
mod program;
pub mod scene;
mod shaders;

pub use backend::{ExternalBackend, open};
pub use limits::{description, languages, limits, not_expressed};
pub use message::schema;
