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
fn each_kind_of_warning_names_its_line() {
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
fn cases_that_assert_nothing_give_a_warning() {
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
fn errors_of_all_files_are_reported_at_once() {
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
fn a_users_own_case_folder_gives_warnings_on_use() {
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

/// Returns line and key of the warnings on a file with a draw of these keys, onto blue, depth 1 and stencil 85.
fn warnings_of(axes: &str, draw: &str) -> Vec<(u64, String)> {
    let (_, json) = told(&format!(
        r#"{{ "about": "t", "spec": ["t"], "axes": {{ {axes} }},
  "scene": {{ "attachments": {{ "c": {{ "format": "rgba8unorm", "clear": [0, 0, 1, 1] }},
      "d": {{ "format": "depth32float-stencil8", "clear": {{ "depth": 1, "stencil": 85 }} }} }},
    "passes": [ {{ "color": ["c"], "depth_stencil": "d", "draws": [
      {{ "shader": "uniform_color", {draw} }} ] }} ],
    "read": ["c", "d"] }} }}"#
    ));
    assert_eq!(json["errors"], 0, "{json:#}");
    let warnings = json["files"][0]["warnings"].as_array().unwrap().iter();
    let place = |w: &Value| {
        (
            w["line"].as_u64().unwrap(),
            w["key"].as_str().unwrap().to_owned(),
        )
    };
    warnings.map(place).collect()
}

#[test]
fn a_draw_that_no_case_shows_gives_a_warning() {
    let full =
        |color: &str| format!(r#""mesh": {{ "kind": "full" }}, "params": {{ "color": {color} }}"#);
    let blue = "[0, 0, 1, 1]";
    let place = || (5, "scene.passes[0].draws[0]".to_owned());
    assert_eq!(warnings_of("", &full(blue)), [place()]);
    assert_eq!(warnings_of("", &full("[1, 0, 0, 1]")), []);
    let axis = format!(
        r#""color": [{{ "name": "blue", "value": {blue} }}, {{ "name": "red", "value": [1, 0, 0, 1] }}]"#
    );
    assert_eq!(warnings_of(&axis, &full("\"$color\"")), []);
    // A state that holds the draw back can be what the file asks about.
    for more in [
        r#""scissor": [0, 0, 0, 0]"#,
        r#""write_mask": """#,
        r#""depth": { "compare": "never", "write": true }"#,
    ] {
        assert_eq!(
            warnings_of("", &format!("{}, {more}", full("[1, 0, 0, 1]"))),
            [],
            "{more}"
        );
    }
    // Vertices given one by one can ask whether they cover nothing; a mesh that is made to cover cannot.
    let outside = |mesh: &str| {
        let viewport = r#""viewport": { "rect": [16, 0, 16, 16], "depth": [0, 1] }"#;
        format!(r#""mesh": {mesh}, {viewport}, "params": {{ "color": [1, 0, 0, 1] }}"#)
    };
    let vertices = r#"{ "kind": "vertices", "positions": [[-1, -1, 0], [1, -1, 0], [-1, 1, 0]] }"#;
    assert_eq!(warnings_of("", &outside(vertices)), []);
    let cover = r#"{ "kind": "cover" }"#;
    assert_eq!(warnings_of("", &outside(cover)), [place()]);
}

#[test]
fn a_test_that_decides_nothing_gives_a_warning() {
    let draw = |depth: &str, stencil: &str| {
        format!(
            r#""mesh": {{ "kind": "columns", "values": [0, 0], "z": [0.25, 0.75] }}, "write_mask": "",
        "params": {{ "color": [1, 0, 0, 1] }},
        "depth": {depth},
        "stencil": {stencil}"#
        )
    };
    let place = |line, test: &str| (line, format!("scene.passes[0].draws[0].{test}"));
    // 85 inverted is 170, so both outcomes store the same.
    let less = r#"{ "compare": "less", "write": false }"#;
    let same = r#"{ "front": { "compare": "always", "pass_op": "replace", "depth_fail_op": "invert" }, "reference": 170 }"#;
    assert_eq!(warnings_of("", &draw(less, same)), [place(7, "depth")]);
    assert_eq!(
        warnings_of("", &draw(less, &same.replace("invert", "zero"))),
        []
    );
    let axis = r#""reference": [170, 171]"#;
    assert_eq!(
        warnings_of(axis, &draw(less, &same.replace("170", "\"$reference\""))),
        []
    );

    let always = r#"{ "compare": "always", "write": false }"#;
    let invert = r#"{ "front": { "compare": "equal", "fail_op": "invert", "pass_op": "invert" }, "reference": 9 }"#;
    assert_eq!(
        warnings_of("", &draw(always, invert)),
        [place(8, "stencil")]
    );
    assert_eq!(
        warnings_of("", &draw(always, &invert.replacen("invert", "keep", 1))),
        []
    );

    // The depth test decides if the stencil test lets fragments through.
    let rejected = r#"{ "front": { "compare": "never", "fail_op": "zero" } }"#;
    let writing = less.replace("false", "true");
    assert_eq!(warnings_of("", &draw(&writing, rejected)), []);
}
