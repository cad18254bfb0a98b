//! Methods against the truth, as a user runs them.
#![expect(clippy::unwrap_used, reason = "a test that panics has failed")]

use assert_cmd::Command;
use etalon_record::{Measured, Record, Run, Verdict};
use std::fs;
use std::path::Path;
use std::time::Duration;

const BINARY: &str = env!("CARGO_BIN_EXE_etalon");

fn etalon(arguments: &[&str]) -> Command {
    let mut command = Command::new(BINARY);
    command.args(arguments).timeout(Duration::from_secs(600));
    command
}

fn run(out: &Path, arguments: &[&str]) -> Run {
    let mut command = etalon(&["run", "--out"]);
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

/// The records of a method in a scene.
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
    let run = run(out.path(), &[&["methods/*"][..], &adapters].concat());
    for record in &run.records {
        let name = format!("{} on {}", record.case, record.adapter);
        if record.verdict == Verdict::NotSupported {
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
            record.message
        );
        let measured = measured(record);
        let distance = &measured.distance;
        assert!(distance.rmse <= distance.max + 1e-12, "{name}");
        assert!((0.0..=1.0).contains(&distance.flip), "{name}");
        assert!((0.0..=1.0).contains(&distance.wrong), "{name}");
        // The truth must be far better than what is measured against it.
        assert!(distance.truth_error <= 0.002, "{name}: {distance:?}");
        assert!(measured.passes > 0 && measured.bytes > 0, "{name}");
        if record.verdict != Verdict::Fail {
            assert!(measured.time.unwrap().wall > 0.0, "{name}");
        }
        if record.adapter == "cpu" {
            // None at all where everything is culled.
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

/// Where a method is exact, its picture is the truth but for the rounding of each blend.
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
            // Of glass in glass both faces of a box are one object.
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
