//! The comparison of two benches for a terminal.

use super::compare::{BenchDiff, TimeChange};
use crate::bench::kind::KINDS;
use crate::numbers::{change, duration};
use crate::terminal::{self, TableOptions, wrapped};
use crate::words::plain;
use tabled::builder::Builder;
use tabled::settings::Color;

/// Facts that make the benches hard to compare, a table of changes per kind of adapter, cases that were timed
/// in one bench only, and the sum. Always ends in a newline.
pub fn diff_table(diff: &BenchDiff, options: TableOptions) -> String {
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
        let changes: Vec<&TimeChange> =
            diff.changes.iter().filter(|c| c.software == kind).collect();
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
    let (sign, color) = match (diff.worse(), diff.untold()) {
        (true, _) => ("✗", "31"),
        (false, [0, 0]) => ("✓", "32"),
        (false, _) => ("?", "33"),
    };
    let line = format!("{sign} {}.", diff.conclusion());
    text.push_str(&options.paint(&plain(&line, 400), color));
    text.push('\n');
    let n = diff.changes.len();
    text.push_str(&format!(
        "{} slower, {} faster, {} undecided. Of {n} comparisons of unchanged things, at most {:.3} \
         are called a change on average ({} each).\n",
        diff.count("slower"),
        diff.count("faster"),
        diff.count("cannot tell"),
        n as f64 * diff.level,
        diff.level,
    ));
    text
}

fn changes_table(changes: &[&TimeChange], options: TableOptions) -> String {
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
    let (builder, _) = terminal::fit(builder, options, &[7, 3, 4, 6]);
    let mut table = terminal::table(builder, options, 3);
    if options.color {
        for (row, color) in painted {
            table.modify((row, 2), color);
        }
    }
    wrapped(table, options)
}
