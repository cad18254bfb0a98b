//! Frame times of one case on one adapter in one run.
//!
//! Statistics treat a round as one sample, so the median of each round is kept and its frames are not.
//! Times are 32-bit floats: their seven digits are more precise than any clock.

use etalon_frame::CaseId;
use etalon_record::{BenchRecord, Time, Times};
use etalon_stats::{TimedRun, median_interval, quantile};

/// Frame times of one case on one adapter in one run, in seconds. For a bench, each list has the median of
/// each round; for a method case in a run, a single median. A list is empty if that time was not measured
/// in every round.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct FrameTimes {
    /// The number of timed frames in all rounds.
    pub frames: u32,
    /// The time of a frame, until the device was done.
    pub wall: Vec<f32>,
    /// The time of a frame, until the last call that submits work returned.
    pub cpu: Vec<f32>,
    /// The time of a frame, between GPU timestamps.
    pub gpu: Vec<f32>,
    /// The time of reading a frame back.
    pub read_back: Vec<f32>,
    /// The ruler's time for each round: fixed work on the processor. Empty for runs.
    pub ruler: Vec<f32>,
    /// The confidence interval of a method case's median wall time.
    pub interval: Option<[f32; 2]>,
}

impl FrameTimes {
    /// Returns true if times of this case are kept.
    pub fn are_kept(case: &str) -> bool {
        let area = CaseId::new(case).area();
        // The name of an area is no case.
        area != case && Times::AREAS.contains(&area)
    }

    /// Returns the rounds' medians of one time; empty if it is not kept or was not measured.
    pub fn of(&self, time: Time) -> &[f32] {
        match time {
            Time::Wall => &self.wall,
            Time::Cpu => &self.cpu,
            Time::Gpu => &self.gpu,
            Time::ReadBack => &self.read_back,
            Time::Prepare | Time::First => &[],
        }
    }

    /// Returns the median over rounds of one time.
    pub fn median(&self, time: Time) -> Option<f64> {
        median(self.of(time).iter().copied().map(f64::from))
    }

    /// Returns the median over rounds of the ruler's time.
    pub fn ruler_median(&self) -> Option<f64> {
        median(self.ruler.iter().copied().map(f64::from))
    }

    /// Returns the point of this run in a series of one time; `None` if the time was not measured or is
    /// invalid.
    pub fn point(&self, time: Time) -> Option<TimedRun> {
        let is_time = |t: &f64| t.is_finite() && *t > 0.0;
        let mut rounds: Vec<f64> = self.of(time).iter().map(|t| f64::from(*t)).collect();
        rounds.sort_unstable_by(f64::total_cmp);
        let median = quantile(&rounds, 0.5).filter(is_time)?;
        let interval = match (time, self.interval) {
            (Time::Wall, Some(interval)) => Some(interval.map(f64::from)),
            _ => median_interval(&rounds),
        };
        let holds = |[low, high]: &[f64; 2]| {
            is_time(low) && is_time(high) && *low <= median && median <= *high
        };
        Some(TimedRun {
            median,
            interval: interval.filter(holds),
            ruler: self.ruler_median().filter(is_time),
        })
    }

    /// Returns the times of a bench; `None` if it has no round.
    pub fn of_bench(record: &BenchRecord) -> Option<Self> {
        let rounds = record.rounds.len();
        let medians = |time: Time| -> Vec<f32> {
            let each = record.samples(time).into_iter();
            let medians: Vec<f32> = each
                .filter_map(|samples| median(samples.iter().copied()))
                .map(|t| t as f32)
                .collect();
            // Each value must have the ruler's time of its own round.
            if medians.len() == rounds {
                medians
            } else {
                Vec::new()
            }
        };
        let frames: usize = record.rounds.iter().map(|r| r.wall.len()).sum();
        (rounds > 0).then(|| Self {
            frames: u32::try_from(frames).unwrap_or(u32::MAX),
            wall: medians(Time::Wall),
            cpu: medians(Time::Cpu),
            gpu: medians(Time::Gpu),
            read_back: medians(Time::ReadBack),
            ruler: record
                .rounds
                .iter()
                .map(|r| r.ruler_time() as f32)
                .collect(),
            interval: None,
        })
    }
}

impl From<&Times> for FrameTimes {
    fn from(times: &Times) -> Self {
        Self {
            frames: times.samples,
            wall: vec![times.wall as f32],
            cpu: vec![times.cpu as f32],
            gpu: times.gpu.iter().map(|t| *t as f32).collect(),
            read_back: Vec::new(),
            ruler: Vec::new(),
            interval: times.interval.map(|interval| interval.map(|t| t as f32)),
        }
    }
}

fn median(values: impl Iterator<Item = f64>) -> Option<f64> {
    let mut sorted: Vec<f64> = values.collect();
    sorted.sort_unstable_by(f64::total_cmp);
    quantile(&sorted, 0.5)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn times_of_two_areas_are_kept() {
        for (case, expected) in [
            ("perf/quad/size=1", true),
            ("methods/transparency/windows", true),
            ("depth/compare", false),
            ("perf", false),
            ("perfect/a", false),
        ] {
            assert_eq!(FrameTimes::are_kept(case), expected, "{case}");
        }
    }

    #[test]
    fn a_point_has_an_interval_if_the_rounds_give_one() {
        let rounds = |wall: Vec<f32>| FrameTimes {
            wall,
            ..FrameTimes::default()
        };
        let few = rounds(vec![3.0, 1.0, 2.0]).point(Time::Wall).unwrap();
        assert_eq!((few.median, few.interval), (2.0, None));
        let many = rounds((1..=30).map(|t| t as f32).collect());
        let [low, high] = many.point(Time::Wall).unwrap().interval.unwrap();
        assert!(low < 15.5 && 15.5 < high, "{low} {high}");
        let method = FrameTimes {
            interval: Some([1.5, 2.5]),
            ..rounds(vec![2.0])
        };
        assert_eq!(method.point(Time::Wall).unwrap().interval, Some([1.5, 2.5]));
        for no_time in [vec![], vec![0.0], vec![f32::NAN]] {
            assert_eq!(rounds(no_time).point(Time::Wall), None);
        }
    }

    #[test]
    fn a_median_is_taken_over_the_rounds() {
        let times = FrameTimes {
            wall: vec![3.0, 1.0, 2.0],
            ..FrameTimes::default()
        };
        assert_eq!(times.median(Time::Wall), Some(2.0));
        assert_eq!(times.median(Time::Gpu), None);
        assert_eq!(times.ruler_median(), None);
    }
}
