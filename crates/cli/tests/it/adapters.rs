//! Adapters: built-in and own descriptions, enumeration, facts, validation, caches.
#![expect(clippy::unwrap_used, reason = "a test that panics has failed")]

use assert_cmd::Command;
use assert_cmd::assert::Assert;
use etalon_record::{Run, Verdict};
use predicates::prelude::*;
use predicates::str::contains;
use serde_json::{Value, json};
use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};
use tempfile::TempDir;

/// A case that every adapter supports.
const CASE: &str = "depth/clear/clear=1/format=depth32float";
/// Software drivers whose packages `ci/test` installs.
const DUE: [&str; 13] = [
    "cpu",
    "gl:es:llvmpipe",
    "gl:es:softpipe",
    "gl:es:zink",
    "gl:llvmpipe",
    "gl:softpipe",
    "gl:zink",
    "vulkan:lavapipe",
    "vulkan:swiftshader",
    "wgpu:gl:llvmpipe",
    "wgpu:gl:zink",
    "wgpu:vulkan:lavapipe",
    "wgpu:vulkan:swiftshader",
];

/// The binary without variables that name drivers.
fn etalon(arguments: &[&str]) -> Command {
    let mut command = crate::etalon::etalon(arguments);
    for name in ["ETALON_ANGLE", "VK_DRIVER_FILES", "VK_ICD_FILENAMES"] {
        command.env_remove(name);
    }
    command
}

/// A file of adapters in a folder of its own.
fn file(text: &str) -> (TempDir, PathBuf) {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("mine.json");
    fs::write(&path, text).unwrap();
    (folder, path)
}

/// Runs the case by a user's file and reads the run.
fn run(path: &Path, names: &[&str]) -> Run {
    let out = tempfile::tempdir().unwrap();
    let mut command = etalon(&["run", CASE, "--adapters"]);
    command.arg(path).arg("--out").arg(out.path().join("out"));
    for name in names {
        command.args(["--adapter", name]);
    }
    command.assert().code(0);
    Run::read(&out.path().join("out")).unwrap()
}

/// Refused as bad input, with all these words, and before anything is written.
fn refused(path: &Path, names: &[&str], words: &[&str]) -> Assert {
    let out = tempfile::tempdir().unwrap();
    let out = out.path().join("out");
    let mut command = etalon(&["run", CASE, "--adapters"]);
    command.arg(path).arg("--out").arg(&out);
    for name in names {
        command.args(["--adapter", name]);
    }
    let mut assert = command.assert().code(64);
    for word in words {
        assert = assert.stderr(contains(*word));
    }
    assert!(!out.join("run.jsonl").exists());
    assert
}

fn lavapipe_manifest() -> String {
    let folder = Path::new("/usr/share/vulkan/icd.d");
    let mut names = fs::read_dir(folder).unwrap().map(|e| e.unwrap().path());
    let is_lavapipe = |p: &PathBuf| p.to_string_lossy().contains("lvp_icd");
    let path = names.find(is_lavapipe);
    let path = path.expect("lavapipe is not installed: apt-get install mesa-vulkan-drivers");
    path.to_str().unwrap().to_owned()
}

fn facts(arguments: &[&str]) -> Vec<Value> {
    let output = etalon(&["adapters", "--format", "json"])
        .args(arguments)
        .assert()
        .code(0);
    serde_json::from_slice(&output.get_output().stdout).unwrap()
}

#[test]
fn a_users_own_adapter_runs_beside_the_built_in_one_and_is_named() {
    let entry = json!([{
        "name": "vulkan:lavapipe-mine",
        "backend": "vulkan",
        "manifests": [lavapipe_manifest()],
        "answers": "llvmpipe",
        "environment": { "ETALON_TEST": "${HOME}" },
    }]);
    let (_folder, path) = file(&entry.to_string());
    let names = ["vulkan:lavapipe", "vulkan:lavapipe-mine"];
    let run = run(&path, &names);
    let header: Vec<&str> = run
        .header
        .adapters
        .iter()
        .map(|a| a.name.as_str())
        .collect();
    assert_eq!(header, names);
    assert_eq!(run.header.adapters[0].device, run.header.adapters[1].device);
    let verdicts: BTreeSet<_> = run
        .records
        .iter()
        .map(|r| (r.adapter.as_str(), r.verdict))
        .collect();
    assert_eq!(
        verdicts,
        names.map(|n| (n, Verdict::Pass)).into_iter().collect()
    );

    etalon(&[
        "explain",
        CASE,
        "--texel",
        "0,0",
        "--adapter",
        "vulkan:lavapipe-mine",
    ])
    .arg("--adapters")
    .arg(&path)
    .assert()
    .code(0)
    .stdout(contains("returned"));
}

#[test]
fn an_entry_takes_the_place_of_the_built_in_one_of_its_name() {
    let (_folder, path) = file(r#"[{ "name": "gl:llvmpipe", "backend": "cpu" }]"#);
    let run = run(&path, &["gl:llvmpipe"]);
    assert_eq!(run.header.adapters[0].name, "gl:llvmpipe");
    assert_eq!(run.header.adapters[0].backend, "cpu");
}

#[test]
fn what_is_wrong_with_a_file_is_said() {
    for (text, words) in [
        ("", &["EOF"][..]),
        ("[{]", &["line 1"]),
        ("{}", &["array"]),
        (
            "[\n{ \"name\": \"a\", \"backend\": \"cpu\", \"colour\": 1 }]",
            &["line 2", "colour"],
        ),
        (
            r#"[{ "name": "a", "backend": "metal" }]"#,
            &["metal", "wgpu-gl"],
        ),
        (r#"[{ "name": "a" }]"#, &["backend"]),
        (
            r#"[{ "name": "a", "backend": "cpu" }, { "name": "a", "backend": "cpu" }]"#,
            &["entry 2 (`a`)", "rename"],
        ),
        (
            r#"[{ "name": "../a", "backend": "cpu" }]"#,
            &["entry 1", "letters"],
        ),
        (
            r#"[{ "name": "<script>", "backend": "cpu" }]"#,
            &["entry 1", "letters"],
        ),
        (
            r#"[{ "name": "cpu:slower=5%", "backend": "gl" }]"#,
            &["entry 1", "letters"],
        ),
        (
            r#"[{ "name": "a", "backend": "wgpu-gl", "egl": "x.so" }]"#,
            &["`a`", "library_path"],
        ),
        (
            r#"[{ "name": "a", "backend": "gl", "egl": "./none/libEGL.so", "remedy": "build it" }]"#,
            &["`a`", "none/libEGL.so", "build it"],
        ),
        (
            r#"[{ "name": "a", "backend": "gl", "library_path": ["none"] }]"#,
            &["`a`", "none", "correct the entry"],
        ),
        (
            r#"[{ "name": "a", "backend": "vulkan", "manifests": ["nobody_has_this.json"] }]"#,
            &["`a`", "nobody_has_this.json"],
        ),
        (
            r#"[{ "name": "a", "backend": "gl", "environment": { "X": "${ETALON_UNSET}" } }]"#,
            &["`a`", "set ETALON_UNSET"],
        ),
        (
            r#"[{ "name": "a", "backend": "gl", "environment": { "X": "${ETALON UNSET" } }]"#,
            &["`a`", "name of a variable"],
        ),
    ] {
        let (_folder, path) = file(text);
        // Without a name all are asked for.
        let assert = refused(&path, &[], &["mine.json"]);
        for word in words {
            let stderr = String::from_utf8_lossy(&assert.get_output().stderr);
            assert!(stderr.contains(word), "{text}: {stderr}");
        }
    }
    let (_folder, path) = file(&format!("[{}]", " ".repeat(1 << 20)));
    refused(&path, &[], &["mine.json", "1 MiB"]);
    refused(&path.with_file_name("none.json"), &[], &["none.json"]);
    refused(path.parent().unwrap(), &[], &["JSON file"]);
    // A raw escape must not reach the terminal.
    let (_folder, path) = file(r#"[{ "name": "a\u001b[31m", "backend": "cpu" }]"#);
    let assert = refused(&path, &[], &["entry 1"]);
    assert!(!assert.get_output().stderr.contains(&0x1b));
}

#[test]
fn what_is_not_asked_for_need_not_be_there() {
    let (_folder, path) = file(
        r#"[{ "name": "a", "backend": "gl", "egl": "/none/libEGL.so" },
            { "name": "b", "backend": "cpu" }]"#,
    );
    assert_eq!(run(&path, &["b"]).records.len(), 1);
    refused(&path, &["a", "b"], &["/none/libEGL.so"]);
}

#[test]
fn another_driver_may_not_answer_for_the_one_that_is_meant() {
    let (_folder, path) = file(
        r#"[{ "name": "gl:voodoo", "backend": "gl", "answers": "voodoo", "remedy": "find one",
              "environment": { "LIBGL_ALWAYS_SOFTWARE": "1", "GALLIUM_DRIVER": "softpipe" } }]"#,
    );
    refused(
        &path,
        &["gl:voodoo"],
        &["another driver answers: softpipe", "find one"],
    );
    // A file that is not a library.
    fs::write(path.with_file_name("libEGL.so"), "no library").unwrap();
    fs::write(
        &path,
        r#"[{ "name": "gl:none", "backend": "gl", "egl": "./libEGL.so" }]"#,
    )
    .unwrap();
    refused(
        &path,
        &["gl:none"],
        &["gl:none", "libEGL.so cannot be loaded"],
    );
}

#[test]
fn the_facts_of_each_adapter_are_there_for_programs() {
    let (_folder, path) =
        file(r#"[{ "name": "mine", "backend": "cpu", "environment": { "A": "b", "C": null } }]"#);
    let all = facts(&["--adapters", path.to_str().unwrap()]);
    let names: Vec<&str> = all.iter().map(|a| a["name"].as_str().unwrap()).collect();
    for due in DUE.iter().chain(&["mine"]) {
        assert!(names.contains(due), "{due} is not among {names:?}");
    }
    assert_eq!(
        names.iter().collect::<BTreeSet<_>>().len(),
        names.len(),
        "{names:?}"
    );
    for adapter in &all {
        for field in [
            "device",
            "driver",
            "driver_version",
            "driver_id",
            "api_version",
            "described_in",
        ] {
            let text = adapter[field].as_str().unwrap();
            assert!(!text.trim().is_empty(), "{field} of {adapter}");
        }
        assert!(adapter["environment"].is_object(), "{adapter}");
        assert!(adapter["library_path"].is_array(), "{adapter}");
        assert!(adapter["limits"]["features"].is_array(), "{adapter}");
        for field in ["manifest", "egl", "device_index"] {
            assert!(adapter.get(field).is_some(), "{field} of {adapter}");
        }
        let hardware = adapter["software"] == json!(false);
        assert_eq!(
            adapter["described_in"] == json!("found"),
            hardware,
            "{adapter}"
        );
    }
    let of = |name: &str| all.iter().find(|a| a["name"] == json!(name)).unwrap();
    assert_eq!(
        of("gl:softpipe")["environment"]["GALLIUM_DRIVER"],
        json!("softpipe")
    );
    assert_eq!(of("gl:softpipe")["described_in"], json!("built-in"));
    assert_eq!(of("mine")["described_in"], json!(path));
    assert_eq!(of("mine")["environment"]["A"], json!("b"));
    assert_eq!(of("mine")["environment"]["C"], Value::Null);
    let lavapipe = of("vulkan:lavapipe");
    let manifest = lavapipe["manifest"].as_str().unwrap();
    assert!(Path::new(manifest).is_file());
    assert_eq!(lavapipe["environment"]["VK_DRIVER_FILES"], json!(manifest));
    assert!(
        lavapipe["driver_id"].as_str().unwrap().contains("LLVMPIPE"),
        "{lavapipe}"
    );
}

#[test]
fn an_adapter_that_a_variable_names_is_told_with_its_remedy_or_in_one_quiet_line() {
    let quiet = etalon(&["adapters"]).assert().code(0);
    let text = String::from_utf8_lossy(&quiet.get_output().stdout).into_owned();
    let found: Vec<&str> = text.lines().filter(|l| l.contains("gl:es:angle")).collect();
    assert_eq!(found.len(), 1, "{text}");
    assert!(found[0].starts_with("Not enabled: "), "{text}");
    assert!(found[0].contains("ETALON_ANGLE"), "{text}");
    etalon(&["adapters"])
        .env("ETALON_ANGLE", "/none")
        .assert()
        .code(0)
        .stdout(contains("gl:es:angle: the folder /none does not exist"))
        .stdout(contains("ci/adapters/angle"))
        .stdout(contains("Not enabled").not());
    let out = tempfile::tempdir().unwrap();
    etalon(&["run", CASE, "--adapter", "gl:es:angle", "--out"])
        .arg(out.path().join("out"))
        .assert()
        .code(64)
        .stderr(contains("ETALON_ANGLE is not set"));
}

/// The files that Mesa's cache has in a folder, but for its own marks.
fn cached(folder: &Path) -> usize {
    let Ok(entries) = fs::read_dir(folder) else {
        return 0;
    };
    let entries = entries.map(|e| e.unwrap().path());
    entries
        .map(|path| if path.is_dir() { cached(&path) } else { 1 })
        .sum()
}

#[test]
fn a_cold_cache_is_neither_read_nor_written() {
    let out = tempfile::tempdir().unwrap();
    for (state, full) in [("cold", false), ("warm", true)] {
        let cache = tempfile::tempdir().unwrap();
        for adapter in ["gl:llvmpipe", "vulkan:lavapipe"] {
            etalon(&[
                "run",
                CASE,
                "--adapter",
                adapter,
                "--shader-cache",
                state,
                "--out",
            ])
            .arg(out.path().join(format!("{state}-{adapter}")))
            .env("MESA_SHADER_CACHE_DIR", cache.path())
            .env_remove("MESA_SHADER_CACHE_DISABLE")
            .assert()
            .code(0);
        }
        assert_eq!(cached(cache.path()) > 0, full, "{state}");
    }
}

/// Correct calls cause no messages; tests of the backends show that wrong ones do.
#[test]
fn validation_says_nothing_of_what_is_right() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    let mut command = etalon(&[
        "run",
        "depth/compare",
        "stencil/compare",
        "multisample/mask",
        "--validate",
    ]);
    let names = [
        "vulkan:lavapipe",
        "gl:llvmpipe",
        "gl:softpipe",
        "wgpu:vulkan:lavapipe",
    ];
    for name in names {
        command.args(["--adapter", name]);
    }
    command.arg("--out").arg(&out).assert().code(0);
    let run = Run::read(&out).unwrap();
    assert_eq!(run.header.adapters.len(), names.len());
    assert!(run.records.len() > names.len());
    for record in &run.records {
        assert_eq!(
            record.validation,
            Vec::<String>::new(),
            "{} {}",
            record.adapter,
            record.case
        );
    }
}

#[test]
fn without_the_validation_layer_nothing_runs_unwatched() {
    let folder = tempfile::tempdir().unwrap();
    for adapter in ["vulkan:lavapipe", "wgpu:vulkan:lavapipe"] {
        etalon(&["run", CASE, "--validate", "--adapter", adapter, "--out"])
            .arg(folder.path().join("out"))
            .env("VK_LAYER_PATH", folder.path())
            .assert()
            .code(64)
            .stderr(contains("validation layer").or(contains("VK_LAYER_KHRONOS_validation")))
            .stderr(contains("apt-get install vulkan-validationlayers"));
    }
}
