//! Whether another worker would find an idle processor.
//!
//! A worker on a device waits: for pipelines, for the device, for texels. With a worker per processor, most
//! processors are then idle. Further workers keep the device busy without the risks of several scenes in one
//! process: a crash costs the scene that is being drawn, and no other.

use crate::sync::lock;
use std::sync::Mutex;
use std::thread::available_parallelism;
use std::time::{Duration, Instant};
use sysinfo::System;

/// The time over which the load is measured.
const PERIOD: Duration = Duration::from_millis(250);

/// The processors that are idle.
pub(super) struct IdleProcessors {
    state: Mutex<State>,
}

struct State {
    system: System,
    measured: Instant,
    /// The number of further threads that the idle processors can carry.
    room: usize,
}

impl IdleProcessors {
    /// Begins to measure. Returns `None` if the load is unknown: if the system hides it, or if this process may not
    /// use all processors.
    pub(super) fn measured() -> Option<Self> {
        let mut system = System::new().ok()?;
        system.refresh_cpu_usage();
        let usable = available_parallelism().map_or(1, usize::from);
        (usable >= system.cpus().len()).then(|| Self {
            state: Mutex::new(State {
                system,
                measured: Instant::now(),
                room: 0,
            }),
        })
    }

    /// Returns true if there is room for one more thread beside the `drawing` ones. It then takes it.
    pub(super) fn take_room(&self, drawing: usize) -> bool {
        let mut state = lock(&self.state);
        if state.measured.elapsed() >= PERIOD {
            state.measured = Instant::now();
            state.system.refresh_cpu_usage();
            let usage = state.system.global_cpu_usage() / 100.0;
            state.room = room(usage, drawing, state.system.cpus().len());
        }
        let has_room = state.room > 0;
        if has_room {
            state.room -= 1;
        }
        has_room
    }
}

/// Returns how many more threads fit, if each uses as much as one of the `drawing` threads.
fn room(usage: f32, drawing: usize, processors: usize) -> usize {
    let used = (usage * processors as f32).max(0.1);
    let idle = processors as f32 - used;
    (idle * drawing as f32 / used) as usize
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn threads_that_wait_leave_room_and_busy_ones_do_not() {
        assert_eq!(room(1.0, 2, 2), 0);
        assert_eq!(room(0.7, 2, 2), 0);
        assert_eq!(room(0.25, 2, 2), 6);
        assert_eq!(room(0.5, 8, 8), 8);
        assert_eq!(room(0.0, 2, 2), 38);
    }
}
