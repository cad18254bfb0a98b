//! The cost of finding change points: series of growing length with a step every 100 runs, and appending a
//! run.

use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use etalon_stats::{TimedRun, change_points};
use oorandom::Rand64;
use std::hint::black_box;

/// Runs with noise of about 1 % and a step of 5 % every 100, up and down, with a ruler.
fn series(runs: usize) -> Vec<TimedRun> {
    let mut random = Rand64::new(1);
    let mut noise = |size: f64| 1.0 + size * (random.rand_float() + random.rand_float() - 1.0);
    let point = |run: usize| TimedRun {
        median: 0.003
            * noise(0.025)
            * if (run / 100).is_multiple_of(2) {
                1.0
            } else {
                1.05
            },
        interval: None,
        ruler: Some(0.002 * noise(0.01)),
    };
    (0..runs).map(point).collect()
}

fn cost(c: &mut Criterion) {
    let mut group = c.benchmark_group("change points");
    for runs in [100, 1_000, 10_000] {
        let points = series(runs);
        group.throughput(Throughput::Elements(runs as u64));
        group.bench_with_input(BenchmarkId::new("all", runs), &points, |b, points| {
            b.iter(|| change_points(black_box(points)));
        });
        let before = change_points(&points[..runs - 1]).expect("times are above zero");
        group.bench_with_input(BenchmarkId::new("one more", runs), &points, |b, points| {
            b.iter(|| before.append(black_box(points)));
        });
    }
    group.finish();
}

criterion_group!(benches, cost);
criterion_main!(benches);
