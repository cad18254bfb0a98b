//! Interruption by the user or the system, and the command that resumes the run.

use crate::failure::{Failure, INCOMPLETE};
use crate::output::say;
use crate::provenance;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};

/// The number of [`OpeningGuard`]s.
static OPENING: AtomicUsize = AtomicUsize::new(0);

/// Returns a flag that the first SIGINT or SIGTERM sets; a second one ends the process immediately, and so does the
/// first while adapters are opened.
pub(crate) fn listen() -> Result<&'static AtomicBool, Failure> {
    static STOP: AtomicBool = AtomicBool::new(false);
    ctrlc::set_handler(|| {
        let is_opening = OPENING.load(Ordering::Relaxed) > 0;
        if is_opening {
            say!("\ninterrupted while adapters are opened");
        }
        if is_opening || STOP.swap(true, Ordering::Relaxed) {
            std::process::exit(i32::from(INCOMPLETE));
        }
        say!("\nstopping; interrupt again to stop immediately");
    })
    .map_err(|e| Failure::incomplete(format!("cannot handle signals: {e}")))?;
    Ok(&STOP)
}

/// Exists while adapters are opened, which can take minutes and leaves nothing to finish.
pub(crate) struct OpeningGuard(());

impl OpeningGuard {
    pub(crate) fn begin() -> Self {
        OPENING.fetch_add(1, Ordering::Relaxed);
        Self(())
    }
}

impl Drop for OpeningGuard {
    fn drop(&mut self) {
        OPENING.fetch_sub(1, Ordering::Relaxed);
    }
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
