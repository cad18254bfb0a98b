//! Builds and runs the program of a bundle, as the recipient of the bundle will.

use crate::failure::Failure;
use crate::output::say;
use etalon_adapters::guard;
use etalon_bundle::{File, Language, Program};
use etalon_process::ProcessGroup;
use etalon_runner::Launch;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};
use std::process::{Command, ExitStatus, Stdio};
use std::thread::sleep;
use std::time::{Duration, Instant};

/// The pause between looks at a running program.
const PAUSE: Duration = Duration::from_millis(5);
/// The suite's lock file, so that programs use the dependency versions whose calls are recorded.
const LOCK: &str = include_str!("../data/Cargo.lock");

/// A program that was built and run.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct ProgramRun {
    /// The exit status; `None` if a signal or the timeout ended it.
    pub(crate) status: Option<i32>,
    /// A text for the exit status or the timeout.
    pub(crate) ending: String,
    /// The last line of the program's output.
    pub(crate) line: String,
    /// Files that the build made and that belong to the program.
    pub(crate) made: Vec<File>,
}

/// Builds a program in its own folder and runs it in the environment of the driver's worker. Returns `None`,
/// and prints the reason, if it cannot be built here or a launcher starts the driver.
pub(crate) fn built_and_run(
    program: &Program,
    launch: &Launch,
    timeout: Duration,
) -> Result<Option<ProgramRun>, Failure> {
    if launch.launcher.is_some() {
        say!("the program is not run here: a launcher starts the driver");
        return Ok(None);
    }
    let failed = |e: io::Error| Failure::incomplete(format!("cannot build the program: {e}"));
    let folder = tempfile::tempdir().map_err(failed)?;
    let folder = folder.path();
    let made = match program.language {
        Language::C => built_c(program, folder),
        Language::Rust => built_rust(program, folder),
        Language::Page => Err(Unbuilt::Here(
            "it is a page; open repro.html in the browser".to_owned(),
        )),
    };
    match made {
        Ok(made) => {
            let ran = run(folder, launch, timeout).map_err(failed)?;
            Ok(Some(ProgramRun { made, ..ran }))
        }
        Err(Unbuilt::Here(why)) => {
            say!("the program is not built here: {why}");
            Ok(None)
        }
        Err(Unbuilt::Wrong { line, .. }) => Err(Failure::incomplete(format!(
            "the program does not compile: {line}"
        ))),
        Err(Unbuilt::Io(e)) => Err(failed(e)),
    }
}

/// The reason why a program was not built.
enum Unbuilt {
    /// This machine lacks something.
    Here(String),
    /// The compiler refuses the program.
    Wrong {
        /// The first line that names an error.
        line: String,
        /// True if cargo failed only because it was offline.
        offline: bool,
    },
    Io(io::Error),
}

impl From<io::Error> for Unbuilt {
    fn from(error: io::Error) -> Self {
        Self::Io(error)
    }
}

/// Builds a C program as `repro` in a folder.
fn built_c(program: &Program, folder: &Path) -> Result<Vec<File>, Unbuilt> {
    written(program, folder)?;
    let mut compiler = Command::new("cc");
    compiler.args(["repro.c", "-ldl", "-o", "repro"]);
    compiled(compiler.current_dir(folder))?;
    Ok(Vec::new())
}

/// Builds a Rust package, and copies its program to `repro` in a folder. All programs are built in the same
/// folder, one after another, so that their dependencies are compiled once. Returns the lock file.
fn built_rust(program: &Program, folder: &Path) -> Result<Vec<File>, Unbuilt> {
    let place = place().unwrap_or_else(|| folder.to_owned());
    let package = place.join("package");
    fs::create_dir_all(&package)?;
    let lock = fs::File::create(place.join("lock"))?;
    lock.lock()?;
    written(program, &package)?;
    fs::write(package.join("Cargo.lock"), LOCK)?;
    let mut cargo = Command::new("cargo");
    cargo
        .args(["build", "--offline", "--target-dir"])
        .arg(place.join("target"))
        .env("CARGO_INCREMENTAL", "0")
        .env("CARGO_PROFILE_DEV_DEBUG", "0");
    match compiled(cargo.current_dir(&package)) {
        // Missing dependencies are not the program's fault.
        Err(Unbuilt::Wrong {
            line,
            offline: true,
        }) => return Err(Unbuilt::Here(line)),
        other => other?,
    }
    fs::copy(place.join("target/debug/repro"), folder.join("repro"))?;
    let about = "the versions of its dependencies";
    let lock = fs::read(package.join("Cargo.lock"))?;
    Ok(vec![File::new("Cargo.lock", about, lock)])
}

fn written(program: &Program, folder: &Path) -> io::Result<()> {
    let mut files = program.files.iter();
    files.try_for_each(|file| fs::write(folder.join(&file.name), &file.content))
}

/// Runs a compiler.
fn compiled(command: &mut Command) -> Result<(), Unbuilt> {
    let name = command.get_program().display().to_string();
    let output = match command.stdin(Stdio::null()).output() {
        Err(e) if e.kind() == io::ErrorKind::NotFound => {
            return Err(Unbuilt::Here(format!("there is no `{name}`")));
        }
        other => other?,
    };
    if output.status.success() {
        return Ok(());
    }
    let text = String::from_utf8_lossy(&output.stderr);
    let first = text.lines().find(|line| line.contains("error"));
    Err(Unbuilt::Wrong {
        line: first.unwrap_or_default().to_owned(),
        offline: text.contains("--offline"),
    })
}

/// Returns the folder in which packages are built: in cargo's target folder if the environment names one,
/// otherwise in the user's cache folder.
fn place() -> Option<PathBuf> {
    let set = |name: &str| std::env::var_os(name).filter(|value| !value.is_empty());
    if let Some(folder) = set("CARGO_TARGET_DIR") {
        return Some(std::path::absolute(folder).ok()?.join("etalon-programs"));
    }
    let caches = set("XDG_CACHE_HOME").map(PathBuf::from);
    let caches = caches.or_else(|| Some(PathBuf::from(set("HOME")?).join(".cache")))?;
    Some(caches.join("etalon/programs"))
}

/// Runs the program in a folder with the environment of a driver.
fn run(folder: &Path, launch: &Launch, timeout: Duration) -> io::Result<ProgramRun> {
    let out = folder.join("out");
    let program = folder.join("repro");
    // Windows ends the program by its job object.
    let mut command = if cfg!(unix) {
        let mut guard = guard(false)?;
        guard.arg(program);
        guard
    } else {
        Command::new(program)
    };
    for (name, value) in &launch.environment {
        match value {
            Some(value) => command.env(name, value),
            None => command.env_remove(name),
        };
    }
    command
        .current_dir(folder)
        // The end of this pipe shows that this process ended.
        .stdin(Stdio::piped())
        .stdout(fs::File::create(&out)?)
        .stderr(Stdio::null());
    let (mut child, group) = ProcessGroup::start(&mut command)?;
    let begun = Instant::now();
    let ended = loop {
        if let Some(status) = child.try_wait()? {
            break Some(status);
        }
        if begun.elapsed() >= timeout {
            group.kill();
            child.wait()?;
            break None;
        }
        sleep(PAUSE);
    };
    group.kill();
    let text = fs::read(&out)?;
    let text = String::from_utf8_lossy(&text);
    Ok(ProgramRun {
        status: ended.and_then(|status| status.code()),
        ending: ended.map_or_else(
            || format!("no end within {} s", timeout.as_secs_f64()),
            |status: ExitStatus| status.to_string(),
        ),
        line: text.lines().last().unwrap_or_default().to_owned(),
        made: Vec::new(),
    })
}
