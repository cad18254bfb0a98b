//! Measuring and limiting the memory that a process uses.
//!
//! The parent polls instead of setting `RLIMIT_AS`, because drivers reserve address space that they never
//! use.

use crate::sync::lock;
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
        thread::Builder::new().spawn(move || {
            while !ended.load(Ordering::Relaxed) {
                let bytes = etalon_process::memory(&lock(&child));
                let Some(now) = bytes.map(|bytes| bytes >> 20) else {
                    return;
                };
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
