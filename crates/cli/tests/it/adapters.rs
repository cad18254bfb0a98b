//! Adapters: built-in and user descriptions, enumeration, facts, validation, caches.
#![expect(clippy::unwrap_used, reason = "a test that panics has failed")]

use assert_cmd::Command;
use assert_cmd::assert::Assert;
use etalon_record::{Run, Verdict};
use predicates::str::contains;
use serde_json::{Value, json};
use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};
use tempfile::TempDir;

/// A case that every adapter supports.
const CASE: &str = "depth/clear/clear=1/format=depth32float";
/// Software drivers whose packages `ci/test` installs.
const DUE: [&str; 15] = [
    "cpu",
    "gl:es:llvmpipe",
    "gl:es:softpipe",
    "gl:es:virgl",
    "gl:es:zink",
    "gl:llvmpipe",
    "gl:softpipe",
    "gl:virgl",
    "gl:zink",
    "vulkan:lavapipe",
    "vulkan:swiftshader",
    "wgpu:gl:llvmpipe",
    "wgpu:gl:zink",
    "wgpu:vulkan:lavapipe",
    "wgpu:vulkan:swiftshader",
];

/// Returns the binary without variables that select drivers.
fn etalon(arguments: &[&str]) -> Command {
    let mut command = crate::etalon::etalon(arguments);
    for name in ["ETALON_ANGLE", "VK_DRIVER_FILES", "VK_ICD_FILENAMES"] {
        command.env_remove(name);
    }
    command
}

/// A file of adapters in its own folder.
fn file(text: &str) -> (TempDir, PathBuf) {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("mine.json");
    fs::write(&path, text).unwrap();
    (folder, path)
}

/// Runs the case with a user's file and reads the run.
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

/// Returns the message that refuses a user's file as bad input, before anything is written.
fn refused(path: &Path, names: &[&str]) -> String {
    let out = tempfile::tempdir().unwrap();
    let out = out.path().join("out");
    let mut command = etalon(&["run", CASE, "--adapters"]);
    // Without a path no browser is found, and none is started.
    command
        .arg(path)
        .arg("--out")
        .arg(&out)
        .env("PATH", "/none");
    for name in names {
        command.args(["--adapter", name]);
    }
    let message = stderr(&command.assert().code(64));
    assert!(!out.join("run.jsonl").exists());
    message.replace(path.parent().unwrap().to_str().unwrap(), "[folder]")
}

fn stderr(assert: &Assert) -> String {
    String::from_utf8(assert.get_output().stderr.clone()).unwrap()
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
        .map(|a| a.info.name.as_str())
        .collect();
    assert_eq!(header, names);
    assert_eq!(
        run.header.adapters[0].info.device,
        run.header.adapters[1].info.device
    );
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
    assert_eq!(run.header.adapters[0].info.name, "gl:llvmpipe");
    assert_eq!(run.header.adapters[0].info.backend, "cpu");
}

#[test]
fn errors_in_a_file_of_adapters_are_named() {
    let mut said = String::new();
    for text in [
        "",
        "[{]",
        "{}",
        "[\n{ \"name\": \"a\", \"backend\": \"cpu\", \"colour\": 1 }]",
        r#"[{ "name": "a", "backend": "metal" }]"#,
        r#"[{ "name": "a" }]"#,
        r#"[{ "name": "a", "backend": "cpu" }, { "name": "a", "backend": "cpu" }]"#,
        r#"[{ "name": "../a", "backend": "cpu" }]"#,
        r#"[{ "name": "<script>", "backend": "cpu" }]"#,
        r#"[{ "name": "cpu:slower=5%", "backend": "gl" }]"#,
        r#"[{ "name": "a", "backend": "wgpu-gl", "egl": "x.so" }]"#,
        r#"[{ "name": "a", "backend": "gl", "browser": ["chromium", "{url}"] }]"#,
        r#"[{ "name": "a", "backend": "webgpu" }]"#,
        r#"[{ "name": "a", "backend": "webgpu", "browser": ["nobody-has-this", "{profile}", "{url}"] }]"#,
        r#"[{ "name": "a", "backend": "webgpu", "browser": ["chromium", "{profile}"] }]"#,
        r#"[{ "name": "a", "backend": "webgpu", "browser": ["chromium", "{url}"] }]"#,
        r#"[{ "name": "a", "backend": "webgpu", "listen": "everywhere" }]"#,
        r#"[{ "name": "a", "backend": "gl", "egl": "./none/libEGL.so", "remedy": "build it" }]"#,
        r#"[{ "name": "a", "backend": "gl", "library_path": ["none"] }]"#,
        r#"[{ "name": "a", "backend": "vulkan", "manifests": ["nobody_has_this.json"] }]"#,
        r#"[{ "name": "a", "backend": "gl", "environment": { "X": "${ETALON_UNSET}" } }]"#,
        r#"[{ "name": "a", "backend": "gl", "environment": { "X": "${ETALON UNSET" } }]"#,
        // A raw escape must not reach the terminal.
        r#"[{ "name": "a\u001b[31m", "backend": "cpu" }]"#,
    ] {
        let (_folder, path) = file(text);
        // Without a name, all adapters are requested.
        said += &format!("A file of `{text}`:\n{}\n", refused(&path, &[]));
    }
    assert!(!said.contains('\u{1b}'));
    let (_folder, path) = file(&format!("[{}]", " ".repeat(1 << 20)));
    said += &format!("A file of more than 1 MiB:\n{}\n", refused(&path, &[]));
    let none = refused(&path.with_file_name("none.json"), &[]);
    said += &format!("No file:\n{none}\n");
    let folder = path.parent().unwrap();
    let refused = refused(folder, &[]);
    let name = folder.file_name().unwrap().to_str().unwrap();
    said += &format!("A folder:\n{}", refused.replace(name, "folder"));
    insta::assert_snapshot!("adapters-files", said);
}

#[test]
fn a_planted_fault_of_another_backend_is_no_adapter() {
    for name in [
        "gl:fault=abort",
        "gl:slower=5%",
        "gl:softpipe:slower=5%",
        "cpu:call-fault=clear-skipped",
        "wgpu:vulkan:lavapipe:call-fault=clear-skipped",
    ] {
        let folder = tempfile::tempdir().unwrap();
        let mut run = etalon(&["run", CASE, "--adapter", name, "--out"]);
        let message = stderr(&run.arg(folder.path().join("out")).assert().code(64));
        assert!(
            message.contains(&format!("no adapter `{name}`")),
            "{message}"
        );
    }
}

#[test]
fn an_unavailable_adapter_matters_only_if_it_is_selected() {
    let (_folder, path) = file(
        r#"[{ "name": "a", "backend": "gl", "egl": "/none/libEGL.so" },
            { "name": "b", "backend": "cpu" }]"#,
    );
    assert_eq!(run(&path, &["b"]).records.len(), 1);
    insta::assert_snapshot!("adapters-absent", refused(&path, &["a", "b"]));
}

#[test]
fn another_driver_cannot_answer_for_the_intended_one() {
    let (_folder, path) = file(
        r#"[{ "name": "gl:voodoo", "backend": "gl", "answers": "voodoo", "remedy": "find one",
              "environment": { "LIBGL_ALWAYS_SOFTWARE": "1", "GALLIUM_DRIVER": "softpipe" } }]"#,
    );
    let other = refused(&path, &["gl:voodoo"]);
    // A file that is not a library.
    fs::write(path.with_file_name("libEGL.so"), "no library").unwrap();
    let none = r#"[{ "name": "gl:none", "backend": "gl", "egl": "./libEGL.so" }]"#;
    fs::write(&path, none).unwrap();
    let said = other + &refused(&path, &["gl:none"]);
    insta::assert_snapshot!("adapters-other-driver", said);
}

#[test]
fn the_facts_of_each_adapter_are_there_for_programs() {
    let (_folder, path) =
        file(r#"[{ "name": "mine", "backend": "cpu", "environment": { "A": "b", "C": null } }]"#);
    let adapters = facts(&["--adapters", path.to_str().unwrap()]);
    let names: Vec<&str> = adapters
        .iter()
        .map(|a| a["name"].as_str().unwrap())
        .collect();
    for name in DUE.iter().chain(&["mine"]) {
        assert!(names.contains(name), "{name} is not among {names:?}");
    }
    assert_eq!(
        names.iter().collect::<BTreeSet<_>>().len(),
        names.len(),
        "{names:?}"
    );
    for adapter in &adapters {
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
    let adapter = |name: &str| adapters.iter().find(|a| a["name"] == json!(name)).unwrap();
    assert_eq!(
        adapter("gl:softpipe")["environment"]["GALLIUM_DRIVER"],
        json!("softpipe")
    );
    assert_eq!(adapter("gl:softpipe")["described_in"], json!("built-in"));
    assert_eq!(adapter("mine")["described_in"], json!(path));
    assert_eq!(adapter("mine")["environment"]["A"], json!("b"));
    assert_eq!(adapter("mine")["environment"]["C"], Value::Null);
    let lavapipe = adapter("vulkan:lavapipe");
    let manifest = lavapipe["manifest"].as_str().unwrap();
    assert!(Path::new(manifest).is_file());
    assert_eq!(lavapipe["environment"]["VK_DRIVER_FILES"], json!(manifest));
    assert!(
        lavapipe["driver_id"].as_str().unwrap().contains("LLVMPIPE"),
        "{lavapipe}"
    );
}

#[test]
fn adapters_that_need_a_variable_are_listed_and_remedies_are_shown_on_request() {
    // The lines below the tables, which are the machine's. Without a path no browser is found.
    let below = |command: &mut Command, head: &str| {
        let assert = command.env("PATH", "/none").assert().code(0);
        let text = String::from_utf8(assert.get_output().stdout.clone()).unwrap();
        text[text.find(head).unwrap()..].to_owned()
    };
    for (name, flags) in [
        ("", &["adapters"][..]),
        ("-remedies", &["adapters", "--remedies"]),
    ] {
        let mut unset = etalon(flags);
        let not_enabled = format!("adapters-not-enabled{name}");
        insta::assert_snapshot!(not_enabled, below(&mut unset, "Not enabled\n"));
        let mut wrong = etalon(flags);
        wrong.env("ETALON_ANGLE", "/none");
        let unavailable = format!("adapters-unavailable{name}");
        insta::assert_snapshot!(unavailable, below(&mut wrong, "Unavailable\n"));
    }
    let out = tempfile::tempdir().unwrap();
    let mut run = etalon(&["run", CASE, "--adapter", "gl:es:angle", "--out"]);
    let assert = run.arg(out.path().join("out")).assert().code(64);
    insta::assert_snapshot!("adapters-not-enabled-run", stderr(&assert));
}

/// Returns the files of Mesa's cache in a folder, without its marker files.
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

/// Correct calls cause no messages. The backends' tests show that wrong calls do.
#[test]
fn validation_layers_are_silent_about_correct_calls() {
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
    let said = ["vulkan:lavapipe", "wgpu:vulkan:lavapipe"].map(|adapter| {
        let mut run = etalon(&["run", CASE, "--validate", "--adapter", adapter, "--out"]);
        run.arg(folder.path().join("out"));
        run.env("VK_LAYER_PATH", folder.path());
        stderr(&run.assert().code(64))
    });
    insta::assert_snapshot!("adapters-without-layer", said.concat());
}

#[test]
fn opengl_with_viewport_arrays_draws_viewports_at_fractions_of_a_texel() {
    let folder = tempfile::tempdir().unwrap();
    let case = "scissor/viewport/scissor=none/viewport=between-texels";
    etalon(&["run", case, "--profile", "full", "--adapter", "gl:llvmpipe"])
        .arg("--out")
        .arg(folder.path().join("out"))
        .assert()
        .code(0);
    let run = Run::read(&folder.path().join("out")).unwrap();
    assert_eq!(run.records[0].verdict, Verdict::Pass);
}
