//! Every command in the code blocks of the pages for users is run, or has a reason why not.
#![expect(clippy::unwrap_used, reason = "a test that panics has failed")]

use crate::etalon::etalon;
use std::collections::BTreeSet;
use std::fs;
use std::path::Path;
use tempfile::TempDir;

/// The pages.
const PAGES: [&str; 10] = [
    "README.md",
    "ci/README.md",
    "ci/adapters/README.md",
    "ci/adapters/external.md",
    "ci/adapters/frames.md",
    "ci/conformance.md",
    "ci/adapters/preflight.md",
    "ci/dashboards.md",
    "crates/commands.md",
    "crates/triage.md",
];

/// The treatment of a command that cannot run as it is written.
enum Treatment {
    /// Runs with these arguments instead. `{new}` is a new path.
    As(&'static str),
    /// Does not run, for this reason.
    Not(&'static str),
}
use Treatment::{As, Not};

const SCRIPT: Treatment =
    Not("a script, which ci_files.rs and driver_releases.rs try with programs of their own");
const FETCHED: Treatment = Not("needs releases of drivers that a script fetches from the network");

/// The commands that do not run as they are written. The folder has `run-a` and `run-b` with a run each, `bench-a` and
/// `bench-b`, `frames`, `cases`, `adapters.json` and `known`.
const TREATED: &[(&str, Treatment)] = &[
    ("ci/adapters/angle /tmp/angle", SCRIPT),
    (
        "ci/adapters/chromium --browser 147 /tmp/chromium-147",
        SCRIPT,
    ),
    ("ci/adapters/chromium 131 /tmp/chromium-131", SCRIPT),
    (
        "ci/adapters/inside /tmp/mesa-sid target/release/etalon run --out reports/mesa-sid",
        SCRIPT,
    ),
    (
        "ci/adapters/lines /tmp/chromium-131 /tmp/chromium-147 >lines.json",
        SCRIPT,
    ),
    ("ci/adapters/lines /tmp/dawn /tmp/deno >lines.json", FETCHED),
    ("ci/adapters/mesa sid /tmp/mesa-sid", SCRIPT),
    ("ci/adapters/mesa-backports /tmp/mesa-25", SCRIPT),
    ("ci/adapters/webgpu dawn 0.6.2 /tmp/dawn", FETCHED),
    (
        "NODE_PATH=/tmp/dawn/node_modules etalon run --adapter webgpu:dawn",
        FETCHED,
    ),
    ("ci/container /srv/etalon", SCRIPT),
    ("ci/mesa-request install runs/main", SCRIPT),
    (
        "ci/mesa-request install runs/request --main runs/main",
        SCRIPT,
    ),
    ("ci/suite", SCRIPT),
    ("ci/suite 'depth/*' --adapter gl:softpipe", SCRIPT),
    ("ci/suite --adapter gl:softpipe 'depth/*'", SCRIPT),
    ("ci/suite --adapter vulkan:lavapipe 'depth/*'", SCRIPT),
    ("ci/test", SCRIPT),
    (
        "time ci/mesa-request /tmp/mesa-25/usr runs/request --main runs/main",
        SCRIPT,
    ),
    ("time ci/mesa-request /usr runs/main", SCRIPT),
    (
        "ETALON_ANGLE=/tmp/angle etalon run --adapter gl:es:angle",
        FETCHED,
    ),
    (
        "ETALON_CHROMIUM_FOLDER=/tmp/chromium-131 etalon run --adapters ci/adapters/chromium.json --adapter vulkan:swiftshader --adapter gl:es:angle --out reports/chromium-131",
        FETCHED,
    ),
    (
        "ETALON_MESA_25=/tmp/mesa-25 etalon run --adapters ci/adapters/mesa-25.json --adapter gl:llvmpipe --adapter gl:llvmpipe@25 --adapter vulkan:lavapipe --adapter vulkan:lavapipe@25",
        FETCHED,
    ),
    (
        "etalon adapters --adapters drivers.json",
        As("adapters --adapters adapters.json"),
    ),
    (
        "etalon bench 'perf/matrix/*' --rounds 7 --seconds 0.01",
        As("bench perf/clear/size=256x256 --adapter cpu --rounds 3 --seconds 0.01 --out {new}"),
    ),
    (
        "etalon bench --adapter cpu --adapter gl:llvmpipe",
        As(
            "bench perf/clear/size=256x256 --adapter cpu --adapter gl:llvmpipe --rounds 3 --seconds 0.01 --out {new}",
        ),
    ),
    (
        "etalon bench --adapter cpu --adapter gl:llvmpipe --out DIR",
        As(
            "bench perf/clear/size=256x256 --adapter cpu --adapter gl:llvmpipe --rounds 3 --seconds 0.01 --out {new}",
        ),
    ),
    (
        "etalon bisect CASE --line softpipe --adapters lines.json",
        FETCHED,
    ),
    (
        "etalon bisect CASE --line swiftshader --adapters FILE",
        FETCHED,
    ),
    (
        "etalon bisect cull paths --line swiftshader --adapters lines.json --out reports/versions",
        FETCHED,
    ),
    (
        "etalon bisect paths --line dawn --adapters lines.json",
        FETCHED,
    ),
    (
        "etalon bundle CASE --adapter gl:zink",
        As("bundle cull/points/cull=none/front_face=cw --adapter gl:softpipe --out {new}"),
    ),
    (
        "etalon check --pairs --profile full",
        Not("takes minutes; check.rs runs it on a few files"),
    ),
    ("etalon check DIR", As("check cases")),
    (
        "etalon conformance --adapters FILE --adapter external:mine",
        As("conformance --adapter cpu"),
    ),
    (
        "etalon run --adapters FILE --adapter external:mine",
        As("run cull/points/* --adapter cpu --out {new}"),
    ),
    (
        "etalon preflight --adapter vulkan:lavapipe",
        As("preflight --adapter cpu"),
    ),
    ("etalon completions SHELL", As("completions bash")),
    ("etalon diff A B", As("diff run-a run-b")),
    ("etalon diff BEFORE AFTER", As("diff bench-a bench-b")),
    ("etalon diff RUN RUN", As("diff run-a run-b")),
    (
        "etalon diff reports/mesa-bookworm reports/mesa-sid",
        As("diff run-a run-b"),
    ),
    (
        "etalon expectations import|export",
        Not("two commands, which expectations.rs runs"),
    ),
    (
        "etalon explain CASE --adapter gl:softpipe",
        As("explain cull/points/cull=none/front_face=cw --adapter gl:softpipe"),
    ),
    (
        "etalon export CASE --out DIR",
        As("export cull/points --adapter cpu --no-values --out {new}"),
    ),
    (
        "etalon judge --frame DIR --rules vulkan",
        As("judge --frame frames --rules vulkan --out {new}"),
    ),
    (
        "etalon judge CASE --frame DIR",
        As("judge cull/points --frame frames --out {new}"),
    ),
    (
        "etalon fuzz --adapter gl:softpipe --count 300 --seed 7 --out DIR",
        As("fuzz --adapter cpu --count 30 --seed 7 --out {new}"),
    ),
    (
        "etalon fuzz --adapter gl:zink --time 10m",
        As("fuzz --adapter cpu --time 1s --out {new}"),
    ),
    (
        "etalon history add DIR… --label branch=main",
        As("history add run-a bench-a --label branch=main --db {new}"),
    ),
    (
        "etalon history add DIR --db FILE",
        As("history add run-a --db {new}"),
    ),
    (
        "etalon history add RUN…",
        As("history add run-a --db history.db"),
    ),
    (
        "etalon history export --format F DIR",
        As("history export --format openmetrics {new} --db history.db"),
    ),
    (
        "etalon history report --out DIR",
        As("history report --out {new} --db history.db"),
    ),
    (
        "etalon history show CASE",
        As("history show cull/points/cull=none/front_face=cw --db history.db"),
    ),
    (
        "etalon history triage",
        As("history triage --db history.db"),
    ),
    ("etalon merge DIR… --out DIR", As("merge run-a --out {new}")),
    (
        "etalon mutants",
        As("mutants cull/front-face-inverted --case cull/points/* --out {new}"),
    ),
    (
        "etalon reduce CASE --adapter gl:zink",
        As("reduce cull/points/cull=none/front_face=cw --adapter gl:softpipe --out {new}"),
    ),
    (
        "etalon reduce cull/points/cull=none/front_face=cw --adapter gl:softpipe --out DIR",
        As("reduce cull/points/cull=none/front_face=cw --adapter gl:softpipe --out {new}"),
    ),
    ("etalon report DIR", As("report run-a")),
    (
        "etalon show CASE [--png FILE]",
        As("show cull/points/cull=none/front_face=cw --png {new}"),
    ),
    (
        "etalon run --bless",
        Not("changes the findings of the sources; expectations.rs runs it on a folder"),
    ),
    (
        "etalon run --resume --out DIR",
        As("run --resume --out run-a"),
    ),
    (
        "etalon run --cases DIR --known-by-look",
        As("run --cases cases --known-by-look --adapter cpu --out {new}"),
    ),
    ("etalon site DIR RUN…", As("site {new} run-a run-b")),
    ("etalon site public DIR…", As("site {new} run-a bench-a")),
    ("etalon --version", As("--version")),
];

/// Returns the commands of a page's code blocks, without comments.
fn commands(page: &str) -> Vec<String> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("../..")
        .join(page);
    let text = fs::read_to_string(path).unwrap().replace("\\\n", " ");
    let mut blocks = text.split("```").skip(1).step_by(2);
    let mut commands = Vec::new();
    for line in blocks.by_ref().flat_map(str::lines) {
        let line = line.trim().trim_start_matches("$ ");
        let line = line.split("  #").next().unwrap_or_default();
        let line = line.split(" # ").next().unwrap_or_default();
        let line = line.split_whitespace().collect::<Vec<_>>().join(" ");
        let first = line.strip_prefix("time ").unwrap_or(&line);
        let is_set =
            |word: &str| word.starts_with(|c: char| c.is_ascii_uppercase()) && word.contains('=');
        let mut words = first.split(' ').skip_while(|word| is_set(word));
        if words
            .next()
            .is_some_and(|word| word == "etalon" || word.starts_with("ci/"))
        {
            commands.push(line);
        }
    }
    commands
}

/// Returns the arguments of a documented command, with names of this folder for its placeholders. Runs draw a few cases
/// on the rasterizer if they are not restricted.
fn arguments(command: &str) -> Vec<String> {
    let words = shlex::split(command).unwrap();
    let mut words: Vec<String> = words[1..].to_vec();
    for index in 1..words.len() {
        let before = words[index - 1].clone();
        let name = match (before.as_str(), words[index].as_str()) {
            ("--cases", "DIR") => "cases",
            ("--history", "FILE") => "history.db",
            ("--expect", _) => "known",
            ("--adapters", _) => "adapters.json",
            (
                "--adapter",
                "gl:mine" | "vulkan:radv@main" | "vulkan:lavapipe@128" | "gl:llvmpipe@128",
            ) => "vulkan:mine",
            ("--out", _) => "{new}",
            (_, "--profile") => "--jobs",
            ("--jobs", "full") => "1",
            (_, "depth/*" | "methods/*") => "cull/points/*",
            _ => continue,
        };
        name.clone_into(&mut words[index]);
    }
    if words[0] == "run" && !words.contains(&"--resume".to_owned()) {
        let has = |words: &[String], flag: &str| words.iter().any(|word| word == flag);
        if !words.iter().any(|word| word.starts_with("cull")) && !has(&words, "--cases") {
            words.push("cull/points/*".to_owned());
        }
        if !has(&words, "--adapter") {
            words.extend(["--adapter", "cpu"].map(str::to_owned));
        }
        if !has(&words, "--out") {
            words.extend(["--out", "{new}"].map(str::to_owned));
        }
    }
    words
}

/// Makes the files that commands name.
fn folder() -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    for name in ["cases/own", "known"] {
        fs::create_dir_all(at(name)).unwrap();
    }
    let cases = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../cases/cull/points.json");
    fs::copy(cases, at("cases/own/points.json")).unwrap();
    let adapters = r#"[{ "name": "vulkan:mine", "backend": "vulkan", "remedy": "apt-get install mesa-vulkan-drivers",
        "manifests": ["lvp_icd.x86_64.json", "lvp_icd.aarch64.json", "lvp_icd.json"] }]"#;
    fs::write(at("adapters.json"), adapters).unwrap();
    let made = |arguments: &[&str]| {
        let mut command = etalon(arguments);
        command.current_dir(folder.path()).assert().code(0);
    };
    for name in ["run-a", "run-b"] {
        let full = [
            "run",
            "cull/points",
            "--profile",
            "full",
            "--adapter",
            "cpu",
        ];
        made(&[&full[..], &["--out", name]].concat());
    }
    for name in ["bench-a", "bench-b"] {
        let bench = [
            "bench",
            "perf/clear/size=256x256",
            "--adapter",
            "cpu",
            "--rounds",
            "3",
            "--seconds",
            "0.01",
        ];
        made(&[&bench[..], &["--out", name]].concat());
    }
    let frames = ["export", "cull/points", "--adapter", "cpu", "--no-values"];
    made(&[&frames[..], &["--out", "frames"]].concat());
    made(&["history", "add", "run-a", "bench-a", "--db", "history.db"]);
    folder
}

#[test]
fn every_documented_command_runs_or_has_a_reason_not_to() {
    let folder = folder();
    let documented: BTreeSet<String> = PAGES.into_iter().flat_map(commands).collect();
    assert!(documented.len() > 60, "{documented:?}");
    for (command, _) in TREATED {
        assert!(documented.contains(*command), "no page has `{command}`");
    }
    for (number, command) in documented.iter().enumerate() {
        let treated = TREATED.iter().find(|(known, _)| known == command);
        let words = match treated {
            Some((_, Not(reason))) => {
                assert!(!reason.is_empty());
                continue;
            }
            Some((_, As(instead))) => instead.split(' ').map(str::to_owned).collect(),
            None => arguments(command),
        };
        let new = format!("new-{number}");
        let words: Vec<String> = words
            .iter()
            .map(|word| word.replace("{new}", &new))
            .collect();
        let words: Vec<&str> = words.iter().map(String::as_str).collect();
        let output = etalon(&words).current_dir(folder.path()).output().unwrap();
        let said = String::from_utf8_lossy(&output.stderr);
        assert!(
            matches!(output.status.code(), Some(0..=2)),
            "`{command}`, run as `etalon {}`: {:?}: {said}",
            words.join(" "),
            output.status.code()
        );
    }
}
