//! Case files: parsing, axes, expansion, ids, meshes and the JSON schema.
//!
//! A [`Library`] holds case files, compiled in or from a folder. Each file expands into
//! [`CaseRef`]s, whose ids cost nothing; [`CaseRef::build`] makes the [`Case`] with its [`Scene`].

mod draw;
mod error;
mod file;
mod library;
mod mesh;
mod methods;
mod pairwise;
mod random;
mod relation;
mod resolve;
pub mod scene;
mod schema;
mod shader;
pub mod state;
mod states;
pub mod truth;
mod variants;
mod wire;

pub use error::CaseError;
pub use file::{Case, CaseFile, CaseRef, Expect, Profile, Variant};
pub use library::Library;
pub use mesh::{Mesh, MeshSource, Primitive, RESTART, Splat, Units, Vertex};
pub use relation::{Invariance, Relation};
pub use scene::Scene;
pub use schema::schema;
pub use truth::{Method, Truth};
