//! The comparison of two runs for a terminal.

use super::data::{AdapterPair, AreaTime, ChangeDirection, MethodTime, RunDiff, both_names};
use super::phrases;
use super::times::STATEMENT;
use crate::numbers::{count, duration, percent};
use crate::page::adapter::adapter;
use crate::table::{Table, some};
use crate::terminal::TableOptions;
use crate::words::{name, plain};

/// The maximum number of changes of a direction that the table lists.
const LISTED: [(ChangeDirection, usize); 3] = [
    (ChangeDirection::Worse, 20),
    (ChangeDirection::Better, 10),
    (ChangeDirection::Other, 10),
];
/// The maximum number of lines of cases in one run only, and of methods.
const LINES: usize = 10;
/// The maximum number of figures of a change in the table.
const FIGURES: usize = 4;

/// Returns the comparison as text: warnings, differences of the headers, a table of adapters, changes, cases
/// in one run only, times, and the sum.
///
/// Lists at most 20 worse changes, 10 better and 10 others, the most serious first, and the first of every
/// kind before any second one. The text always ends in a newline.
pub fn table(diff: &RunDiff, options: TableOptions) -> String {
    let mut text = String::new();
    for warning in &diff.warnings {
        text.push_str(&options.paint(&format!("! {}", plain(warning, 400)), "33"));
        text.push('\n');
    }
    for fact in diff.facts.iter().filter(|f| f.differs()) {
        text.push_str(&fact_line("", fact.name, &fact.before, &fact.after));
    }
    for pair in &diff.pairs {
        for fact in pair.facts.iter().filter(|f| f.differs()) {
            let name = format!("{} ", pair.name());
            text.push_str(&fact_line(&name, fact.name, &fact.before, &fact.after));
        }
    }
    for unpaired in &diff.unpaired {
        let sign = if unpaired.worse { "✗ " } else { "" };
        let line = format!(
            "{sign}{} {}: {}, not compared",
            unpaired.adapter,
            phrases::side(unpaired.side),
            count(unpaired.records, "record")
        );
        text += &format!("{}\n", plain(&line, 300));
    }
    if !text.is_empty() {
        text.push('\n');
    }
    if diff.pairs.is_empty() {
        text.push_str("Nothing was compared.\n");
        if diff.worse() {
            text.push_str(&sum(diff, options));
        }
        return text;
    }
    let (table, _) = pair_table().terminal(&diff.pairs, options, &[]);
    text += &format!("{table}\n\n");
    transitions(&mut text, &diff.pairs);
    for (direction, most) in LISTED {
        changes(&mut text, diff, direction, most, options);
    }
    only(&mut text, diff);
    times(&mut text, diff, options);
    text.push_str(&sum(diff, options));
    text
}

fn fact_line(name: &str, what: &str, before: &str, after: &str) -> String {
    let shown = |text: &str| match text {
        "" => "–".to_owned(),
        text => plain(text, 160),
    };
    let name = plain(name, 120);
    format!("{name}{what}: {} → {}\n", shown(before), shown(after))
}

/// Returns a table with a row per pair of adapters.
pub(super) fn pair_table<'a>() -> Table<'a, &'a AdapterPair> {
    Table::new("")
        .head("adapter", |pair: &&AdapterPair| adapter(&pair.name()))
        .number("compared", |pair| some(pair.compared))
        .number("same", |pair| some(pair.same))
        .number("worse", |pair| some(pair.worse))
        .number("better", |pair| some(pair.better))
        .number("other", |pair| some(pair.other))
        .number("only before", |pair| some(pair.only[0]))
        .number("only after", |pair| some(pair.only[1]))
        .number("asserted", |pair| {
            let [before, after] = pair.asserted.map(|share| percent(share, 2));
            if before == after {
                after
            } else {
                format!("{before} → {after}")
            }
        })
        .text("changed verdicts", |pair| phrases::transitions(pair))
        .only_on_page()
}

fn transitions(text: &mut String, pairs: &[AdapterPair]) {
    for pair in pairs.iter().filter(|p| !p.transitions.is_empty()) {
        let changes = phrases::transitions(pair);
        *text += &format!("{}: {changes}\n", plain(&pair.name(), 120));
    }
}

fn changes(
    text: &mut String,
    diff: &RunDiff,
    direction: ChangeDirection,
    most: usize,
    options: TableOptions,
) {
    let these = phrases::spread(&diff.changes, direction);
    if these.is_empty() {
        return;
    }
    let [sign, color, _] = phrases::look(direction);
    *text += &format!("\n{} {}\n", these.len(), direction.name());
    let room = options.room(4);
    for change in these.iter().take(most) {
        let head = format!("{sign} {}", phrases::verdicts(change));
        let adapter = plain(&both_names(&change.adapter), 120);
        let case = plain(&change.case, 300);
        *text += &format!("{}  {adapter}  {case}\n", options.paint(&head, color));
        let mut lines: Vec<String> = Vec::new();
        if change.verdict[0] != change.verdict[1] {
            // The headline of the worse record gives the reason.
            lines.push(change.headline[usize::from(direction != ChangeDirection::Better)].clone());
        }
        lines.extend(phrases::expectation(change).map(str::to_owned));
        if let Some(frame) = &change.frame {
            lines.push(phrases::frame(frame).join("; "));
        }
        let figures: Vec<String> = change
            .details
            .iter()
            .take(FIGURES)
            .map(phrases::detail)
            .collect();
        if !figures.is_empty() {
            lines.push(figures.join("; "));
        }
        for line in lines {
            *text += &format!("    {}\n", plain(&line, room));
        }
    }
    if these.len() > most {
        *text += &format!("and {} more\n", these.len() - most);
    }
}

fn only(text: &mut String, diff: &RunDiff) {
    let files = phrases::only_by_file(&diff.only);
    if files.is_empty() {
        return;
    }
    *text += &format!(
        "\n{} in one run only\n",
        count(diff.only.len() as u64, "record")
    );
    for (file, n) in files.iter().take(LINES) {
        let sign = if file.worse { "✗" } else { " " };
        let line = match n {
            1 => format!("{}, {}", file.case, name(file.verdict)),
            n => format!("{} of {}", count(*n, "case"), file.case_file),
        };
        let line = format!(
            "{sign} {}  {}  {line}",
            phrases::side(file.side),
            file.adapter
        );
        *text += &format!("{}\n", plain(&line, 400));
    }
    if files.len() > LINES {
        *text += &format!(
            "and of {} more\n",
            count((files.len() - LINES) as u64, "case file")
        );
    }
}

fn times(text: &mut String, diff: &RunDiff, options: TableOptions) {
    if diff.times.is_empty() && diff.methods.is_empty() {
        return;
    }
    *text += &format!("\nTimes. {STATEMENT}\n");
    if !diff.times.is_empty() {
        let (table, _) = area_table().terminal(&diff.times, options, &[]);
        *text += &format!("{table}\n");
    }
    if !diff.methods.is_empty() {
        text.push_str(&methods(&diff.methods, options));
    }
    text.push('\n');
}

/// Returns a table with a row per area and pair of adapters.
pub(super) fn area_table<'a>() -> Table<'a, &'a AreaTime> {
    Table::new("")
        .head("adapter", |time: &&AreaTime| {
            adapter(&both_names(&time.adapter))
        })
        .text("area", |time| &*time.area)
        .number("cases", |time| time.cases)
        .number("sum before", |time| duration(time.sum[0]))
        .number("after", |time| duration(time.sum[1]))
        .number("change", |time| phrases::ratio(time.sum))
        .number("median before", |time| duration(time.median[0]))
        .number("after", |time| duration(time.median[1]))
        .number("change", |time| phrases::ratio(time.median))
}

/// Returns a table with a row per method and pair of adapters.
pub(super) fn method_table<'a>() -> Table<'a, &'a MethodTime> {
    Table::new("")
        .head("method", |time: &&MethodTime| &*time.case)
        .text("adapter", |time| adapter(&both_names(&time.adapter)))
        .number("frame before", |time| duration(time.wall[0]))
        .number("after", |time| duration(time.wall[1]))
        .number("change", |time| phrases::ratio(time.wall))
        .number("GPU before", |time| time.gpu.map(|gpu| duration(gpu[0])))
        .only_on_page()
        .number("after", |time| time.gpu.map(|gpu| duration(gpu[1])))
        .only_on_page()
        .number("frames", |time| {
            format!("{} and {}", time.samples[0], time.samples[1])
        })
        .only_on_page()
}

fn methods(times: &[MethodTime], options: TableOptions) -> String {
    let mut sorted: Vec<&MethodTime> = times.iter().collect();
    let far = |t: &MethodTime| (t.wall[1] / t.wall[0]).ln().abs();
    sorted.sort_by(|a, b| far(b).total_cmp(&far(a)));
    sorted.truncate(LINES);
    let (table, _) = method_table().terminal(sorted, options, &[]);
    match times.len().saturating_sub(LINES) {
        0 => format!("{table}\n"),
        left => {
            let left = count(left as u64, "method");
            format!("{table}\nand {left} that changed less\n")
        }
    }
}

/// Returns the last line, in the colour of its conclusion: green only if everything could be decided.
fn sum(diff: &RunDiff, options: TableOptions) -> String {
    let [worse, better, other] = ChangeDirection::ALL.map(|d| diff.count(d));
    let same: u64 = diff.pairs.iter().map(|p| p.same).sum();
    let color = match (diff.worse(), diff.untold.is_empty()) {
        (true, _) => "31",
        (false, true) => "32",
        (false, false) => "33",
    };
    let line = format!(
        "Of {}: {worse} worse, {better} better, {other} other, {same} the same{}.",
        count(diff.compared(), "record"),
        phrases::beside(diff)
    );
    format!("{}\n", options.paint(&plain(&line, 600), color))
}
