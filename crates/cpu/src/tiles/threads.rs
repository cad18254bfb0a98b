//! The threads that share the work of a pass.

use rayon_core::{ThreadPool, ThreadPoolBuilder};
use std::sync::LazyLock;
use std::thread;

/// The largest number of threads that tests draw with, even on a machine with fewer.
const TESTED: usize = 3;

thread_local! {
    /// This thread and its helpers, which wait between frames; `None` if the system provides no threads.
    static POOL: Option<ThreadPool> = ThreadPoolBuilder::new()
        .num_threads(if cfg!(test) { available().max(TESTED) } else { available() })
        .thread_name(|number| format!("tiles-{number}"))
        .use_current_thread()
        .build()
        .ok();
}

/// Returns the number of threads that this machine runs at once.
pub(crate) fn available() -> usize {
    // Each query reads a dozen files of the kernel.
    static THREADS: LazyLock<usize> =
        LazyLock::new(|| thread::available_parallelism().map_or(1, usize::from));
    *THREADS
}

/// Runs each job on a thread of its own, the first on this one. When this thread is done, it also runs jobs
/// that no other thread has begun.
///
/// `run` is called through a pointer, so that kernels are compiled only once, for the first job and the
/// others.
pub(crate) fn on_threads<J: Send>(jobs: Vec<J>, run: &(dyn Fn(J) + Sync)) {
    if jobs.len() < 2 {
        return jobs.into_iter().for_each(run);
    }
    POOL.with(|pool| match pool {
        Some(pool) => pool.scope(|scope| {
            let mut jobs = jobs.into_iter();
            let first = jobs.next();
            for job in jobs {
                scope.spawn(move |_| run(job));
            }
            first.into_iter().for_each(run);
        }),
        None => jobs.into_iter().for_each(run),
    });
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::atomic::{AtomicUsize, Ordering};
    use std::sync::{Barrier, Mutex};
    use std::time::Duration;

    #[test]
    fn every_job_is_done_once() {
        for count in 0..6 {
            let done: Vec<AtomicUsize> = (0..count).map(|_| AtomicUsize::new(0)).collect();
            on_threads((0..count).collect(), &|job: usize| {
                done[job].fetch_add(1, Ordering::Relaxed);
            });
            assert!(done.iter().all(|n| n.load(Ordering::Relaxed) == 1));
        }
    }

    #[test]
    fn helpers_end_with_their_thread() {
        // On Linux, threads have folders; elsewhere their end cannot be observed.
        let folder = || std::fs::read_link("/proc/thread-self").ok();
        let owner = thread::spawn(move || {
            let (barrier, folders) = (Barrier::new(TESTED), Mutex::new(Vec::new()));
            on_threads(vec![(); TESTED], &|()| {
                barrier.wait();
                folders.lock().expect("no job fails").extend(folder());
            });
            folders.into_inner().expect("no job fails")
        });
        let folders = owner.join().expect("jobs are done");
        assert!(folders.is_empty() || folders.len() == TESTED, "{folders:?}");
        for folder in folders {
            let folder = std::path::Path::new("/proc").join(folder);
            let ended = || {
                thread::sleep(Duration::from_millis(10));
                !folder.exists()
            };
            assert!((0..1000).any(|_| ended()), "{} goes on", folder.display());
        }
    }
}
