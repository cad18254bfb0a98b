//! The time that a run with a limit has left, shared between its adapters.

use etalon_record::Reason;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::{Duration, Instant};

/// The time limit of a run.
pub(super) struct Budget {
    end: Instant,
    limit: Duration,
    adapters: usize,
    /// The number of adapters that have begun.
    begun: AtomicUsize,
    jobs: usize,
}

impl Budget {
    /// Begins a limit for `adapters` adapters. `jobs` adapters draw at the same time.
    pub(super) fn new(limit: Duration, adapters: usize, jobs: usize) -> Self {
        Self {
            end: Instant::now() + limit,
            limit,
            adapters,
            begun: AtomicUsize::new(0),
            jobs: jobs.max(1),
        }
    }

    /// Returns the time at which the next adapter must end, so that those after it get as much.
    pub(super) fn next_end(&self) -> Instant {
        let begun = self.begun.fetch_add(1, Ordering::Relaxed);
        let rounds = self.adapters.div_ceil(self.jobs);
        let rounds = rounds.saturating_sub(begun / self.jobs).max(1);
        let now = Instant::now();
        now + self.end.saturating_duration_since(now) / u32::try_from(rounds).unwrap_or(u32::MAX)
    }

    /// Returns the reason why a case is left out.
    pub(super) fn reason(&self) -> Reason {
        Reason::OutOfTime(self.limit.as_secs_f64())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn adapters_share_the_time_and_inherit_time_that_others_leave() {
        let limit = Duration::from_secs(60);
        let budget = Budget::new(limit, 3, 2);
        let begun = Instant::now();
        let ends = [0; 3].map(|_| {
            budget
                .next_end()
                .duration_since(begun)
                .as_secs_f64()
                .round()
        });
        // The third one begins after the first two; here they took no time.
        assert_eq!(ends, [30.0, 30.0, 60.0]);
        assert_eq!(budget.reason(), Reason::OutOfTime(60.0));
    }
}
