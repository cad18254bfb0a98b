//! Counted instructions, a second clock beside the times: a busy machine does not change them.

use etalon_frame::state_enum;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

state_enum! {
    /// The program that counts the instructions of a process.
    InstructionCounter: array {
        /// `perf stat`, by a counter of the processor.
        Perf = "perf",
        /// Valgrind's cachegrind, which emulates the processor.
        Valgrind = "valgrind",
    }
}

/// The instructions of processes that draw the same case and differ only in their number of frames.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CountedInstructions {
    /// The case's id.
    pub case: String,
    /// The adapter's name.
    pub adapter: String,
    /// The program that counted; figures of different programs are not comparable.
    pub counter: InstructionCounter,
    /// The frames and the instructions of each process; the frames increase.
    pub processes: Vec<[u64; 2]>,
}

impl CountedInstructions {
    /// Returns the instructions of one frame: the difference of the last and the first process, per frame. What
    /// a process does only once cancels. `None` if no process has more frames than the first, or if more
    /// frames took no more instructions.
    pub fn per_frame(&self) -> Option<f64> {
        slope(*self.processes.first()?, *self.processes.last()?)
    }

    /// Returns the largest distance of the slopes between neighbouring processes from
    /// [`CountedInstructions::per_frame`], relative to it: 0 if each frame took as many instructions.
    pub fn scatter(&self) -> Option<f64> {
        let whole = self.per_frame()?;
        let slopes = self.processes.windows(2).map(|pair| match pair {
            [a, b] => slope(*a, *b),
            _ => None,
        });
        let distances = slopes.map(|slope| slope.map_or(1.0, |slope| (slope / whole - 1.0).abs()));
        Some(distances.fold(0.0, f64::max))
    }

    /// Returns the reason if no recorder writes such counts.
    pub(super) fn wrong(&self) -> Option<&'static str> {
        let ordered = self.processes.is_sorted_by(|a, b| a[0] < b[0]);
        (self.processes.len() < 2 || !ordered)
            .then_some("the frames of its processes do not increase")
    }
}

fn slope(first: [u64; 2], last: [u64; 2]) -> Option<f64> {
    let frames = last[0].checked_sub(first[0]).filter(|n| *n > 0)?;
    let instructions = last[1].checked_sub(first[1]).filter(|n| *n > 0)?;
    Some(instructions as f64 / frames as f64)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn counted(processes: &[[u64; 2]]) -> CountedInstructions {
        CountedInstructions {
            case: "perf/a".to_owned(),
            adapter: "cpu".to_owned(),
            counter: InstructionCounter::Valgrind,
            processes: processes.to_vec(),
        }
    }

    #[test]
    fn instructions_that_a_process_executes_once_cancel() {
        let even = counted(&[[2, 1_000_200], [8, 1_000_800], [14, 1_001_400]]);
        assert_eq!(even.per_frame(), Some(100.0));
        assert_eq!(even.scatter(), Some(0.0));
        let uneven = counted(&[[2, 0], [8, 660], [14, 1200]]);
        assert_eq!(uneven.per_frame(), Some(100.0));
        assert!((uneven.scatter().unwrap() - 0.1).abs() < 1e-9);
    }

    #[test]
    fn fewer_instructions_for_more_frames_are_no_count() {
        assert_eq!(counted(&[[2, 500], [8, 400]]).per_frame(), None);
        let fewer = counted(&[[2, 500], [8, 400], [14, 1700]]);
        assert!(fewer.scatter().unwrap() >= 1.0);
        assert_eq!(counted(&[]).per_frame(), None);
        assert!(counted(&[[2, 5]]).wrong().is_some());
        assert!(counted(&[[2, 5], [2, 6]]).wrong().is_some());
        assert_eq!(counted(&[[2, 5], [3, 6]]).wrong(), None);
    }
}
