//! Building and running the program of a bundle, as its reader will.

use crate::failure::Failure;
use crate::output::say;
use etalon_runner::Launch;
use std::fs::{self, File};
use std::io;
use std::path::Path;
use std::process::{Command, ExitStatus, Stdio};
use std::thread::sleep;
use std::time::{Duration, Instant};

/// The C compiler.
const COMPILER: &str = "cc";
/// How often a running program is looked at.
const PAUSE: Duration = Duration::from_millis(5);

/// A program that was built and run.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Run {
    /// The exit status; `None` if a signal or its time ended it.
    pub(crate) status: Option<i32>,
    /// How it ended, in words.
    pub(crate) ending: String,
    /// The last line that it wrote.
    pub(crate) line: String,
}

/// Builds a C program in a folder of its own and runs it as a driver's worker is run. Returns `None`, and says why, if
/// nothing can be built here or the driver is elsewhere.
pub(crate) fn built_and_run(
    source: &str,
    launch: &Launch,
    timeout: Duration,
) -> Result<Option<Run>, Failure> {
    if launch.launcher.is_some() {
        say!("the program is not run here: a launcher starts the driver");
        return Ok(None);
    }
    let failed = |e: io::Error| Failure::incomplete(format!("cannot build the program: {e}"));
    let folder = tempfile::tempdir().map_err(failed)?;
    let (file, program) = (folder.path().join("repro.c"), folder.path().join("repro"));
    fs::write(&file, source).map_err(failed)?;
    let compiled = Command::new(COMPILER)
        .arg(&file)
        .args(["-ldl", "-o"])
        .arg(&program)
        .stdin(Stdio::null())
        .output();
    let output = match compiled {
        Ok(output) => output,
        Err(e) if e.kind() == io::ErrorKind::NotFound => {
            say!("the program is not built here: there is no C compiler `{COMPILER}`");
            return Ok(None);
        }
        Err(e) => return Err(failed(e)),
    };
    if !output.status.success() {
        let text = String::from_utf8_lossy(&output.stderr);
        let line = text.lines().next().unwrap_or_default();
        return Err(Failure::incomplete(format!(
            "the program does not compile: {line}"
        )));
    }
    run(&program, folder.path(), launch, timeout)
        .map(Some)
        .map_err(failed)
}

/// Runs a program in the environment of a driver.
fn run(program: &Path, folder: &Path, launch: &Launch, timeout: Duration) -> io::Result<Run> {
    let out = folder.join("out");
    let mut command = Command::new(program);
    for (name, value) in &launch.environment {
        match value {
            Some(value) => command.env(name, value),
            None => command.env_remove(name),
        };
    }
    let mut child = command
        .current_dir(folder)
        .stdin(Stdio::null())
        .stdout(File::create(&out)?)
        .stderr(Stdio::null())
        .spawn()?;
    let begun = Instant::now();
    let ended = loop {
        if let Some(status) = child.try_wait()? {
            break Some(status);
        }
        if begun.elapsed() >= timeout {
            child.kill()?;
            child.wait()?;
            break None;
        }
        sleep(PAUSE);
    };
    let text = fs::read(&out)?;
    let text = String::from_utf8_lossy(&text);
    Ok(Run {
        status: ended.and_then(|status| status.code()),
        ending: ended.map_or_else(
            || format!("no end within {} s", timeout.as_secs_f64()),
            |status: ExitStatus| status.to_string(),
        ),
        line: text.lines().last().unwrap_or_default().to_owned(),
    })
}
