//! Three years of a nightly matrix, simulated: how large the history is and how fast it is read.
//!
//! ```text
//! cargo run --release -p etalon-history --example simulate -- [--cases N] [--adapters N] [--runs N] [--db FILE]
//! ```
//!
//! The rates are those of real matrices or above them: a driver is upgraded every thirty nights and changes some of its
//! outcomes, some cases are flaky on some adapters, the suite gets cases every fortnight and loses a few, one night in
//! fifty is cut off, and one in twenty is of a part of the cases. Everything follows from the seed.
#![expect(
    clippy::unwrap_used,
    reason = "an example may end when something fails"
)]

use etalon_frame::{AdapterInfo, Aspect, TexelCounts};
use etalon_history::{
    Adapter, Added, Asserted, FrameTimes, History, HistoryError, Kind, Measures, MethodMeasures,
    NewAdapter, NewRun, Outcome, Writer, parse_time,
};
use etalon_record::{Labels, Machine, Verdict};
use oorandom::Rand64;
use std::collections::{BTreeMap, BTreeSet};
use std::error::Error;
use std::fs;
use std::path::PathBuf;
use std::time::{Duration, Instant};

/// A day in seconds.
const DAY: i64 = 86_400;
/// Nights between two upgrades of a driver.
const UPGRADE: u64 = 30;
/// Nights between two changes of the suite.
const SUITE: usize = 14;
/// The share of outcomes that an upgrade changes.
const CHANGED: f64 = 0.002;
/// The share of cases that are flaky on an adapter.
const FLAKY: f64 = 0.001;
/// Of how many cases one is timed.
const TIMED: usize = 140;

/// The values of the command line.
struct Settings {
    cases: usize,
    adapters: usize,
    runs: usize,
    db: Option<PathBuf>,
}

impl Settings {
    fn read() -> Result<Self, Box<dyn Error>> {
        let mut settings = Self {
            cases: 14_000,
            adapters: 10,
            runs: 1_000,
            db: None,
        };
        let mut words = std::env::args().skip(1);
        while let Some(word) = words.next() {
            let value = words.next().ok_or(format!("{word} needs a value"))?;
            match word.as_str() {
                "--cases" => settings.cases = value.parse()?,
                "--adapters" => settings.adapters = value.parse()?,
                "--runs" => settings.runs = value.parse()?,
                "--db" => settings.db = Some(value.into()),
                _ => return Err(format!("no such option: {word}").into()),
            }
        }
        Ok(settings)
    }
}

/// One adapter as it stands on a night.
struct Driver {
    name: String,
    version: u32,
    outcomes: BTreeMap<usize, Outcome>,
    /// Cases whose outcome a night may change.
    flaky: BTreeSet<usize>,
    /// Seconds of a frame, by case.
    seconds: BTreeMap<usize, f64>,
}

/// The matrix and its chance.
struct Matrix {
    random: Rand64,
    names: Vec<String>,
    /// Places in `names` of the cases that there are now.
    cases: BTreeSet<usize>,
    drivers: Vec<Driver>,
}

impl Matrix {
    fn new(settings: &Settings) -> Self {
        let mut matrix = Self {
            random: Rand64::new(2026),
            names: Vec::new(),
            cases: BTreeSet::new(),
            drivers: Vec::new(),
        };
        for number in 0..settings.adapters {
            matrix.drivers.push(Driver {
                name: format!("{}:driver-{number}", ["vulkan", "gl", "wgpu"][number % 3]),
                version: 100,
                outcomes: BTreeMap::new(),
                flaky: BTreeSet::new(),
                seconds: BTreeMap::new(),
            });
        }
        matrix.grow(settings.cases);
        matrix
    }

    fn chance(&mut self, probability: f64) -> bool {
        self.random.rand_float() < probability
    }

    /// Adds cases.
    fn grow(&mut self, by: usize) {
        const AREAS: [&str; 8] = [
            "depth/compare",
            "stencil/operations",
            "blend/factors",
            "cull/faces",
            "multisample/resolve",
            "texture/filter",
            "paths/load",
            "order/draws",
        ];
        for _ in 0..by {
            let n = self.names.len();
            let name = match n % TIMED {
                0 => format!("perf/matrix/fill/blend=off/format=rgba8unorm/layers={n}/samples=1"),
                1 => format!("methods/transparency/windows/method=depth-peeling/layers={n}"),
                _ => format!(
                    "{}/compare=less-equal/format=depth24plus-stencil8/stored=0.5/write=true/n={n}",
                    AREAS[n / 40 % AREAS.len()]
                ),
            };
            self.names.push(name);
            self.cases.insert(n);
            for d in 0..self.drivers.len() {
                let outcome = self.outcome(n);
                let flaky = self.chance(FLAKY);
                let seconds = 0.0005 + 0.002 * self.random.rand_float();
                let driver = &mut self.drivers[d];
                driver.outcomes.insert(n, outcome);
                if flaky {
                    driver.flaky.insert(n);
                }
                if n % TIMED < 2 {
                    driver.seconds.insert(n, seconds);
                }
            }
        }
    }

    /// An outcome as full runs have them: most pass, a tenth is not supported, one in a hundred is known to fail.
    fn outcome(&mut self, case: usize) -> Outcome {
        let roll = self.random.rand_float();
        let verdict = match roll {
            _ if case % TIMED == 1 => Verdict::Measured,
            x if x < 0.10 => Verdict::NotSupported,
            x if x < 0.18 => Verdict::Imprecise,
            x if x < 0.19 => Verdict::Fail,
            _ => Verdict::Pass,
        };
        let mut outcome = Outcome::new(verdict);
        if verdict == Verdict::NotSupported {
            return outcome;
        }
        if verdict == Verdict::Fail && self.chance(0.9) {
            outcome.expected = Some(format!("finding-{}", self.random.rand_range(0..40)));
        }
        let total = [256, 1024, 4096][case / 7 % 3];
        let wrong = if verdict == Verdict::Fail {
            self.random.rand_range(1..total)
        } else {
            0
        };
        let imprecise = if verdict == Verdict::Imprecise {
            self.random.rand_range(1..total)
        } else {
            0
        };
        outcome.measures = Measures {
            asserted: vec![Asserted {
                aspect: Aspect::Color,
                channels: 4 * total,
                asserted: 4 * total - self.random.rand_range(0..3),
                codes: 4 * total + self.random.rand_range(0..60),
            }],
            texels: TexelCounts {
                total,
                wrong,
                imprecise,
                open: 0,
            },
            method: (verdict == Verdict::Measured).then(|| MethodMeasures {
                rmse: self.random.rand_float() as f32,
                max: 0.5,
                flip: self.random.rand_float() as f32,
                wrong: 0.25,
                passes: 4,
                draws: 9,
                fragments: None,
                bytes: 65_536,
            }),
        };
        outcome
    }

    /// Makes the changes between two nights.
    fn night(&mut self, night: usize, settings: &Settings) {
        if night % SUITE == SUITE - 1 {
            // The suite keeps its size: as many cases go as come.
            let turn = settings.cases / 400;
            for _ in 0..turn {
                let index = self.random.rand_range(0..self.cases.len() as u64) as usize;
                let gone = self.cases.iter().nth(index).copied().unwrap();
                self.cases.remove(&gone);
            }
            self.grow(turn);
        }
        for d in 0..self.drivers.len() {
            if (night as u64 + 3 * d as u64) % UPGRADE != UPGRADE - 1 {
                continue;
            }
            self.drivers[d].version += 1;
            let cases: Vec<usize> = self.cases.iter().copied().collect();
            for case in cases {
                if self.chance(CHANGED) {
                    let outcome = self.outcome(case);
                    self.drivers[d].outcomes.insert(case, outcome);
                }
            }
            let factor = 0.97 + 0.06 * self.random.rand_float();
            self.drivers[d]
                .seconds
                .values_mut()
                .for_each(|s| *s *= factor);
        }
    }

    /// The run of a night.
    fn run(&mut self, night: usize) -> NewRun {
        let part = night % 20 == 7;
        let cut = night % 50 == 13;
        let drivers = self.drivers.len();
        let mut adapters = Vec::with_capacity(drivers);
        for d in 0..drivers {
            let mut random = Rand64::new(self.random.rand_u64().into());
            let driver = &self.drivers[d];
            let mut made = NewAdapter::new(Adapter {
                info: AdapterInfo {
                    name: driver.name.clone(),
                    backend: driver.name.split(':').next().unwrap_or_default().to_owned(),
                    device: "a device".to_owned(),
                    driver: "a driver".to_owned(),
                    driver_version: format!("{}.0.{}", driver.version / 10, driver.version % 10),
                    api_version: "1.3".to_owned(),
                    software: true,
                    ..AdapterInfo::default()
                },
                line: String::new(),
                version: String::new(),
            });
            let most = if cut && d + 1 == drivers {
                self.cases.len() / 3
            } else {
                usize::MAX
            };
            for case in self
                .cases
                .iter()
                .take(most)
                .filter(|case| !part || **case % 5 == 0)
            {
                let mut outcome = driver.outcomes[case].clone();
                if driver.flaky.contains(case) && random.rand_float() < 0.3 {
                    outcome.verdict = Verdict::Flaky;
                }
                let name = &self.names[*case];
                if let Some(seconds) = driver.seconds.get(case) {
                    made.times
                        .insert(name.clone(), times(*seconds, &mut random));
                }
                made.outcomes.insert(name.clone(), outcome);
            }
            adapters.push(made);
        }
        let mut digest = [0; 32];
        digest[..8].copy_from_slice(&(night as u64).to_le_bytes());
        NewRun {
            digest,
            header: digest,
            kind: Kind::Run,
            etalon: "0.1.0".to_owned(),
            commit: Some(format!("{:040x}", night / 3)),
            machine: Machine {
                os: "Linux".to_owned(),
                cpu: "a processor".to_owned(),
                cores: 16,
            },
            started: parse_time("2024-01-01").unwrap() + DAY * night as i64,
            released: None,
            profile: Some("full".to_owned()),
            ruler: Some("a ruler".to_owned()),
            missing: 0,
            labels: Labels::from([("branch".to_owned(), "main".to_owned())]),
            adapters,
        }
    }
}

fn times(seconds: f64, random: &mut Rand64) -> FrameTimes {
    let mut noisy = |base: f64| {
        (0..7)
            .map(|_| (base * (1.0 + 0.02 * random.rand_float())) as f32)
            .collect::<Vec<_>>()
    };
    FrameTimes {
        frames: 35,
        wall: noisy(seconds),
        cpu: noisy(seconds / 2.0),
        gpu: Vec::new(),
        read_back: Vec::new(),
        ruler: noisy(0.001),
        interval: None,
    }
}

/// Median and longest of some durations, in milliseconds.
fn spread(mut durations: Vec<Duration>) -> String {
    durations.sort_unstable();
    let ms = |d: Option<&Duration>| d.map_or(0.0, |d| d.as_secs_f64() * 1e3);
    format!(
        "median {:.2} ms, longest {:.2} ms",
        ms(durations.get(durations.len() / 2)),
        ms(durations.last())
    )
}

fn timed<T>(action: impl FnOnce() -> T) -> (T, Duration) {
    let begun = Instant::now();
    let result = action();
    (result, begun.elapsed())
}

fn main() -> Result<(), Box<dyn Error>> {
    let settings = Settings::read()?;
    let folder = tempfile::tempdir()?;
    let path = settings
        .db
        .clone()
        .unwrap_or_else(|| folder.path().join("etalon.db"));
    let mut matrix = Matrix::new(&settings);
    let mut writer = Writer::open(&path)?;
    let (mut adding, mut records) = (Vec::new(), 0u64);
    for night in 0..settings.runs {
        matrix.night(night, &settings);
        let run = matrix.run(night);
        records += run
            .adapters
            .iter()
            .map(|a| a.outcomes.len() as u64)
            .sum::<u64>();
        let (added, took) = timed(|| writer.add(&run));
        // A file that was made in parts has the first nights already.
        if matches!(added?, Added::New(_)) {
            adding.push(took);
        }
        if night % 100 == 99 {
            eprintln!(
                "{} runs, {:.1} MB",
                night + 1,
                fs::metadata(&path)?.len() as f64 / 1e6
            );
        }
    }
    drop(writer);
    let bytes = fs::metadata(&path)?.len();
    println!(
        "{} runs, {} adapters, {records} records",
        settings.runs, settings.adapters
    );
    println!(
        "{:.1} MB, {:.2} bytes a record",
        bytes as f64 / 1e6,
        bytes as f64 / records as f64
    );
    println!("adding {} runs: {}", adding.len(), spread(adding));

    let (history, took) = timed(|| History::open_read(&path));
    let history = history?;
    println!("opening: {:.2} ms", took.as_secs_f64() * 1e3);
    let mut random = Rand64::new(7);
    let timelines = history.timelines();
    let (mut on_all, mut on_one, mut opened) = (Vec::new(), Vec::new(), Vec::new());
    let mut points = 0;
    for _ in 0..100 {
        let case = &matrix.names[random.rand_range(0..matrix.names.len() as u64) as usize];
        let timeline = &timelines[random.rand_range(0..timelines.len() as u64) as usize];
        let (found, took) = timed(|| history.case_history(case, None));
        points += found?.iter().map(|h| h.points.len()).sum::<usize>();
        on_all.push(took);
        let (found, took) = timed(|| history.case_history(case, Some(timeline)));
        found?;
        on_one.push(took);
    }
    for _ in 0..10 {
        let case = &matrix.names[random.rand_range(0..matrix.names.len() as u64) as usize];
        let (found, took) = timed(|| History::open_read(&path)?.case_history(case, None));
        found?;
        opened.push(took);
    }
    println!("one case on one adapter: {}", spread(on_one));
    println!(
        "one case on all adapters, {} points: {}",
        points / 100,
        spread(on_all)
    );
    println!("the same with opening: {}", spread(opened));
    let (counted, took) = timed(|| {
        let parts = history.adapter_runs().iter();
        parts
            .map(|part| Ok(history.tallies(part)?.len()))
            .sum::<Result<usize, HistoryError>>()
    });
    println!(
        "counts of all runs, {} rows: {:.0} ms",
        counted?,
        took.as_secs_f64() * 1e3
    );
    let keys = history.series_keys()?;
    let (points, took) = timed(|| {
        keys.iter()
            .map(|key| Ok(history.series(key)?.len()))
            .sum::<Result<usize, HistoryError>>()
    });
    println!(
        "{} series, {} points: {:.0} ms",
        keys.len(),
        points?,
        took.as_secs_f64() * 1e3
    );
    let mut read = 0u64;
    let (done, took) = timed(|| {
        history.each_record::<HistoryError>(|_, _, _, _| {
            read += 1;
            Ok(())
        })
    });
    done?;
    println!("every record, {read}: {:.1} s", took.as_secs_f64());
    Ok(())
}
