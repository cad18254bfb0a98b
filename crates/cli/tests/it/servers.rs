//! Servers of drivers: they end with the run, a server that dies is named in the records, and another server's socket
//! is left alone.
#![expect(clippy::unwrap_used, reason = "a test that panics has failed")]

use crate::etalon::{BINARY, REMOVED, etalon};
use assert_cmd::assert::Assert;
use etalon_record::{Run, Verdict};
use rustix::process::{Pid, Signal, kill_process};
use std::fs;
use std::os::unix::net::UnixListener;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::thread::sleep;
use std::time::{Duration, Instant};

/// The time limit of each wait.
const LIMIT: Duration = Duration::from_secs(60);

fn wait_until(what: &str, mut is_so: impl FnMut() -> bool) {
    let begun = Instant::now();
    while !is_so() {
        assert!(begun.elapsed() < LIMIT, "{what}");
        sleep(Duration::from_millis(20));
    }
}

fn stderr(assert: &Assert) -> String {
    String::from_utf8_lossy(&assert.get_output().stderr).into_owned()
}

/// Writes an adapter's description: the rasterizer, with a shell script as its server. In the script, `$0` is the
/// socket.
fn write_description(folder: &Path, script: &str) -> PathBuf {
    let entry = serde_json::json!([{
        "name": "served",
        "backend": "cpu",
        "server": { "command": ["sh", "-c", script, "{socket}"], "socket": folder.join("known") },
    }]);
    let file = folder.join("adapters.json");
    fs::write(&file, entry.to_string()).unwrap();
    file
}

/// Returns the number of processes whose command line names a server's folder in `folder`.
fn server_count(folder: &Path) -> usize {
    let socket = folder.join("etalon-server-");
    let socket = socket.to_str().unwrap();
    let processes = fs::read_dir("/proc").unwrap().flatten();
    let names = |entry: &fs::DirEntry| {
        let line = fs::read(entry.path().join("cmdline")).unwrap_or_default();
        String::from_utf8_lossy(&line).contains(socket)
    };
    processes.filter(names).count()
}

fn nothing_is_left(folder: &Path) {
    wait_until("a server is left", || server_count(folder) == 0);
    let is_server = |entry: fs::DirEntry| {
        let name = entry.file_name();
        name.to_str().unwrap().starts_with("etalon-server-")
    };
    wait_until("a folder is left", || {
        !fs::read_dir(folder).unwrap().flatten().any(is_server)
    });
    assert!(fs::symlink_metadata(folder.join("known")).is_err());
}

#[test]
fn a_server_ends_with_the_run() {
    let folder = tempfile::tempdir().unwrap();
    etalon(&["run", "stencil/compare", "--profile", "full", "--jobs", "2"])
        .args(["--adapter", "gl:virgl", "--adapter", "gl:es:virgl", "--out"])
        .arg(folder.path().join("out"))
        .env("TMPDIR", folder.path())
        .assert()
        .code(0);
    let run = Run::read(&folder.path().join("out")).unwrap();
    let passed = |name: &str| {
        let records = run.records.iter().filter(|record| record.adapter == name);
        records
            .filter(|record| record.verdict == Verdict::Pass)
            .count()
    };
    assert!(passed("gl:virgl") > 4 && passed("gl:es:virgl") > 4);
    nothing_is_left(folder.path());
}

#[test]
fn a_killed_run_leaves_no_server() {
    for signal in [Signal::INT, Signal::KILL] {
        let folder = tempfile::tempdir().unwrap();
        let file = write_description(folder.path(), "touch \"$0\"; sleep 1000");
        let mut command = Command::new(BINARY);
        command
            .args(["run", "stencil/compare", "--adapter", "served:fault=hang"])
            .arg("--adapters")
            .arg(file)
            .arg("--out")
            .arg(folder.path().join("out"))
            .env("TMPDIR", folder.path())
            .stdout(Stdio::null())
            .stderr(Stdio::null());
        for name in REMOVED {
            command.env_remove(name);
        }
        let mut run = command.spawn().unwrap();
        wait_until("nothing is drawn", || {
            folder.path().join("out/run.jsonl").exists() && server_count(folder.path()) > 0
        });
        kill_process(Pid::from_child(&run), signal).unwrap();
        run.wait().unwrap();
        nothing_is_left(folder.path());
    }
}

#[test]
fn a_server_that_ends_is_named_in_the_records() {
    let folder = tempfile::tempdir().unwrap();
    // The server ends once a worker has seen its socket.
    let script = format!(
        "touch \"$0\"; until [ -e {}.lock ]; do :; done; echo broken >&2; exit 3",
        folder.path().join("known").display()
    );
    let file = write_description(folder.path(), &script);
    let out = folder.path().join("out");
    etalon(&["run", "stencil/compare", "--adapter", "served:fault=abort"])
        .arg("--adapters")
        .arg(&file)
        .arg("--out")
        .arg(&out)
        .assert()
        .code(1);
    let run = Run::read(&out).unwrap();
    let stderrs = run
        .records
        .iter()
        .filter_map(|record| record.process.as_ref());
    let stderrs: Vec<&str> = stderrs.map(|end| end.stderr.as_str()).collect();
    let message = "the server sh has ended: exit status: 3";
    assert!(
        stderrs
            .iter()
            .any(|text| text.contains("broken") && text.contains(message)),
        "{stderrs:?}"
    );
}

#[test]
fn a_server_that_does_not_listen_makes_its_adapter_unavailable() {
    let folder = tempfile::tempdir().unwrap();
    let file = write_description(folder.path(), "exit 3");
    let assert = etalon(&["run", "stencil/compare", "--adapter", "served"])
        .arg("--adapters")
        .arg(&file)
        .assert()
        .code(64);
    let said = stderr(&assert);
    assert!(
        said.contains("the server sh ends before it listens"),
        "{said}"
    );
}

#[test]
fn the_path_of_another_server_is_left_alone() {
    let folder = tempfile::tempdir().unwrap();
    let file = write_description(folder.path(), "touch \"$0\"; sleep 1000");
    let known = folder.path().join("known");
    let run = || {
        etalon(&["run", "stencil/compare", "--adapter", "served"])
            .arg("--adapters")
            .arg(&file)
            .arg("--out")
            .arg(folder.path().join("out"))
            .env("TMPDIR", folder.path())
            .assert()
    };
    let listener = UnixListener::bind(&known).unwrap();
    let said = stderr(&run().code(64));
    assert!(said.contains("another server is at"), "{said}");
    assert!(known.exists());
    // A killed server leaves its socket, which nobody listens to.
    drop(listener);
    assert!(known.exists());
    run().code(0);
    nothing_is_left(folder.path());
}
