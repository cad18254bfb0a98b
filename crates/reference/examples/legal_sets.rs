//! Prints a hash of the legal sets of each case under each API's rules, or the time that judging a case takes.
//! A change that only makes the judge faster leaves the hashes equal.
//!
//! `cargo run --release -p etalon-reference --example legal_sets -- hashes 1`

use etalon_backend::Backend;
use etalon_case::{Case, CaseFile, CaseRef, Library, Profile};
use etalon_cpu::CpuBackend;
use etalon_frame::{Api, LegalSet, Limits};
use etalon_reference::{Geometries, Judgement, Texels, judgements_by, shared_sets};
use etalon_scene::Scene;
use rustc_hash::FxHasher;
use std::hash::{Hash, Hasher};
use std::hint::black_box;
use std::process::ExitCode;
use std::time::Instant;

/// The largest number of judged texels of a picture that exists to be measured.
const MEASURED: u64 = 4096;

/// The number of times that all cases are timed; the least time of each counts.
const ROUNDS: usize = 3;

fn main() -> ExitCode {
    let mut arguments = std::env::args().skip(1);
    let action = arguments.next().unwrap_or_default();
    let step: usize = arguments.next().map_or(1, |n| n.parse().unwrap_or(1));
    let prefix = arguments.next().unwrap_or_default();
    let library = Library::built_in();
    let cases = library.cases(Profile::Full);
    let cases = cases.filter(|case| case.id().starts_with(&prefix));
    let cases: Vec<CaseRef<'_>> = cases.step_by(step.max(1)).collect();
    let count = cases.len();
    let cases = || {
        cases
            .iter()
            .map(|case| case.build().expect("built-in cases build"))
    };
    let limits = [Api::Vulkan, Api::OpenGl, Api::OpenGlEs, Api::WebGpu].map(|api| Limits {
        api,
        ..CpuBackend::new("cpu").limits().clone()
    });
    let geometries = Geometries::default();
    match action.as_str() {
        "hashes" => {
            for case in cases() {
                for limits in &limits {
                    let hash = hash(&case, limits, &geometries);
                    println!("{hash:016x} {} {}", limits.api, case.id);
                }
            }
        }
        "times" => {
            let mut times = vec![f64::INFINITY; count];
            for _ in 0..ROUNDS {
                let geometries = Geometries::default();
                for (least, case) in times.iter_mut().zip(cases()) {
                    *least = least.min(time(&case, &limits[0], &geometries));
                }
            }
            times.sort_by(f64::total_cmp);
            let mean = times.iter().sum::<f64>() / times.len().max(1) as f64;
            let at = |share: f64| times[(times.len() as f64 * share) as usize];
            println!(
                "{} cases: median {:.3} ms, mean {mean:.3} ms, 95th percentile {:.3} ms",
                times.len(),
                at(0.5),
                at(0.95)
            );
        }
        // Judges each case once, for a profiler.
        "judge" => {
            for case in cases() {
                black_box(judge(&case.scene, &case, &limits[0], &geometries));
            }
        }
        // Judges a grid of 2000 triangles a row once, for its memory.
        "grid" => {
            let case = grid(step);
            black_box(judge(&case.scene, &case, &limits[0], &geometries));
        }
        _ => {
            eprintln!(
                "usage: legal_sets hashes|times|judge [STEP [PREFIX]], or legal_sets grid ROWS"
            );
            return ExitCode::from(2);
        }
    }
    ExitCode::SUCCESS
}

/// Returns a case of a grid of triangles.
fn grid(rows: usize) -> Case {
    let text = format!(
        r#"{{"about":"t","spec":["t"],"scene":{{
            "attachments":{{"color":{{"format":"rgba8unorm","size":[500,500]}}}},
            "passes":[{{"color":["color"],"draws":[{{
                "mesh":{{"kind":"grid","cells":[1000,{rows}],"value":0.5}},"shader":"flat_color"}}]}}],
            "read":["color"]}}}}"#
    );
    let file = CaseFile::parse("grid.json", &text).expect("the case parses");
    let case = file.cases(Profile::Full).next().expect("one case");
    case.build().expect("the case builds")
}

fn texels(case: &Case) -> Texels {
    if case.measured {
        Texels::AtMost(MEASURED)
    } else {
        Texels::All
    }
}

/// Returns the judgements of a scene of a case.
fn judge(scene: &Scene, case: &Case, limits: &Limits, geometries: &Geometries) -> Vec<Judgement> {
    let texels = texels(case);
    let sets = shared_sets(scene, texels, geometries);
    judgements_by(scene, limits, texels, &sets)
}

/// Returns the time of both bands of a case's scene in milliseconds.
fn time(case: &Case, limits: &Limits, geometries: &Geometries) -> f64 {
    let start = Instant::now();
    black_box(judge(&case.scene, case, limits, geometries));
    start.elapsed().as_secs_f64() * 1e3
}

/// Returns a hash of both bands of all scenes of a case.
fn hash(case: &Case, limits: &Limits, geometries: &Geometries) -> u64 {
    let mut hasher = FxHasher::default();
    let variants = case.variants.iter().map(|variant| &variant.scene);
    for scene in std::iter::once(&case.scene).chain(variants) {
        for judgement in judge(scene, case, limits, geometries) {
            for set in [&judgement.legal, &judgement.yardstick] {
                hash_set(set, &mut hasher);
            }
        }
    }
    hasher.finish()
}

fn hash_set(set: &LegalSet, hasher: &mut FxHasher) {
    format!("{:?}{:?}", set.images, set.counters).hash(hasher);
    for group in &set.groups {
        for (end, set) in group.runs() {
            (end, set).hash(hasher);
        }
    }
}
