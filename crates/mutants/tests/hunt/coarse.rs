//! The additional step of the hierarchy's mutants, without a bug.

use etalon_backend::Prepared;
use etalon_case::{Library, Profile};
use etalon_cpu::CpuScene;
use etalon_cpu::steps::Faithful;
use etalon_mutants::with_faithful_hierarchy;

/// A coarse depth buffer without a bug rejects only fragments that fail the depth test.
#[test]
fn a_right_coarse_depth_changes_no_frame() {
    let library = Library::built_in();
    let areas = ["depth/", "stencil/", "multisample/depth", "size/hierarchy"];
    let cases: Vec<_> = library
        .cases(Profile::Candidates)
        .filter(|case| areas.iter().any(|area| case.id().starts_with(area)))
        .map(|case| case.build().unwrap())
        .collect();
    let draw = |mut prepared: Box<dyn Prepared>| {
        prepared.submit().unwrap();
        prepared.read_back().unwrap()
    };
    for scene in cases.iter().flat_map(|case| case.scenes()) {
        let expected = CpuScene::new(scene.clone(), Faithful);
        let found = with_faithful_hierarchy(scene.clone());
        assert_eq!(draw(Box::new(expected)), draw(Box::new(found)));
    }
}
