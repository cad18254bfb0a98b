//! The summary for a terminal.

use crate::methods;
use crate::numbers::count;
use crate::run::blind::blind_spots;
use crate::run::grid::{RunGrid, VerdictTally, rate};
use crate::run::reasons::{ReasonRecords, total, undrawn};
use crate::run::unexpected::unexpected_records;
use crate::table::{Cell, Table, some};
use crate::terminal::{self, TableOptions};
use crate::words::{Tone, headline, name, plain, symbol};
use etalon_record::{Record, Run, Verdict};
use std::collections::BTreeMap;
use tabled::settings::Color;

/// The maximum number of unexpected records that are listed.
const LISTED: usize = 20;

/// The maximum number of reasons for cases that were not drawn.
const REASONS: usize = 10;

/// Verdicts of cases without a frame to judge. They share one column.
const BROKEN: [Verdict; 7] = [
    Verdict::Blocked,
    Verdict::Flaky,
    Verdict::Crash,
    Verdict::Timeout,
    Verdict::DeviceLost,
    Verdict::ResourceError,
    Verdict::InternalError,
];

/// Returns a table with a row per adapter, then the reasons why cases were not drawn, then a line per unexpected
/// record (20 at most), then what is missing. A bad verdict that was expected is counted under `expected`
/// only, a selftest that failed as due under `selftests`, so that a row's counts add up to its records; the rate counts records per second of drawing and judging.
/// Always ends in a newline.
pub fn table(run: &Run, options: TableOptions) -> String {
    if run.records.is_empty() {
        return format!("No case was run.\n{}", incomplete(run));
    }
    let grid = RunGrid::new(run);
    let rows: Vec<(&str, Vec<&Record>)> = grid
        .adapters
        .iter()
        .map(|a| (*a, run.records.iter().filter(|r| r.adapter == *a).collect()))
        .collect();
    let mut text = format!(
        "{}\n{}{}",
        adapters(&rows, options),
        explanations(&rows),
        not_drawn(run, options)
    );
    if let Some(found) = methods::Methods::of(run) {
        text.push_str(&methods::lines(&found));
    }
    text.push_str(&hidden(run, options));
    text.push_str(&unexpected(run, options));
    let improvements = run.records.iter().filter(|r| r.improvement()).count();
    if improvements > 0 {
        text += &format!(
            "{}: their expectations can be removed\n",
            count(improvements as u64, "improvement")
        );
    }
    text.push_str(&incomplete(run));
    text
}

/// Columns whose names do not say what they count.
const EXPLAINED: [Explained; 5] = [
    Explained {
        column: "imprecise",
        text: "allowed, but less exact than 32-bit arithmetic",
        count: |tally| tally.plain(Verdict::Imprecise),
    },
    Explained {
        column: "open",
        text: "nothing could be asserted",
        count: |tally| tally.plain(Verdict::Open),
    },
    Explained {
        column: "broken",
        text: "no picture to judge, because of a crash, a block or the like",
        count: |tally| BROKEN.iter().map(|v| tally.plain(*v)).sum(),
    },
    Explained {
        column: "expected",
        text: "bad, but a finding or --expect says so",
        count: |tally| tally.known,
    },
    Explained {
        column: "selftests",
        text: "cases that must fail, and did",
        count: |tally| tally.due,
    },
];

/// A column and what it counts.
struct Explained {
    column: &'static str,
    text: &'static str,
    count: fn(&VerdictTally) -> u64,
}

/// Columns that are shown only if a run has such a verdict.
const RARE: [&str; 4] = ["measured", "required by CTS", "disputed", "skipped"];

fn adapters(rows: &[(&str, Vec<&Record>)], options: TableOptions) -> String {
    use Verdict::{
        Disputed, Fail, Imprecise, Measured, NotSupported, Open, Pass, RequiredByCts, Skipped,
    };
    let occurs = |verdicts: &[Verdict]| {
        let mut records = rows.iter().flat_map(|(_, records)| records);
        records.any(|r| verdicts.contains(&r.verdict))
    };
    // The adapter decides what is not supported; the user decides what is skipped.
    let columns: [(&'static str, &[Verdict], Color); 10] = [
        ("pass", &[Pass], Color::FG_GREEN),
        ("measured", &[Measured], Color::FG_BLUE),
        ("imprecise", &[Imprecise], Color::FG_CYAN),
        ("fail", &[Fail], Color::FG_RED | Color::BOLD),
        ("required by CTS", &[RequiredByCts], Color::FG_RED),
        ("disputed", &[Disputed], Color::FG_RED),
        ("open", &[Open], Color::FG_YELLOW),
        ("not supported", &[NotSupported], Color::FG_BRIGHT_BLACK),
        ("skipped", &[Skipped], Color::FG_BRIGHT_BLACK),
        ("broken", &BROKEN, Color::FG_MAGENTA | Color::BOLD),
    ];
    let mut table =
        Table::<(&str, VerdictTally, Option<String>)>::new("").text("adapter", |row| row.0);
    // Columns of zeros are left out first, then the columns that say least about the driver.
    let mut optional = Vec::new();
    for (name, verdicts, color) in columns {
        let occurs = occurs(verdicts);
        if !occurs && RARE.contains(&name) {
            continue;
        }
        if !occurs {
            optional.push(name);
        }
        table = table.number(name, move |(_, tally, _)| {
            let count = some(verdicts.iter().map(|v| tally.plain(*v)).sum());
            Cell::from(count).color(count.map(|_| color.clone()))
        });
    }
    optional.extend([
        "cases/s",
        "selftests",
        "imprecise",
        "skipped",
        "measured",
        "not supported",
        "open",
    ]);
    let table = table
        .number("expected", |(_, tally, _)| some(tally.known))
        .number("selftests", |(_, tally, _)| some(tally.due))
        .number("cases/s", |(_, _, rate)| rate.clone());
    let rows = rows.iter().map(|(adapter, records)| {
        (
            *adapter,
            VerdictTally::of(records.iter().copied()),
            rate(records).map(|rate| format!("{rate:.0}")),
        )
    });
    let (mut text, left_out) = table.terminal(rows, options, &optional);
    if !left_out.is_empty() {
        text.push('\n');
        text.push_str(&terminal::listed(
            "Left out for width: ",
            &left_out,
            2,
            options,
        ));
    }
    text
}

/// Returns what the columns count that have a number and need a word about it.
fn explanations(rows: &[(&str, Vec<&Record>)]) -> String {
    let tally = VerdictTally::of(rows.iter().flat_map(|(_, records)| records.iter().copied()));
    let shown = EXPLAINED.iter().filter(|e| (e.count)(&tally) > 0);
    shown
        .map(|e| format!("{}: {}\n", e.column, e.text))
        .collect()
}

/// Returns the number of records of cases that were not drawn, and the reasons, with counts per adapter.
fn not_drawn(run: &Run, options: TableOptions) -> String {
    let reasons = undrawn(run);
    if reasons.is_empty() {
        return String::new();
    }
    let undrawn_records = total(&reasons);
    let mut text = format!(
        "\nNot drawn: {undrawn_records} of {}\n",
        count(run.records.len() as u64, "record")
    );
    let named = reasons.iter().map(|reason| (reason, reason.sentence()));
    text += &by_adapter(&named.collect::<Vec<_>>(), ["for", "other reason"], options);
    text
}

/// Returns the kinds of cases that show no further bug of an adapter, because it draws each one wrong as expected.
fn hidden(run: &Run, options: TableOptions) -> String {
    let spots = blind_spots(run.all_records());
    if spots.is_empty() {
        return String::new();
    }
    let named = spots.iter().map(|spot| (spot, spot.text.clone()));
    format!(
        "\nHidden: {} of cases that an adapter draws wrong throughout, as expected, so that no other bug can show there\n{}",
        count(spots.len() as u64, "kind"),
        by_adapter(&named.collect::<Vec<_>>(), ["of", "other kind"], options)
    )
}

/// Returns a line for each of the first reasons, with its number of records on each adapter, and one for the others.
fn by_adapter(
    named: &[(&ReasonRecords, String)],
    [of, other]: [&str; 2],
    options: TableOptions,
) -> String {
    let sum = |named: &[(&ReasonRecords, String)]| -> u64 {
        named.iter().map(|(reason, _)| reason.records()).sum()
    };
    let width = sum(named).to_string().len();
    let mut text = String::new();
    for (reason, name) in named.iter().take(REASONS) {
        let head = format!("  {:>width$}  {}: ", reason.records(), plain(name, 160));
        text.push_str(&terminal::listed(&head, &reason.each(), width + 6, options));
        text.push('\n');
    }
    if let Some(others) = named.get(REASONS..).filter(|others| !others.is_empty()) {
        let n = sum(others);
        text += &format!(
            "  {n:>width$}  {of} {}\n",
            count(others.len() as u64, other)
        );
    }
    text
}

fn unexpected(run: &Run, options: TableOptions) -> String {
    let bad = unexpected_records(run);
    if bad.is_empty() {
        return String::new();
    }
    let mut text = format!("\n{}\n", count(bad.len() as u64, "unexpected record"));
    let mut left = bad.len();
    for group in blocked_together(bad).into_iter().take(LISTED) {
        let record = group[0];
        left -= group.len();
        let sign = match Tone::of(record) {
            Tone::Missed => symbol(Verdict::Fail),
            _ => symbol(record.verdict),
        };
        let head = options.paint(&format!("{sign} {}", name(record.verdict)), "31");
        let adapter = plain(&record.adapter, 60);
        // The whole record in one line: a terminal wraps it if necessary, and a program finds all of it.
        let (case, reason) = (plain(&record.case, 300), headline(record));
        let case = match group.len() {
            1 => case,
            n => format!("{} (reasons above), first {case}", count(n as u64, "case")),
        };
        text += &format!("{head}  {adapter}  {case}: {reason}\n");
    }
    match left {
        0 => {}
        n => text.push_str(&format!("and {n} more\n")),
    }
    text
}

/// Groups the blocked records of each adapter; each other record is a group of its own.
fn blocked_together(records: Vec<&Record>) -> Vec<Vec<&Record>> {
    let mut groups: Vec<Vec<&Record>> = Vec::new();
    let mut blocked = BTreeMap::new();
    for record in records {
        let next = groups.len();
        let group = match record.verdict {
            Verdict::Blocked => *blocked.entry(&record.adapter).or_insert(next),
            _ => next,
        };
        if group == next {
            groups.push(Vec::new());
        }
        groups[group].push(record);
    }
    groups
}

fn incomplete(run: &Run) -> String {
    let mut text = String::new();
    if run.truncated {
        text.push_str("The last record was cut off: the run did not end by itself.\n");
    }
    let missing = run.missing();
    if missing > 0 {
        text += &format!(
            "Incomplete: {missing} of {} records are missing.\n",
            run.header.expected_records()
        );
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;
    use etalon_record::{Expected, Header};

    #[test]
    fn blocked_records_are_one_line_and_columns_are_explained() {
        let blocked = |case: &str| Record::new(case, "gl:x", Verdict::Blocked);
        let mut known = Record::new("a/known", "gl:x", Verdict::Fail);
        known.expected = Some(Expected {
            reason: "a bug".to_owned(),
        });
        let run = Run {
            header: Header::new(Vec::new(), 5),
            records: vec![
                blocked("a/b"),
                blocked("a/c"),
                blocked("b/c"),
                Record::new("a/d", "gl:x", Verdict::Fail),
                known,
            ],
            beside: Vec::new(),
            truncated: false,
        };
        let text = table(&run, TableOptions::default());
        assert!(text.contains("4 unexpected records"), "{text}");
        let lines: Vec<&str> = text.lines().filter(|l| l.contains("⊗")).collect();
        assert_eq!(lines.len(), 1, "{text}");
        assert!(
            lines[0].contains("3 cases (reasons above), first a/b"),
            "{text}"
        );
        for (column, is_explained) in [
            ("expected: ", true),
            ("broken: ", true),
            ("imprecise: ", false),
        ] {
            let found = text.lines().any(|line| line.starts_with(column));
            assert_eq!(found, is_explained, "{text}");
        }
    }
}
