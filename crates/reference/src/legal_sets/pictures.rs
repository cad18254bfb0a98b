//! Pictures against single samples: the result for all samples of a state equals the result for each of them
//! walked alone.

use super::legal_set_of_texels;
use crate::geometry::Geometries;
use crate::notes::Notes;
use crate::rules::Rules;
use crate::sample::Sample;
use crate::test_limits::limits;
use crate::texels::Texels;
use crate::walk::Walk;
use etalon_case::{Library, Profile};
use etalon_frame::{Api, Limits, TexelSet};
use etalon_scene::Scene;

/// The maximum number of samples per scene that are walked alone.
const MOST: usize = 600;

fn alone(walk: &Walk<'_>, at: Sample) -> TexelSet {
    let worlds = walk.worlds(at, walk.scene.passes.len(), &mut Notes(None));
    let mut set = worlds.map_or_else(TexelSet::default, |worlds| {
        walk.finish(&worlds, at, &mut Notes(None))
    });
    set.worlds.sort_unstable();
    set.worlds.dedup();
    set
}

fn check(id: &str, scene: &Scene, limits: &Limits, rules: &Rules) {
    let set = legal_set_of_texels(scene, limits, rules, Texels::All, &Geometries::default());
    let walk = Walk::new(scene, limits, rules, Texels::All);
    for group in &set.groups {
        let ([width, height], samples) = (group.size, group.samples);
        let count = (width * height * samples) as usize;
        // A step that is coprime to the sizes reaches all columns, rows and samples.
        let step = if count > MOST { (count / MOST) | 1 } else { 1 };
        for i in (0..count as u32).step_by(step) {
            let (texel, sample) = (i / samples, i % samples);
            let at = Sample {
                size: group.size,
                samples,
                x: texel % width,
                y: texel / width,
                sample,
            };
            walk.forget();
            let separate = alone(&walk, at);
            let shared = group.sample(at.x, at.y, sample);
            assert_eq!(*shared, separate, "{id} under {}: {at:?}", limits.api);
        }
    }
}

/// A case of each file, a different one per API; with `ETALON_TESTS=all`, every case of the quick profile.
#[test]
fn samples_judged_together_have_the_sets_that_each_has_alone() {
    let everything = std::env::var_os("ETALON_TESTS").is_some_and(|v| v == "all");
    let library = Library::built_in();
    let apis = [Api::Vulkan, Api::OpenGl, Api::OpenGlEs, Api::WebGpu];
    let mut checked = 0;
    for file in library.files() {
        if file.is_measured() {
            continue;
        }
        let cases: Vec<_> = file.cases(Profile::Quick).collect();
        for (i, case) in cases.iter().enumerate() {
            for (a, api) in apis.iter().enumerate() {
                if !everything && i != (cases.len() * a / apis.len()) {
                    continue;
                }
                let case = case.build().expect("a built-in case builds");
                let limits = limits(*api);
                for rules in [Rules::of(&limits), Rules::yardstick(&limits)] {
                    check(&case.id, &case.scene, &limits, &rules);
                }
                checked += 1;
            }
        }
    }
    assert!(checked > 400, "{checked}");
}
