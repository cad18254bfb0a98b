//! Programs that speak the open protocol: ours draw and are judged, their planted mistakes are named, and hostile ones
//! cost a case each.
#![expect(clippy::unwrap_used, reason = "a test that panics has failed")]

use crate::etalon::etalon;
use crate::house::root;
use assert_cmd::Command;
use etalon_record::{LossKind, Record, Run, Verdict};
use etalon_report::message;
use serde_json::{Value, json};
use std::fs;
use std::path::{Path, PathBuf};
use tempfile::TempDir;

/// The mistakes that the programs make on request, and the topics that name them.
const MISTAKES: [(&str, &str); 3] = [
    ("upside-down", "orientation"),
    ("srgb-twice", "transfer function"),
    ("one-sample", "sample order"),
];

/// Returns a folder with the C program.
fn compiled() -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    let mut compiler = Command::new("cc");
    compiler
        .args(["-std=gnu11", "-O2", "-Wall", "-Wextra", "-Werror", "-o"])
        .arg(folder.path().join("loop"))
        .arg(root().join("ci/adapters/external/loop.c"))
        .arg("-lm");
    compiler.assert().success();
    folder
}

/// Describes a program in a folder.
fn described(folder: &Path, command: &[&str]) -> PathBuf {
    let file = folder.join("adapters.json");
    let entry = json!([{ "name": "external:mine", "backend": "external", "command": command }]);
    fs::write(&file, entry.to_string()).unwrap();
    file
}

/// Returns the command `conformance` or `run` for the described program.
fn asked(arguments: &[&str], file: &Path) -> Command {
    let mut command = etalon(arguments);
    command
        .args(["--adapter", "external:mine", "--adapters"])
        .arg(file);
    command
}

fn run(globs: &[&str], file: &Path, code: i32) -> Run {
    let out = tempfile::tempdir().unwrap();
    let arguments = [
        &[
            "run",
            "--profile",
            "full",
            "--timeout",
            "3",
            "--memory",
            "500",
            "--jobs",
            "1",
        ],
        globs,
    ]
    .concat();
    let mut command = asked(&arguments, file);
    command
        .arg("--out")
        .arg(out.path().join("run"))
        .assert()
        .code(code);
    Run::read(&out.path().join("run")).unwrap()
}

fn count(run: &Run, verdict: Verdict) -> usize {
    run.records
        .iter()
        .filter(|record| record.verdict == verdict)
        .count()
}

/// Returns the topic that `conformance` says to fix first, its checks, and the number of checks that pass.
fn conformance(file: &Path, code: i32) -> (Value, usize) {
    let assert = asked(&["conformance", "--format", "json"], file)
        .assert()
        .code(code);
    let found: Value = serde_json::from_slice(&assert.get_output().stdout).unwrap();
    let passed = found["passed"].as_array().unwrap().len();
    assert_eq!(found["failed"] == json!([]), code == 0, "{found:#}");
    (found["fix_first"]["topic"].clone(), passed)
}

/// Asserts that a program conforms, and that each of its mistakes is named.
fn names_mistakes(folder: &Path, command: &[&str], least: usize) {
    let (topic, passed) = conformance(&described(folder, command), 0);
    assert_eq!(topic, Value::Null);
    assert!(passed >= least, "{passed}");
    for (mistake, named) in MISTAKES {
        let file = described(folder, &[command, &[mistake]].concat());
        assert_eq!(conformance(&file, 1).0, named, "{mistake}");
    }
}

#[test]
fn mistakes_of_a_program_in_c_are_named() {
    let folder = compiled();
    names_mistakes(folder.path(), &["./loop"], 40);
}

#[test]
fn a_program_in_c_is_judged() {
    let folder = compiled();
    let file = described(folder.path(), &["./loop"]);
    let run = run(
        &[
            "depth/*",
            "blend/*",
            "multisample/*",
            "scissor/*",
            "texture/*",
        ],
        &file,
        0,
    );
    assert!(
        count(&run, Verdict::Pass) > 50,
        "{}",
        count(&run, Verdict::Pass)
    );
    let words = run
        .records
        .iter()
        .filter(|r| r.verdict == Verdict::NotSupported);
    assert!(words.map(message).any(|text| text.contains("this shader")));
}

#[test]
#[ignore = "needs PyPI's wgpu, which ci/test --all installs"]
fn a_program_in_python_is_judged_and_its_mistakes_are_named() {
    let folder = tempfile::tempdir().unwrap();
    let program = root().join("ci/adapters/external/wgpu_executor.py");
    let command = ["python3", program.to_str().unwrap()];
    names_mistakes(folder.path(), &command, 80);
    let file = described(folder.path(), &command);
    let run = run(
        &["depth/compare", "stencil/compare", "blend/*", "cull/*"],
        &file,
        0,
    );
    assert!(
        count(&run, Verdict::Pass) > 200,
        "{}",
        count(&run, Verdict::Pass)
    );
}

/// Passes lines between etalon and the program in C, except the answer to a scene that clears depth to 1.
const HOSTILE: &str = r#"
import json, os, signal, subprocess, sys, time
inner = subprocess.Popen(["./loop"], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)
print(inner.stdout.readline(), end="", flush=True)
for line in sys.stdin:
    inner.stdin.write(line)
    inner.stdin.flush()
    answer = inner.stdout.readline()
    if '"depth":1.0' not in line:
        print(answer, end="", flush=True)
        continue
    images = json.loads(answer)["frame"]["images"]
    image = images.pop()
    number = json.loads(line)["number"]
    frame = lambda **changed: json.dumps({"number": number, "frame": {"images": images + [image | changed]}})
    exec(sys.argv[1])
    sys.stdout.flush()
"#;

/// What a hostile program does in place of its answer, the verdict, and a part of the message.
const DEEDS: [(&str, Verdict, &str); 15] = [
    ("print('hello')", Verdict::InternalError, "not an answer"),
    (
        "os.write(1, bytes(range(256)) + b'\\n')",
        Verdict::InternalError,
        "not an answer",
    ),
    (
        "print('{}')",
        Verdict::InternalError,
        "missing field `number`",
    ),
    (
        "print(frame().replace(str(number), '99', 1))",
        Verdict::InternalError,
        "number 99",
    ),
    (
        "print(frame(texels=image['texels'][4:]))",
        Verdict::InternalError,
        "bytes, but 16 by 16 texels of 1 samples",
    ),
    (
        "print(frame(texels='?'))",
        Verdict::InternalError,
        "not base64",
    ),
    (
        "print(frame(attachment='other'))",
        Verdict::InternalError,
        "of other in place of depth of",
    ),
    (
        "print(frame(aspect='color'))",
        Verdict::InternalError,
        "color of",
    ),
    (
        "print(json.dumps({'number': number, 'frame': {'images': images}}))",
        Verdict::InternalError,
        "1 images, 2 were requested",
    ),
    (
        "print(json.dumps({'number': number, 'frame': {'images': images + [image], 'counters': [1]}}))",
        Verdict::InternalError,
        "1 counters",
    ),
    (
        "print(json.dumps({'number': number, 'unsupported': 'a', 'frame': {'images': images}}))",
        Verdict::InternalError,
        "exactly one",
    ),
    (
        "while True: os.write(1, b'x' * 65536)",
        Verdict::InternalError,
        "longer than",
    ),
    ("time.sleep(1000)", Verdict::Timeout, "3 s"),
    (
        "print('last words', file=sys.stderr, flush=True); os._exit(3)",
        Verdict::Crash,
        "last words",
    ),
    (
        "os.kill(os.getpid(), signal.SIGSEGV)",
        Verdict::Crash,
        "signal 11",
    ),
];

#[test]
fn a_hostile_program_costs_a_case() {
    let folder = compiled();
    fs::write(folder.path().join("hostile.py"), HOSTILE).unwrap();
    let memory = (
        "a = b'x' * (800 << 20); time.sleep(1000)",
        Verdict::ResourceError,
        "500 MiB",
    );
    for (deed, verdict, part) in DEEDS.into_iter().chain([memory]) {
        let file = described(folder.path(), &["python3", "hostile.py", deed]);
        let run = run(
            &[
                "depth/clear/clear=0/format=depth32float",
                "depth/clear/clear=1/format=depth32float",
                "--recheck",
                "off",
            ],
            &file,
            1,
        );
        let (bad, good): (Vec<&Record>, Vec<_>) = run
            .records
            .iter()
            .partition(|record| record.case.contains("clear=1/"));
        assert!(!good.is_empty(), "{deed}");
        for record in good {
            assert_eq!(record.verdict, Verdict::Pass, "{deed}: {}", record.case);
        }
        let [bad] = bad[..] else {
            panic!("{deed}: {bad:?}");
        };
        let text = message(bad);
        assert_eq!(bad.verdict, verdict, "{deed}: {text}");
        assert!(text.contains(part), "{deed}: {text}");
        let end = bad.process.as_ref().map(|end| end.kind);
        assert_ne!(
            end,
            Some(LossKind::Garbage),
            "the worker itself never breaks: {deed}"
        );
    }
}

#[test]
fn a_program_without_a_description_is_unavailable() {
    let folder = tempfile::tempdir().unwrap();
    let hello = |more: &str| {
        format!(
            "echo '{{\"protocol\":1,\"device\":\"d\",\"driver\":\"d\",\"rules\":\"vulkan\",\"max_size\":1,\"max_color_attachments\":1{more}}}'; cat"
        )
    };
    for (script, part) in [
        (
            "exit 3".to_owned(),
            "it ended with exit status: 3 before its first line",
        ),
        (
            "echo hello; cat".to_owned(),
            "its first line is not a description",
        ),
        (
            "echo '{}'; cat".to_owned(),
            "its first line has no number `protocol`",
        ),
        (
            "echo '{\"protocol\":2}'; cat".to_owned(),
            "it speaks protocol 2, and this etalon protocol 1",
        ),
        (
            "yes | tr -d '\\n'".to_owned(),
            "its first line is longer than",
        ),
        (hello(""), "missing field `formats`"),
        (
            hello(",\"formats\":{},\"colour\":1"),
            "unknown field `colour`",
        ),
        (
            hello(",\"formats\":{},\"features\":[\"tessellation\"]"),
            "which the protocol cannot express",
        ),
        (
            hello(",\"formats\":{},\"features\":[\"sample-mask-input\"],\"shaders\":[\"glsl\"]"),
            "whose shaders are in WGSL only",
        ),
        (
            hello(",\"formats\":{\"bgra4unorm\":{\"samples\":[1]}}"),
            "which has no layout in WebGPU",
        ),
        (
            hello(",\"formats\":{\"rgba8unorm\":{\"samples\":[3]}}"),
            "3 samples per texel",
        ),
        (
            hello(",\"formats\":{},\"sample_positions\":{\"4\":[[0,0]]}"),
            "1 sample positions for 4 samples",
        ),
    ] {
        let file = described(folder.path(), &["sh", "-c", &script]);
        let assert = asked(&["run", "depth/clear"], &file).assert().code(64);
        let text = String::from_utf8(assert.get_output().stderr.clone()).unwrap();
        assert!(text.contains(part), "{script}: {text}");
    }
    let file = described(folder.path(), &["./none"]);
    let assert = asked(&["conformance"], &file).assert().code(64);
    let text = String::from_utf8(assert.get_output().stderr.clone()).unwrap();
    assert!(text.contains("none does not exist"), "{text}");
}

#[test]
fn the_schema_of_the_protocol_takes_every_line_of_both_sides() {
    let output = etalon(&["schema", "--protocol"]).assert().success();
    let schema: Value = serde_json::from_slice(&output.get_output().stdout).unwrap();
    jsonschema::meta::validate(&schema).unwrap();
    let validator = jsonschema::validator_for(&schema).unwrap();
    let folder = compiled();
    let script = "tee -a in | ./loop | tee -a out";
    let file = described(folder.path(), &["sh", "-c", script]);
    run(
        &[
            "depth/compare",
            "blend/factors",
            "cull/*",
            "multisample/mask",
        ],
        &file,
        0,
    );
    for name in ["in", "out"] {
        let text = fs::read_to_string(folder.path().join(name)).unwrap();
        assert!(text.lines().count() > 20, "{name}");
        for line in text.lines() {
            let value = serde_json::from_str(line).unwrap();
            if let Some(error) = validator.iter_errors(&value).next() {
                panic!("{name}: {error}: {line}");
            }
        }
    }
    for wrong in [
        json!({}),
        json!({ "number": "7" }),
        json!({ "number": 7, "frames": {} }),
    ] {
        assert!(!validator.is_valid(&wrong), "{wrong}");
    }
}

#[test]
fn shaders_come_in_the_languages_that_a_program_asks_for() {
    let folder = compiled();
    let script = r#"tee -a in | ./loop | sed -u '1s/"rules"/"shaders":["spirv","glsl"],"rules"/'"#;
    let file = described(folder.path(), &["sh", "-c", script]);
    let case = "depth/compare/compare=less/format=depth32float/write=true";
    run(&[case], &file, 0);
    let text = fs::read_to_string(folder.path().join("in")).unwrap();
    let requests = text
        .lines()
        .map(|line| serde_json::from_str::<Value>(line).unwrap());
    let drawn = |request: &Value| request["scene"]["shaders"] != json!({});
    let request = requests.into_iter().find(drawn).unwrap();
    let shaders = request["scene"]["shaders"].as_object().unwrap();
    for shader in shaders.values() {
        assert_eq!(shader["wgsl"], Value::Null);
        // The magic number of SPIR-V, in base64.
        assert!(
            shader["spirv"].as_str().unwrap().starts_with("AwIjB"),
            "{shader}"
        );
        for stage in ["vertex", "fragment"] {
            let text = shader["glsl"][stage].as_str().unwrap();
            assert!(text.starts_with("#version 450 core"), "{text}");
        }
    }
}
