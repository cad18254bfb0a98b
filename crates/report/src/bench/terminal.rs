//! Benches for a terminal.

use super::data::{Figures, Timed};
use super::{KINDS, change, duration};
use crate::words::{count, plain};
use crate::{Change, Diff, TableOptions};
use etalon_record::{Bench, Time};
use tabled::Table;
use tabled::builder::Builder;
use tabled::settings::object::{Columns, Rows};
use tabled::settings::peaker::Priority;
use tabled::settings::{Alignment, Color, Style, Width};

/// A table per kind of adapter with a row per case and adapter, fastest first; then what was not
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
        for case in &figures.cases {
            for (i, timed) in case.of_kind(kind).iter().enumerate() {
                let name = if i == 0 { case.case } else { "" };
                builder.push_record(row(name, timed));
                rows += 1;
            }
        }
        if rows > 0 {
            let mut table = builder.build();
            finish(&mut table, options, 3);
            text.push_str(&format!("{title}\n{table}\n\n"));
        }
    }
    let untimed: Vec<_> = figures.cases.iter().flat_map(|c| &c.untimed).collect();
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
        "Median of the rounds' medians with its 99 % interval; equal numbers (#) cannot be told apart;\n\
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

fn finish(table: &mut Table, options: TableOptions, text_columns: usize) {
    table
        .with(Style::rounded())
        .modify(Columns::new(text_columns..), Alignment::right());
    if options.color {
        table.modify(Rows::first(), Color::BOLD);
    }
    table.with(
        Width::wrap(options.width)
            .keep_words(true)
            .priority(Priority::max(true)),
    );
}

/// What makes the benches hard to compare, a table of changes per kind of adapter, what was timed in
/// one of them only, and the sum. Always ends in a newline.
pub fn diff_table(diff: &Diff, options: TableOptions) -> String {
    let mut text = String::new();
    for (name, side) in [("before", &diff.before), ("after", &diff.after)] {
        let commit = side
            .commit
            .as_deref()
            .map_or(String::new(), |c| format!(" {c}"));
        let line = format!(
            "{name}: {}, etalon {}{commit}, {}",
            side.started, side.etalon, side.machine
        );
        text.push_str(&format!("{}\n", plain(&line, 300)));
    }
    for note in &diff.notes {
        text.push_str(&format!("! {}\n", plain(note, 300)));
    }
    text.push('\n');
    for (kind, title) in KINDS {
        let changes: Vec<&Change> = diff.changes.iter().filter(|c| c.software == kind).collect();
        if !changes.is_empty() {
            text.push_str(&format!("{title}, {} times\n", diff.time));
            text.push_str(&changes_table(&changes, options));
            text.push_str("\n\n");
        }
    }
    if !diff.gone.is_empty() {
        text.push_str("Timed in one bench only\n");
        for gone in &diff.gone {
            let side = if gone.from_after { "after" } else { "before" };
            let sign = if gone.worse { "✗" } else { " " };
            let line = format!("{}  {}  not {side}: {}", gone.case, gone.adapter, gone.why);
            text.push_str(&format!("{sign} {}\n", plain(&line, 400)));
        }
        text.push('\n');
    }
    let n = diff.changes.len();
    text.push_str(&format!(
        "{} slower, {} faster, {} cannot be told. Of {n} comparisons of unchanged things at most {:.3} \
         would be called a change on average ({} each).\n",
        diff.count("slower"),
        diff.count("faster"),
        diff.count("cannot tell"),
        n as f64 * diff.level,
        diff.level,
    ));
    text
}

fn changes_table(changes: &[&Change], options: TableOptions) -> String {
    let mut builder = Builder::default();
    builder.push_record([
        "case", "adapter", "outcome", "before", "after", "change", "interval", "visible",
    ]);
    let mut painted = Vec::new();
    for (at, c) in changes.iter().enumerate() {
        let outcome = match c.why {
            Some(why) => format!("{}: {why}", c.outcome),
            None => c.outcome.to_owned(),
        };
        match c.outcome {
            "slower" => painted.push((at + 1, Color::FG_RED | Color::BOLD)),
            "faster" => painted.push((at + 1, Color::FG_GREEN)),
            _ => {}
        }
        builder.push_record([
            plain(&c.case, 120),
            plain(&c.adapter, 60),
            outcome,
            duration(c.before),
            duration(c.after),
            change(c.ratio),
            c.interval.map_or_else(
                || "·".to_owned(),
                |[low, high]| format!("{} to {}", change(low), change(high)),
            ),
            c.visible.map_or_else(|| "·".to_owned(), change),
        ]);
    }
    let mut table = builder.build();
    if options.color {
        for (row, color) in painted {
            table.modify((row, 2), color);
        }
    }
    finish(&mut table, options, 3);
    table.to_string()
}
