//! The summary for a terminal.

use crate::methods;
use crate::numbers::count;
use crate::run::grid::{Grid, Tally};
use crate::run::undrawn::{Undrawn, undrawn};
use crate::run::unexpected::unexpected_records;
use crate::terminal::{self, TableOptions, dotted, wrapped};
use crate::words::{Tone, headline, name, plain, symbol};
use etalon_record::{Record, Run, Verdict};
use tabled::builder::Builder;
use tabled::settings::Color;
use tabled::settings::object::Cell;

/// The most unexpected records that are listed.
const LISTED: usize = 20;

/// The most reasons for cases that were not drawn.
const REASONS: usize = 10;

/// Verdicts of cases without a frame to judge; one column together.
const BROKEN: [Verdict; 7] = [
    Verdict::Blocked,
    Verdict::Flaky,
    Verdict::Crash,
    Verdict::Timeout,
    Verdict::DeviceLost,
    Verdict::ResourceError,
    Verdict::InternalError,
];

/// A table with a row per adapter, then the reasons for which cases were not drawn, then a line per unexpected record (20 at most), then what is
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
    text.push_str(&not_drawn(run, options));
    if let Some(found) = methods::Methods::of(run) {
        text.push_str(&methods::lines(&found, options.width));
    }
    text.push_str(&unexpected(run, options));
    let improvements = run.records.iter().filter(|r| r.improvement()).count();
    if improvements > 0 {
        text.push_str(&format!(
            "{}: their expectations can be removed\n",
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
        ("broken", &BROKEN, Color::FG_MAGENTA | Color::BOLD),
    ];
    // Not supported is the adapter's word, skipped is the user's.
    let skipped = rows
        .iter()
        .any(|(_, r)| r.iter().any(|r| r.verdict == Verdict::Skipped));
    if skipped {
        let column = ("skipped", &[Verdict::Skipped][..], Color::FG_BRIGHT_BLACK);
        columns.insert(columns.len() - 1, column);
    }
    // Weaker grades of evidence have columns of their own, where a run has any.
    for (name, verdict) in [
        ("disputed", Verdict::Disputed),
        ("required by CTS", Verdict::RequiredByCts),
    ] {
        let any = rows
            .iter()
            .any(|(_, r)| r.iter().any(|r| r.verdict == verdict));
        if any {
            let verdicts: &[Verdict] = match verdict {
                Verdict::Disputed => &[Verdict::Disputed],
                _ => &[Verdict::RequiredByCts],
            };
            columns.insert(3, (name, verdicts, Color::FG_RED));
        }
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
            row.push(dotted(n));
            if n > 0 {
                painted.push((at + 1, i + 1, color.clone()));
            }
        }
        row.push(dotted(tally.excused()));
        row.push(rate(records));
        builder.push_record(row);
    }
    // What is 0 everywhere goes first, then what says least about the driver.
    let empty = |i: &usize| {
        let none = |verdicts: &[Verdict]| {
            rows.iter()
                .all(|(_, r)| !r.iter().any(|r| verdicts.contains(&r.verdict)))
        };
        none(columns[*i].1)
    };
    let mut optional: Vec<usize> = (0..columns.len()).filter(empty).map(|i| i + 1).collect();
    optional.push(columns.len() + 2);
    for name in ["imprecise", "skipped", "measured", "not supported", "open"] {
        let place = columns
            .iter()
            .position(|(other, ..)| *other == name)
            .map(|i| i + 1);
        optional.extend(place.filter(|i| !optional.contains(i)));
    }
    let heads: Vec<&str> = columns.iter().map(|(name, ..)| *name).collect();
    let (builder, left_out) = terminal::fit(builder, options, &optional);
    let mut table = terminal::table(builder, options, 1);
    if options.color {
        for (row, column, color) in painted {
            let before = left_out.iter().filter(|c| **c < column).count();
            if !left_out.contains(&column) {
                table.modify(Cell::new(row, column - before), color);
            }
        }
    }
    let mut text = wrapped(table, options);
    let named: Vec<String> = left_out
        .iter()
        .map(|column| {
            heads
                .get(*column - 1)
                .copied()
                .unwrap_or("cases/s")
                .to_owned()
        })
        .collect();
    if !named.is_empty() {
        text.push('\n');
        text.push_str(&terminal::listed(
            "Left out for width: ",
            &named,
            2,
            options,
        ));
    }
    text
}

/// The number of records of cases that were not drawn, and the reasons, with counts per adapter.
fn not_drawn(run: &Run, options: TableOptions) -> String {
    let reasons = undrawn(run);
    if reasons.is_empty() {
        return String::new();
    }
    let all: u64 = reasons.iter().map(Undrawn::records).sum();
    let mut text = format!(
        "\nNot drawn: {all} of {}\n",
        count(run.records.len() as u64, "record")
    );
    let width = all.to_string().len();
    for reason in reasons.iter().take(REASONS) {
        let adapters = reason.adapters.iter();
        let each: Vec<String> = adapters.map(|(name, n)| format!("{name} {n}")).collect();
        let head = format!(
            "  {:>width$}  {}: ",
            reason.records(),
            plain(&reason.text(), 160)
        );
        text.push_str(&terminal::listed(&head, &each, width + 6, options));
        text.push('\n');
    }
    if reasons.len() > REASONS {
        let rest = &reasons[REASONS..];
        let n: u64 = rest.iter().map(Undrawn::records).sum();
        text.push_str(&format!(
            "  {n:>width$}  for {}\n",
            count(rest.len() as u64, "other reason")
        ));
    }
    text
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
    let bad = unexpected_records(run);
    if bad.is_empty() {
        return String::new();
    }
    let mut text = format!("\n{}\n", count(bad.len() as u64, "unexpected record"));
    for record in bad.iter().take(LISTED) {
        let sign = match Tone::of(record) {
            Tone::Missed => symbol(Verdict::Fail),
            _ => symbol(record.verdict),
        };
        let head = options.paint(&format!("{sign} {}", name(record.verdict)), "31");
        let adapter = plain(&record.adapter, 60);
        // One line, whole: a terminal breaks it where it must, and a program finds all of it.
        let (case, reason) = (plain(&record.case, 300), headline(record));
        text.push_str(&format!("{head}  {adapter}  {case}: {reason}\n"));
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
