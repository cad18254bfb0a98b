//! The threads that share a pass.

use rayon_core::{ThreadPool, ThreadPoolBuilder};
use std::thread;

/// The most threads that tests draw with, on a machine that has fewer, too.
const TESTED: usize = 3;

thread_local! {
    /// This thread and its helpers, which wait between frames; `None` if the system gives no threads.
    static POOL: Option<ThreadPool> = ThreadPoolBuilder::new()
        .num_threads(if cfg!(test) { available().max(TESTED) } else { available() })
        .thread_name(|number| format!("tiles-{number}"))
        .use_current_thread()
        .build()
        .ok();
}

/// Returns the number of threads that this machine runs at once.
pub(crate) fn available() -> usize {
    thread::available_parallelism().map_or(1, usize::from)
}

/// Does each job on a thread of its own, the first on this one. What no other thread has begun when this one is done
/// is done here, too.
///
/// `run` is called through a pointer, so that kernels are compiled once for the first job and the others.
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
