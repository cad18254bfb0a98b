//! The passes of a reduction, in order: passes that remove the most come first.
//!
//! A pass is a function from a document to edits. Each edit makes the document smaller or simpler by the
//! pass's own order. No pass restores what another one removes, because reductions would not end otherwise.
//! Edits need not give valid cases: case files are checked elsewhere.

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

/// Returns the edits of a document, given a wrong texel, the largest edits first.
pub(crate) type EditPass = fn(&Value, Option<[u32; 2]>) -> Vec<Edit>;

/// All passes.
pub(crate) const PASSES: &[EditPass] = &[
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
