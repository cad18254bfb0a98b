//! What ends with a process that is killed: workers, what launchers start, servers.
#![expect(clippy::unwrap_used, reason = "a test that panics has failed")]

use crate::etalon::{BINARY, REMOVED, etalon};
use rustix::process::{Pid, Signal, kill_process};
use serde_json::{Value, json};
use std::fs;
use std::net::{TcpListener, TcpStream};
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::thread::sleep;
use std::time::{Duration, Instant};

/// The variable whose value is the folder of a test, in every process that the test starts.
const MARK: &str = "ETALON_TEST_FOLDER";
/// The longest wait for what begins.
const BEGIN: Duration = Duration::from_secs(60);
/// The longest wait for what ends by itself. Workers have 5 s.
const END: Duration = Duration::from_secs(20);

/// Returns the processes that a test has started and their command lines.
fn processes(folder: &Path) -> Vec<(i32, String)> {
    let mark = format!("{MARK}={}\0", folder.display());
    let entries = fs::read_dir("/proc").unwrap().flatten();
    let numbers = entries.filter_map(|entry| entry.file_name().to_str()?.parse().ok());
    let read = |number: i32, name: &str| {
        let bytes = fs::read(format!("/proc/{number}/{name}")).unwrap_or_default();
        String::from_utf8_lossy(&bytes).into_owned()
    };
    numbers
        .filter(|number| read(*number, "environ").contains(&mark))
        .map(|number| (number, read(number, "cmdline").replace('\0', " ")))
        .collect()
}

fn wait_until(folder: &Path, limit: Duration, what: &str, mut is_so: impl FnMut() -> bool) {
    let begun = Instant::now();
    while !is_so() {
        let left = processes(folder);
        assert!(begun.elapsed() < limit, "{what}: {left:#?}");
        sleep(Duration::from_millis(20));
    }
}

fn nothing_is_left(folder: &Path) {
    wait_until(folder, END, "processes are left", || {
        processes(folder).is_empty()
    });
}

/// Writes the description of one adapter, `there`.
fn described(folder: &Path, entry: &Value) {
    let mut entry = entry.clone();
    entry["name"] = json!("there");
    fs::write(folder.join("mine.json"), json!([entry]).to_string()).unwrap();
}

fn run(folder: &Path, adapter: &str) -> Child {
    let mut command = Command::new(BINARY);
    for name in REMOVED {
        command.env_remove(name);
    }
    command
        .args(["run", "cull/lines", "--timeout", "60", "--adapter", adapter])
        .arg("--adapters")
        .arg(folder.join("mine.json"))
        .arg("--out")
        .arg(folder.join("out"))
        .env(MARK, folder)
        .env("TMPDIR", folder)
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
        .unwrap()
}

fn kill(process: i32) {
    kill_process(Pid::from_raw(process).unwrap(), Signal::KILL).unwrap();
}

#[test]
fn processes_of_a_killed_run_end_wherever_they_hang() {
    let port = TcpListener::bind("127.0.0.1:0").unwrap();
    let address = port.local_addr().unwrap().to_string();
    drop(port);
    let sh = |script: &str| json!(["sh", "-c", script, "sh"]);
    let hangs = "touch \"$0\"; sleep 1000";
    for (what, entry, adapter, processes_due, word) in [
        (
            "a driver that is opened",
            json!({ "backend": "cpu" }),
            "there:fault=mute",
            2,
            "--open",
        ),
        (
            "a driver that draws",
            json!({ "backend": "cpu" }),
            "there:fault=hang",
            2,
            "--open",
        ),
        (
            "a worker that waits for a page",
            json!({ "backend": "webgpu", "listen": address }),
            "there",
            2,
            "listen",
        ),
        (
            "a launcher before its worker",
            json!({ "backend": "cpu", "launcher": sh("sleep 1000 & sleep 1001; exec \"$@\"") }),
            "there",
            4,
            "sleep 1001",
        ),
        (
            "a driver behind a launcher with a child",
            json!({ "backend": "cpu", "launcher": sh("sleep 1000 & \"$@\"; exit 3") }),
            "there:fault=mute",
            4,
            "worker --open",
        ),
        (
            "a driver with a server",
            json!({
                "backend": "cpu",
                "server": { "command": ["sh", "-c", hangs, "{socket}"], "socket": "/tmp/etalon-no-such" },
            }),
            "there:fault=hang",
            4,
            "sleep 1000",
        ),
    ] {
        let folder = tempfile::tempdir().unwrap();
        let folder = folder.path();
        let mut entry = entry.clone();
        if let Some(server) = entry.get_mut("server") {
            server["socket"] = json!(folder.join("known"));
        }
        described(folder, &entry);
        let mut run = run(folder, adapter);
        wait_until(folder, BEGIN, what, || {
            let started = processes(folder);
            let draws = !adapter.ends_with("hang") || folder.join("out/run.jsonl").exists();
            let is_due = started.iter().any(|(_, line)| line.contains(word));
            draws && is_due && started.len() >= processes_due
        });
        // A launcher's worker opens its driver after its greeting.
        sleep(Duration::from_millis(200));
        run.kill().unwrap();
        run.wait().unwrap();
        nothing_is_left(folder);
        // A process that is ending has no environment any more, but still its port.
        wait_until(folder, END, "the port is left", || {
            TcpListener::bind(&address).is_ok()
        });
    }
}

#[test]
fn a_server_ends_with_its_keeper_or_its_guard() {
    for killed in ["--keep", "--guard"] {
        let folder = tempfile::tempdir().unwrap();
        let folder = folder.path();
        // The shell has a child in the server's group.
        let script = "touch \"$0\"; sleep 1000 & sleep 1001; exit 3";
        let server = json!({
            "command": ["sh", "-c", script, "{socket}"],
            "socket": folder.join("known"),
        });
        described(folder, &json!({ "backend": "cpu", "server": server }));
        let mut run = run(folder, "there:fault=hang");
        wait_until(folder, BEGIN, "nothing is drawn", || {
            let sleeps = processes(folder);
            let sleeps = sleeps.iter().filter(|(_, line)| line.starts_with("sleep"));
            folder.join("out/run.jsonl").exists() && sleeps.count() == 2
        });
        let started = processes(folder);
        let keeper = started.iter().find(|(_, line)| line.contains(killed));
        kill(keeper.unwrap().0);
        wait_until(folder, END, "the server is left", || {
            let left = processes(folder);
            !left.iter().any(|(_, line)| line.starts_with("sleep 100"))
        });
        assert!(run.try_wait().unwrap().is_none(), "the run goes on");
        run.kill().unwrap();
        run.wait().unwrap();
        nothing_is_left(folder);
    }
}

#[test]
fn processes_that_a_launcher_leaves_end_with_the_run() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let script = "sleep 1000 & exec \"$@\"";
    described(
        folder,
        &json!({ "backend": "cpu", "launcher": ["sh", "-c", script, "sh"] }),
    );
    assert_eq!(run(folder, "there").wait().unwrap().code(), Some(0));
    nothing_is_left(folder);
    // A run that kills its worker kills the launcher's children too.
    let mut command = etalon(&["run", "cull/lines", "--timeout", "0.3", "--recheck", "off"]);
    command
        .args(["--adapter", "there:fault=hang", "--force", "--adapters"])
        .arg(folder.join("mine.json"))
        .arg("--out")
        .arg(folder.join("out"))
        .env(MARK, folder)
        .assert()
        .code(1);
    nothing_is_left(folder);
}

#[test]
fn one_signal_ends_the_wait_for_a_page() {
    for signal in [Signal::INT, Signal::TERM] {
        let folder = tempfile::tempdir().unwrap();
        let folder = folder.path();
        let port = TcpListener::bind("127.0.0.1:0").unwrap();
        let address = port.local_addr().unwrap().to_string();
        drop(port);
        described(folder, &json!({ "backend": "webgpu", "listen": address }));
        let mut run = run(folder, "there");
        wait_until(folder, BEGIN, "nobody listens", || {
            TcpStream::connect(&address).is_ok()
        });
        let asked = Instant::now();
        kill_process(Pid::from_child(&run), signal).unwrap();
        assert_eq!(run.wait().unwrap().code(), Some(3));
        assert!(asked.elapsed() < Duration::from_secs(10));
        nothing_is_left(folder);
    }
}
