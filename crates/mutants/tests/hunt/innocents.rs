//! The permissions that innocents use.

use etalon_frame::Grade;
use etalon_mutants::{innocents, specifications};
use etalon_reference::Rules;
use std::collections::BTreeSet;

/// Permissions that no innocent uses, and why.
const WITHOUT: &[(&str, &str)] = &[
    ("facing", "a must: there is nothing to permit"),
    ("stencil", "a must: there is nothing to permit"),
    ("write_mask", "a must: there is nothing to permit"),
    (
        "float_error",
        "the rasterizer's viewport and interpolation have no step to replace by a coarser one",
    ),
    (
        "shader_error",
        "the rasterizer's shaders have no step to replace",
    ),
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
        "clears_count_nothing",
        "clears have no counters in the rasterizer",
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

/// The evidence by which each specification forbids each behaviour; `-` where it permits it. The table is read and
/// accepted by people: a rule that becomes narrower shows here as a behaviour that was permitted.
const TABLE: &str = include_str!("innocents.txt");

#[test]
fn the_specifications_permit_what_the_table_says() {
    let specifications = specifications();
    let rows: Vec<Vec<&str>> = innocents()
        .iter()
        .map(|innocent| {
            let each = specifications.iter().map(|s| innocent.forbidden_by(s));
            let cells = each.map(|grade| grade.map_or("-", Grade::name));
            [innocent.name.as_str()].into_iter().chain(cells).collect()
        })
        .collect();
    let cells = |line: &'static str| line.split_whitespace().collect::<Vec<_>>();
    let accepted: Vec<Vec<&str>> = TABLE.lines().skip(1).map(cells).collect();
    for (row, accepted) in rows.iter().zip(&accepted) {
        assert_eq!(row, accepted);
    }
    assert_eq!(rows.len(), accepted.len());
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
