//! Runs `etalon bundle`, and the programs that it writes.
#![expect(clippy::unwrap_used, reason = "a test that panics has failed")]

use crate::etalon::etalon;
use serde_json::Value;
use std::path::Path;
use std::process::{Command, Output};
use std::time::Duration;

/// The folder in which Rust packages are compiled, so that their dependencies are compiled once.
pub(crate) const PROGRAMS: &str = env!("CARGO_TARGET_TMPDIR");

/// The time limit of a bundle; the first one compiles wgpu.
const FIRST: Duration = Duration::from_secs(600);

/// Bundles a case. Returns the exit code, the summary and the error output.
pub(crate) fn bundle(case: &str, adapter: &str, out: &Path, more: &[&str]) -> (i32, Value, String) {
    let out = out.to_str().unwrap();
    let base = [
        "bundle",
        case,
        "--adapter",
        adapter,
        "--format",
        "json",
        "--out",
        out,
    ];
    let output = etalon(&[&base, more].concat())
        .env("CARGO_TARGET_DIR", PROGRAMS)
        .timeout(FIRST)
        .output()
        .unwrap();
    let summary = serde_json::from_slice(&output.stdout).unwrap_or(Value::Null);
    let error = String::from_utf8(output.stderr).unwrap();
    (output.status.code().unwrap(), summary, error)
}

pub(crate) fn last_line(output: &Output) -> String {
    let text = String::from_utf8_lossy(&output.stdout);
    text.lines().last().unwrap_or_default().to_owned()
}

/// Runs the command that a report gives, in the program's folder.
pub(crate) fn run_as_told(report: &str, folder: &Path) -> Output {
    let mut lines = report.lines();
    let line = lines.find(|line| line.ends_with("./repro")).unwrap();
    let shell = ["-c", line];
    let mut command = Command::new("sh");
    command.args(shell).current_dir(folder).output().unwrap()
}
