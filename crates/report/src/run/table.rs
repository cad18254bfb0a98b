//! The summary for a terminal.

use crate::methods;
use crate::run::grid::{Grid, Tally};
use crate::words::{Tone, count, headline, name, plain, symbol};
use etalon_record::{Record, Run, Verdict};
use std::cmp::Reverse;
use std::collections::HashMap;
use tabled::builder::Builder;
use tabled::settings::object::{Cell, Columns, Rows};
use tabled::settings::peaker::Priority;
use tabled::settings::{Alignment, Color, Style, Width};

/// How wide and colourful [`table()`] may be.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TableOptions {
    /// Columns of the terminal; long lines are cut, and the table's cells wrapped.
    pub width: usize,
    /// Whether ANSI colours may be used. The caller knows `NO_COLOR` and whether this is a terminal.
    pub color: bool,
}

impl Default for TableOptions {
    fn default() -> Self {
        Self {
            width: 100,
            color: false,
        }
    }
}

/// The most unexpected records that are listed.
const LISTED: usize = 20;

/// Verdicts that say that a case could not be drawn; one column together.
const BROKEN: [Verdict; 6] = [
    Verdict::Flaky,
    Verdict::Crash,
    Verdict::Timeout,
    Verdict::DeviceLost,
    Verdict::ResourceError,
    Verdict::InternalError,
];

/// A table with a row per adapter, then a line per unexpected record (20 at most), then what is
/// missing. A bad verdict that was expected or due is counted under `expected` only, so that a
/// row's counts add up to its records; the rate counts records per second of drawing and judging.
/// Always ends in a newline.
pub fn table(run: &Run, options: TableOptions) -> String {
    if run.records.is_empty() {
        return format!("No case was run.\n{}", incomplete(run));
    }
    let grid = Grid::new(run);
    let rows: Vec<(&str, Vec<&Record>)> = grid
        .adapters
        .iter()
        .map(|a| (*a, run.records.iter().filter(|r| r.adapter == *a).collect()))
        .collect();
    let mut text = adapters(&rows, options);
    text.push('\n');
    if let Some(found) = methods::Methods::of(run) {
        text.push_str(&methods::lines(&found, options.width));
    }
    text.push_str(&unexpected(run, options));
    let improvements = run.records.iter().filter(|r| r.improvement()).count();
    if improvements > 0 {
        text.push_str(&format!(
            "{}: entries of the expectations may go\n",
            count(improvements as u64, "improvement")
        ));
    }
    text.push_str(&incomplete(run));
    text
}

fn adapters(rows: &[(&str, Vec<&Record>)], options: TableOptions) -> String {
    let measured = rows
        .iter()
        .any(|(_, r)| r.iter().any(|r| r.verdict == Verdict::Measured));
    let mut columns: Vec<(&str, &[Verdict], Color)> = vec![
        ("pass", &[Verdict::Pass], Color::FG_GREEN),
        ("imprecise", &[Verdict::Imprecise], Color::FG_CYAN),
        ("fail", &[Verdict::Fail], Color::FG_RED | Color::BOLD),
        ("open", &[Verdict::Open], Color::FG_YELLOW),
        (
            "not supported",
            &[Verdict::NotSupported],
            Color::FG_BRIGHT_BLACK,
        ),
        ("crash & co", &BROKEN, Color::FG_MAGENTA | Color::BOLD),
    ];
    // Adapters that lack something and cases that were not to be drawn stand apart.
    let skipped = rows
        .iter()
        .any(|(_, r)| r.iter().any(|r| r.verdict == Verdict::Skipped));
    if skipped {
        let column = ("skipped", &[Verdict::Skipped][..], Color::FG_BRIGHT_BLACK);
        columns.insert(columns.len() - 1, column);
    }
    if measured {
        columns.insert(1, ("measured", &[Verdict::Measured], Color::FG_BLUE));
    }
    let mut builder = Builder::default();
    let names = columns.iter().map(|(name, _, _)| *name);
    builder.push_record(
        ["adapter"]
            .into_iter()
            .chain(names)
            .chain(["expected", "cases/s"]),
    );
    let mut painted = Vec::new();
    for (at, (adapter, records)) in rows.iter().enumerate() {
        let tally = Tally::of(records.iter().copied());
        let mut row = vec![plain(adapter, 60)];
        for (i, (_, verdicts, color)) in columns.iter().enumerate() {
            let n: u64 = verdicts.iter().map(|v| tally.plain(*v)).sum();
            row.push(blank_zero(n));
            if n > 0 {
                painted.push((Cell::new(at + 1, i + 1), color.clone()));
            }
        }
        row.push(blank_zero(tally.excused()));
        row.push(rate(records));
        builder.push_record(row);
    }
    let mut table = builder.build();
    table
        .with(Style::rounded())
        .modify(Columns::new(1..), Alignment::right());
    if options.color {
        table.modify(Rows::first(), Color::BOLD);
        for (cell, color) in painted {
            table.modify(cell, color);
        }
    }
    table.with(
        Width::wrap(options.width)
            .keep_words(true)
            .priority(Priority::max(true)),
    );
    table.to_string()
}

fn blank_zero(n: u64) -> String {
    match n {
        0 => "·".to_owned(),
        n => n.to_string(),
    }
}

fn rate(records: &[&Record]) -> String {
    let seconds: f64 = records
        .iter()
        .map(|r| r.seconds.draw + r.seconds.judge)
        .sum();
    if seconds > 0.0 {
        format!("{:.0}", records.len() as f64 / seconds)
    } else {
        "·".to_owned()
    }
}

fn unexpected(run: &Run, options: TableOptions) -> String {
    let mut bad: Vec<&Record> = run.records.iter().filter(|r| r.unexpected()).collect();
    if bad.is_empty() {
        return String::new();
    }
    bad.sort_by_key(|r| (Reverse(r.verdict.severity()), &r.case, &r.adapter));
    // One of each kind before the second of any: a list of one driver's one bug says little.
    let mut seen: HashMap<(&str, &str, Verdict), usize> = HashMap::new();
    bad.sort_by_cached_key(|r| {
        let rank = seen
            .entry((r.case_file(), &r.adapter, r.verdict))
            .or_default();
        *rank += 1;
        *rank
    });
    let mut text = format!("\n{}\n", count(bad.len() as u64, "unexpected record"));
    for record in bad.iter().take(LISTED) {
        let sign = match Tone::of(record) {
            Tone::Missed => symbol(Verdict::Fail),
            _ => symbol(record.verdict),
        };
        let head = format!("{sign} {}", name(record.verdict));
        let head = if options.color {
            format!("\u{1b}[31m{head}\u{1b}[0m")
        } else {
            head
        };
        let adapter = plain(&record.adapter, 60);
        text.push_str(&format!(
            "{head}  {adapter}  {}\n",
            plain(&record.case, 300)
        ));
        let room = options.width.saturating_sub(5).max(20);
        text.push_str(&format!("    {}\n", plain(&headline(record), room)));
    }
    match bad.len().saturating_sub(LISTED) {
        0 => {}
        n => text.push_str(&format!("and {n} more\n")),
    }
    text
}

fn incomplete(run: &Run) -> String {
    let mut text = String::new();
    if run.truncated {
        text.push_str("The last record was cut off: the run did not end by itself.\n");
    }
    let missing = run.missing();
    if missing > 0 {
        text.push_str(&format!(
            "Incomplete: {missing} of {} records are missing.\n",
            run.header.expected_records()
        ));
    }
    text
}
