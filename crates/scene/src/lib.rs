//! What a driver is asked to draw.
//!
//! A [`Scene`] is data: attachments, passes, draws with all their state, and what is read back. It
//! names no case and no expected value, so a backend, which depends on this crate and not on the
//! cases, cannot see what it is judged by.

mod invariance;
mod mesh;
mod scene;
mod shader;
mod state;

pub use invariance::Invariance;
pub use mesh::{MAX_VERTICES, Mesh, MeshSource, Primitive, RESTART, Splat, Units, Vertex};
pub use scene::*;
pub use shader::Shader;
pub use state::*;
