//! The workers: this executable itself; an ignored test in it serves a faulty backend.
//!
//! libtest prints to standard output, so the protocol goes to descriptor 3.

use etalon_backend::{Backend, Unavailable};
use etalon_runner::{Launch, START_TIMEOUT, Setup};
use std::fs::{self, File, OpenOptions};
use std::io::{self, BufReader, Write};
use std::path::Path;

/// The variable with the adapter's name.
pub(crate) const NAME: &str = "ETALON_TEST_NAME";
/// The variable with the fault.
pub(crate) const FAULT: &str = "ETALON_TEST_FAULT";
/// The variable with a file that gets one line per start; numbers after it are starts that fail.
const STARTS: &str = "ETALON_TEST_STARTS";

/// The variable of a worker that a launcher starts.
pub(crate) const LAUNCHED: &str = "ETALON_TEST_LAUNCHED";
/// The request to such a worker.
pub(crate) const TO_OPEN: &str = "what to open";

/// The command that starts a worker by running an ignored test.
pub(crate) fn launch(test: &str, adapter: &str, fault: &str) -> Launch {
    let program = std::env::current_exe().unwrap();
    let script = r#"exec "$0" "$1" --exact --ignored --nocapture 3>&1 1>&2"#;
    Launch {
        adapter: adapter.to_owned(),
        program: "/bin/sh".into(),
        arguments: vec![
            "-c".to_owned(),
            script.to_owned(),
            program.to_str().unwrap().to_owned(),
            test.to_owned(),
        ],
        environment: [(NAME, adapter), (FAULT, fault)]
            .map(|(key, value)| (key.to_owned(), Some(value.to_owned())))
            .to_vec(),
        launcher: None,
        release: None,
        patience: START_TIMEOUT,
        alone: false,
    }
}

/// Counts a worker's starts in a file, and lets some of them fail.
pub(crate) fn fail_starts(launch: &mut Launch, file: &Path, failing: &str) {
    let starts = format!("{} {failing}", file.display());
    launch.environment.push((STARTS.to_owned(), Some(starts)));
}

/// The number of starts in such a file.
pub(crate) fn starts(file: &Path) -> usize {
    fs::read_to_string(file).unwrap().lines().count()
}

/// The worker's end of the pipe to the parent.
pub(crate) fn protocol() -> File {
    OpenOptions::new()
        .write(true)
        .open("/proc/self/fd/3")
        .unwrap()
}

/// Serves a backend, unless this start is one that fails.
pub(crate) fn serve(open: impl FnOnce() -> Result<Box<dyn Backend>, Unavailable>) {
    if let Ok(variable) = std::env::var(STARTS) {
        let (path, failing) = variable.split_once(' ').unwrap();
        let mut file = OpenOptions::new()
            .create(true)
            .append(true)
            .open(path)
            .unwrap();
        file.write_all(b"started\n").unwrap();
        let number = starts(Path::new(path));
        if failing.split(' ').any(|f| f.parse() == Ok(number)) {
            std::process::exit(9);
        }
    }
    if std::env::var_os(LAUNCHED).is_some() {
        let setup = Setup::receive(io::stdin().lock()).unwrap();
        assert_eq!((&*setup.open, setup.missing()), (TO_OPEN, Vec::new()));
    }
    let input = BufReader::new(io::stdin());
    etalon_runner::serve(open, input, &mut protocol()).unwrap();
}
