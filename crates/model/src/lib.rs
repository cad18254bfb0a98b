//! Scenes of one's own, read from glTF files.
//!
//! What methods draw is read: triangles in their places, their base colours with alpha and vertex colours, alpha modes,
//! and a camera. Where a texture or vertex colours vary within a triangle, it is cut into pieces of one colour. Skins, morph
//! targets, animations, lights and normals are not read; triangles are lit by their own planes.

mod accessor;
mod color;
mod document;
mod error;
mod files;
mod mesh;
mod nodes;
#[cfg(test)]
mod tests;
mod texture;

pub use document::{ReadModel, read};
pub use error::ModelError;
