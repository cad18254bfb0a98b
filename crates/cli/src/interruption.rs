//! Interruption by the user or the system, and the command that resumes the run.

use crate::failure::{Failure, INCOMPLETE};
use crate::output::say;
use crate::provenance;
use std::sync::atomic::{AtomicBool, Ordering};

/// Returns a flag that the first SIGINT or SIGTERM sets; a second one ends the process immediately.
pub(crate) fn listen() -> Result<&'static AtomicBool, Failure> {
    static STOP: AtomicBool = AtomicBool::new(false);
    ctrlc::set_handler(|| {
        if STOP.swap(true, Ordering::Relaxed) {
            std::process::exit(i32::from(INCOMPLETE));
        }
        say!("\nstopping; interrupt again to stop immediately");
    })
    .map_err(|e| Failure::incomplete(format!("cannot handle signals: {e}")))?;
    Ok(&STOP)
}

/// Returns the command that resumes this run, quoted for a shell.
pub(crate) fn how_to_resume() -> String {
    let command = provenance::command();
    let arguments = command.iter().map(String::as_str);
    let words = arguments.filter(|word| *word != "--force" && *word != "--resume");
    // Quoting fails only on a zero byte, which no argument contains.
    let command = shlex::try_join(words.chain(["--resume"])).unwrap_or_default();
    format!("resume with: {command}")
}
