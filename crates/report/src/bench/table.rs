//! The summary of a bench for a terminal.

use super::figures::{Figures, Timed};
use super::kind::KINDS;
use crate::numbers::{change, count, duration};
use crate::terminal::{self, TableOptions, wrapped};
use crate::words::plain;
use etalon_record::{Bench, Time, cell};
use tabled::builder::Builder;

/// The cases outside the performance matrix: a table per kind of adapter with a row per case and adapter, fastest first; then what was not
/// timed, and why. Always ends in a newline.
pub fn bench_table(bench: &Bench, options: TableOptions) -> String {
    let figures = Figures::new(bench);
    let mut text = String::new();
    for (kind, title) in KINDS {
        let mut builder = Builder::default();
        builder.push_record([
            "case", "#", "adapter", "median", "interval", "p95", "cpu", "gpu", "n", "visible",
        ]);
        let mut rows = 0;
        for case in figures.cases.iter().filter(|c| cell(c.case).is_none()) {
            for (i, timed) in case.of_kind(kind).iter().enumerate() {
                let name = if i == 0 { case.case } else { "" };
                builder.push_record(row(name, timed));
                rows += 1;
            }
        }
        if rows > 0 {
            // Samples, the visible change, the other times, the interval.
            let (builder, _) = terminal::fit(builder, options, &[8, 7, 6, 9, 5, 4]);
            let table = wrapped(terminal::table(builder, options, 3), options);
            text.push_str(&format!("{title}\n{table}\n\n"));
        }
    }
    let untimed: Vec<_> = figures
        .cases
        .iter()
        .filter(|c| cell(c.case).is_none())
        .flat_map(|c| &c.untimed)
        .collect();
    if !untimed.is_empty() {
        text.push_str("Not timed\n");
        for record in untimed {
            let p = &record.picture;
            let verdict = record.ended.as_ref().map_or(p.verdict, |e| e.verdict);
            let line = format!(
                "{verdict}  {}  {}",
                plain(&p.adapter, 60),
                plain(&p.case, 200)
            );
            text.push_str(&format!("  {line}\n"));
        }
        text.push('\n');
    }
    let missing = bench.missing();
    if bench.truncated || missing > 0 {
        let rounds = count(missing, "round");
        text.push_str(&format!("Incomplete: {rounds} missing.\n"));
    }
    text.push_str(
        "Median of the rounds' medians with its 99 % interval; adapters with equal ranks (#) do not differ provably;\n\
         visible: the smallest change that a diff with another bench like this one would find.\n",
    );
    text
}

fn row(case: &str, timed: &Timed<'_>) -> Vec<String> {
    let s = &timed.wall;
    let other = |time: Time| match timed.others.get(&time) {
        Some(summary) => duration(summary.median),
        None => "·".to_owned(),
    };
    let interval = match s.interval {
        Some([low, high]) => format!("{} to {}", duration(low), duration(high)),
        None => "·".to_owned(),
    };
    vec![
        plain(case, 120),
        timed.rank.to_string(),
        plain(timed.adapter(), 60),
        duration(s.median),
        interval,
        duration(s.p95),
        other(Time::Cpu),
        other(Time::Gpu),
        format!("{}×{}", s.rounds, s.samples / s.rounds.max(1)),
        s.visible.map_or_else(|| "·".to_owned(), change),
    ]
}
