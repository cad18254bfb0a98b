//! Measuring and limiting the memory that a process uses.
//!
//! The parent polls instead of setting `RLIMIT_AS`, because drivers reserve address space that they never
//! use.

use crate::sync::lock;
use std::fs;
use std::io;
use std::process::Child;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::{Arc, Mutex};
use std::thread;
use std::time::Duration;

/// The interval between two readings of a worker's memory.
const INTERVAL: Duration = Duration::from_millis(50);

/// A memory limit on a process, which is killed if it exceeds the limit.
#[derive(Debug)]
pub(crate) struct MemoryLimit {
    /// The limit in MiB.
    limit: u64,
    /// The MiB used when the process was killed; 0 before.
    held: Arc<AtomicU64>,
}

impl MemoryLimit {
    /// Watches a process until `ended` is set. Does nothing if the system does not report the process's
    /// memory.
    ///
    /// # Errors
    /// If the system refuses a thread.
    pub(crate) fn watch(
        child: Arc<Mutex<Child>>,
        limit: u64,
        ended: Arc<AtomicBool>,
    ) -> io::Result<Self> {
        let held = Arc::<AtomicU64>::default();
        let exceeded = Arc::clone(&held);
        let id = lock(&child).id();
        thread::Builder::new().spawn(move || {
            while !ended.load(Ordering::Relaxed) {
                let Some(now) = held_by(id) else { return };
                if now > limit {
                    exceeded.store(now, Ordering::Relaxed);
                    // The process may have ended already; then there is nothing to kill.
                    let _ = lock(&child).kill();
                    return;
                }
                thread::sleep(INTERVAL);
            }
        })?;
        Ok(Self { limit, held })
    }

    /// Returns the memory used and the limit in MiB, if the process was killed for exceeding it.
    pub(crate) fn exceeded(&self) -> Option<(u64, u64)> {
        let held = self.held.load(Ordering::Relaxed);
        (held > 0).then_some((held, self.limit))
    }
}

/// Returns the MiB of memory that a process uses, resident and swapped; `None` if the system does not
/// report it.
fn held_by(process: u32) -> Option<u64> {
    let status = fs::read_to_string(format!("/proc/{process}/status")).ok()?;
    let field = |name: &str| -> Option<u64> {
        let line = status.lines().find_map(|l| l.strip_prefix(name))?;
        line.trim_end_matches("kB").trim().parse().ok()
    };
    Some((field("VmRSS:")? + field("VmSwap:").unwrap_or(0)) / 1024)
}
