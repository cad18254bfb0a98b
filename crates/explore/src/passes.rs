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

/// Returns the parts of a list of so many items that are taken away together: all, both halves, quarters, down
/// to one.
fn parts(length: usize) -> Vec<std::ops::Range<usize>> {
    let mut all = Vec::new();
    let mut size = length;
    while size > 0 {
        let starts = (0..length).step_by(size);
        all.extend(starts.map(|start| start..(start + size).min(length)));
        size /= 2;
    }
    all
}

/// Returns the number of a scene's passes.
fn passes_of(document: &Value) -> usize {
    crate::document::list(&document["scene"], "passes").len()
}

/// Returns the places of all draws.
fn draws_of(document: &Value) -> Vec<crate::edit::Place> {
    let passes = crate::document::list(&document["scene"], "passes").iter();
    let each = passes.enumerate().flat_map(|(p, pass)| {
        let draws = 0..crate::document::list(pass, "draws").len();
        draws.map(move |d| crate::edit::place!["scene", "passes", p, "draws", d])
    });
    each.collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parts_are_all_then_smaller_ones() {
        assert_eq!(parts(4), [0..4, 0..2, 2..4, 0..1, 1..2, 2..3, 3..4]);
        assert_eq!(parts(3), [0..3, 0..1, 1..2, 2..3]);
        assert_eq!(parts(0), []);
    }
}
