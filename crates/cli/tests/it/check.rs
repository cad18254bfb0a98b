//! `etalon check`, and the warnings of `--cases`.
#![expect(clippy::unwrap_used, reason = "a test that panics has failed")]

use crate::etalon::etalon;
use predicates::prelude::*;
use predicates::str::contains;
use serde_json::Value;
use std::fs;
use std::path::{Path, PathBuf};

fn cases_folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../cases")
}

/// Returns a case file with an axis, a mesh, a format and a list of attachments to read back.
fn file(axes: &str, positions: &str, format: &str) -> String {
    format!(
        r#"{{ "about": "t", "spec": ["t"],
  "axes": {{ {axes} }},
  "scene": {{
    "attachments": {{ "c": {{ "format": "{format}", "size": [8, 8] }} }},
    "passes": [ {{ "color": ["c"], "draws": [
      {{ "shader": "uniform_color", "params": {{ "color": [1, 0, 0, 1] }},
        "mesh": {{ "kind": "vertices", "units": "texels", "positions": {positions} }} }} ] }} ],
    "read": ["c"] }} }}"#
    )
}

const EXACT: &str = "[[-1, -1, 0], [20, -1, 0], [-1, 20, 0]]";

fn written(text: &str) -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    fs::create_dir(folder.path().join("own")).unwrap();
    fs::write(folder.path().join("own/file.json"), text).unwrap();
    folder
}

fn told(text: &str) -> (i32, Value) {
    let folder = written(text);
    let output = etalon(&["check", "--format", "json"])
        .arg(folder.path())
        .output()
        .unwrap();
    let json = serde_json::from_slice(&output.stdout).unwrap();
    (output.status.code().unwrap(), json)
}

#[test]
fn the_repositorys_own_cases_have_no_warnings() {
    let output = etalon(&["check", "--format", "json"])
        .arg(cases_folder())
        .output()
        .unwrap();
    let summary: Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(summary["errors"], 0);
    let mut warnings = Vec::new();
    for file in summary["files"].as_array().unwrap() {
        for warning in file["warnings"].as_array().unwrap() {
            warnings.push((
                file["file"].as_str().unwrap(),
                warning["message"].as_str().unwrap(),
            ));
        }
    }
    // There, triangles with other indices overlap, whatever they cover.
    warnings.retain(|(file, message)| {
        !(*file == "sequence/state/indices.json" && message.contains("an edge passes"))
    });
    assert!(warnings.is_empty(), "{warnings:#?}");
    let judged = summary["files"].as_array().unwrap().iter();
    let judged: usize = judged.map(|f| f["judged"].as_array().unwrap().len()).sum();
    assert!(judged > 2000, "{judged}");
}

#[test]
fn each_kind_of_warning_is_told_with_its_line() {
    let (code, json) = told(&file(r#""n": [1, 2]"#, EXACT, "rgba8unorm"));
    assert_eq!(code, 1);
    let warnings = json["files"][0]["warnings"].as_array().unwrap();
    assert_eq!(warnings.len(), 1, "{warnings:#?}");
    assert_eq!(
        (&warnings[0]["key"], &warnings[0]["line"]),
        (&"axes.n".into(), &2.into())
    );

    // An edge through texel centres.
    let (code, json) = told(&file(
        "",
        "[[0.5, -1, 0], [20, -1, 0], [0.5, 20, 0]]",
        "rgba8unorm",
    ));
    let message = json["files"][0]["warnings"][0]["message"].as_str().unwrap();
    assert_eq!(
        (code, message.contains("an edge passes at 0.000 texels")),
        (1, true),
        "{message}"
    );
    assert_eq!(json["files"][0]["warnings"][0]["line"], 7);

    let (code, json) = told(&file("", EXACT, "rgba8unorm"));
    assert_eq!((code, json["warnings"].as_u64()), (0, Some(0)), "{json:#}");
    let judged = &json["files"][0]["judged"][0];
    assert_eq!(judged["asserts"], true);
    assert_eq!(judged["aspects"][0]["asserted"], 1.0);
    assert_eq!(judged["aspects"][0]["codes"], 1.0);
}

#[test]
fn what_asserts_nothing_is_told() {
    // An empty write mask on a texture whose contents a store operation discarded.
    let text = file("", EXACT, "rgba8unorm").replace(
        r#""color": ["c"], "draws""#,
        r#""color": ["c"], "operations": { "color": [ { "store": "discard" } ] }, "draws""#,
    );
    let (code, json) = told(&text);
    assert_eq!(code, 1);
    let message = json["files"][0]["warnings"][0]["message"].as_str().unwrap();
    assert!(
        message.contains("1 of 1 judged cases assert nothing"),
        "{message}"
    );
    assert_eq!(json["files"][0]["judged"][0]["asserts"], false);
}

#[test]
fn errors_of_all_files_are_told_at_once() {
    let folder = written(&file(r#""n": ["rgba8unorm", "rgba9unorm"]"#, EXACT, "$n"));
    fs::write(folder.path().join("own/other.json"), "{ \"about\": 3 }").unwrap();
    fs::write(
        folder.path().join("own/third.json"),
        file("", EXACT, "rgba8unorm"),
    )
    .unwrap();
    etalon(&["check"])
        .arg(folder.path())
        .assert()
        .code(64)
        .stdout(
            contains("error: own/other.json")
                .and(contains("own/file.json:2: axes.n[1]"))
                .and(contains("own/third.json: 1 cases, 1 judged")),
        );
    let path = folder.path().join("own/third.json");
    etalon(&["check"])
        .arg(&path)
        .assert()
        .success()
        .stdout(contains("100.0 %     1.00 codes"));
    etalon(&["check", "/nowhere.json"]).assert().code(64);
}

#[test]
fn a_folder_of_ones_own_warns_where_it_is_used() {
    let folder = written(&file(r#""n": [1, 2]"#, EXACT, "rgba8unorm"));
    etalon(&["list", "--cases"])
        .arg(folder.path())
        .assert()
        .success()
        .stderr(contains(
            "warning: own/file.json:2: axes.n: nothing uses this axis",
        ));
    let warns = contains("warning");
    etalon(&["list"]).assert().success().stderr(warns.not());
}
