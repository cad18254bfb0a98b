//! The times of a method's frames: how many are drawn, and their medians.

use etalon_record::Times;

/// Frames that are drawn after the first and before the first timed one. Drivers compile and allocate at
/// the first frame, and some again at the second. A frame as long as the budget needs no warm-up.
const WARM_UP: u32 = 2;
/// The total time of a case's timed frames in seconds, within the limits on their number.
const BUDGET: f64 = 0.04;
/// The minimum and the maximum number of frames that are timed.
const FRAMES: [u32; 2] = [3, 31];

/// A time in seconds that no frame falls short of.
const SHORTEST: f64 = 1e-6;

/// The times of one frame, in seconds.
#[derive(Clone, Copy, Debug)]
pub struct FrameSeconds {
    /// Until the device was done.
    pub wall: f64,
    /// Until the last call that submits work returned.
    pub cpu: f64,
    /// Between GPU timestamps, if the device has them.
    pub gpu: Option<f64>,
}

/// The next frames of a scene that is timed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Timing {
    /// The first frame, at which a driver compiles.
    #[default]
    First,
    /// Frames that warm the driver up.
    WarmUp,
    /// The frames whose times are kept: this many.
    Timed(u32),
}

impl Timing {
    /// Returns the number of frames to draw.
    pub fn frames(self) -> u32 {
        match self {
            Self::First => 1,
            Self::WarmUp => WARM_UP,
            Self::Timed(frames) => frames,
        }
    }

    /// Returns what is drawn after frames with these times; `None` if their times are kept.
    pub fn next(self, times: &[FrameSeconds]) -> Option<Self> {
        let last = times.last()?.wall;
        match self {
            Self::First if last < BUDGET => Some(Self::WarmUp),
            Self::First | Self::WarmUp => {
                let [fewest, most] = FRAMES;
                let fit = (BUDGET / last.max(SHORTEST)) as u32;
                Some(Self::Timed(fit.clamp(fewest, most)))
            }
            Self::Timed(_) => None,
        }
    }
}

/// Returns the medians of some frame times; `None` for no frames. The interval contains the error of a clock with
/// steps of `step` seconds.
pub fn medians(times: &[FrameSeconds], step: f64) -> Option<Times> {
    let sorted = |time: fn(&FrameSeconds) -> Option<f64>| {
        let mut values: Vec<f64> = times.iter().filter_map(time).collect();
        values.sort_unstable_by(f64::total_cmp);
        values
    };
    let median = |values: Vec<f64>| values.get(values.len() / 2).copied();
    let walls = sorted(|frame| Some(frame.wall));
    let interval = interval(&walls);
    let interval = interval.map(|[low, high]| [(low - step).max(low.min(SHORTEST)), high + step]);
    Some(Times {
        samples: times.len() as u32,
        wall: median(walls)?,
        cpu: median(sorted(|frame| Some(frame.cpu)))?,
        gpu: median(sorted(|frame| frame.gpu)),
        interval,
    })
}

/// Returns the two closest order statistics between which the median is with 95 % confidence, whatever the
/// distribution (the binomial sign test). Fewer than six times cannot reach that confidence; for these,
/// returns the ends.
fn interval(sorted: &[f64]) -> Option<[f64; 2]> {
    let last = sorted.len().checked_sub(1)?;
    // The probability that at most `low` of the times are below the median.
    let (mut low, mut tail, mut term) = (0, 0.0, 0.5_f64.powi(sorted.len() as i32));
    while low < last / 2 {
        tail += term;
        term *= (sorted.len() - low) as f64 / (low + 1) as f64;
        if tail + term > 0.025 {
            break;
        }
        low += 1;
    }
    Some([sorted[low], sorted[last - low]])
}

#[cfg(test)]
mod tests {
    use super::*;

    fn frame(wall: f64, gpu: Option<f64>) -> FrameSeconds {
        FrameSeconds {
            wall,
            cpu: 0.001,
            gpu,
        }
    }

    #[test]
    fn times_have_their_medians_and_no_frames_have_none() {
        assert_eq!(medians(&[], 0.0), None);
        let times = [
            frame(0.009, None),
            frame(0.002, Some(0.003)),
            frame(0.004, None),
        ];
        let expected = Times {
            samples: 3,
            wall: 0.004,
            cpu: 0.001,
            gpu: Some(0.003),
            interval: Some([0.002, 0.009]),
        };
        assert_eq!(medians(&times, 0.0), Some(expected));
        let coarse = medians(&times, 0.005).and_then(|times| times.interval);
        assert_eq!(coarse, Some([SHORTEST, 0.009 + 0.005]));
    }

    #[test]
    fn short_frames_are_warmed_up_and_timed_more_often() {
        let frames = |wall: f64| {
            let mut counts = Vec::new();
            let mut timing = Some(Timing::default());
            while let Some(now) = timing {
                counts.push(now.frames());
                timing = now.next(&[frame(wall, None)]);
            }
            counts
        };
        assert_eq!(frames(0.0), [1, 2, 31]);
        assert_eq!(frames(0.004), [1, 2, 10]);
        assert_eq!(frames(2.0), [1, 3]);
        assert_eq!(Timing::default().next(&[]), None);
    }

    #[test]
    fn the_interval_holds_the_median_with_the_level_that_is_stated() {
        let measured = |count: u32| {
            let times: Vec<f64> = (1..=count).map(f64::from).collect();
            interval(&times).map(|ends| ends.map(|e| e as u32))
        };
        assert_eq!(measured(0), None);
        assert_eq!(measured(1), Some([1, 1]));
        assert_eq!(measured(5), Some([1, 5]), "93.75 % at most");
        // From tables of the sign test: with 6 to 8 times, none is dropped at either end; with 9 to 11, one;
        // with 12 to 14, two; with 31, nine.
        assert_eq!(measured(6), Some([1, 6]));
        assert_eq!(measured(8), Some([1, 8]));
        assert_eq!(measured(9), Some([2, 8]));
        assert_eq!(measured(12), Some([3, 10]));
        assert_eq!(measured(31), Some([10, 22]));
    }
}
