//! `ci/action`: its files satisfy the schemas of GitHub and GitLab, and its steps install, draw and report.
#![expect(clippy::unwrap_used, reason = "a test that panics has failed")]

use crate::house::root;
use serde_json::{Value, json};
use std::collections::BTreeMap;
use std::fs;
use std::path::Path;
use std::process::{Command, Output};

const BINARY: &str = env!("CARGO_BIN_EXE_etalon");
const ACTION: &str = "ci/action/action.yml";
const COMPONENT: &str = "ci/action/gitlab.yml";

/// Returns the documents of a YAML file.
fn documents(name: &str) -> Vec<Value> {
    let text = fs::read_to_string(root().join(name)).unwrap();
    let documents = text.split("\n---\n");
    documents
        .map(|document| serde_saphyr::from_str(document).unwrap())
        .collect()
}

fn schema(name: &str) -> jsonschema::Validator {
    let path = root().join("crates/cli/tests/schemas").join(name);
    let text = fs::read_to_string(path).unwrap();
    jsonschema::validator_for(&serde_json::from_str(&text).unwrap()).unwrap()
}

#[test]
fn the_action_and_the_component_satisfy_their_schemas() {
    let files = [
        (ACTION, "github-action.json", "/runs/using", json!("perl")),
        (COMPONENT, "gitlab-ci.json", "/etalon/cache/key", json!([1])),
    ];
    for (name, format, pointer, wrong) in files {
        let schema = schema(format);
        for mut value in documents(name) {
            let errors: Vec<String> = schema.iter_errors(&value).map(|e| e.to_string()).collect();
            assert!(errors.is_empty(), "{name}: {errors:#?}");
            if let Some(place) = value.pointer_mut(pointer) {
                *place = wrong.clone();
                assert!(!schema.is_valid(&value), "{name}: any {pointer} would do");
            }
        }
    }
}

#[test]
fn the_action_and_the_component_install_the_version_of_the_workspace() {
    let version = json!(env!("CARGO_PKG_VERSION"));
    let action = &documents(ACTION)[0];
    assert_eq!(action["inputs"]["version"]["default"], version);
    let component = &documents(COMPONENT)[0];
    assert_eq!(component["spec"]["inputs"]["version"]["default"], version);
}

/// The steps of the action that have this name, as shell lines.
fn step(name: &str) -> (String, BTreeMap<String, String>) {
    let action = &documents(ACTION)[0];
    let steps = action["runs"]["steps"].as_array().unwrap();
    let step = steps.iter().find(|step| step["name"] == name).unwrap();
    let environment = step["env"].as_object().into_iter().flatten();
    let text = |value: &Value| value.as_str().unwrap().to_owned();
    (
        text(&step["run"]),
        environment
            .map(|(name, value)| (name.clone(), text(value)))
            .collect(),
    )
}

/// Runs a step in `folder`, with these inputs and what GitHub sets.
fn run_step(
    folder: &Path,
    name: &str,
    inputs: &[(&str, &str)],
    variables: &[(&str, &Path)],
) -> Output {
    let (line, environment) = step(name);
    let mut command = Command::new("bash");
    command.args(["-e", "-o", "pipefail", "-c", &line]);
    command.current_dir(folder);
    command.env("GITHUB_ACTION_PATH", root().join("ci/action"));
    for (name, file) in [
        ("GITHUB_OUTPUT", "output"),
        ("GITHUB_STEP_SUMMARY", "summary"),
        ("GITHUB_PATH", "path"),
    ] {
        command.env(name, folder.join(file));
    }
    for (variable, template) in environment {
        // What GitHub gives comes from `variables`.
        let Some(input) = template.strip_prefix("${{ inputs.") else {
            continue;
        };
        let input = input.trim_end_matches(" }}");
        let value = inputs.iter().find(|(name, _)| *name == input);
        command.env(variable, value.unwrap_or_else(|| panic!("{input}")).1);
    }
    command.envs(variables.iter().copied());
    command.output().unwrap()
}

fn search_path(folder: &Path) -> String {
    format!("{}:{}", folder.display(), std::env::var("PATH").unwrap())
}

#[test]
fn the_step_that_draws_sets_the_outputs_and_writes_the_summary() {
    let work = tempfile::tempdir().unwrap();
    let folder = work.path();
    let path = search_path(Path::new(BINARY).parent().unwrap());
    let draw = |globs: &str, expectations: &str| {
        let inputs = [
            ("globs", globs),
            ("profile", "quick"),
            ("adapters", "cpu"),
            ("expectations", expectations),
        ];
        let output = run_step(folder, "Draw", &inputs, &[("PATH", Path::new(&path))]);
        let read = |name: &str| fs::read_to_string(folder.join(name)).unwrap_or_default();
        let texts = (read("output"), read("summary"));
        for name in ["output", "summary"] {
            let _ = fs::remove_file(folder.join(name));
        }
        (output, texts)
    };
    let (output, (outputs, summary)) = draw("cull/points* scissor/*", "");
    assert!(output.status.success(), "{output:?}");
    assert_eq!(outputs, "unexpected=0\nreport=reports/etalon/index.html\n");
    assert!(folder.join("reports/etalon/index.html").is_file());
    assert!(summary.contains("cpu"), "{summary}");

    let (output, (outputs, _)) = draw("selftest/*", "no-such-file.json");
    assert_eq!((output.status.code(), outputs), (Some(64), String::new()));
    let (output, _) = draw("no/such/case", "");
    assert_eq!(output.status.code(), Some(4), "{output:?}");
}

#[test]
fn the_step_that_asks_writes_an_answer_for_each_adapter() {
    let work = tempfile::tempdir().unwrap();
    let folder = work.path();
    let path = search_path(Path::new(BINARY).parent().unwrap());
    let ask = |names| {
        run_step(
            folder,
            "Preflight",
            &[("preflight", names)],
            &[("PATH", Path::new(&path))],
        )
    };
    let output = ask("cpu vulkan:lavapipe");
    assert!(output.status.success(), "{output:?}");
    for name in ["cpu", "vulkan-lavapipe"] {
        let text = fs::read(folder.join(format!("reports/etalon/{name}.json"))).unwrap();
        let answer: Value = serde_json::from_slice(&text).unwrap();
        assert_eq!(answer["formats"]["rgba8unorm"]["safety"], "safe");
    }
    let summary = fs::read_to_string(folder.join("summary")).unwrap();
    assert!(summary.contains("What it draws wrong"), "{summary}");
    assert!(!ask("no-such-adapter").status.success());
}

#[test]
fn the_step_that_installs_takes_only_what_has_the_right_digest() {
    let work = tempfile::tempdir().unwrap();
    let folder = work.path();
    let name = "etalon-9.9.9-x86_64-unknown-linux-gnu";
    let bin = folder.join("made").join(name).join("bin");
    fs::create_dir_all(&bin).unwrap();
    fs::write(bin.join("etalon"), "a binary").unwrap();
    let release = folder.join("releases/v9.9.9");
    fs::create_dir_all(&release).unwrap();
    let pack = format!(
        "tar -C made -czf releases/v9.9.9/{name}.tar.gz {name} && cd releases/v9.9.9 && sha256sum *.gz >SHA256SUMS"
    );
    let status = Command::new("bash")
        .args(["-c", &pack])
        .current_dir(folder)
        .status();
    assert!(status.unwrap().success());
    let place = format!("file://{}/releases", folder.display());
    let install = || {
        let variables = [
            ("ETALON_RELEASES", Path::new(&place)),
            ("RUNNER_TEMP", folder),
        ];
        run_step(folder, "Binary", &[("version", "9.9.9")], &variables)
    };
    let output = install();
    assert!(output.status.success(), "{output:?}");
    let path = fs::read_to_string(folder.join("path")).unwrap();
    assert_eq!(
        fs::read(Path::new(path.trim()).join("etalon")).unwrap(),
        b"a binary"
    );

    fs::write(release.join(format!("{name}.tar.gz")), "another").unwrap();
    let output = install();
    assert!(!output.status.success(), "{output:?}");
}

#[test]
fn the_lines_of_the_component_draw_what_the_inputs_name() {
    let work = tempfile::tempdir().unwrap();
    let job = &documents(COMPONENT)[1]["etalon"];
    let lines = job["script"].as_array().unwrap().iter();
    let lines: Vec<&str> = lines.map(|line| line.as_str().unwrap()).collect();
    let script = lines.join("\n").replace("$[[ inputs.profile ]]", "quick");
    assert!(!script.contains("$[["), "{script}");
    let output = Command::new("sh")
        .args(["-e", "-c", &script])
        .current_dir(work.path())
        .env("PATH", search_path(Path::new(BINARY).parent().unwrap()))
        .env("ETALON_GLOBS", "cull/points/* scissor/*")
        .env("ETALON_ADAPTERS", "cpu")
        .env("ETALON_EXPECT", "")
        .output()
        .unwrap();
    assert!(output.status.success(), "{output:?}");
    let folder = work.path().join("reports/etalon");
    let records = fs::read_to_string(folder.join("run.jsonl")).unwrap();
    assert!(records.contains("\"scissor/") && records.contains("\"cull/points/"));
    assert!(!records.contains("vulkan:lavapipe"));
    // What GitLab shows.
    let junit = job["artifacts"]["reports"]["junit"].as_str().unwrap();
    assert!(work.path().join(junit).is_file());
}
