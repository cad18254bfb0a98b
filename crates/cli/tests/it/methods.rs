//! Runs of methods against the truth.
#![expect(clippy::unwrap_used, reason = "a test that panics has failed")]

use crate::etalon::etalon;
use crate::sample;
use etalon_record::{Measured, Record, Run, Verdict};
use etalon_report::message;
use std::fs;
use std::path::Path;
use std::time::Duration;

fn run(out: &Path, arguments: &[&str]) -> Run {
    let mut command = etalon(&["run", "--out"]);
    command.timeout(Duration::from_secs(600));
    command.arg(out).args(arguments).assert().code(0);
    let run = Run::read(out).unwrap();
    assert_eq!((run.truncated, run.missing()), (false, 0));
    run
}

fn measured(record: &Record) -> &Measured {
    record
        .measured
        .as_ref()
        .unwrap_or_else(|| panic!("{record:?}"))
}

/// Returns the records of a method in a scene.
fn of<'r>(run: &'r Run, question: &str, scene: &str, method: &str) -> Vec<&'r Record> {
    let prefix = format!("methods/{question}/{scene}/method={method}");
    let found: Vec<&Record> = run
        .records
        .iter()
        .filter(|r| r.case == prefix || r.case.starts_with(&format!("{prefix}/")))
        .collect();
    assert!(!found.is_empty(), "{prefix}");
    found
}

#[test]
fn the_quick_methods_are_measured_on_a_rasterizer_and_a_driver() {
    let out = tempfile::tempdir().unwrap();
    let adapters = ["--adapter", "cpu", "--adapter", "gl:softpipe"];
    let listed = etalon(&["list", "methods/*"]).assert().success();
    let listed = String::from_utf8(listed.get_output().stdout.clone()).unwrap();
    let ids: Vec<&str> = listed.lines().collect();
    let count = sample::count("cases", ids.len() / 4, ids.len());
    let chosen: Vec<&str> = ids.iter().copied().step_by(ids.len() / count).collect();
    assert!(chosen.len() >= count && count > 30, "{count}");
    let run = run(out.path(), &[&chosen[..], &adapters].concat());
    assert_eq!(run.records.len(), 2 * chosen.len());
    for record in &run.records {
        let name = format!("{} on {}", record.case, record.adapter);
        if matches!(record.verdict, Verdict::NotSupported | Verdict::Blocked) {
            assert_ne!(record.adapter, "cpu", "{name}");
            continue;
        }
        assert!(
            matches!(
                record.verdict,
                Verdict::Pass | Verdict::Imprecise | Verdict::Measured
            ) || record.expected.is_some(),
            "{name}: {} {}",
            record.verdict,
            message(record)
        );
        let measured = measured(record);
        let distance = &measured.distance;
        assert!(distance.rmse <= distance.max + 1e-12, "{name}");
        assert!((0.0..=1.0).contains(&distance.flip), "{name}");
        assert!((0.0..=1.0).contains(&distance.wrong), "{name}");
        // The truth must be far more precise than the methods that are measured against it.
        assert!(distance.truth_error <= 0.002, "{name}: {distance:?}");
        assert!(measured.passes > 0 && measured.bytes > 0, "{name}");
        if record.verdict != Verdict::Fail {
            assert!(measured.time.unwrap().wall > 0.0, "{name}");
        }
        if record.adapter == "cpu" {
            // There are no fragments if everything is culled.
            assert!(measured.fragments.is_some(), "{name}");
        }
    }
    for page in ["index.html", "methods.html"] {
        let text = fs::read_to_string(out.path().join(page)).unwrap();
        assert!(text.contains("<svg") || page == "index.html", "{page}");
    }
    let pictures = run
        .records
        .iter()
        .filter_map(|r| r.measured.as_ref()?.picture.as_ref());
    for picture in pictures {
        let bytes = fs::read(out.path().join(picture)).unwrap();
        assert!(bytes.starts_with(b"\x89PNG"), "{picture}");
    }
}

/// The picture of an exact method differs from the truth only by the rounding of each blend.
#[test]
fn exact_methods_agree_with_the_truth() {
    let out = tempfile::tempdir().unwrap();
    let globs = [
        "methods/transparency/windows/*alpha=0.4",
        "methods/transparency/nested-glass",
    ];
    let others = ["--profile", "full", "--adapter", "cpu"];
    let run = run(out.path(), &[&globs[..], &others].concat());
    for scene in ["windows", "nested-glass"] {
        let exact: &[&str] = match scene {
            // In nested glass, both faces of a box belong to one object.
            "windows" => &[
                "sorted",
                "front-to-back",
                "depth-peeling",
                "dual-depth-peeling",
            ],
            _ => &["depth-peeling", "dual-depth-peeling"],
        };
        for method in exact {
            for record in of(&run, "transparency", scene, method) {
                let distance = &measured(record).distance;
                assert!(distance.max <= 4.5 / 255.0, "{}: {distance:?}", record.case);
            }
        }
        let unsorted = of(&run, "transparency", scene, "unsorted");
        let worst = unsorted.iter().map(|r| measured(r).distance.rmse);
        assert!(
            worst.fold(0.0, f64::max) > 0.01,
            "{scene}: order must matter"
        );
    }
}
