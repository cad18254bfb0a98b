//! Simulated series of nightly benches with planted steps, and how well change points match them. Also for
//! `examples/change_points.rs`.

use etalon_stats::{TimedRun, change_points};
use oorandom::Rand64;

/// Runs of a series.
pub(crate) const RUNS: usize = 200;
/// Steps in a series.
pub(crate) const STEPS: usize = 3;
/// The fewest runs between steps, and between steps and the ends.
const APART: u64 = 20;
/// A change at most this many runs from a step is that step.
const TOLERANCE: usize = 5;
/// Rounds of a run; their spread is that of the runs times the square root of this.
const ROUNDS: f64 = 9.0;

/// A machine and its noise; deviations and drifts are of the logarithm.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Machine {
    pub(crate) name: &'static str,
    /// Deviation between runs.
    pub(crate) noise: f64,
    /// The correlation of a run's deviation with that of the run before.
    pub(crate) memory: f64,
    /// The drift from the first run to the last, the ruler's too.
    pub(crate) drift: f64,
    /// The share of runs that take up to several times as long.
    pub(crate) outliers: f64,
    /// The share by which the second pace is slower, the ruler's too.
    pub(crate) pace: f64,
    /// The probability to keep the pace for another run.
    pub(crate) stay: f64,
    /// The size of the machine's steps, which the ruler shares, 40 runs from the driver's steps.
    pub(crate) moved: f64,
    /// Deviation of the ruler, if there is one.
    pub(crate) ruler: Option<f64>,
}

const STEADY: Machine = Machine {
    name: "1 % noise",
    noise: 0.01,
    memory: 0.0,
    drift: 0.0,
    outliers: 0.0,
    pace: 0.0,
    stay: 0.5,
    moved: 0.0,
    ruler: None,
};

/// The machines of the table.
pub(crate) const MACHINES: [Machine; 10] = [
    STEADY,
    Machine {
        name: "3 % noise",
        noise: 0.03,
        ..STEADY
    },
    Machine {
        name: "1 %, runs resemble the one before (0.5)",
        memory: 0.5,
        ..STEADY
    },
    Machine {
        name: "1 %, drift of 10 %",
        drift: 0.1,
        ..STEADY
    },
    Machine {
        name: "1 %, 5 % of runs are spikes",
        outliers: 0.05,
        ..STEADY
    },
    Machine {
        name: "1 %, two paces 10 % apart at random",
        pace: 0.1,
        ..STEADY
    },
    Machine {
        name: "the same with a ruler",
        pace: 0.1,
        ruler: Some(0.005),
        ..STEADY
    },
    Machine {
        name: "1 %, paces kept for 10 runs, no ruler",
        pace: 0.1,
        stay: 0.9,
        ..STEADY
    },
    Machine {
        name: "the same with a ruler",
        pace: 0.1,
        stay: 0.9,
        ruler: Some(0.005),
        ..STEADY
    },
    Machine {
        name: "1 %, the machine steps by 10 %, with a ruler",
        moved: 0.1,
        ruler: Some(0.005),
        ..STEADY
    },
];

/// A series and the first run of each of its steps.
#[derive(Clone, Debug)]
pub(crate) struct Series {
    pub(crate) points: Vec<TimedRun>,
    pub(crate) steps: Vec<usize>,
}

pub(crate) fn normal(random: &mut Rand64) -> f64 {
    let radius = (-2.0 * (1.0 - random.rand_float()).ln()).sqrt();
    radius * (std::f64::consts::TAU * random.rand_float()).cos()
}

/// A series of a machine with steps of this size up or down; no steps for size 0.
pub(crate) fn series(random: &mut Rand64, machine: Machine, size: f64) -> Series {
    let free = RUNS as u64 - (STEPS as u64 + 1) * APART;
    let mut steps: Vec<u64> = (0..STEPS).map(|_| random.rand_range(0..free)).collect();
    steps.sort_unstable();
    let place = |(i, step): (usize, &u64)| (*step + (i as u64 + 1) * APART) as usize;
    let steps: Vec<usize> = steps.iter().enumerate().map(place).collect();
    let signs: Vec<f64> = steps
        .iter()
        .map(|_| if random.rand_float() < 0.5 { -1.0 } else { 1.0 })
        .collect();
    let mut points = Vec::with_capacity(RUNS);
    let (mut deviation, mut slow, mut level) = (normal(random), random.rand_float() < 0.5, 0.0);
    for run in 0..RUNS {
        if let Some(i) = steps.iter().position(|step| *step == run) {
            level += signs[i] * (1.0 + size).ln();
        }
        if random.rand_float() >= machine.stay {
            slow = !slow;
        }
        deviation = machine.memory * deviation
            + (1.0 - machine.memory * machine.memory).sqrt() * normal(random);
        let mut common = machine.drift * run as f64 / RUNS as f64;
        common += if slow { (1.0 + machine.pace).ln() } else { 0.0 };
        common += if run % 80 >= 40 { machine.moved } else { 0.0 };
        let mut log = level + common + machine.noise * deviation;
        if random.rand_float() < machine.outliers {
            log += (1.0 - (1.0 - random.rand_float()).ln()).ln();
        }
        let within = machine.noise / 2.0 * 2.576 / ROUNDS.sqrt();
        let median = 0.003 * log.exp();
        points.push(TimedRun {
            median,
            interval: Some([median * (-within).exp(), median * within.exp()]),
            ruler: machine
                .ruler
                .map(|ruler| 0.002 * (common + ruler * normal(random)).exp()),
        });
    }
    let steps = if size > 0.0 { steps } else { Vec::new() };
    Series { points, steps }
}

/// Series whose changes were matched with planted steps.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Score {
    pub(crate) planted: usize,
    pub(crate) hits: usize,
    pub(crate) wrong: usize,
    pub(crate) runs: usize,
}

impl Score {
    /// Adds the changes of a series. Each step takes the nearest change.
    pub(crate) fn add(&mut self, steps: &[usize], found: &[usize], runs: usize) {
        let mut open = found.to_vec();
        for step in steps {
            let near = (0..open.len()).min_by_key(|i| open[*i].abs_diff(*step));
            if let Some(near) = near.filter(|i| open[*i].abs_diff(*step) <= TOLERANCE) {
                open.remove(near);
                self.hits += 1;
            }
        }
        self.planted += steps.len();
        self.wrong += open.len();
        self.runs += runs;
    }

    pub(crate) fn recall(&self) -> f64 {
        self.hits as f64 / self.planted.max(1) as f64
    }

    pub(crate) fn precision(&self) -> f64 {
        match self.hits + self.wrong {
            0 => 1.0,
            found => self.hits as f64 / found as f64,
        }
    }
}

/// The runs that a person should look at.
pub(crate) fn alarms(points: &[TimedRun]) -> Vec<usize> {
    let changes = change_points(points).expect("simulated times are above zero");
    let alarms = changes.points.iter().filter(|point| point.is_alarm());
    alarms.map(|point| point.index).collect()
}
