//! Browsers as adapters: which processes end with a run, what a lost browser costs, and a page that a person
//! opens.
#![expect(clippy::unwrap_used, reason = "a test that panics has failed")]

use crate::etalon::{BINARY, REMOVED, etalon};
use etalon_record::{Run, Verdict};
use rustix::process::{Pid, Signal, kill_process, kill_process_group};
use std::fs;
use std::io::{BufRead, BufReader};
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::thread::sleep;
use std::time::{Duration, Instant};

/// The longest wait for an event.
const LIMIT: Duration = Duration::from_secs(60);

fn wait_until(what: &str, mut is_so: impl FnMut() -> bool) {
    let begun = Instant::now();
    while !is_so() {
        assert!(begun.elapsed() < LIMIT, "{what}");
        sleep(Duration::from_millis(20));
    }
}

/// Starts a run on Chromium with the temporary folder `folder`.
fn started(folder: &Path, cases: &str) -> Child {
    let mut command = Command::new(BINARY);
    command
        .args([
            "run",
            cases,
            "--adapter",
            "webgpu:chromium",
            "--jobs",
            "1",
            "--out",
        ])
        .arg(folder.join("out"))
        .env("TMPDIR", folder)
        .stdout(Stdio::null())
        .stderr(Stdio::null());
    for name in REMOVED {
        command.env_remove(name);
    }
    command.spawn().unwrap()
}

/// Returns the number of records that a run has written.
fn records(folder: &Path) -> usize {
    let lines = fs::read(folder.join("out/run.jsonl")).unwrap_or_default();
    lines
        .iter()
        .filter(|byte| **byte == b'\n')
        .count()
        .saturating_sub(1)
}

/// Returns the processes whose own or parent's command line names a browser profile in `folder`.
fn browsers(folder: &Path) -> Vec<i32> {
    let profile = folder.join("etalon-browser-");
    let profile = profile.to_str().unwrap();
    let processes = fs::read_dir("/proc").unwrap().flatten();
    let numbers = processes.filter_map(|entry| entry.file_name().to_str()?.parse().ok());
    let names = |number: &i32| {
        let line = fs::read(format!("/proc/{number}/cmdline")).unwrap_or_default();
        String::from_utf8_lossy(&line).contains(profile)
    };
    numbers.filter(names).collect()
}

fn profiles(folder: &Path) -> usize {
    let entries = fs::read_dir(folder).unwrap().flatten();
    let is_profile = |name: &str| name.starts_with("etalon-browser-");
    entries
        .filter(|entry| entry.file_name().to_str().is_some_and(is_profile))
        .count()
}

fn nothing_is_left(folder: &Path) {
    wait_until("a browser is left", || browsers(folder).is_empty());
    wait_until("a profile is left", || profiles(folder) == 0);
}

#[test]
fn a_browser_and_its_profile_end_with_the_run() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    etalon(&[
        "run",
        "depth/compare",
        "--adapter",
        "webgpu:chromium",
        "--out",
    ])
    .arg(&out)
    .env("TMPDIR", folder.path())
    .assert()
    .code(0);
    let run = Run::read(&out).unwrap();
    assert!(
        run.records
            .iter()
            .all(|record| record.verdict == Verdict::Pass)
    );
    assert_eq!(run.header.adapters[0].info.driver, "Chromium");
    nothing_is_left(folder.path());
}

#[test]
fn a_killed_run_leaves_no_browser() {
    for signal in [Signal::INT, Signal::KILL] {
        let folder = tempfile::tempdir().unwrap();
        let mut run = started(folder.path(), "stencil/*");
        wait_until("nothing is drawn", || records(folder.path()) > 3);
        assert!(!browsers(folder.path()).is_empty());
        kill_process(Pid::from_child(&run), signal).unwrap();
        run.wait().unwrap();
        nothing_is_left(folder.path());
    }
}

/// Only the case that is being drawn is lost, and its recheck might find it right.
#[test]
fn a_lost_browser_costs_one_case() {
    let folder = tempfile::tempdir().unwrap();
    let mut run = started(folder.path(), "stencil/*");
    wait_until("nothing is drawn", || records(folder.path()) > 3);
    let first = browsers(folder.path()).into_iter().min().unwrap();
    kill_process_group(Pid::from_raw(first).unwrap(), Signal::KILL).unwrap();
    run.wait().unwrap();
    let run = Run::read(&folder.path().join("out")).unwrap();
    assert_eq!(run.missing(), 0);
    let bad: Vec<_> = run.records.iter().filter(|r| r.unexpected()).collect();
    assert!(bad.len() <= 1, "{bad:?}");
    for record in bad {
        let is_loss = [Verdict::Crash, Verdict::Flaky].contains(&record.verdict);
        assert!(is_loss, "{record:?}");
    }
    nothing_is_left(folder.path());
}

#[test]
fn the_browser_that_opens_the_page_becomes_the_adapter() {
    let folder = tempfile::tempdir().unwrap();
    let port = std::net::TcpListener::bind("127.0.0.1:0").unwrap();
    let address = port.local_addr().unwrap();
    drop(port);
    let file = folder.path().join("adapters.json");
    let entry =
        format!(r#"[{{ "name": "webgpu:mine", "backend": "webgpu", "listen": "{address}" }}]"#);
    fs::write(&file, entry).unwrap();
    let mut command = Command::new(BINARY);
    // A second worker draws failures again; the first one must release the page to it.
    command
        .args([
            "run",
            "depth/compare",
            "paths/bias",
            "--adapter",
            "webgpu:mine",
            "--jobs",
            "2",
        ])
        .arg("--adapters")
        .arg(&file)
        .arg("--out")
        .arg(folder.path().join("out"))
        .stdout(Stdio::null())
        .stderr(Stdio::piped());
    for name in REMOVED {
        command.env_remove(name);
    }
    let mut run = command.spawn().unwrap();
    let mut lines = BufReader::new(run.stderr.take().unwrap()).lines();
    let line = lines.by_ref().find_map(|line| {
        let line = line.unwrap();
        let (_, url) = line.split_once("open ")?;
        Some(url.split(' ').next()?.to_owned())
    });
    let url = line.unwrap();
    std::thread::spawn(move || lines.for_each(drop));
    let profile = folder.path().join("profile");
    let mut browser = Command::new("chromium");
    browser
        .args([
            "--headless",
            "--no-sandbox",
            "--disable-dev-shm-usage",
            "--enable-unsafe-webgpu",
        ])
        .arg("--use-webgpu-adapter=swiftshader")
        .arg(format!("--user-data-dir={}", profile.display()))
        .arg(url)
        .stdout(Stdio::null())
        .stderr(Stdio::null());
    std::os::unix::process::CommandExt::process_group(&mut browser, 0);
    let mut browser = browser.spawn().unwrap();
    let ended = run.wait().unwrap();
    kill_process_group(Pid::from_child(&browser), Signal::KILL).unwrap();
    browser.wait().unwrap();
    let run = Run::read(&folder.path().join("out")).unwrap();
    assert_eq!(run.missing(), 0);
    // No finding names this adapter, so the bias of depth16unorm is new, and a new worker drew it again.
    assert_eq!(ended.code(), Some(1));
    let (right, wrong): (Vec<_>, Vec<_>) = run
        .records
        .iter()
        .filter(|r| r.verdict != Verdict::NotSupported)
        .partition(|r| r.verdict == Verdict::Pass);
    assert!(!right.is_empty(), "{wrong:?}");
    assert!(
        !wrong.is_empty() && wrong.iter().all(|r| r.verdict == Verdict::Fail),
        "{wrong:?}"
    );
}
