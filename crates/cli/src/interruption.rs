//! Ctrl-C and termination, and the command that goes on afterwards.

use crate::failure::{Failure, INCOMPLETE};
use crate::provenance;
use std::sync::atomic::{AtomicBool, Ordering};

/// Set at the first Ctrl-C, or when the process is asked to terminate; a second one ends it at once.
pub(crate) fn listen() -> Result<&'static AtomicBool, Failure> {
    static STOP: AtomicBool = AtomicBool::new(false);
    ctrlc::set_handler(|| {
        if STOP.swap(true, Ordering::Relaxed) {
            std::process::exit(i32::from(INCOMPLETE));
        }
        eprintln!("\nstopping; once more to stop at once");
    })
    .map_err(|e| Failure::incomplete(format!("cannot listen for interrupts: {e}")))?;
    Ok(&STOP)
}

/// The command that goes on with this run.
pub(crate) fn how_to_resume() -> String {
    let own = provenance::command();
    let own = own.iter().map(String::as_str);
    let words = own.filter(|word| *word != "--force" && *word != "--resume");
    // An argument cannot hold the zero byte that no quoting helps.
    let command = shlex::try_join(words.chain(["--resume"])).unwrap_or_default();
    format!("go on with: {command}")
}
