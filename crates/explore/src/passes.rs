//! The passes of a reduction, in order: what takes most away comes first.
//!
//! A pass is a function from a document to edits, each of which makes it smaller or simpler by an order of its
//! own. No pass puts back what another takes away, or reductions would not end. Edits need not give valid
//! cases: case files are checked elsewhere.

mod attachments;
mod lists;
mod meshes;
mod numbers;
mod sizes;
mod states;
mod textures;
mod words;

use crate::edit::Edit;
use serde_json::Value;

/// Returns the edits of a document, of which a texel is wrong, the boldest first.
pub(crate) type Pass = fn(&Value, Option<[u32; 2]>) -> Vec<Edit>;

/// All passes.
pub(crate) const PASSES: &[Pass] = &[
    lists::frames,
    lists::passes,
    lists::draws,
    states::of_draws,
    lists::counters,
    lists::clears,
    attachments::bound,
    attachments::read,
    textures::shaders,
    attachments::unused,
    meshes::meshes,
    states::members,
    sizes::sizes,
    sizes::samples,
    textures::texels,
    words::formats,
    words::words,
    numbers::numbers,
];
