//! Prints what a case costs: `cargo test --release -p etalon-vulkan --test driver -- --ignored --nocapture`.

use crate::common::backend;
use etalon_backend::Backend;
use etalon_case::{Library, Profile};
use std::time::{Duration, Instant};

#[test]
#[ignore = "prints times, asserts nothing"]
fn what_a_case_costs() {
    let backend = backend(false);
    let library = Library::built_in().unwrap();
    let scenes: Vec<_> = library
        .cases(Profile::Full)
        .map(|c| c.build().unwrap().scene)
        .filter(|s| backend.limits().missing(&s.requirements()).is_none())
        .collect();
    println!("{:?}", backend.adapter());
    // Few enough that all their pipelines are kept.
    let scenes: Vec<_> = scenes.iter().step_by(scenes.len() / 100 + 1).collect();
    for round in ["cold", "warm", "warm again"] {
        let mut parts = [Duration::ZERO; 4];
        for scene in scenes.iter().copied() {
            let mut at = Instant::now();
            let mut lap = |part: &mut Duration| {
                *part += at.elapsed();
                at = Instant::now();
            };
            let mut prepared = backend.prepare(scene).unwrap();
            lap(&mut parts[0]);
            prepared.submit().unwrap();
            lap(&mut parts[1]);
            prepared.read_back().unwrap();
            lap(&mut parts[2]);
            drop(prepared);
            lap(&mut parts[3]);
        }
        let per_case = |d: Duration| d.as_secs_f64() * 1e3 / scenes.len() as f64;
        let total: Duration = parts.iter().sum();
        println!(
            "{round}: {} cases, {:.3} ms each: prepare {:.3}, submit {:.3}, read back {:.3}, drop {:.3}",
            scenes.len(),
            per_case(total),
            per_case(parts[0]),
            per_case(parts[1]),
            per_case(parts[2]),
            per_case(parts[3]),
        );
    }
}
