//! The summary of a bench for a terminal.

use super::figures::{KINDS, TimedCase, end, figures};
use crate::numbers::{between, change, count, duration};
use crate::table::Table;
use crate::terminal::TableOptions;
use crate::words::plain;
use etalon_record::{Bench, Time, cell};
use std::iter::repeat;

/// Returns a table for each kind of adapter, with a row per case and adapter, fastest first. The cases
/// without times follow, with the reasons. Cases of the performance matrix are excluded. The text always ends
/// in a newline.
pub fn bench_table(bench: &Bench, options: TableOptions) -> String {
    let figures = figures(bench);
    let mut text = String::new();
    let cases = || figures.iter().filter(|c| cell(c.case).is_none());
    for (kind, title) in KINDS {
        let rows: Vec<(&str, &TimedCase<'_>)> = cases()
            .flat_map(|case| {
                let names = [case.case].into_iter().chain(repeat(""));
                names.zip(case.of_kind(kind))
            })
            .collect();
        if !rows.is_empty() {
            let optional = ["n", "gpu", "cpu", "visible", "p95", "interval"];
            let mut table = table();
            if rows.iter().any(|(_, timed)| timed.instructions().is_some()) {
                table = table.number("instructions", |(_, timed)| timed.instructions());
            }
            let (table, _) = table.terminal(rows, options, &optional);
            text += &format!("{title}\n{table}\n\n");
        }
    }
    let untimed: Vec<_> = cases().flat_map(|c| &c.untimed).collect();
    if !untimed.is_empty() {
        text.push_str("Not timed\n");
        for record in untimed {
            let (verdict, p) = (end(record).0, &record.picture);
            let (adapter, case) = (plain(&p.adapter, 60), plain(&p.case, 200));
            text += &format!("  {verdict}  {adapter}  {case}\n");
        }
        text.push('\n');
    }
    let missing = bench.missing();
    if bench.truncated || missing > 0 {
        let rounds = count(missing, "round");
        text += &format!("Incomplete: {rounds} missing.\n");
    }
    text.push_str(
        "Median of the rounds' medians with its 99 % interval; adapters with equal ranks (#) do not differ provably;\n\
         visible: the smallest change that a diff with another bench like this one would find.\n",
    );
    text
}

fn table<'a>() -> Table<'a, (&'a str, &'a TimedCase<'a>)> {
    Table::new("")
        .text("case", |(case, _): &(&'a str, &'a TimedCase<'a>)| *case)
        .text("#", |(_, timed)| timed.rank)
        .text("adapter", |(_, timed)| timed.adapter())
        .number("median", |(_, timed)| duration(timed.wall.median))
        .number("interval", |(_, timed)| {
            timed.wall.interval.map(|ends| between(ends, duration))
        })
        .number("p95", |(_, timed)| duration(timed.wall.p95))
        .number("cpu", |(_, timed)| timed.other(Time::Cpu))
        .number("gpu", |(_, timed)| timed.other(Time::Gpu))
        .number("n", |(_, timed)| timed.counted("×"))
        .number("visible", |(_, timed)| timed.wall.visible.map(change))
}
