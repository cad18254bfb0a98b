//! Case files: parsing, axes, expansion, ids and the JSON schema.
//!
//! A [`Library`] is a set of case files, compiled in or read from a folder. Each file expands into
//! [`CaseRef`]s, whose ids cost nothing; [`CaseRef::build`] makes the [`Case`] with its scene.

mod attachment;
mod blame;
mod build;
mod case;
mod changes;
mod codes;
mod comments;
mod document;
mod draw;
mod each;
mod error;
mod expanded;
mod fetch;
mod file;
mod file_text;
mod json;
mod library;
mod lint;
mod pairwise;
mod pass_operations;
mod path;
mod place;
mod queries;
mod random;
mod redundant;
mod relation;
mod resolve;
mod scene_json;
mod schema;
mod select;
mod sequence;
mod states;
mod tiles;
mod values;
mod variants;
mod wire;

pub use case::{Case, ExpectedTexel};
pub use document::build;
pub use error::CaseError;
pub use etalon_methods::Method;
pub use file::{CaseFile, CaseRef, Profile};
pub use json::parse_json;
pub use library::Library;
pub use relation::Relation;
pub use scene_json::scene_json;
pub use schema::schema;
pub use select::{Globs, SelectError, Selection, left_out, select};
pub use variants::Variant;
