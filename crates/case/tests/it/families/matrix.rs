//! The performance matrix: its cells, and the work between their two cases.

use etalon_case::{Case, Library, Profile};
use etalon_frame::Work;
use std::collections::{BTreeMap, BTreeSet};

/// The cases of the matrix by their cell and size.
fn cells(profile: Profile) -> BTreeMap<String, Vec<Case>> {
    let library = Library::built_in();
    let mut cells: BTreeMap<String, Vec<Case>> = BTreeMap::new();
    for case in library.cases(profile) {
        let id = case.id();
        if !id.starts_with("perf/matrix/") {
            continue;
        }
        let parts: Vec<&str> = id
            .split('/')
            .filter(|p| !p.starts_with("layers="))
            .collect();
        let case = case.build().expect("built-in cases build");
        cells.entry(parts.join("/")).or_default().push(case);
    }
    cells
}

fn group(cell: &str) -> &str {
    cell.split('/').nth(2).expect("a cell has a group")
}

#[test]
fn the_matrix_has_its_cells_and_the_quick_profile_some_of_each_group() {
    let full = cells(Profile::Full);
    let large: Vec<&String> = full
        .keys()
        .filter(|c| c.contains("size=1024x1024"))
        .collect();
    assert!(large.len() >= 300, "{}", large.len());
    assert_eq!(large.len() * 2, full.len());
    assert!(full.values().all(|cases| cases.len() == 2));
    let groups: BTreeSet<&str> = full.keys().map(|c| group(c)).collect();
    let quick = cells(Profile::Quick);
    assert_eq!(
        quick.keys().map(|c| group(c)).collect::<BTreeSet<_>>(),
        groups
    );
    // A cell takes about half a second for seven rounds, so all of them stay below a minute.
    assert!(quick.len() <= 70, "{}", quick.len());
    assert!(quick.keys().all(|c| c.contains("size=512x512")));
    assert!(quick.values().all(|cases| cases.len() == 2));
    for cell in [
        "perf/matrix/fill/blend=none/format=rgba8unorm/samples=1/size=512x512",
        "perf/matrix/clear/format=rgba8unorm/size=512x512",
    ] {
        assert!(quick.contains_key(cell), "{cell}");
    }
}

#[test]
fn the_cases_of_a_cell_differ_only_in_the_work_that_it_measures() {
    for (cell, cases) in cells(Profile::Quick) {
        let (less, more) = (cases[0].scene.work(), cases[1].scene.work());
        let size = cases[0].scene.attachments[0].size;
        let texels = u64::from(size[0]) * u64::from(size[1]);
        let same = |f: fn(Work) -> u64| f(less) == f(more);
        let of_passes = match group(&cell) {
            "clear" | "clear-samples" | "clear-depth" | "clear-depth-stencil" => {
                assert_eq!(
                    [less.cleared, more.cleared],
                    [4 * texels, 12 * texels],
                    "{cell}"
                );
                same(|w| w.resolved) && same(|w| w.read)
            }
            "resolve" => {
                assert_eq!(
                    [less.resolved, more.resolved],
                    [2 * texels, 8 * texels],
                    "{cell}"
                );
                same(|w| w.cleared) && same(|w| w.read)
            }
            "read-back" => {
                assert_eq!([less.read, more.read], [texels, 3 * texels], "{cell}");
                same(|w| w.triangles) && same(|w| w.texels)
            }
            "cull" => {
                assert_eq!([less.texels, more.texels], [0, 0], "{cell}");
                assert_eq!(more.triangles, 4 * less.triangles, "{cell}");
                true
            }
            "triangles" => {
                let each = less.texels / less.triangles;
                assert!(
                    cell.ends_with(&format!("texels={each}")),
                    "{cell}: {less:?}"
                );
                assert_eq!(more.triangles, 4 * less.triangles, "{cell}");
                assert_eq!(more.texels, 4 * less.texels, "{cell}");
                true
            }
            _ => {
                assert_eq!(
                    [less.texels, more.texels],
                    [4 * texels, 12 * texels],
                    "{cell}"
                );
                same(|w| w.cleared) && same(|w| w.resolved) && same(|w| w.read)
            }
        };
        assert!(of_passes, "{cell}: {less:?} {more:?}");
    }
}
