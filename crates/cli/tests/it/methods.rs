//! Runs of methods against the truth.
#![expect(clippy::unwrap_used, reason = "a test that panics has failed")]

use crate::etalon::etalon;
use crate::sample;
use etalon_frame::Requirement;
use etalon_record::{Clock, Measured, Reason, Record, Run, Verdict};
use etalon_report::message;
use predicates::str::contains;
use serde_json::{Value, json};
use sha2::{Digest, Sha256};
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
    let adapters = [
        "--adapter",
        "cpu",
        "--adapter",
        "gl:softpipe",
        "--sizes",
        "none",
    ];
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
    let others = ["--profile", "full", "--adapter", "cpu", "--sizes", "none"];
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

/// A frame of another size shows the same scene, costs more, and says why it was left out.
#[test]
fn methods_are_timed_at_the_sizes_of_frames() {
    let out = tempfile::tempdir().unwrap();
    let globs = [
        "methods/transparency/windows",
        "methods/anti-aliasing/thin-wedge",
    ];
    // The last size is larger than what the rasterizer draws.
    let sizes = ["--sizes", "640x360,960x540,8000x100", "--adapter", "cpu"];
    let drawn = run(out.path(), &[&globs[..], &sizes].concat());
    assert_eq!(
        drawn.header.settings.sizes,
        [[640, 360], [960, 540], [8000, 100]]
    );
    for record in &drawn.records {
        let (name, measured) = (&record.case, measured(record));
        let [small, large, too_large] = &measured.sizes[..] else {
            panic!("{name}: {:?}", measured.sizes);
        };
        assert_eq!(
            too_large.reason,
            Some(Reason::Missing(Requirement::Size(8000))),
            "{name}"
        );
        assert_eq!((too_large.time, too_large.distance), (None, None), "{name}");
        for frame in [small, large] {
            let distance = frame.distance.unwrap();
            assert!(
                frame.time.unwrap().wall > 0.0 && frame.reason.is_none(),
                "{name}"
            );
            assert!(distance.texels >= 4096, "{name}: {distance:?}");
            assert!(distance.rmse <= distance.max, "{name}: {distance:?}");
            // No edge counts in a question about composition, and fewer texels are on edges in a larger frame.
            let picture = measured.distance.rmse;
            assert!(
                distance.rmse <= picture * 1.2 + 1e-3,
                "{name}: {distance:?} {picture}"
            );
            if name.contains("/windows/") {
                assert!(
                    distance.rmse >= picture * 0.8,
                    "{name}: {distance:?} {picture}"
                );
            }
        }
        let cost = measured.cost.unwrap();
        assert!(cost.per_megapixel.median > 0.0, "{name}: {cost:?}");
        assert!(
            cost.deviation.is_some() && cost.clock == Clock::Wall,
            "{name}: {cost:?}"
        );
    }
    let page = fs::read_to_string(out.path().join("methods.html")).unwrap();
    assert!(page.contains("960\u{d7}540</option>"), "a size to choose");
    let resumed = ["--resume", "--sizes", "none", "--adapter", "cpu"];
    let mut command = etalon(&["run", "--out"]);
    command
        .arg(out.path())
        .args([&globs[..], &resumed].concat());
    command.assert().code(64).stderr(contains("sizes"));
}

/// Returns the path of a scene of one's own.
fn scene(name: &str) -> String {
    format!("{}/../../cases/gltf/{name}", env!("CARGO_MANIFEST_DIR"))
}

#[test]
fn a_scene_of_ones_own_is_drawn_like_a_built_in_one() {
    let out = tempfile::tempdir().unwrap();
    let file = scene("greenhouse.glb");
    let globs = [
        "methods/transparency/*method=sorted",
        "methods/transparency/*method=depth-peeling",
        "methods/anti-aliasing/*method=msaa-4",
    ];
    let adapters = ["--adapter", "cpu", "--adapter", "gl:softpipe"];
    let others = ["--gltf", &file, "--sizes", "320x180", "--format", "json"];
    let mut command = etalon(&["run", "--out"]);
    command.arg(out.path());
    let printed = command.args([&globs[..], &adapters, &others].concat());
    let printed: Value =
        serde_json::from_slice(&printed.assert().code(0).get_output().stdout).unwrap();
    let run = Run::read(out.path()).unwrap();
    assert_eq!(run.records.len(), 6);
    let sorted = of(&run, "transparency", "gltf=greenhouse", "sorted");
    let peeled = of(&run, "transparency", "gltf=greenhouse", "depth-peeling");
    for (sorted, peeled) in sorted.iter().zip(&peeled) {
        let [sorted, peeled] = [sorted, peeled].map(|record| &measured(record).distance);
        // The bubble is around a ball and its faces are not sorted; eight layers hold everything.
        assert!(
            peeled.rmse < 0.003 && peeled.rmse < sorted.rmse,
            "{sorted:?} {peeled:?}"
        );
    }
    let gltf = run.header.settings.gltf.as_ref().unwrap();
    let digest = format!("{:x}", Sha256::digest(fs::read(&file).unwrap()));
    assert_eq!((gltf.name.as_str(), &gltf.sha256), ("greenhouse", &digest));
    let points = printed["points"].as_array().unwrap();
    // Each record has its picture and a frame; softpipe does not draw four samples.
    assert_eq!(points.len(), 10);
    let large = points.iter().filter(|p| p["size"] == json!([320, 180]));
    assert_eq!(large.count(), 5);
    let csv = fs::read_to_string(out.path().join("methods.csv")).unwrap();
    let columns: Vec<usize> = csv.lines().map(|line| line.split(',').count()).collect();
    assert_eq!(columns, [16; 11]);
    let mut resume = etalon(&["run", "--resume", "--out"]);
    resume.arg(out.path()).args(globs).args(adapters);
    let other = scene("avenue.gltf");
    resume.args(["--gltf", &other]).assert().code(64);
}

#[test]
fn a_scene_that_cannot_be_drawn_gets_one_message() {
    let out = tempfile::tempdir().unwrap();
    let broken = out.path().join("broken.glb");
    fs::write(&broken, "glTF").unwrap();
    let mut list = etalon(&["list", "--gltf"]);
    let refused = list.arg(&broken).assert().code(64);
    refused.stderr(contains("broken.glb, the file: it is not valid glTF 2.0"));
    let avenue = scene("avenue.gltf");
    let refused = etalon(&["list", "--gltf", &avenue, "methods/transparency/*"]);
    let text =
        "the scene gives methods/anti-aliasing/gltf=avenue, methods/depth-precision/gltf=avenue";
    { refused }.assert().code(4).stderr(contains(text));
}

#[test]
fn the_size_of_the_picture_is_timed_once_more_and_not_twice() {
    let out = tempfile::tempdir().unwrap();
    let case = "methods/transparency/windows/method=sorted/alpha=0.4";
    let drawn = run(
        out.path(),
        &[case, "--sizes", "128x128", "--adapter", "cpu"],
    );
    let [record] = &drawn.records[..] else {
        panic!("{:?}", drawn.records);
    };
    let [frame] = &measured(record).sizes[..] else {
        panic!("{:?}", measured(record).sizes);
    };
    assert!(
        frame.time.is_some() && frame.distance.is_some(),
        "{frame:?}"
    );
    assert_eq!(
        measured(record).cost,
        None,
        "one amount of work has no line"
    );
}

#[test]
fn a_size_that_is_none_is_refused_with_the_names() {
    etalon(&["run", "methods/transparency/windows", "--sizes", "480p"])
        .assert()
        .code(64)
        .stderr(contains(
            "`480p` is no size: expected 720p, 1080p, 4k, WIDTHxHEIGHT",
        ));
}
