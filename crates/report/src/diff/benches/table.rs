//! The comparison of two benches for a terminal.

use super::compare::{BenchDiff, TimeChange};
use super::instructions::instructions_table;
use crate::bench::figures::KINDS;
use crate::numbers::{between, change, duration};
use crate::page::adapter::adapter;
use crate::table::{Cell, Table};
use crate::terminal::TableOptions;
use crate::words::plain;
use etalon_stats::Conclusion;
use maud::html;
use tabled::settings::Color;

/// Returns facts that make the benches hard to compare, a table of changes for each kind of adapter, cases
/// that were timed in one bench only, and the sum. The text always ends in a newline.
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
        text += &format!("{}\n", plain(&line, 300));
    }
    for note in &diff.notes {
        text += &format!("! {}\n", plain(note, 300));
    }
    text.push('\n');
    for (kind, title) in KINDS {
        let changes = diff.of_kind(kind);
        if !changes.is_empty() {
            let optional = ["visible", "before", "after", "interval"];
            let (table, _) = changes_table().terminal(changes, options, &optional);
            text += &format!("{title}, {} times\n{table}\n\n", diff.time);
        }
    }
    if !diff.instructions.is_empty() {
        let (table, _) =
            instructions_table().terminal(diff.instructions.iter(), options, &["before", "after"]);
        text += &format!("Instructions of a frame\n{table}\n\n");
    }
    if !diff.gone.is_empty() {
        text.push_str("Timed in one bench only\n");
        for gone in &diff.gone {
            let side = if gone.is_missing_after {
                "after"
            } else {
                "before"
            };
            let sign = if gone.worse { "✗" } else { " " };
            let line = format!("{}  {}  not {side}: {}", gone.case, gone.adapter, gone.why);
            text += &format!("{sign} {}\n", plain(&line, 400));
        }
        text.push('\n');
    }
    let look = diff.look();
    let line = format!("{} {}.", look.sign, diff.conclusion());
    text.push_str(&options.paint(&plain(&line, 400), look.color));
    text.push('\n');
    let n = diff.changes.len();
    let counts = diff.counts();
    text += &format!(
        "{} slower, {} faster, {} undecided. Of {n} comparisons of unchanged things, at most {:.3} \
         are called a change on average ({} each).\n",
        counts.slower,
        counts.faster,
        counts.undecided,
        n as f64 * diff.level,
        diff.level,
    );
    text
}

/// Returns a table with a row per change.
pub(super) fn changes_table<'a>() -> Table<'a, &'a TimeChange> {
    let interval = |ends: Option<[f64; 2]>| ends.map(|ends| between(ends, change));
    Table::new("diff stacked")
        .row_class(|c: &&TimeChange| c.decided().unwrap_or_default())
        .head("case", |c| &*c.case)
        .text("adapter", |c| adapter(&c.adapter))
        .text("outcome", |c| {
            let why = c.why.map_or_else(String::new, |why| format!(": {why}"));
            let color = match c.outcome {
                Conclusion::Slower => Some(Color::FG_RED | Color::BOLD),
                Conclusion::Faster => Some(Color::FG_GREEN),
                Conclusion::CannotTell(_) => None,
            };
            let name = c.outcome.name();
            let shown = html! { b { (name) } small { (why) } };
            Cell::from(format!("{name}{why}"))
                .on_page(shown)
                .color(color)
        })
        .number("before", |c| duration(c.before))
        .number("after", |c| duration(c.after))
        .number("change", |c| change(c.ratio))
        .number("interval", move |c| interval(c.interval))
        .number("in units of the ruler", move |c| {
            let ends = interval(c.ruled_interval).unwrap_or_else(|| "–".to_owned());
            c.ruled.map(|ruled| format!("{} ({ends})", change(ruled)))
        })
        .only_on_page()
        .number("visible", |c| c.visible.map(change))
        .number("rounds", |c| format!("{} and {}", c.rounds[0], c.rounds[1]))
        .only_on_page()
}
