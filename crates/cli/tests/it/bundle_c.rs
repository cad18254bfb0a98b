//! `etalon bundle`: its programs are built and run as a maintainer would, and show a bug only on drivers that
//! have it.
#![expect(clippy::unwrap_used, reason = "a test that panics has failed")]

use crate::bundling::{bundle, last_line, run_as_told};
use crate::etalon::etalon;
use crate::sample;
use serde_json::{Value, json};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use tempfile::TempDir;

/// Builds a program in an empty folder, without a warning.
fn built(folder: &Path, empty: &Path) -> PathBuf {
    let program = empty.join("repro");
    let output = Command::new("cc")
        .args(["-std=c99", "-Wall", "-Wextra", "-Werror", "-pedantic"])
        .arg(folder.join("repro.c"))
        .args(["-ldl", "-o"])
        .arg(&program)
        .current_dir(empty)
        .output()
        .unwrap();
    let errors = String::from_utf8(output.stderr).unwrap();
    assert!(output.status.success(), "{}: {errors}", folder.display());
    program
}

/// Runs a program on one of Mesa's drivers.
fn run_on(driver: &str, program: &Path) -> Output {
    Command::new(program)
        .env("LIBGL_ALWAYS_SOFTWARE", "1")
        .env("GALLIUM_DRIVER", driver)
        .env_remove("MESA_LOADER_DRIVER_OVERRIDE")
        .env("XDG_RUNTIME_DIR", "/tmp")
        .output()
        .unwrap()
}

/// Cases that a driver fails, with a driver that passes them or lacks a feature. One for each finding about
/// the driver itself.
const FAILING: [(&str, &str, &str); 30] = [
    (
        "cull/lines/cull=none/front_face=cw",
        "gl:softpipe",
        "llvmpipe",
    ),
    (
        "found/reduced/bug=clear-depth-part",
        "gl:llvmpipe",
        "softpipe",
    ),
    (
        "scissor/samples/mask=all/rect=row/samples=4",
        "gl:es:llvmpipe",
        "softpipe",
    ),
    (
        "early-z/counted-depth-rejects-all/early=forced/format=depth24plus-stencil8/occlusion=any-samples-passed/samples=1",
        "gl:es:softpipe",
        "llvmpipe",
    ),
    (
        "blend/dual-source/dst=src1/operation=add/src=src-alpha",
        "gl:es:softpipe",
        "llvmpipe",
    ),
    ("combined/extended/seed=16", "gl:softpipe", "llvmpipe"),
    (
        "blend/order-formats/equation=subtract/format=rg11b10ufloat",
        "gl:es:softpipe",
        "llvmpipe",
    ),
    (
        "blend/snorm/constant=inside/equation=over",
        "gl:es:softpipe",
        "llvmpipe",
    ),
    ("combined/extended/seed=21", "gl:es:softpipe", "llvmpipe"),
    (
        "cull/points/cull=none/front_face=cw",
        "gl:es:softpipe",
        "llvmpipe",
    ),
    (
        "cull/polygon-line/cull=none/front_face=cw",
        "gl:softpipe",
        "llvmpipe",
    ),
    (
        "cull/stencil-faces-points/cull=none/format=depth24plus-stencil8/front_face=cw",
        "gl:es:softpipe",
        "llvmpipe",
    ),
    (
        "depth/clamp-first-draw/clamp=true/format=depth24plus",
        "gl:es:softpipe",
        "llvmpipe",
    ),
    (
        "found/reduced/bug=snorm-under-mask",
        "gl:es:softpipe",
        "llvmpipe",
    ),
    ("found/reduced/bug=alpha-absent", "gl:softpipe", "llvmpipe"),
    (
        "paths/integers/end=blit/start=clear-command/target=plain",
        "gl:es:softpipe",
        "llvmpipe",
    ),
    (
        "texture/texel-for-texel/across=repeat/down=mirror-repeat/filter=linear/window=thrice",
        "gl:es:softpipe",
        "llvmpipe",
    ),
    (
        "blend/integers-logic/mask=gb/operation=or",
        "gl:softpipe",
        "llvmpipe",
    ),
    (
        "blend/logic/format=rgb10a2unorm/logic=or",
        "gl:softpipe",
        "llvmpipe",
    ),
    (
        "capabilities/features/feature=depth-clamp",
        "gl:softpipe",
        "llvmpipe",
    ),
    (
        "stencil/export/early-tests/compare=equal/shader=exported_depth",
        "gl:softpipe",
        "llvmpipe",
    ),
    (
        "blend/factors-formats/factor=src/format=rgba8snorm",
        "gl:llvmpipe",
        "softpipe",
    ),
    (
        "blend/formats-store/format=rgba8snorm/source=large",
        "gl:llvmpipe",
        "softpipe",
    ),
    ("combined/multisample/seed=5", "gl:llvmpipe", "softpipe"),
    (
        "cull/tessellation/polygon-line/cull=none/front_face=cw/order=cw",
        "gl:llvmpipe",
        "softpipe",
    ),
    (
        "found/reduced/bug=advanced-blend-clamped",
        "gl:llvmpipe",
        "softpipe",
    ),
    (
        "found/reduced/bug=outline-stencil-face",
        "gl:llvmpipe",
        "softpipe",
    ),
    (
        "found/reduced/bug=point-beside-scissor",
        "gl:llvmpipe",
        "softpipe",
    ),
    (
        "multisample/alpha-between-draws/multisample=to-one/samples=4",
        "gl:llvmpipe",
        "softpipe",
    ),
    (
        "size/tiles/edges-samples/by=scissor/edge=7",
        "gl:es:llvmpipe",
        "softpipe",
    ),
];

#[test]
fn a_program_shows_the_bug_on_the_accused_driver_only() {
    let count = sample::count("failing cases of drivers", 4, FAILING.len());
    for (case, adapter, other) in &FAILING[..count] {
        let (out, empty) = (TempDir::new().unwrap(), TempDir::new().unwrap());
        let (code, summary, error) = bundle(case, adapter, out.path(), &[]);
        assert_eq!(code, 0, "{case} on {adapter}: {error}");
        assert_eq!(summary["clean"], true, "{summary}");
        assert_eq!(summary["failed"], summary["runs"], "{summary}");
        let folder = Path::new(summary["folder"].as_str().unwrap());
        let program = built(folder, empty.path());
        let report = fs::read_to_string(folder.join("report.md")).unwrap();
        let accused = run_as_told(&report, empty.path());
        let line = last_line(&accused);
        assert_eq!(
            accused.status.code(),
            Some(1),
            "{case} on {adapter}: {line}"
        );
        assert!(
            line.contains("is wrong: ") || line.starts_with("counter"),
            "{line}"
        );
        // The tool builds and runs the program too: the report has its last line.
        assert!(
            report.contains(&format!("ends with 1: `{line}`")),
            "{report}"
        );
        let sound = run_on(other, &program);
        let line = last_line(&sound);
        match sound.status.code() {
            Some(0) => assert_eq!(line, "right"),
            Some(77) => assert!(line.starts_with("not supported: "), "{line}"),
            other => panic!("{case}: {other:?}: {line}"),
        }
        for picture in ["expected.png", "actual.png", "difference.png"] {
            let image = image::open(folder.join(picture));
            assert!(
                image.is_ok() || report.contains("| counter "),
                "{case}: {picture}"
            );
        }
        assert!(Path::new(summary["archive"].as_str().unwrap()).is_file());
    }
}

#[test]
fn the_case_file_of_a_bundle_fails_as_the_case_did() {
    let out = TempDir::new().unwrap();
    let (code, summary, error) =
        bundle("combined/extended/seed=16", "gl:softpipe", out.path(), &[]);
    assert_eq!(code, 0, "{error}");
    let folder = Path::new(summary["folder"].as_str().unwrap());
    let cases = out.path().join("cases");
    fs::create_dir(&cases).unwrap();
    fs::copy(folder.join("case.json"), cases.join("case.json")).unwrap();
    let run = out.path().join("run");
    let [cases, run] = [&cases, &run].map(|path| path.to_str().unwrap());
    etalon(&[
        "run",
        "--cases",
        cases,
        "--adapter",
        "gl:softpipe",
        "--out",
        run,
    ])
    .assert()
    .code(1);

    // A bundle is replaced only with --force.
    let (code, _, error) = bundle("combined/extended/seed=16", "gl:softpipe", out.path(), &[]);
    assert_eq!(code, 64, "{error}");
    assert!(error.contains("--force"), "{error}");
}

/// Cases that lavapipe fails, one for each finding.
const FAILING_ON_LAVAPIPE: [&str; 8] = [
    "paths/resolve/pass=dynamic-rendering/start=transfer/target=array-layer",
    "capabilities/depth-resolve/format=depth16unorm/mode=average/samples=4",
    "found/reduced/bug=indexed-indirect",
    "found/reduced/bug=alpha-to-coverage-of-integers",
    "found/reduced/bug=alpha-to-one-of-integers",
    "found/reduced/bug=outline-stencil-face",
    "paths/resolve-depth/pass=render-pass/start=transfer/target=array-layer",
    "multisample/alpha-between-draws/multisample=to-one/samples=4",
];

#[test]
fn a_program_of_vulkan_keeps_to_the_rules_and_accuses_one_driver() {
    let count = sample::count("cases that lavapipe fails", 3, FAILING_ON_LAVAPIPE.len());
    for case in &FAILING_ON_LAVAPIPE[..count] {
        let (out, empty) = (TempDir::new().unwrap(), TempDir::new().unwrap());
        let (code, summary, error) = bundle(case, "vulkan:lavapipe", out.path(), &[]);
        assert_eq!(code, 0, "{case}: {error}");
        assert_eq!(summary["clean"], true, "{summary}");
        let folder = Path::new(summary["folder"].as_str().unwrap());
        let program = built(folder, empty.path());
        let report = fs::read_to_string(folder.join("report.md")).unwrap();
        let accused = run_as_told(&report, empty.path());
        assert_eq!(
            accused.status.code(),
            Some(1),
            "{case}: {}",
            last_line(&accused)
        );

        // The validation layer writes its messages to the program's output.
        let mut lines = report.lines();
        let line = lines.find(|line| line.ends_with("./repro")).unwrap();
        let checked = Command::new("sh")
            .args(["-c", line])
            .env("VK_INSTANCE_LAYERS", "VK_LAYER_KHRONOS_validation")
            .current_dir(empty.path())
            .output()
            .unwrap();
        let text = String::from_utf8_lossy(&checked.stdout);
        assert_eq!(text.lines().count(), 2, "{case}: {text}");

        let other = "/usr/lib/chromium/vk_swiftshader_icd.json";
        let sound = Command::new(&program)
            .env("VK_DRIVER_FILES", other)
            .env("VK_ICD_FILENAMES", other)
            .output()
            .unwrap();
        let line = last_line(&sound);
        match sound.status.code() {
            Some(0) => assert_eq!(line, "right"),
            Some(77) => assert!(
                line.contains("VkResult") || line.starts_with("not supported"),
                "{line}"
            ),
            // SwiftShader has these bugs too: `ci/findings/swiftshader-*.json`.
            Some(1) if case.contains("coverage-of-integers") || case.contains("outline") => {}
            other => panic!("{case}: {other:?}: {line}"),
        }
    }
}

#[test]
fn a_fault_of_the_suite_becomes_no_bundle() {
    let case = "multisample/formats/format=rgba8unorm-srgb/samples=4";
    for adapter in ["gl:llvmpipe", "vulkan:lavapipe"] {
        let out = TempDir::new().unwrap();
        let adapter = format!("{adapter}:read-fault=off-by-one");
        let (code, _, error) = bundle(case, &adapter, out.path(), &[]);
        assert_eq!(code, 1, "{adapter}: {error}");
        let words = "does not show the bug: exit status: 0, right";
        assert!(error.contains(words), "{adapter}: {error}");
        assert_eq!(fs::read_dir(out.path()).unwrap().count(), 0);
    }
}

#[test]
fn a_case_that_the_layer_objects_to_has_no_bundle() {
    let folder = TempDir::new().unwrap();
    let file = folder.path().join("adapters.json");
    // The validation layer warns about an extension that the backend enables.
    let adapters = json!([{
        "name": "vulkan:strict", "backend": "vulkan", "answers": "llvmpipe",
        "environment": { "VK_LAYER_ENABLES": "VK_VALIDATION_FEATURE_ENABLE_BEST_PRACTICES_EXT" },
    }]);
    fs::write(&file, adapters.to_string()).unwrap();
    let out = folder.path().join("out");
    let more = ["--adapters", file.to_str().unwrap()];
    let case = "found/reduced/bug=indexed-indirect";
    let (code, _, error) = bundle(case, "vulkan:strict", &out, &more);
    assert_eq!(code, 1, "{error}");
    let words = "does not keep to the rules of the API: Validation Warning";
    assert!(error.contains(words), "{error}");
    assert!(!out.exists());
}

/// Text that would end a C string, a comment, a shell word or Markdown if it were not escaped.
const HOSTILE: &str =
    "*/ \"; system(\"touch pwned\"); /* $(touch pwned) `touch pwned` '; touch pwned; ' ??/\\ <b>";

#[test]
fn hostile_texts_reach_neither_a_shell_nor_c() {
    let folder = TempDir::new().unwrap();
    let file = folder.path().join("adapters.json");
    let adapters = json!([{
        "name": "gl:strange", "backend": "gl", "answers": "softpipe",
        "environment": { "LIBGL_ALWAYS_SOFTWARE": "1", "GALLIUM_DRIVER": "softpipe", "ETALON_STRANGE": HOSTILE },
    }]);
    fs::write(&file, adapters.to_string()).unwrap();
    let cases = folder.path().join("cases");
    fs::create_dir(&cases).unwrap();
    let found = "cases/found/reduced.json";
    let text = fs::read_to_string(
        Path::new(env!("CARGO_MANIFEST_DIR"))
            .join("../..")
            .join(found),
    )
    .unwrap();
    let mut document: Value = serde_json::from_str(&text).unwrap();
    document["about"] = json!(HOSTILE);
    fs::write(cases.join("strange.json"), document.to_string()).unwrap();
    let more = [
        "--adapters",
        file.to_str().unwrap(),
        "--cases",
        cases.to_str().unwrap(),
    ];
    let out = folder.path().join("out");
    let (code, summary, error) = bundle("strange/bug=alpha-absent", "gl:strange", &out, &more);
    assert_eq!(code, 0, "{error}");
    let bundled = Path::new(summary["folder"].as_str().unwrap());
    let empty = TempDir::new().unwrap();
    built(bundled, empty.path());
    let report = fs::read_to_string(bundled.join("report.md")).unwrap();
    let output = run_as_told(&report, empty.path());
    assert_eq!(output.status.code(), Some(1), "{report}");
    let files: Vec<_> = fs::read_dir(empty.path())
        .unwrap()
        .map(|e| e.unwrap().file_name())
        .collect();
    assert_eq!(files, ["repro"], "something else was run");
    assert!(!Path::new("pwned").exists());
}

#[test]
fn the_report_says_whether_the_newest_release_has_the_bug() {
    let folder = TempDir::new().unwrap();
    let release = |driver: &str, version: &str| {
        json!({
            "name": format!("gl:{driver}@{version}"), "backend": "gl", "answers": driver, "line": "drivers", "version": version,
            "environment": { "LIBGL_ALWAYS_SOFTWARE": "1", "GALLIUM_DRIVER": driver },
        })
    };
    let case = "cull/points/cull=none/front_face=cw";
    for (newest, phrase) in [("llvmpipe", "not in 26"), ("softpipe", "still in 26")] {
        let file = folder.path().join(format!("{newest}.json"));
        let lines = json!([release("softpipe", "22.4"), release(newest, "26")]);
        fs::write(&file, lines.to_string()).unwrap();
        let out = folder.path().join(newest);
        let more = ["--adapters", file.to_str().unwrap(), "--latest", "drivers"];
        let (code, summary, error) = bundle(case, "gl:softpipe@22.4", &out, &more);
        assert_eq!(code, 0, "{error}");
        let folder = Path::new(summary["folder"].as_str().unwrap());
        let report = fs::read_to_string(folder.join("report.md")).unwrap();
        assert!(report.contains(phrase), "{report}");
    }
}

#[test]
fn a_line_without_releases_is_refused_before_a_driver_starts() {
    let out = TempDir::new().unwrap();
    let more = ["--latest", "nothing"];
    // The adapter does not exist either, which only opening it shows.
    let (code, _, error) = bundle(
        "cull/points/cull=none/front_face=cw",
        "gl:none",
        out.path(),
        &more,
    );
    assert_eq!(
        (code, error.contains("line `nothing`")),
        (64, true),
        "{error}"
    );
}

#[test]
fn a_program_begins_with_the_state_that_it_draws_with() {
    let out = TempDir::new().unwrap();
    let (code, summary, error) = bundle(
        "cull/points/cull=none/front_face=cw",
        "gl:softpipe",
        out.path(),
        &[],
    );
    assert_eq!(code, 0, "{error}");
    let folder = Path::new(summary["folder"].as_str().unwrap());
    let program = fs::read_to_string(folder.join("repro.c")).unwrap();
    let screen: String = program.lines().take(50).collect::<Vec<_>>().join("\n");
    for words in [
        "What it draws:",
        "front_facing",
        "point-list",
        "Build and run:",
    ] {
        assert!(screen.contains(words), "`{words}` in {screen}");
    }
    let head = screen.split("Build and run").next().unwrap();
    assert!(head.lines().all(|line| line.len() <= 100), "{head}");
}

#[test]
fn a_case_that_does_not_fail_has_no_bundle() {
    let out = TempDir::new().unwrap();
    for (case, adapter, code, words) in [
        (
            "cull/points/cull=none/front_face=cw",
            "gl:llvmpipe",
            4,
            "does not fail",
        ),
        (
            "cull/points/cull=none/front_face=cw",
            "gl:none",
            64,
            "gl:none",
        ),
        ("no/such/case", "gl:softpipe", 64, "no/such/case"),
        (
            "cull/points/cull=none/front_face=cw",
            "cpu",
            4,
            "does not fail",
        ),
    ] {
        let (actual, _, error) = bundle(case, adapter, out.path(), &[]);
        assert_eq!(actual, code, "{case} on {adapter}: {error}");
        assert!(error.contains(words), "{error}");
    }
    assert_eq!(fs::read_dir(out.path()).unwrap().count(), 0);
}
