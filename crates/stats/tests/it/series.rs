//! Change points of series: made by hand, by properties of any series, simulated, and recorded.

use crate::nightly::{MACHINES, Machine, RUNS, Score, alarms, normal, series};
use etalon_stats::{
    Cause, Changes, MIN_RUNS, PointError, Samples, TimedRun, change_points, quantile,
};
use oorandom::Rand64;
use std::path::Path;

fn points(times: &[f64]) -> Vec<TimedRun> {
    let point = |median: &f64| TimedRun {
        median: *median,
        interval: None,
        ruler: None,
    };
    times.iter().map(point).collect()
}

fn found(times: &[f64]) -> Changes {
    change_points(&points(times)).unwrap()
}

fn indices(changes: &Changes) -> Vec<usize> {
    changes.points.iter().map(|p| p.index).collect()
}

/// Runs of noise about a level.
fn level(random: &mut Rand64, runs: usize, level: f64, noise: f64) -> Vec<f64> {
    (0..runs)
        .map(|_| level * (noise * normal(random)).exp())
        .collect()
}

#[test]
fn changes_of_small_series_agree_with_those_by_hand() {
    // A step of a tenth, and nothing else.
    let times = [
        10.0, 10.1, 9.9, 10.0, 10.1, 9.9, 10.0, 10.1, 11.0, 11.1, 10.9, 11.0, 11.1, 10.9, 11.0,
        11.1,
    ];
    let changes = found(&times);
    assert_eq!(indices(&changes), [8]);
    let point = changes.points[0];
    assert_eq!(point.between, [7, 8]);
    assert!((point.before - 10.01).abs() < 0.01 && (point.after - 11.01).abs() < 0.01);
    assert!((point.ratio.estimate - 1.1).abs() < 0.002, "{point:?}");
    assert!(point.ratio.low < 1.1 && 1.1 < point.ratio.high && point.ratio.low > 1.07);
    assert!(
        point.p < 1e-6 && point.visible > 1.01 && point.visible < 1.06,
        "{point:?}"
    );
    assert_eq!((point.cause, point.returns), (Cause::NoRuler, false));
    // The same without the step, and with too few runs after it.
    assert!(found(&times[..8]).points.is_empty());
    assert!(found(&times[..8 + MIN_RUNS - 1]).points.is_empty());
    assert_eq!(indices(&found(&times[..8 + MIN_RUNS])), [8]);
    // Up to three disturbed runs in a row are no change.
    let mut disturbed = times[..8].repeat(4);
    disturbed[5] = 30.0;
    disturbed[14] = 5.0;
    for time in &mut disturbed[20..23] {
        *time = 14.0;
    }
    assert!(found(&disturbed).points.is_empty());
}

#[test]
fn short_or_constant_series_have_no_changes() {
    for times in [&[][..], &[1.0], &[1.0, 2.0, 3.0], &[7.5; 300]] {
        let changes = found(times);
        assert!(
            changes.points.is_empty() && changes.drifts.is_empty(),
            "{times:?}"
        );
        assert_eq!(changes.visible(MIN_RUNS - 1), None);
        assert_eq!(changes.visible(7).is_some(), times.len() >= MIN_RUNS);
    }
    let two = found(&[1.0, 1.0, 1.0, 1.0, 2.0, 2.0, 2.0, 2.0]);
    assert_eq!(indices(&two), [4]);
    // Wide intervals within the runs show that the agreement is chance.
    let wide = |p: TimedRun| TimedRun {
        interval: Some([p.median / 3.0, p.median * 3.0]),
        ..p
    };
    let wide: Vec<TimedRun> = points(&[1.0, 1.0, 1.0, 1.0, 2.0, 2.0, 2.0, 2.0])
        .into_iter()
        .map(wide)
        .collect();
    assert!(change_points(&wide).unwrap().points.is_empty());
}

#[test]
fn an_invalid_time_is_refused() {
    for time in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        let error = change_points(&points(&[1.0, time])).unwrap_err();
        assert!(
            matches!(error, PointError::Time { index: 1, .. }),
            "{error}"
        );
        let ruler = TimedRun {
            ruler: Some(time),
            ..points(&[1.0])[0]
        };
        assert!(change_points(&[ruler]).is_err());
    }
    let outside = TimedRun {
        interval: Some([2.0, 3.0]),
        ..points(&[1.0])[0]
    };
    assert!(matches!(
        change_points(&[outside]),
        Err(PointError::Interval { index: 0, .. })
    ));
}

#[test]
fn a_point_has_the_medians_of_a_bench() {
    let rounds: Vec<[f64; 1]> = (0..9).map(|i| [1.0 + 0.01 * f64::from(i)]).collect();
    let samples = Samples::new(&rounds).unwrap();
    let point = TimedRun::from(&samples);
    assert!(
        (point.median - 1.04).abs() < 1e-12 && point.interval.is_some() && point.ruler.is_none()
    );
    let ruled = samples
        .with_ruler(&[2.0, 2.0, 2.0, 2.0, 2.1, 2.2, 2.2, 2.2, 2.2])
        .unwrap();
    assert!((TimedRun::from(&ruled).ruler.unwrap() - 2.1).abs() < 1e-12);
}

#[test]
fn a_step_that_the_ruler_shares_is_the_machine_s() {
    let mut random = Rand64::new(5);
    let mut times = level(&mut random, 40, 1.0, 0.01);
    times.extend(level(&mut random, 40, 1.1, 0.01));
    let with = |ruler_after: f64, noise: f64, random: &mut Rand64| -> Cause {
        let mut rulers = level(random, 40, 2.0, noise);
        rulers.extend(level(random, 40, 2.0 * ruler_after, noise));
        let points: Vec<TimedRun> = points(&times)
            .into_iter()
            .zip(rulers)
            .map(|(p, ruler)| TimedRun {
                ruler: Some(ruler),
                ..p
            })
            .collect();
        let changes = change_points(&points).unwrap();
        assert_eq!(indices(&changes), [40]);
        changes.points[0].cause
    };
    assert_eq!(with(1.0, 0.003, &mut random), Cause::Driver);
    assert_eq!(with(1.1, 0.003, &mut random), Cause::Machine);
    assert_eq!(with(1.07, 0.003, &mut random), Cause::Machine);
    assert_eq!(with(1.03, 0.003, &mut random), Cause::Driver);
    assert_eq!(with(1.0, 0.3, &mut random), Cause::Unclear);
    // In the other direction, the times did not step by the ruler's step.
    assert_eq!(with(0.8, 0.003, &mut random), Cause::Unclear);
}

#[test]
fn a_ruler_that_steps_alone_is_no_change() {
    let mut random = Rand64::new(8);
    let times = level(&mut random, 80, 1.0, 0.01);
    let points: Vec<TimedRun> = points(&times)
        .into_iter()
        .enumerate()
        .map(|(i, p)| TimedRun {
            ruler: Some(if i < 40 { 1.0 } else { 1.2 }),
            ..p
        })
        .collect();
    assert_eq!(change_points(&points).unwrap().points, []);
}

#[test]
fn a_drift_is_one_drift_and_no_stairs() {
    let mut random = Rand64::new(2);
    let mut times = level(&mut random, 300, 1.0, 0.01);
    for (i, time) in times.iter_mut().enumerate() {
        *time *= 1.0 + 0.0005 * i as f64;
    }
    let changes = found(&times);
    assert!(changes.points.is_empty(), "{:?}", changes.points);
    let [drift] = changes.drifts[..] else {
        panic!("{:?}", changes.drifts)
    };
    assert_eq!((drift.from, drift.to, drift.machine), (0, 300, false));
    assert!((1.13..1.17).contains(&drift.ratio.estimate), "{drift:?}");
    let ruled: Vec<TimedRun> = points(&times)
        .into_iter()
        .map(|p| TimedRun {
            ruler: Some(p.median * 2.0),
            ..p
        })
        .collect();
    assert!(change_points(&ruled).unwrap().drifts[0].machine);
}

#[test]
fn going_back_and_forth_is_marked() {
    let mut random = Rand64::new(6);
    let mut times = Vec::new();
    for i in 0..5 {
        times.extend(level(
            &mut random,
            20,
            if i % 2 == 0 { 1.0 } else { 1.2 },
            0.01,
        ));
    }
    let changes = found(&times);
    assert_eq!(indices(&changes), [20, 40, 60, 80]);
    assert!(changes.points.iter().all(|p| p.returns));
    assert!(found(&times[..60]).points.iter().all(|p| !p.returns));
}

/// Steps, spikes and noise of many kinds.
fn any(seed: u128) -> Vec<f64> {
    let mut random = Rand64::new(seed);
    let noise = [0.002, 0.01, 0.03][(seed % 3) as usize];
    let mut times = Vec::new();
    for _ in 0..random.rand_range(1..6) {
        let runs = random.rand_range(5..70) as usize;
        let time = 1.0 + 0.3 * random.rand_float();
        times.extend(level(&mut random, runs, time, noise));
    }
    times
}

#[test]
fn scale_and_direction_of_a_series_do_not_matter() {
    for seed in 0..150 {
        let times = any(seed);
        let changes = found(&times);
        assert_eq!(changes, found(&times), "{seed}: the same again");
        let scaled: Vec<f64> = times.iter().map(|t| t * 3.7e-3).collect();
        let other = found(&scaled);
        assert_eq!(indices(&other), indices(&changes), "{seed}");
        for (a, b) in changes.points.iter().zip(&other.points) {
            assert_eq!(a.between, b.between, "{seed}");
            assert!((a.ratio.estimate / b.ratio.estimate - 1.0).abs() < 1e-9);
            assert!((a.before * 3.7e-3 / b.before - 1.0).abs() < 1e-9);
        }
        let backwards: Vec<f64> = times.iter().rev().copied().collect();
        let mut mirrored = indices(&found(&backwards));
        mirrored.reverse();
        let expected: Vec<usize> = mirrored.iter().map(|index| times.len() - index).collect();
        assert_eq!(expected, indices(&changes), "{seed}");
        for point in &changes.points {
            assert!(point.between[0] < point.index && point.index <= point.between[1]);
            assert!(
                point.ratio.low <= point.ratio.estimate && point.ratio.estimate <= point.ratio.high
            );
            assert!(point.visible > 1.005 && point.p <= etalon_stats::LEVEL);
        }
    }
}

#[test]
fn adding_run_by_run_gives_the_same_as_all_at_once() {
    for seed in 0..12 {
        let mut random = Rand64::new(seed);
        let mut times = Vec::new();
        for time in [1.0, 1.1, 1.05, 1.3, 1.2] {
            times.extend(level(&mut random, 90, time, 0.01));
        }
        let points = points(&times);
        let mut grown = change_points(&points[..100]).unwrap();
        for runs in 101..=points.len() {
            grown = grown.append(&points[..runs]).unwrap();
        }
        let expected = change_points(&points).unwrap();
        assert_eq!(indices(&grown), indices(&expected), "{seed}");
        assert_eq!(grown.settled(), 270);
        // Earlier points are not read.
        let mut other = points.clone();
        other[..200].fill(TimedRun {
            median: 9.0,
            ..points[0]
        });
        assert_eq!(
            grown.append(&other).unwrap(),
            grown.append(&points).unwrap()
        );
    }
}

#[test]
fn intervals_and_places_contain_the_planted_steps() {
    let (mut held, mut inside, mut total) = (0, 0, 0);
    for seed in 0..400 {
        let mut random = Rand64::new(seed);
        let mut times = level(&mut random, 50, 1.0, 0.01);
        times.extend(level(&mut random, 30, 1.015, 0.01));
        for point in found(&times).points {
            total += 1;
            held += usize::from(point.ratio.low <= 1.015 && 1.015 <= point.ratio.high);
            inside += usize::from(point.between[0] < 50 && 50 <= point.between[1]);
        }
    }
    println!("{total}: {held} intervals, {inside} places");
    assert!(total > 350, "{total}");
    assert!(held * 100 >= 98 * total, "{held} of {total}");
    assert!(inside * 100 >= 96 * total, "{inside} of {total}");
}

#[test]
fn the_smallest_visible_step_is_found_as_often_as_it_says() {
    for (noise, before, after) in [(0.01, 60, 7), (0.03, 100, 40), (0.005, 20, 20)] {
        let mut random = Rand64::new(11);
        let trials = 300;
        let mut hits = 0;
        for _ in 0..trials {
            let mut times = level(&mut random, before, 1.0, noise);
            let visible = found(&times).visible(after).unwrap();
            assert!(
                visible > 1.0 + noise / 2.0 && visible < 1.0 + 9.0 * noise,
                "{visible}"
            );
            times.extend(level(&mut random, after, visible, noise));
            hits += usize::from(!found(&times).points.is_empty());
        }
        println!("{noise} {before} {after}: {hits} of {trials}");
        assert!(hits * 100 >= 85 * trials, "{noise}: {hits} of {trials}");
    }
}

/// The score of a sample of the table that `examples/change_points.rs` prints.
fn score(machine: Machine, size: f64) -> Score {
    let mut random = Rand64::new(77);
    let mut score = Score::default();
    for _ in 0..30 {
        let series = series(&mut random, machine, size);
        score.add(&series.steps, &alarms(&series.points), RUNS);
    }
    score
}

#[test]
fn planted_steps_are_found_with_few_false_alarms() {
    // Machine, size, floors of recall and precision.
    for (number, size, recall, precision) in [
        (0, 0.02, 0.95, 0.95),
        (0, 0.05, 0.99, 0.98),
        (0, 0.2, 0.99, 0.98),
        (1, 0.05, 0.80, 0.90),
        (1, 0.1, 0.98, 0.98),
        (2, 0.05, 0.95, 0.88),
        (3, 0.05, 0.80, 0.85),
        (3, 0.1, 0.95, 0.90),
        (4, 0.05, 0.95, 0.95),
        (5, 0.1, 0.90, 0.93),
        (6, 0.05, 0.65, 0.80),
        (6, 0.1, 0.95, 0.95),
        (8, 0.2, 0.92, 0.88),
        (9, 0.05, 0.75, 0.95),
    ] {
        let machine = MACHINES[number];
        let score = score(machine, size);
        println!(
            "{number} {size}: {:.2} {:.2}",
            score.recall(),
            score.precision()
        );
        assert!(
            score.recall() >= recall,
            "{} {size}: {score:?}",
            machine.name
        );
        assert!(
            score.precision() >= precision,
            "{} {size}: {score:?}",
            machine.name
        );
    }
}

#[test]
fn noise_alone_gives_no_alarm() {
    // 6,000 runs each; without a ruler, the paces (7) look like steps.
    for (number, machine) in MACHINES
        .into_iter()
        .enumerate()
        .filter(|(number, _)| *number != 7)
    {
        let score = score(machine, 0.0);
        println!("{number}: {} in {} runs", score.wrong, score.runs);
        assert!(score.wrong <= 6, "{}: {score:?}", machine.name);
    }
}

/// Benches of `ci/history/record`: the points, and the runs at which frames were made longer or shorter.
fn recorded(name: &str) -> (Vec<TimedRun>, Vec<usize>) {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../reports/history");
    let text = std::fs::read_to_string(folder.join(name)).unwrap();
    let line = |line: &str| {
        let values: Vec<f64> = line.split(',').map(|v| v.parse().unwrap()).collect();
        let [_, percent, rounds @ .., ruler] = values.as_slice() else {
            panic!("{line}")
        };
        let rounds: Vec<[f64; 1]> = rounds.iter().map(|t| [*t]).collect();
        let samples = Samples::new(&rounds).unwrap();
        let samples = samples.with_ruler(&vec![*ruler; rounds.len()]).unwrap();
        (TimedRun::from(&samples), *percent)
    };
    let (points, percents): (Vec<TimedRun>, Vec<f64>) = text.lines().skip(1).map(line).unzip();
    let steps = (1..percents.len()).filter(|i| percents[*i] != percents[i - 1]);
    (points, steps.collect())
}

#[test]
fn recorded_steps_are_found_with_few_false_alarms() {
    // The machine changed its pace at times, once seven runs before a step.
    let (points, steps) = recorded("recorded.csv");
    assert_eq!(
        (points.len(), steps.as_slice()),
        (200, &[40, 80, 110, 150, 175][..])
    );
    let changes = change_points(&points).unwrap();
    for point in &changes.points {
        println!("{point:?}");
    }
    println!("noise {} drifts {:?}", changes.noise, changes.drifts);
    let mut score = Score::default();
    score.add(&steps, &alarms(&points), points.len());
    assert!(score.recall() >= 0.8, "{score:?}");
    assert!(score.precision() >= 0.8, "{score:?}");
    let middle = |from: usize, to: usize| {
        let mut medians: Vec<f64> = points[from..to].iter().map(|p| p.median).collect();
        medians.sort_unstable_by(f64::total_cmp);
        quantile(&medians, 0.5).unwrap()
    };
    let first = changes
        .points
        .iter()
        .find(|p| p.index.abs_diff(40) <= 5)
        .unwrap();
    let expected = middle(40, 80) / middle(0, 40);
    assert!(
        (first.ratio.estimate / expected - 1.0).abs() < 0.02,
        "{first:?} {expected}"
    );
}

#[test]
fn a_machine_that_is_busy_hides_steps_and_says_so() {
    // During other work, frames and the ruler took up to twice as long for hours; steps of 3 to 11 % are
    // planted.
    for name in ["recorded-busy-1.csv", "recorded-busy-2.csv"] {
        let (points, steps) = recorded(name);
        let changes = change_points(&points).unwrap();
        let mut score = Score::default();
        score.add(&steps, &alarms(&points), points.len());
        println!(
            "{name}: {score:?} {:?} {:?}",
            changes.visible(7),
            changes.noise
        );
        assert!(score.wrong <= 1, "{name}: {score:?}");
        // Twice the largest step.
        assert!(changes.visible(7).unwrap() > 1.22, "{name}");
    }
}
