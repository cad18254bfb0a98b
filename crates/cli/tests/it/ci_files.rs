//! The files of `ci/` for CI systems and clusters: they satisfy the systems' schemas, the scripts that they
//! call exist, and their shell lines, run with the systems' variables, draw every case once.
#![expect(clippy::unwrap_used, reason = "a test that panics has failed")]

use serde_json::{Value, json};
use std::collections::BTreeSet;
use std::fs;
use std::os::unix::fs::PermissionsExt as _;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use std::time::Duration;

const BINARY: &str = env!("CARGO_BIN_EXE_etalon");
const WORKFLOW: &str = "ci/github-actions.yml";
const PIPELINE: &str = "ci/gitlab-ci.yml";
/// Templates for the repository of a driver, in which ours is the folder `etalon`.
const MESA_WORKFLOW: &str = "ci/mesa-request-github.yml";
const MESA_PIPELINE: &str = "ci/mesa-request-gitlab.yml";
const JOB: &str = "ci/kubernetes/job.yaml";
const MERGE: &str = "ci/kubernetes/merge.yaml";
const CLAIM: &str = "ci/kubernetes/claim.yaml";

/// The variables of systems that start many processes; the tests themselves can run in such a system.
const VARIABLES: [&str; 17] = [
    "CI",
    "CI_NODE_INDEX",
    "CI_NODE_TOTAL",
    "TEST_SHARD_INDEX",
    "TEST_TOTAL_SHARDS",
    "SLURM_ARRAY_TASK_ID",
    "SLURM_ARRAY_TASK_MIN",
    "SLURM_ARRAY_TASK_STEP",
    "SLURM_ARRAY_TASK_COUNT",
    "SLURM_RESTART_COUNT",
    "JOB_COMPLETION_INDEX",
    "JOB_COMPLETIONS",
    "GITHUB_STEP_SUMMARY",
    "ETALON_RESTARTS",
    "ETALON_HISTORY",
    "ETALON_HISTORY_ADD",
    "ETALON_BRANCH",
];

/// Enough cases that no shard is empty.
const GLOB: &str = "cull/*";

fn root() -> PathBuf {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    root.canonicalize().unwrap()
}

fn text(name: &str) -> String {
    fs::read_to_string(root().join(name)).unwrap_or_else(|e| panic!("{name}: {e}"))
}

fn yaml(name: &str) -> Value {
    serde_saphyr::from_str(&text(name)).unwrap_or_else(|e| panic!("{name}: {e}"))
}

fn schema(name: &str) -> jsonschema::Validator {
    let text = text(&format!("crates/cli/tests/schemas/{name}"));
    jsonschema::validator_for(&serde_json::from_str(&text).unwrap()).unwrap()
}

#[test]
fn every_file_satisfies_the_schema_of_its_format() {
    // Each file, with a key and a value that its format refuses there.
    let files = [
        (
            WORKFLOW,
            "github-workflow.json",
            "/jobs/shard/steps/0/uses",
            json!(7),
        ),
        (PIPELINE, "gitlab-ci.json", "/shard/parallel", json!("four")),
        (
            MESA_WORKFLOW,
            "github-workflow.json",
            "/jobs/draw/steps/1/uses",
            json!(7),
        ),
        (
            MESA_PIPELINE,
            "gitlab-ci.json",
            "/etalon/timeout",
            json!([1]),
        ),
        (JOB, "kubernetes.json", "/spec/completionMode", json!(true)),
        (
            MERGE,
            "kubernetes.json",
            "/spec/template/spec/containers/0/command",
            json!("x"),
        ),
        (
            CLAIM,
            "kubernetes.json",
            "/spec/accessModes",
            json!("ReadWriteMany"),
        ),
    ];
    for (name, format, pointer, wrong) in files {
        let schema = schema(format);
        let mut value = yaml(name);
        let errors: Vec<String> = schema
            .iter_errors(&value)
            .map(|e| format!("{}: {e}", e.instance_path()))
            .collect();
        assert!(errors.is_empty(), "{name}: {errors:#?}");
        *value.pointer_mut(pointer).unwrap() = wrong;
        assert!(!schema.is_valid(&value), "{name}: any {pointer} would do");
        let mut value = yaml(name);
        let keys = value.as_object_mut().unwrap();
        keys.insert("no such key".to_owned(), json!(1));
        assert!(!schema.is_valid(&value), "{name}: any key would do");
    }
}

/// Returns the shell lines of a file: per job, in order.
fn lines(name: &str) -> Vec<(String, Vec<String>)> {
    let value = yaml(name);
    let strings = |v: &Value| -> Vec<String> {
        let items = v.as_array().map(Vec::as_slice).unwrap_or_default();
        items
            .iter()
            .map(|s| s.as_str().unwrap().to_owned())
            .collect()
    };
    let jobs = match name {
        WORKFLOW | MESA_WORKFLOW => value["jobs"].as_object().unwrap(),
        PIPELINE | MESA_PIPELINE => value.as_object().unwrap(),
        _ => {
            let container = &value["spec"]["template"]["spec"]["containers"][0];
            let words = [strings(&container["command"]), strings(&container["args"])].concat();
            let name = container["name"].as_str().unwrap().to_owned();
            return vec![(name, vec![words.join(" ")])];
        }
    };
    let of_job = |job: &Value| match job["steps"].as_array() {
        Some(steps) => steps
            .iter()
            .filter_map(|s| s["run"].as_str().map(str::to_owned))
            .collect(),
        None => strings(&job["script"]),
    };
    jobs.iter()
        .map(|(name, job)| (name.clone(), of_job(job)))
        .filter(|(_, lines)| !lines.is_empty())
        .collect()
}

/// Returns the line of a job that calls this script.
fn line(name: &str, job: &str, script: &str) -> String {
    let jobs = lines(name);
    let (_, lines) = jobs.iter().find(|(n, _)| n == job).unwrap();
    let found: Vec<&String> = lines.iter().filter(|l| l.contains(script)).collect();
    assert_eq!(found.len(), 1, "{name}, {job}: {lines:?}");
    found[0].clone()
}

/// Returns the flags in a command's help.
fn flags(command: &str) -> BTreeSet<String> {
    let output = Command::new(BINARY)
        .args([command, "--help"])
        .output()
        .unwrap();
    let help = String::from_utf8(output.stdout).unwrap();
    let words = help.split(|c: char| c.is_whitespace() || c == ',');
    words
        .filter(|w| w.starts_with("--"))
        .map(|w| {
            w.trim_end_matches(|c: char| !c.is_alphanumeric())
                .to_owned()
        })
        .collect()
}

/// Returns the names under `ci/` in a line that are not executable files, and its flags that `etalon` does not know.
fn unknown(line: &str) -> Vec<String> {
    let mut unknown = Vec::new();
    let mut known = None;
    let is_edge = |c: char| c.is_whitespace() || "\"'()$;".contains(c);
    for word in line.split(is_edge).filter(|w| !w.is_empty()) {
        if word.starts_with("ci/") {
            let there = fs::metadata(root().join(word))
                .is_ok_and(|m| m.is_file() && m.permissions().mode() & 0o111 != 0);
            if !there {
                unknown.push(word.to_owned());
            }
            known = match word {
                "ci/shard" => Some(flags("run")),
                "ci/merge-shards" => Some(flags("merge")),
                _ => None,
            };
        }
        if let Some(known) = &known
            && word.starts_with("--")
            && !known.contains(word)
        {
            unknown.push(word.to_owned());
        }
    }
    unknown
}

#[test]
fn scripts_that_ci_files_call_exist() {
    let drawn = [
        "ci/binary",
        "ci/merge-shards",
        "ci/shard",
        "ci/software-drivers",
    ];
    for (name, scripts) in [
        (WORKFLOW, &drawn[..]),
        (PIPELINE, &drawn[..]),
        (JOB, &["ci/shard"]),
        (MERGE, &["ci/merge-shards"]),
    ] {
        let mut called = BTreeSet::new();
        for (job, lines) in lines(name) {
            for line in lines {
                assert_eq!(
                    unknown(&line),
                    Vec::<String>::new(),
                    "{name}, {job}: {line}"
                );
                called.extend(drawn.iter().filter(|s| line.contains(*s)).copied());
            }
        }
        assert_eq!(called, scripts.iter().copied().collect(), "{name}");
    }
    assert_eq!(unknown("ci/shard runs --shards 1/2"), ["--shards"]);
    assert_eq!(unknown("x \"$(ci/binaries)\""), ["ci/binaries"]);
    assert_eq!(unknown("ci/README.md"), ["ci/README.md"]);
}

#[test]
fn the_templates_for_mesa_call_scripts_of_ours() {
    for name in [MESA_WORKFLOW, MESA_PIPELINE] {
        let mut called = BTreeSet::new();
        for (job, lines) in lines(name) {
            for line in lines {
                let line = line.replace("etalon/ci/", "ci/");
                let unknown = unknown(&line);
                assert_eq!(unknown, Vec::<String>::new(), "{name}, {job}: {line}");
                let scripts = ["ci/binary", "ci/mesa-request "];
                called.extend(scripts.into_iter().filter(|s| line.contains(s)));
            }
        }
        assert_eq!(called.len(), 2, "{name}: {called:?}");
    }
}

#[test]
fn actions_are_githubs_own_and_pinned() {
    let workflows = [yaml(WORKFLOW), yaml(MESA_WORKFLOW)];
    let jobs = workflows
        .iter()
        .flat_map(|w| w["jobs"].as_object().unwrap().values());
    let mut used = BTreeSet::new();
    for step in jobs.flat_map(|j| j["steps"].as_array().unwrap()) {
        let Some(uses) = step["uses"].as_str() else {
            continue;
        };
        let (action, version) = uses.split_once('@').unwrap();
        let major = version.strip_prefix('v').unwrap();
        assert!(major.parse::<u32>().is_ok(), "{uses}");
        used.insert(action);
        // The artifacts of two shards must not overwrite each other.
        if action == "actions/upload-artifact" && step["if"] == "always()" {
            assert!(step["with"]["name"].is_string(), "{step}");
        }
    }
    let known = [
        "cache",
        "cache/restore",
        "cache/save",
        "checkout",
        "download-artifact",
        "upload-artifact",
    ];
    let known: Vec<String> = known.iter().map(|n| format!("actions/{n}")).collect();
    assert_eq!(used, known.iter().map(String::as_str).collect());
}

/// A folder for a test's output, with stand-ins for `etalon` and other programs on its search path.
struct Place {
    folder: tempfile::TempDir,
}

impl Place {
    fn new() -> Self {
        Self {
            folder: tempfile::tempdir().unwrap(),
        }
    }

    fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    /// Adds a program with this text, first on the search path.
    fn program(&self, name: &str, text: &str) -> PathBuf {
        let path = self.path(name);
        fs::write(&path, format!("#!/usr/bin/env bash\n{text}\n")).unwrap();
        fs::set_permissions(&path, fs::Permissions::from_mode(0o755)).unwrap();
        path
    }

    /// Adds an `etalon` whose `run` draws a few cases on `cpu` alone.
    fn few_cases(&self) {
        self.program(
            "etalon",
            &format!(
                "if [ \"$1\" = run ]; then exec '{BINARY}' \"$@\" '{GLOB}' --adapter cpu; fi\nexec '{BINARY}' \"$@\""
            ),
        );
    }

    /// Returns a command in the repository, with this folder's `etalon` and without outside variables.
    fn command(&self, program: &str) -> Command {
        let mut command = Command::new(program);
        command.current_dir(root());
        for name in VARIABLES {
            command.env_remove(name);
        }
        let path = std::env::var("PATH").unwrap();
        command.env("PATH", format!("{}:{path}", self.folder.path().display()));
        command.env("ETALON", self.path("etalon"));
        command
    }

    /// Runs a shell line with these variables; paths that begin with `runs` or `/runs` lead into this folder.
    fn shell(&self, line: &str, variables: &[(&str, String)]) -> Output {
        let runs = self.path("runs");
        let line = line
            .replace("/runs", "runs")
            .replace("runs", runs.to_str().unwrap());
        let mut command = self.command("bash");
        command.args(["-c", &line]);
        command.envs(variables.iter().map(|(name, value)| (name, value)));
        command.output().unwrap()
    }

    /// Asserts that the merged run has every case once, and that each of `count` shards drew some.
    fn is_whole(&self, count: usize, profile: &str) {
        let cases = |folder: &str| -> Vec<String> {
            let records = self.path(folder).join("run.jsonl");
            let text = fs::read_to_string(&records).unwrap_or_else(|e| panic!("{records:?}: {e}"));
            let records = text
                .lines()
                .map(|l| serde_json::from_str::<Value>(l).unwrap());
            records
                .filter_map(|r| r["case"].as_str().map(str::to_owned))
                .collect()
        };
        let list = Command::new(BINARY)
            .args(["list", GLOB, "--profile", profile])
            .output()
            .unwrap();
        let mut wanted: Vec<String> = String::from_utf8(list.stdout)
            .unwrap()
            .lines()
            .map(str::to_owned)
            .collect();
        let mut merged = cases("runs/merged");
        wanted.sort();
        merged.sort();
        assert!(wanted.len() > 20, "{wanted:?}");
        assert_eq!(merged, wanted);
        let parts: Vec<usize> = fs::read_dir(self.path("runs"))
            .unwrap()
            .map(|entry| entry.unwrap().file_name().into_string().unwrap())
            .filter(|name| name.starts_with("shard-"))
            .map(|name| cases(&format!("runs/{name}")).len())
            .collect();
        assert_eq!(parts.len(), count, "{parts:?}");
        assert!(parts.iter().all(|n| *n > 0), "{parts:?}");
        let catalogue = self.path("runs/merged/cases");
        assert!(
            fs::read_dir(&catalogue).unwrap().count() > 0,
            "{catalogue:?}"
        );
        assert_eq!(parts.iter().sum::<usize>(), wanted.len(), "{parts:?}");
    }
}

fn printed(output: &Output) -> String {
    let both = [&output.stdout[..], &output.stderr[..]].concat();
    String::from_utf8(both).unwrap()
}

fn succeeds(output: &Output) {
    assert!(
        output.status.success(),
        "{:?}: {}",
        output.status,
        printed(output)
    );
}

#[test]
fn the_lines_for_github_draw_every_case_once() {
    let place = Place::new();
    place.few_cases();
    let workflow = yaml(WORKFLOW);
    let shards = workflow["jobs"]["shard"]["strategy"]["matrix"]["shard"]
        .as_array()
        .unwrap();
    let template = line(WORKFLOW, "shard", "ci/shard ");
    for shard in shards {
        let line = template
            .replace("${{ matrix.shard }}", &shard.to_string())
            .replace("${{ strategy.job-total }}", &shards.len().to_string())
            .replace(
                "${{ github.event_name == 'schedule' && 'full' || 'quick' }}",
                "quick",
            );
        assert!(!line.contains("${{"), "{line}");
        succeeds(&place.shell(&line, &[]));
    }
    let summary = place.path("step-summary");
    let variables = [("GITHUB_STEP_SUMMARY", summary.display().to_string())];
    succeeds(&place.shell(&line(WORKFLOW, "merge", "ci/merge-shards"), &variables));
    place.is_whole(4, "quick");
    assert!(fs::read_to_string(&summary).unwrap().contains("cpu"));
}

#[test]
fn the_lines_for_gitlab_draw_every_case_once_and_merging_names_what_is_missing() {
    let place = Place::new();
    place.few_cases();
    let total = yaml(PIPELINE)["shard"]["parallel"].as_u64().unwrap();
    let script = line(PIPELINE, "shard", "ci/shard ");
    let merge = line(PIPELINE, "merge", "ci/merge-shards");
    let nothing = place.shell(&merge, &[]);
    assert_eq!(nothing.status.code(), Some(3), "{}", printed(&nothing));
    for index in 1..=total {
        if index == total {
            let early = place.shell(&merge, &[]);
            assert_eq!(early.status.code(), Some(3), "{}", printed(&early));
            assert!(printed(&early).contains("missing: cpu cull/"));
        }
        let variables = [
            ("CI_NODE_INDEX", index.to_string()),
            ("CI_NODE_TOTAL", total.to_string()),
            ("PROFILE", "quick".to_owned()),
        ];
        succeeds(&place.shell(&script, &variables));
    }
    succeeds(&place.shell(&merge, &[]));
    place.is_whole(4, "quick");
}

#[test]
fn merging_keeps_a_history_and_begins_one_when_it_is_lost() {
    let place = Place::new();
    place.few_cases();
    let db = place.path("history/etalon.db");
    let shard = [
        ("CI_NODE_INDEX", "1".to_owned()),
        ("CI_NODE_TOTAL", "1".to_owned()),
    ];
    succeeds(&place.shell("ci/shard runs/shard-1", &shard));
    let merge = |add: &str| {
        let variables = [
            ("ETALON_HISTORY", db.display().to_string()),
            ("ETALON_HISTORY_ADD", add.to_owned()),
        ];
        let output = place.shell("ci/merge-shards runs", &variables);
        succeeds(&output);
        printed(&output)
    };
    // A proposed change adds nothing.
    assert!(merge("no").contains("judged without a history"));
    assert!(!db.exists());
    assert!(merge("yes").contains("is run 1"));
    assert!(merge("yes").contains("run 1 already"));
    // The next nightly run.
    fs::remove_dir_all(place.path("runs")).unwrap();
    std::thread::sleep(Duration::from_millis(1100));
    succeeds(&place.shell("ci/shard runs/shard-1", &shard));
    let next = merge("yes");
    assert!(
        next.contains("compared with run 1") && next.contains("is run 2"),
        "{next}"
    );
    // The history is lost with the cache.
    fs::remove_file(&db).unwrap();
    let lost = merge("yes");
    assert!(
        lost.contains("there is no history at") && lost.contains("is run 1"),
        "{lost}"
    );
}

#[test]
fn the_pods_of_kubernetes_draw_every_case_once() {
    let place = Place::new();
    place.few_cases();
    let job = yaml(JOB);
    let completions = job["spec"]["completions"].as_u64().unwrap();
    assert_eq!(job["spec"]["parallelism"].as_u64(), Some(completions));
    let container = &job["spec"]["template"]["spec"]["containers"][0];
    let runs = place.path("runs").display().to_string();
    let words: Vec<String> = ["command", "args"]
        .iter()
        .flat_map(|key| container[key].as_array().unwrap())
        .map(|word| word.as_str().unwrap().replace("/runs", &runs))
        .collect();
    for index in 0..completions {
        let mut pod = place.command(&words[0]);
        pod.args(&words[1..]);
        pod.env("JOB_COMPLETION_INDEX", index.to_string());
        for variable in container["env"].as_array().unwrap() {
            let [name, value] = ["name", "value"].map(|k| variable[k].as_str().unwrap());
            pod.env(name, value);
        }
        succeeds(&pod.output().unwrap());
    }
    succeeds(&place.shell(&line(MERGE, "merge", "ci/merge-shards"), &[]));
    place.is_whole(8, "full");
}

/// `etalon`, but `run` draws on `cpu`, which calls itself the Mesa `DRIVER`, and whose first passing case fails if `BROKEN`
/// is set.
const OTHER_DRIVER: &str = r#"
[ "$1" = run ] || exec "$BINARY" "$@"
shift
while [ $# -gt 0 ]; do
    case $1 in --out) out=$2 ;; esac
    shift
done
[ "${BROKEN:-}" = alone ] || set -- --adapter gl:llvmpipe
"$BINARY" run 'cull/points/*' --profile full --adapter cpu "$@" --out "$out" --force || exit
sed -i "1s/\"driver_version\":\"[^\"]*\"/\"driver_version\":\"Mesa $DRIVER\"/g" "$out/run.jsonl"
[ "${BROKEN:-}" != yes ] || sed -i '/cull=front\/front_face=ccw/s/"verdict":"[a-z]*"/"verdict":"fail"/' "$out/run.jsonl""#;

#[test]
fn a_request_of_mesa_is_compared_with_the_main_branch() {
    let place = Place::new();
    place.program("etalon", OTHER_DRIVER);
    let build = place.path("install");
    for (file, content) in [
        ("lib/libvulkan_lvp.so", "Mesa 99.1.0-devel (LLVM)"),
        (
            "share/vulkan/icd.d/lvp_icd.x86_64.json",
            r#"{"ICD":{"api_version":"1.4.0","library_path":"/gone/libvulkan_lvp.so"}}"#,
        ),
        ("share/glvnd/egl_vendor.d/50_mesa.json", "{}"),
    ] {
        let path = build.join(file);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(path, content).unwrap();
    }
    let request = |words: &str, driver: &str, broken: &str| {
        let line = format!("ci/mesa-request '{}' {words}", build.display());
        let variables = [("BINARY", BINARY), ("DRIVER", driver), ("BROKEN", broken)];
        place.shell(
            &line,
            &variables.map(|(name, value)| (name, value.to_owned())),
        )
    };
    let comment = || fs::read_to_string(place.path("runs/request/comment.md")).unwrap();
    // Nothing to compare with yet: known bugs alone are expected.
    let compared = "runs/request --main runs/main";
    let output = request(compared, "99.1.0-devel", "");
    succeeds(&output);
    assert!(printed(&output).contains("There is no run in"));
    assert!(comment().contains("Nothing unexpected"), "{}", comment());

    succeeds(&request("runs/main", "99.1.0-devel", ""));
    succeeds(&request(compared, "99.1.0-devel", ""));
    assert!(comment().contains("Nothing is worse"), "{}", comment());

    let output = request(compared, "99.1.0-devel", "yes");
    assert_eq!(output.status.code(), Some(1), "{}", printed(&output));
    assert!(comment().contains("#### Worse"), "{}", comment());
    assert!(comment().contains("`cull/points/"), "{}", comment());
    // The same change is one entry, on whichever adapters.
    assert!(
        comment().contains("on `cpu`, `gl:llvmpipe`: `cull/points/"),
        "{}",
        comment()
    );

    request(compared, "99.1.0-devel", "alone");
    let text = comment();
    assert!(
        text.contains("Nothing is worse than on main, on the adapters of both"),
        "{text}"
    );
    assert!(
        text.contains("Not compared: `gl:llvmpipe` has 8 records in the run of main"),
        "{text}"
    );

    // Another Mesa than the build's answered.
    let output = request(compared, "22.3.6", "");
    assert_eq!(output.status.code(), Some(64), "{}", printed(&output));
    fs::remove_file(build.join("lib/libvulkan_lvp.so")).unwrap();
    let output = request(compared, "99.1.0-devel", "");
    assert_eq!(output.status.code(), Some(64), "{}", printed(&output));
    assert!(printed(&output).contains("has no libvulkan_lvp.so"));
}

/// A replacement for Slurm's `sbatch`: runs the tasks of an array one after another, and then the merge.
const SBATCH: &str = r#"
echo "$*" >>"$PLACE/sbatch.txt"
tasks=
while [[ $1 = -* ]]; do
    case $1 in --array=1-*) tasks=${1#--array=1-} ;; esac
    shift
done
if [ -z "$tasks" ]; then bash "$@" >&2; echo 8; exit; fi
for task in $(seq "$tasks"); do
    SLURM_ARRAY_JOB_ID=7 SLURM_ARRAY_TASK_ID=$task SLURM_ARRAY_TASK_MIN=1 SLURM_ARRAY_TASK_STEP=1 \
        SLURM_ARRAY_TASK_COUNT=$tasks bash "$@" >&2
done
echo '7;cluster'"#;

#[test]
fn the_jobs_of_slurm_draw_every_case_once() {
    let place = Place::new();
    place.few_cases();
    place.program("sbatch", SBATCH);
    let variables = [("PLACE", place.folder.path().display().to_string())];
    let output = place.shell("ci/slurm/submit runs 3 --profile quick", &variables);
    succeeds(&output);
    assert_eq!(
        String::from_utf8_lossy(&output.stdout),
        "array 7\nmerge 8\n"
    );
    place.is_whole(3, "quick");
    let asked = fs::read_to_string(place.path("sbatch.txt")).unwrap();
    assert!(asked.contains("--dependency=afterany:7 "), "{asked}");
    for script in ["ci/slurm/array.sbatch", "ci/slurm/merge.sbatch"] {
        assert!(text(script).contains("\n#SBATCH --requeue\n"), "{script}");
    }
    let output = place.shell("ci/slurm/submit runs none", &variables);
    assert_eq!(output.status.code(), Some(64));
}

#[test]
fn a_drawn_shard_succeeds_whatever_its_verdicts_are() {
    let place = Place::new();
    place.program("etalon", "exit \"$CODE\"");
    for (code, then) in [(0, 0), (1, 0), (2, 0), (3, 3), (4, 4), (64, 64)] {
        let output = place.shell("ci/shard runs", &[("CODE", code.to_string())]);
        assert_eq!(output.status.code(), Some(then), "{}", printed(&output));
    }
    let output = place.shell("ci/shard --profile full", &[("CODE", "0".to_owned())]);
    assert_eq!(output.status.code(), Some(64), "a folder is wanted");
}

/// An `etalon` that draws until it gets a signal, for at most 20 s.
const PATIENT: &str = r#"trap 'exit 3' TERM; touch "$PLACE/ready"
for _ in $(seq 400); do sleep 0.05; done; exit 9"#;

/// Starts a script, sends it a signal once `etalon` draws, and returns how it ended.
fn signalled(
    place: &Place,
    words: &[&str],
    signal: rustix::process::Signal,
    restarts: u32,
) -> Output {
    let runs = place.path("runs").display().to_string();
    let mut command = place.command(words[0]);
    command.args(&words[1..]).arg(runs);
    command.env("PLACE", place.folder.path());
    command.envs([("SLURM_ARRAY_JOB_ID", "7"), ("SLURM_ARRAY_TASK_ID", "2")]);
    command.env("SLURM_RESTART_COUNT", restarts.to_string());
    command.stdout(std::process::Stdio::piped());
    command.stderr(std::process::Stdio::piped());
    let child = command.spawn().unwrap();
    while !place.path("ready").exists() {
        std::thread::sleep(Duration::from_millis(20));
    }
    fs::remove_file(place.path("ready")).unwrap();
    rustix::process::kill_process(rustix::process::Pid::from_child(&child), signal).unwrap();
    child.wait_with_output().unwrap()
}

#[test]
fn a_shard_that_is_asked_to_stop_ends_as_incomplete() {
    let place = Place::new();
    place.program("etalon", PATIENT);
    let output = signalled(&place, &["ci/shard"], rustix::process::Signal::TERM, 0);
    assert_eq!(output.status.code(), Some(3), "{}", printed(&output));
}

#[test]
fn a_task_of_slurm_whose_time_is_up_queues_itself_again() {
    let place = Place::new();
    place.program("etalon", PATIENT);
    place.program("scontrol", "echo \"$*\" >>\"$PLACE/scontrol.txt\"");
    let asked = place.path("scontrol.txt");
    let usr1 = rustix::process::Signal::USR1;
    let words = ["bash", "ci/slurm/array.sbatch"];
    let output = signalled(&place, &words, usr1, 4);
    assert_eq!(output.status.code(), Some(3), "{}", printed(&output));
    assert_eq!(fs::read_to_string(&asked).unwrap(), "requeue 7_2\n");
    // At most five times.
    fs::remove_file(&asked).unwrap();
    let output = signalled(&place, &words, usr1, 5);
    assert_eq!(output.status.code(), Some(3), "{}", printed(&output));
    assert!(!asked.exists());
}

/// The shell scripts of `ci/`.
fn scripts() -> Vec<PathBuf> {
    let mut folders = vec![root().join("ci")];
    let mut scripts = Vec::new();
    while let Some(folder) = folders.pop() {
        for entry in fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                folders.push(path);
            } else if fs::read(&path)
                .unwrap()
                .starts_with(b"#!/usr/bin/env bash\n")
            {
                scripts.push(path);
            }
        }
    }
    scripts
}

#[test]
fn a_userland_is_not_made_in_a_folder_with_foreign_files() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("own"), "kept").unwrap();
    let container = |arguments: &[&Path]| {
        let script = root().join("ci/container");
        let mut command = Command::new(script);
        let output = command
            .args(arguments)
            .env("ETALON", BINARY)
            .output()
            .unwrap();
        assert_eq!(output.status.code(), Some(64), "{}", printed(&output));
        String::from_utf8(output.stderr).unwrap()
    };
    assert!(container(&[]).starts_with("usage: "));
    assert!(container(&[Path::new("--help")]).starts_with("usage: "));
    let refused = container(&[folder.path()]);
    // Without root it gets no further.
    assert!(
        refused.contains("not what this script made") || refused.contains("needs root"),
        "{refused}"
    );
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1);
    let empty = tempfile::tempdir().unwrap();
    let refused = container(&[empty.path(), Path::new("cull/points")]);
    assert!(
        refused.contains("is no command of etalon") || refused.contains("needs root"),
        "{refused}"
    );
}

#[test]
fn shell_scripts_are_free_of_known_mistakes() {
    let scripts = scripts();
    assert!(scripts.len() >= 12, "{scripts:?}");
    for script in &scripts {
        let output = Command::new("bash").arg("-n").arg(script).output().unwrap();
        succeeds(&output);
    }
    // Only if shellcheck is installed; the shell's own check above always runs.
    if let Ok(output) = Command::new("shellcheck").args(&scripts).output() {
        succeeds(&output);
    }
}
