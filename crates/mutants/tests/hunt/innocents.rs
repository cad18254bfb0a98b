//! The permissions that innocents use.

use etalon_mutants::{innocents, specifications};
use etalon_reference::Rules;
use std::collections::BTreeSet;

/// Permissions that no innocent uses, and why.
const WITHOUT: &[(&str, &str)] = &[
    ("facing", "a must: there is nothing to permit"),
    ("stencil", "a must: there is nothing to permit"),
    ("write_mask", "a must: there is nothing to permit"),
    (
        "shader_error",
        "the rasterizer's shaders have no step to replace",
    ),
    ("half_overflows", "no specification leaves it open"),
    (
        "outlines_face_as_polygons",
        "open only where polygons have no modes",
    ),
    (
        "restarts_before_base_vertex",
        "a scene's indices have no base vertex",
    ),
    (
        "bias_clamps_fragments",
        "the rasterizer biases fragments only",
    ),
    (
        "operations_count_nothing",
        "clears have no counters in the rasterizer",
    ),
    (
        "runs_for_overwritten",
        "the rasterizer does not know later fragments",
    ),
];

#[test]
fn each_permission_has_an_innocent_or_a_reason() {
    let used: BTreeSet<&str> = innocents().iter().flat_map(|i| i.permissions()).collect();
    let rules = Rules::of(&specifications()[0]);
    for (name, _, _) in rules.permissions() {
        let is_without = WITHOUT.iter().any(|(without, _)| *without == name);
        assert!(used.contains(name) != is_without, "{name}");
    }
}

#[test]
fn each_part_of_a_profile_is_an_innocent() {
    let names: BTreeSet<&str> = innocents().iter().map(|i| i.name.as_str()).collect();
    for innocent in innocents() {
        for part in innocent.parts {
            assert!(names.contains(part), "{}: {part}", innocent.name);
        }
    }
}
