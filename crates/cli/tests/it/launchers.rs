//! Workers behind launchers: other roots, other loaders, lost environments, another machine's shell.
#![expect(clippy::unwrap_used, reason = "a test that panics has failed")]

use crate::etalon::etalon;
use etalon_record::{Release, Run, Verdict};
use serde_json::{Value, json};
use std::fs;
use std::os::unix::fs::PermissionsExt as _;
use std::path::{Path, PathBuf};
use std::process::Command;
use tempfile::TempDir;

/// A case that every adapter supports.
const CASE: &str = "depth/clear/clear=1/format=depth32float";
const BINARY: &str = env!("CARGO_BIN_EXE_etalon");

/// Writes a file with one adapter, `there`, with some additional keys.
fn described(folder: &Path, entry: &Value) -> PathBuf {
    let mut entry = entry.clone();
    entry["name"] = json!("there");
    let path = folder.join("mine.json");
    fs::write(&path, json!([entry]).to_string()).unwrap();
    path
}

/// Runs the case through a launcher and reads the run.
fn run(entry: &Value) -> Run {
    let folder = tempfile::tempdir().unwrap();
    let file = described(folder.path(), entry);
    let out = folder.path().join("out");
    let mut command = etalon(&["run", CASE, "--adapter", "there", "--adapters"]);
    command.arg(file).arg("--out").arg(&out);
    command.assert().code(0);
    let run = Run::read(&out).unwrap();
    assert_eq!(run.records.len(), 1);
    assert_eq!(run.records[0].verdict, Verdict::Pass);
    run
}

/// Returns the message that refuses a launcher, before anything is written.
fn refused(entry: &Value) -> String {
    let folder = tempfile::tempdir().unwrap();
    let file = described(folder.path(), entry);
    let out = folder.path().join("out");
    let mut command = etalon(&["run", CASE, "--adapter", "there", "--adapters"]);
    command.arg(file).arg("--out").arg(&out);
    let assert = command.assert().code(64);
    assert!(!out.exists());
    let text = String::from_utf8(assert.get_output().stderr.clone()).unwrap();
    text.replace(folder.path().to_str().unwrap(), "[folder]")
}

/// The command that makes a process root of its own user namespace, if it is not root already.
fn as_root() -> Vec<&'static str> {
    if rustix::process::geteuid().is_root() {
        vec!["unshare", "--mount"]
    } else {
        vec!["unshare", "--map-root-user", "--mount"]
    }
}

/// A folder with only this program and all libraries that it needs.
fn root() -> TempDir {
    let root = tempfile::tempdir().unwrap();
    let output = Command::new("ldd").arg(BINARY).output().unwrap();
    let text = String::from_utf8(output.stdout).unwrap();
    let libraries = text.split_whitespace().filter(|word| word.starts_with('/'));
    for library in libraries {
        let to = root.path().join(library.trim_start_matches('/'));
        fs::create_dir_all(to.parent().unwrap()).unwrap();
        fs::copy(library, to).unwrap();
    }
    fs::copy(BINARY, root.path().join("etalon")).unwrap();
    root
}

#[test]
fn a_worker_runs_in_a_namespace_of_its_own() {
    let run = run(&json!({
        "backend": "gl", "launcher": as_root(), "answers": "llvmpipe", "line": "mesa", "version": "22.3.6",
        "environment": { "LIBGL_ALWAYS_SOFTWARE": "1", "GALLIUM_DRIVER": "llvmpipe" },
    }));
    let release = Release {
        line: "mesa".to_owned(),
        version: "22.3.6".to_owned(),
    };
    assert_eq!(run.header.adapters[0].release, Some(release));
}

#[test]
fn a_worker_runs_under_another_root() {
    let root = root();
    let mut launcher = as_root();
    launcher.extend(["chroot", root.path().to_str().unwrap()]);
    run(&json!({ "backend": "cpu", "launcher": launcher, "program": "/etalon" }));
}

#[test]
fn a_worker_runs_by_another_loader() {
    let root = root();
    let loader = ["lib64/ld-linux-x86-64.so.2", "lib/ld-linux-aarch64.so.1"]
        .map(|name| root.path().join(name))
        .into_iter()
        .find(|path| path.exists());
    let libraries = fs::read_dir(root.path().join("lib")).unwrap();
    let libraries: Vec<String> = libraries
        .map(|entry| entry.unwrap().path().display().to_string())
        .collect();
    let loader = loader.unwrap();
    let path = libraries.join(":");
    run(&json!({ "backend": "cpu", "launcher": [loader, "--library-path", path] }));
}

#[test]
fn a_worker_gets_its_environment_even_if_the_launcher_drops_it() {
    // Without its variables, a different driver would answer.
    run(&json!({
        "backend": "gl", "launcher": ["env", "-i"], "answers": "llvmpipe",
        "environment": { "LIBGL_ALWAYS_SOFTWARE": "1", "GALLIUM_DRIVER": "llvmpipe" },
    }));
}

/// A server that ssh itself starts, without a port, and the command that reaches it.
fn ssh(folder: &Path) -> Vec<String> {
    let key = |name: &str| {
        let path = folder.join(name);
        let mut command = Command::new("ssh-keygen");
        command.args(["-q", "-t", "ed25519", "-N", "", "-f"]);
        assert!(command.arg(&path).status().unwrap().success());
        path
    };
    let (host, user) = (key("host"), key("user"));
    let accepted = folder.join("accepted");
    fs::copy(user.with_extension("pub"), &accepted).unwrap();
    fs::set_permissions(&accepted, fs::Permissions::from_mode(0o600)).unwrap();
    let settings = folder.join("settings");
    let text = format!(
        "HostKey {}\nAuthorizedKeysFile {}\nStrictModes no\nUsePAM no\nPermitRootLogin yes\n",
        host.display(),
        accepted.display()
    );
    fs::write(&settings, text).unwrap();
    let server = format!("ProxyCommand=/usr/sbin/sshd -i -f {}", settings.display());
    let words = ["ssh", "-F", "none", "-q", "-o", &server, "-o"].map(str::to_owned);
    let mut words = words.to_vec();
    words.extend(
        [
            "StrictHostKeyChecking=no",
            "-o",
            "UserKnownHostsFile=/dev/null",
            "-i",
        ]
        .map(str::to_owned),
    );
    words.push(user.display().to_string());
    words.push("there".to_owned());
    words
}

#[test]
fn a_worker_runs_behind_a_remote_shell() {
    let folder = tempfile::tempdir().unwrap();
    // Normally the system's daemon makes it.
    let _ = fs::create_dir("/run/sshd");
    let run = run(&json!({
        "backend": "gl", "launcher": ssh(folder.path()), "answers": "llvmpipe",
        "environment": { "LIBGL_ALWAYS_SOFTWARE": "1", "GALLIUM_DRIVER": "llvmpipe" },
    }));
    assert_eq!(run.header.adapters[0].release, None);
}

#[test]
fn errors_of_a_launcher_are_named() {
    for (launcher, word) in [
        (
            json!(["/nowhere/podman", "run"]),
            "the launcher `/nowhere/podman` cannot be started",
        ),
        (
            json!(["echo", "Welcome"]),
            "in place of a greeting; a launcher must not print anything",
        ),
        (
            json!(["sh", "-c", "echo no route to host >&2; exit 255"]),
            "no route to host",
        ),
        (
            json!(["sh", "-c", "echo 'etalon worker 0.0.1, protocol 1'"]),
            "start the same program there",
        ),
        (
            json!(["${NOBODY_SETS_THIS}"]),
            "the variable NOBODY_SETS_THIS is not set",
        ),
    ] {
        let message = refused(&json!({ "backend": "cpu", "launcher": launcher }));
        assert!(message.contains(word), "{launcher}: {message}");
        assert!(
            message.contains("[folder]/mine.json: entry `there`"),
            "{message}"
        );
    }
}

#[test]
fn an_adapter_says_how_it_is_launched() {
    let folder = tempfile::tempdir().unwrap();
    let file = described(
        folder.path(),
        &json!({ "backend": "cpu", "launcher": ["env"] }),
    );
    let mut command = etalon(&["adapters", "--format", "json", "--adapters"]);
    let assert = command.arg(file).assert().code(0);
    let adapters: Value = serde_json::from_slice(&assert.get_output().stdout).unwrap();
    let adapter = adapters
        .as_array()
        .unwrap()
        .iter()
        .find(|a| a["name"] == "there");
    assert_eq!(adapter.unwrap()["launcher"], json!(["env"]));
}
