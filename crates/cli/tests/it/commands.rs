//! The output and the errors of each command.
#![expect(clippy::unwrap_used, reason = "a test that panics has failed")]

use crate::etalon::{BINARY, etalon};
use predicates::prelude::*;
use predicates::str::{contains, is_empty, starts_with};
use serde_json::Value;
use std::collections::BTreeSet;
use std::fs;
use std::io::{BufRead, BufReader, Read};
use std::path::{Path, PathBuf};
use std::process::Stdio;

const CLEARED: &str = "depth/clear/clear=1/format=depth32float";

/// Returns true if a command's messages are only about left-out cases.
fn tells_what_is_left_out(text: &str) -> bool {
    text.lines().all(|line| line.starts_with("left out: "))
}

fn lines(arguments: &[&str]) -> Vec<String> {
    let says_what_is_left_out = predicates::function::function(tells_what_is_left_out);
    let output = etalon(arguments)
        .assert()
        .success()
        .stderr(says_what_is_left_out);
    let text = String::from_utf8(output.get_output().stdout.clone()).unwrap();
    text.lines().map(str::to_owned).collect()
}

/// Asserts that a command is refused as bad usage with one message that contains these words, and no standard
/// output.
fn refused(arguments: &[&str], words: &[&str]) {
    let assert = etalon(arguments).assert().code(64).stdout(is_empty());
    for word in words {
        let text = String::from_utf8_lossy(&assert.get_output().stderr).into_owned();
        assert!(text.contains(word), "{arguments:?}: `{word}` in: {text}");
        assert!(!text.contains("panicked"), "{text}");
    }
}

fn cases_folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../cases")
}

#[test]
fn list_names_every_case_once_and_readably() {
    let ids = lines(&["list", "--profile", "full"]);
    assert!(ids.len() >= 8000, "{}", ids.len());
    for id in &ids {
        let fine = |b: u8| b.is_ascii_alphanumeric() || b"/=-_.+".contains(&b);
        assert!(id.bytes().all(fine), "`{id}`");
    }
    let mut unique = ids.clone();
    unique.sort();
    unique.dedup();
    assert_eq!(unique.len(), ids.len());
    let folder = cases_folder();
    let folder = folder.to_str().unwrap();
    let read = lines(&["list", "--profile", "full", "--cases", folder]);
    assert_eq!(read, ids);
}

#[test]
fn the_quick_profile_is_a_small_part_of_every_area() {
    let quick = lines(&["list"]);
    assert_eq!(lines(&["list", "--profile", "quick"]), quick);
    assert!(quick.len() <= 1800, "{}", quick.len());
    let full = lines(&["list", "--profile", "full"]);
    assert!(
        quick.len() * 5 < full.len(),
        "{} of {}",
        quick.len(),
        full.len()
    );
    let known: BTreeSet<&String> = full.iter().collect();
    assert!(quick.iter().all(|id| known.contains(id)));
    let areas = |ids: &[String]| -> BTreeSet<String> {
        let first = ids.iter().filter_map(|id| id.split('/').next());
        first.map(str::to_owned).collect()
    };
    assert_eq!(areas(&quick), areas(&full));
}

#[test]
fn a_list_says_what_a_run_would_leave_out() {
    let measured = |ids: &[String]| ids.iter().filter(|id| id.starts_with("perf/")).count();
    assert_eq!(measured(&lines(&["list"])), 0);
    let named = lines(&["list", "depth", "perf"]);
    assert!(measured(&named) > 0 && measured(&named) < named.len());
    let output = etalon(&["list"]).assert().code(0);
    let stderr = String::from_utf8_lossy(&output.get_output().stderr).into_owned();
    let full = lines(&["list", "--profile", "full"]).len();
    let left = full - lines(&["list"]).len();
    assert!(stderr.contains(" cases that are measured"), "{stderr}");
    let by_profile = format!("left out: {left} cases that --profile full has");
    assert!(stderr.contains(&by_profile), "{stderr}");
}

#[test]
fn globs_choose_cases() {
    let ids = lines(&["list"]);
    let chosen = |keep: &dyn Fn(&str) -> bool| -> Vec<String> {
        ids.iter().filter(|id| keep(id)).cloned().collect()
    };
    let depth = chosen(&|id| id.starts_with("depth/"));
    assert!(!depth.is_empty());
    assert_eq!(lines(&["list", "depth"]), depth);
    assert_eq!(lines(&["list", "depth/"]), depth);
    assert_eq!(lines(&["list", "depth/*"]), depth);
    let compare = chosen(&|id| id.starts_with("depth/compare/"));
    assert_eq!(lines(&["list", "depth/compare"]), compare);
    let deep = chosen(&|id| id.starts_with("depth/") && id.ends_with("write=true"));
    assert_eq!(lines(&["list", "depth/*write=true"]), deep);
    let two = chosen(&|id| id.starts_with("depth/") || id.starts_with("cull/"));
    assert_eq!(lines(&["list", "cull", "depth"]), two);
    assert_eq!(lines(&["list", CLEARED]), [CLEARED]);
}

#[test]
fn a_list_without_cases_is_no_success() {
    for globs in [&["dep"][..], &["nothing/*", "depth/compar"], &["Depth/*"]] {
        etalon(&["list"])
            .args(globs)
            .assert()
            .code(4)
            .stdout(is_empty())
            .stderr(contains("no case matches").and(contains(globs[0])));
    }
    etalon(&["list", "combined/extended/seed=1[6]"])
        .assert()
        .code(4)
        .stderr(contains("of the full one 1: add --profile full"));
    let empty = tempfile::tempdir().unwrap();
    etalon(&["list", "--cases"])
        .arg(empty.path())
        .assert()
        .code(4)
        .stderr("etalon: there are no cases\n");
    refused(&["list", "depth/["], &["depth/[", "not a glob"]);
}

#[test]
fn a_reader_that_leaves_early_is_no_error() {
    for arguments in [&["list"][..], &["schema"]] {
        let mut child = std::process::Command::new(BINARY)
            .args(arguments)
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        let mut first = String::new();
        BufReader::with_capacity(16, child.stdout.take().unwrap())
            .read_line(&mut first)
            .unwrap();
        assert!(!first.is_empty());
        let mut said = String::new();
        let mut stderr = child.stderr.take().unwrap();
        stderr.read_to_string(&mut said).unwrap();
        assert!(tells_what_is_left_out(&said), "{said}");
        assert!(child.wait().unwrap().success());
    }
}

/// A complete case file, for tests that break it.
const FINE: &str = r#"{
  "about": "An attachment is filled.",
  "spec": ["none"],
  "axes": { "write": [true, false] },
  "scene": {
    "attachments": {
      "color": { "format": "rgba8unorm", "size": [4, 4] },
      "depth": { "format": "depth32float" }
    },
    "passes": [
      {
        "color": ["color"],
        "depth_stencil": "depth",
        "draws": [
          {
            "mesh": { "kind": "full" },
            "shader": "uniform_color",
            "params": { "color": [1, 0, 0, 1] },
            "depth": { "compare": "less", "write": "$write" }
          }
        ]
      }
    ],
    "read": ["color", "depth"]
  }
}
"#;

#[test]
fn broken_case_files_are_named_with_line_and_key() {
    let draw = "scene.passes[0].draws[0]";
    let breaks: &[(&str, &str, &str, &str)] = &[
        ("unknown key", "\"about\"", "\"abuot\"", ":2: abuot: "),
        ("unknown key below", "\"compare\"", "\"compair\"", ":19: "),
        ("wrong type", "[\"none\"]", "\"none\"", ":3: spec: "),
        ("wrong type below", "\"$write\"", "1", "depth.write: "),
        ("unknown value", "\"less\"", "\"lesser\"", "depth.compare: "),
        ("empty axis", "[true, false]", "[]", ":4: axes.write: "),
        (
            "axis twice",
            "[true, false]",
            "[true, true]",
            ":4: axes.write[1]: ",
        ),
        (
            "axis name",
            "[true, false]",
            "[\"a b\"]",
            ":4: axes.write[0]: ",
        ),
        (
            "axis value",
            "[true, false]",
            "[[1]]",
            ":4: axes.write[0]: ",
        ),
        ("no such axis", "\"$write\"", "\"$wrte\"", "depth.write: "),
        (
            "impossible size",
            "[4, 4]",
            "[4, 0]",
            ":7: scene.attachments.color.size: ",
        ),
        (
            "impossible depth",
            "\"depth32float\"",
            "\"rgba8unorm\"",
            "scene.passes[0].depth_stencil: ",
        ),
        (
            "no such attachment",
            "\"read\": [\"color\", \"depth\"]",
            "\"read\": [\"colour\"]",
            ":24: scene.read[0]: ",
        ),
        (
            "nothing read",
            "\"read\": [\"color\", \"depth\"]",
            "\"read\": []",
            ":24: scene.read: ",
        ),
        (
            "axis without an end",
            "[true, false]",
            "{ \"from\": 0 }",
            ":4: axes.write",
        ),
        (
            "unknown counter",
            "\"read\": [\"color\", \"depth\"]",
            "\"counters\": { \"n\": \"frogs\" }, \"read\": [\"color\"]",
            "scene.counters.n: ",
        ),
        (
            "variants without a relation",
            "\"spec\": [\"none\"],",
            "\"spec\": [\"none\"], \"variants\": [{ \"name\": \"x\" }],",
            "relation: ",
        ),
        (
            "two scenes",
            "\"spec\": [\"none\"],",
            "\"spec\": [\"none\"], \"random\": { \"flavor\": \"common\", \"seed\": 1 },",
            "random: ",
        ),
        ("missing key", "\"kind\": \"full\"", "", "mesh: "),
        (
            "not JSON",
            "\"spec\": [\"none\"],",
            "\"spec\": [\"none\"]",
            ":4: ",
        ),
        (
            "cut off",
            "\"read\": [\"color\", \"depth\"]\n  }\n}\n",
            "\"read\": [",
            ":24: ",
        ),
    ];
    for (what, from, to, words) in breaks {
        let folder = tempfile::tempdir().unwrap();
        fs::create_dir(folder.path().join("area")).unwrap();
        fs::write(folder.path().join("area/fine.json"), FINE).unwrap();
        let text = FINE.replacen(from, to, 1);
        assert_ne!(text, FINE, "{what}");
        fs::write(folder.path().join("area/odd.json"), text).unwrap();
        let out = folder.path().join("out");
        for command in [&["list"][..], &["run", "--adapter", "cpu", "--out"]] {
            let mut etalon = etalon(command);
            if command.len() > 1 {
                etalon.arg(&out);
            }
            let assert = etalon.arg("--cases").arg(folder.path()).assert();
            let message = String::from_utf8_lossy(&assert.get_output().stderr).into_owned();
            assert.code(64).stdout(is_empty());
            assert!(
                message.starts_with("etalon: area/odd.json:"),
                "{what}: {message}"
            );
            assert!(message.contains(words), "{what}: {message}");
            assert_eq!(message.lines().count(), 1, "{what}: {message}");
            assert!(!out.exists(), "{what}");
            if words.contains("depth.") {
                assert!(message.contains(draw), "{what}: {message}");
            }
        }
    }
}

#[test]
fn unreadable_case_files_are_named() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().to_str().unwrap();
    let file = folder.path().join("odd.json");
    fs::write(&file, b"\xff\xfe{}").unwrap();
    refused(&["list", "--cases", path], &["odd.json", "cannot be read"]);
    fs::remove_file(&file).unwrap();
    std::os::unix::fs::symlink("nowhere", &file).unwrap();
    refused(&["list", "--cases", path], &["odd.json", "cannot be read"]);
    fs::remove_file(&file).unwrap();
    fs::create_dir(folder.path().join("old")).unwrap();
    let records = folder.path().join("old/run.jsonl");
    fs::write(&records, "").unwrap();
    let words = ["old/run.jsonl", "belongs to a run", "move its folder"];
    refused(&["list", "--cases", path], &words);
    fs::remove_file(&records).unwrap();
    fs::write(folder.path().join("a b.json"), FINE).unwrap();
    refused(&["list", "--cases", path], &["a b.json"]);
    let nowhere = folder.path().join("nowhere");
    refused(
        &["list", "--cases", nowhere.to_str().unwrap()],
        &["nowhere", "cannot be read"],
    );
}

fn case_files(folder: &Path, found: &mut Vec<PathBuf>) {
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            case_files(&path, found);
        } else if path.extension().is_some_and(|e| e == "json") {
            found.push(path);
        }
    }
}

#[test]
fn the_schema_takes_every_case_file_and_no_broken_one() {
    let output = etalon(&["schema"]).assert().success();
    let schema: Value = serde_json::from_slice(&output.get_output().stdout).unwrap();
    jsonschema::meta::validate(&schema).unwrap();
    let validator = jsonschema::validator_for(&schema).unwrap();
    let mut files = Vec::new();
    case_files(&cases_folder(), &mut files);
    assert!(files.len() > 40, "{}", files.len());
    for file in files {
        let value = etalon_case::parse_json(&fs::read_to_string(&file).unwrap()).unwrap();
        let errors: Vec<String> = validator
            .iter_errors(&value)
            .map(|e| format!("{}: {e}", e.instance_path()))
            .collect();
        assert!(errors.is_empty(), "{}: {errors:#?}", file.display());
    }
    let broken = |from: &str, to: &str| {
        let text = FINE.replacen(from, to, 1);
        assert_ne!(text, FINE);
        let value: Value = serde_json::from_str(&text).unwrap();
        !validator.is_valid(&value)
    };
    assert!(validator.is_valid(&serde_json::from_str(FINE).unwrap()));
    assert!(!broken("{", "{ \"$schema\": \"schema.json\","));
    assert!(broken("\"about\"", "\"abuot\""));
    assert!(broken("\"compare\"", "\"compair\""));
    assert!(broken("\"less\"", "\"lesser\""));
    assert!(broken("\"$write\"", "1"));
    assert!(broken("[true, false]", "[null]"));
    assert!(broken("\"rgba8unorm\"", "\"rgba8\""));
    assert!(broken("\"kind\": \"full\"", "\"kind\": \"fuller\""));
    let each = |values: &str| format!("\"each\": {{ \"z\": {values} }}, \"mesh\"");
    assert!(!broken("\"mesh\"", &each("[0, 1]")));
    assert!(broken("\"mesh\"", &each("[]")));
    assert!(broken("\"color\": {", "\"color\": { \"each\": 1,"));
}

#[test]
fn wrong_usage_exits_with_64_and_help_does_not() {
    for arguments in [
        &[][..],
        &["lst"],
        &["list", "--globs"],
        &["frobnicate"],
        &["run", "--frobnicate"],
        &["run", "--format", "xml"],
        &["run", "--adapter"],
        &["adapters", "--format", "yaml"],
        &["adapters", "more"],
        &["schema", "more"],
        &["report"],
        &["explain"],
        &["explain", CLEARED],
        &["worker"],
        &["worker", "--open", "{}"],
        &["worker", "--enumerate", "metal"],
    ] {
        refused(arguments, &[]);
    }
    refused(&["run", "--frobnicate"], &["--frobnicate"]);
    refused(&["lst"], &["lst"]);
    for arguments in [
        &["--help"][..],
        &["help"],
        &["run", "--help"],
        &["-V"],
        &["--version"],
    ] {
        etalon(arguments)
            .assert()
            .code(0)
            .stdout(contains("etalon"))
            .stderr(is_empty());
    }
}

#[test]
fn unknown_adapters_cases_and_texels_are_refused() {
    let out = tempfile::tempdir().unwrap();
    let out = out.path().join("out");
    let folder = out.to_str().unwrap();
    refused(
        &["run", CLEARED, "--adapter", "gl:voodoo", "--out", folder],
        &["gl:voodoo", "cpu"],
    );
    assert!(!out.exists());
    refused(
        &[
            "explain",
            CLEARED,
            "--texel",
            "0,0",
            "--adapter",
            "gl:voodoo",
        ],
        &["gl:voodoo", "cpu"],
    );
    refused(
        &["explain", "depth/clear", "--texel", "0,0"],
        &["depth/clear"],
    );
    for texel in ["0", "0,", "a,b", "-1,0", "0,0,0", "0;0", "4294967296,0"] {
        let texel = format!("--texel={texel}");
        refused(&["explain", CLEARED, &texel], &["two whole numbers"]);
    }
    for texel in ["16,0", "0,16", "4294967295,4294967295"] {
        refused(&["explain", CLEARED, "--texel", texel], &[texel, "outside"]);
    }
}

#[test]
fn explain_tells_the_story_of_a_texel() {
    let id = "depth/compare/compare=less/format=depth32float/write=true";
    let explained = |arguments: &[&str]| {
        let mut command = etalon(&["explain", id, "--texel", "3,2"]);
        command.args(arguments);
        command.assert().code(0).stderr(is_empty())
    };
    explained(&[])
        .stdout(starts_with("texel 3,2 must be blue [0, 0, 255, 255]"))
        .stdout(contains("judged by Vulkan 1.").and(contains(id)))
        .stdout(contains("depth test: 1 less stored 0 is false"))
        .stdout(contains("[Vulkan: Depth Test").and(contains("[Direct3D").not()))
        .stdout(contains("the driver").not());
    explained(&["--yardstick"]).stdout(contains("texel 3,2 should be").and(contains("[Direct3D")));
    let on_cpu = explained(&["--adapter", "cpu"]);
    let text = String::from_utf8(on_cpu.get_output().stdout.clone()).unwrap();
    insta::assert_snapshot!("explain", text);
    explained(&["--adapter", "gl:softpipe"])
        .stdout(contains("judged by OpenGL 3.3 (core profile)").and(contains("[OpenGL 3.3:")))
        .stdout(contains("; the driver returned ").and(contains(", which is allowed")));
    explained(&["--adapter", "gl:es:softpipe"])
        .stdout(contains("judged by OpenGL ES 3.").and(contains("[OpenGL ES 3.")));
    explained(&["--adapter", "wgpu:vulkan:lavapipe"])
        .stdout(contains("judged by WebGPU").and(contains("[WebGPU")));
}

#[test]
fn explain_without_a_texel_takes_the_first_wrong_one() {
    let id = "cull/points/cull=none/front_face=cw";
    let explain = |more: &[&str]| etalon(&[&["explain", id], more].concat()).assert();
    explain(&["--adapter", "gl:softpipe"])
        .code(1)
        .stdout(starts_with("texel 0,0 must be green"));
    explain(&["--adapter", "cpu"])
        .code(4)
        .stderr(contains("no texel").and(contains("--texel X,Y")));
    explain(&[]).code(64).stderr(contains("--texel X,Y"));
}

#[test]
fn show_lists_the_cases_of_a_family_and_the_files_of_an_area() {
    let shown = |name: &str| {
        let output = etalon(&["show", name]).output().unwrap();
        assert_eq!(output.status.code(), Some(0));
        String::from_utf8(output.stdout).unwrap()
    };
    let family = shown("cull/points");
    assert!(family.starts_with("cull/points: "), "{family}");
    assert!(
        family.contains("\n  No cull mode removes points"),
        "{family}"
    );
    assert!(
        family.contains("\ncull/points/cull=none/front_face=cw\n"),
        "{family}"
    );
    let area = shown("cull");
    assert!(
        area.contains("\ncull/lines: ") && !area.contains("front_face="),
        "{area}"
    );
    refused(&["show", "cull/points", "--kernels"], &["there is no case"]);
}

#[test]
fn explain_shows_what_a_selftest_gets_wrong() {
    let id = "selftest/params-color";
    etalon(&[
        "explain",
        id,
        "--texel",
        "0,0",
        "--adapter",
        "vulkan:lavapipe",
    ])
    .assert()
    .code(0)
    .stdout(starts_with("texel 0,0 must be "))
    .stdout(contains("; the driver wrote ").and(contains("proven: the text forbids it")));
}

#[test]
fn explain_distinguishes_samples() {
    let id = "scissor/samples-color/mask=odd/rect=one-texel/samples=4";
    let explained = |arguments: &[&str]| {
        let mut command = etalon(&["explain", id, "--texel", "2,1", "--adapter", "cpu"]);
        command.args(arguments);
        let output = command.assert().code(0).stderr(is_empty());
        String::from_utf8(output.get_output().stdout.clone()).unwrap()
    };
    let every_sample = explained(&[]);
    insta::assert_snapshot!("explain_samples", every_sample);
    let second = explained(&["--sample", "1"]);
    assert!(
        second.starts_with("sample 1 of texel 2,1 must be red"),
        "{second}"
    );
    assert!(!second.contains("sample 0"), "{second}");
    refused(
        &["explain", id, "--texel", "2,1", "--sample", "4"],
        &["no sample 4", "color has 4 samples, 0 to 3"],
    );
    refused(
        &["explain", CLEARED, "--texel", "0,0", "--sample", "1"],
        &["no sample 1", "1 sample"],
    );
}

#[test]
fn adapters_are_listed_as_json() {
    let output = etalon(&["adapters", "--format", "json"]).assert().code(0);
    let found: Value = serde_json::from_slice(&output.get_output().stdout).unwrap();
    let found = found.as_array().unwrap();
    for adapter in found {
        for field in ["name", "backend", "device", "driver", "api_version"] {
            let text = adapter[field].as_str().unwrap();
            assert!(!text.trim().is_empty(), "{field} of {adapter}");
        }
        assert!(adapter["driver_version"].is_string(), "{adapter}");
        assert!(adapter["software"].is_boolean(), "{adapter}");
        let limits = &adapter["limits"];
        assert!(limits["sub_pixel_bits"].as_u64().unwrap() >= 4, "{adapter}");
        let formats = limits["formats"].as_object().unwrap();
        assert!(formats.contains_key("rgba8unorm"), "{adapter}");
        assert!(limits["features"].is_array(), "{adapter}");
    }
    // The text has the same adapters, by API.
    let text = etalon(&["adapters"]).assert().code(0);
    let text = String::from_utf8(text.get_output().stdout.clone()).unwrap();
    let mut heads = Vec::new();
    for (api, head) in [
        ("vulkan", "By the rules of Vulkan"),
        ("open-gl", "By the rules of OpenGL"),
        ("open-gl-es", "By the rules of OpenGL ES"),
        ("web-gpu", "By the rules of WebGPU"),
    ] {
        let expected = found
            .iter()
            .filter(|adapter| adapter["limits"]["api"] == api);
        let expected: Vec<&str> = expected.map(|a| a["name"].as_str().unwrap()).collect();
        if expected.is_empty() {
            continue;
        }
        let lines = text.lines().skip_while(|line| *line != head);
        let lines = lines.skip(1).take_while(|line| line.starts_with("  "));
        let names = lines.map(|line| line.trim_start().split("  ").next().unwrap());
        assert_eq!(names.collect::<Vec<_>>(), expected, "{text}");
        heads.push(text.find(&format!("{head}\n")).unwrap());
    }
    assert!(heads.len() > 1 && heads.is_sorted(), "{text}");
}

#[test]
fn cases_are_listed_as_json() {
    let output = etalon(&["list", CLEARED, "early-z/shaderless", "--format", "json"])
        .output()
        .unwrap();
    let cases: Vec<Value> = serde_json::from_slice(&output.stdout).unwrap();
    let cleared = cases.iter().find(|case| case["id"] == CLEARED).unwrap();
    assert_eq!(
        (&cleared["area"], &cleared["file"]),
        (&"depth".into(), &"depth/clear".into())
    );
    assert_eq!(
        cleared["axes"],
        serde_json::json!({ "clear": "1", "format": "depth32float" })
    );
    assert!(
        cleared["about"].as_str().unwrap().ends_with('.'),
        "{cleared}"
    );
    assert!(!cleared["spec"].as_array().unwrap().is_empty());
    let features = |case: &Value| case["features"].as_array().unwrap().len();
    assert!(cases.iter().any(|case| features(case) > 0), "{cases:?}");
}

#[test]
fn misspelt_names_get_a_suggestion() {
    for (word, meant) in [
        ("dpeth", "did you mean `depth`?"),
        ("blend/factrs/*", "did you mean `blend/factors`?"),
        ("depth/clear/clear=1/format=depth23float", CLEARED),
    ] {
        etalon(&["list", word])
            .assert()
            .code(4)
            .stderr(contains("did you mean").and(contains(meant)));
    }
    refused(
        &[
            "explain",
            "depth/clear/clear=1/format=dept32float",
            "--texel",
            "0,0",
        ],
        &["did you mean", CLEARED],
    );
    refused(&["run", "--adapter", "cppu"], &["did you mean `cpu`?"]);
}

#[test]
fn show_describes_a_case_and_draws_it() {
    let folder = tempfile::tempdir().unwrap();
    let png = folder.path().join("case.png");
    let id = "stencil/masks-zero/compare=less/format=depth24plus-stencil8";
    let output = etalon(&["show", id, "--png"]).arg(&png).output().unwrap();
    let text = String::from_utf8(output.stdout).unwrap();
    for word in [
        id,
        "pass 0 on",
        "draw 0: ",
        "read_mask 0",
        "reads back",
        "\"compare\": \"less\"",
        "@fragment",
    ] {
        assert!(text.contains(word), "`{word}` in {text}");
    }
    assert!(!text.contains("\"$"), "{text}");
    assert!(fs::read(&png).unwrap().starts_with(b"\x89PNG"));
    // `show` also draws pictures that are too large for a page.
    let large = "size/spanning/samples=1/size=1023x769";
    etalon(&["show", large, "--png"]).arg(&png).assert().code(0);
    assert!(fs::metadata(&png).unwrap().len() > 1000);
    refused(&["show", "depth/none"], &["there is no case"]);
}

#[test]
fn show_describes_the_kernels_of_a_case() {
    let shown = |id: &str| {
        let output = etalon(&["show", id, "--kernels"]).output().unwrap();
        String::from_utf8(output.stdout).unwrap()
    };
    let blended = shown("perf/blended-layers/size=256x256");
    let mesh = "pass 0, draw 0: tiles; flat colours of vertices, a linear function of each code";
    assert!(blended.contains(mesh), "{blended}");
    let lines = shown("stencil/masks-zero/compare=less/format=depth24plus-stencil8");
    assert!(
        lines.contains("kernels\n  spans, since there is no kernel for "),
        "{lines}"
    );
}

#[test]
fn a_run_writes_its_cases_next_to_its_page() {
    let out = tempfile::tempdir().unwrap();
    etalon(&[
        "run",
        "depth/clear",
        "cull/lines",
        "--adapter",
        "cpu",
        "--out",
    ])
    .arg(out.path())
    .assert()
    .success();
    for area in ["depth", "cull"] {
        let text = fs::read_to_string(out.path().join(format!("cases/{area}.js"))).unwrap();
        let json = text
            .strip_prefix(&format!("etalonArea(\"{area}\", "))
            .unwrap()
            .trim_end()
            .strip_suffix(");")
            .unwrap();
        let held: Value = serde_json::from_str(json).unwrap();
        assert!(!held["pictures"].as_array().unwrap().is_empty());
        assert!(!held["lines"].as_array().unwrap().is_empty());
        for (file, cases) in held["cases"].as_object().unwrap() {
            assert!(held["files"][file]["about"].is_string(), "{file}");
            assert!(
                cases
                    .as_object()
                    .unwrap()
                    .values()
                    .all(|case| case[1].as_i64().unwrap() >= 0),
                "{cases}"
            );
        }
    }
    let page = fs::read_to_string(out.path().join("index.html")).unwrap();
    assert!(
        page.contains("#gallery=depth"),
        "the page links its galleries"
    );
}
