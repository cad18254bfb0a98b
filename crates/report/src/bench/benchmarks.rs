//! The figures of a bench for services that keep a history of their own.

use super::figures::{Figures, Timed};
use crate::numbers::change;
use etalon_dashboards::{Benchmark, Figure, nanoseconds};
use etalon_record::Time;
use etalon_stats::Summary;

/// All that was timed, in the order of the figures.
pub(crate) fn benchmarks(figures: &Figures<'_>) -> Vec<Benchmark> {
    let each = figures.timed().map(|(case, timed)| {
        let wall = [(Time::Wall, figure(&timed.wall))].into_iter();
        let others = timed.others.iter().map(|(time, s)| (*time, figure(s)));
        Benchmark {
            // Ids and adapters hold no spaces.
            name: format!("{case} {}", timed.adapter()),
            times: wall.chain(others).collect(),
            extra: extra(timed),
        }
    });
    each.collect()
}

fn figure(summary: &Summary) -> Figure {
    Figure {
        median: summary.median,
        interval: summary.interval,
    }
}

fn extra(timed: &Timed<'_>) -> String {
    let s = &timed.wall;
    let visible = s.visible.map_or_else(
        || "no change is visible with so few rounds".to_owned(),
        |v| format!("smallest visible change {}", change(v)),
    );
    format!(
        "{} rounds, {} samples, {} discarded as warm-up\np50 {} ns, p95 {} ns\n{visible}",
        s.rounds,
        s.samples,
        timed.record.discarded(),
        nanoseconds(s.p50),
        nanoseconds(s.p95),
    )
}
