//! The comparison of two runs for a terminal.

use super::data::{AreaTime, Direction, MethodTime, Pair, RunDiff, both_names};
use super::phrases;
use super::times::STATEMENT;
use crate::numbers::{count, duration, percent};
use crate::terminal::{self, TableOptions, dotted, wrapped};
use crate::words::{name, plain};
use tabled::builder::Builder;

/// The most changes of a direction that are listed.
const LISTED: [(Direction, usize); 3] = [
    (Direction::Worse, 20),
    (Direction::Better, 10),
    (Direction::Other, 10),
];
/// The most lines of cases in one run only, and of methods.
const LINES: usize = 10;
/// The most figures of a change.
const FIGURES: usize = 4;

/// Warnings, differences of the headers, a table of adapters, changes, the gravest
/// first (at most 20 that are worse, 10 that are better, 10 others; one of each kind before the second of
/// any), cases in one run only, times, and the sum. Always ends in a newline.
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
            let of = format!("{} ", pair.name());
            text.push_str(&fact_line(&of, fact.name, &fact.before, &fact.after));
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
        text.push_str(&format!("{}\n", plain(&line, 300)));
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
    text.push_str(&pairs(&diff.pairs, options));
    text.push('\n');
    transitions(&mut text, &diff.pairs);
    for (direction, most) in LISTED {
        changes(&mut text, diff, direction, most, options);
    }
    only(&mut text, diff);
    times(&mut text, diff, options);
    text.push_str(&sum(diff, options));
    text
}

fn fact_line(of: &str, what: &str, before: &str, after: &str) -> String {
    let shown = |text: &str| match text {
        "" => "–".to_owned(),
        text => plain(text, 160),
    };
    let of = plain(of, 120);
    format!("{of}{what}: {} → {}\n", shown(before), shown(after))
}

fn text_of(builder: Builder, options: TableOptions, text_columns: usize) -> String {
    format!(
        "{}\n",
        wrapped(terminal::table(builder, options, text_columns), options)
    )
}

fn pairs(pairs: &[Pair], options: TableOptions) -> String {
    let mut builder = Builder::default();
    builder.push_record([
        "adapter",
        "compared",
        "same",
        "worse",
        "better",
        "other",
        "only before",
        "only after",
        "asserted",
    ]);
    for pair in pairs {
        let [before, after] = pair.asserted.map(|share| percent(share, 2));
        builder.push_record([
            plain(&pair.name(), 120),
            dotted(pair.compared),
            dotted(pair.same),
            dotted(pair.worse),
            dotted(pair.better),
            dotted(pair.other),
            dotted(pair.only[0]),
            dotted(pair.only[1]),
            match before == after {
                true => after,
                false => format!("{before} → {after}"),
            },
        ]);
    }
    text_of(builder, options, 1)
}

fn transitions(text: &mut String, pairs: &[Pair]) {
    for pair in pairs.iter().filter(|p| !p.transitions.is_empty()) {
        let each = pair.transitions.iter();
        let each = each.map(|t| format!("{} {}", t.records, phrases::transition(t.verdict)));
        let all = each.collect::<Vec<_>>().join(", ");
        text.push_str(&format!("{}: {all}\n", plain(&pair.name(), 120)));
    }
}

fn changes(
    text: &mut String,
    diff: &RunDiff,
    direction: Direction,
    most: usize,
    options: TableOptions,
) {
    let these = phrases::spread(&diff.changes, direction);
    if these.is_empty() {
        return;
    }
    let color = match direction {
        Direction::Worse => "31",
        Direction::Better => "32",
        Direction::Other => "36",
    };
    text.push_str(&format!("\n{} {}\n", these.len(), direction.name()));
    let room = options.room(4);
    for change in these.iter().take(most) {
        let head = format!("{} {}", phrases::sign(direction), phrases::verdicts(change));
        let adapter = plain(&both_names(&change.adapter), 120);
        let case = plain(&change.case, 300);
        text.push_str(&format!(
            "{}  {adapter}  {case}\n",
            options.paint(&head, color)
        ));
        let mut lines: Vec<String> = Vec::new();
        if change.verdict[0] != change.verdict[1] {
            // The worse of the two says why.
            lines.push(change.headline[usize::from(direction != Direction::Better)].clone());
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
            text.push_str(&format!("    {}\n", plain(&line, room)));
        }
    }
    if these.len() > most {
        text.push_str(&format!("and {} more\n", these.len() - most));
    }
}

fn only(text: &mut String, diff: &RunDiff) {
    let files = phrases::only_by_file(&diff.only);
    if files.is_empty() {
        return;
    }
    text.push_str(&format!(
        "\n{} in one run only\n",
        count(diff.only.len() as u64, "record")
    ));
    for (one, n) in files.iter().take(LINES) {
        let sign = if one.worse { "✗" } else { " " };
        let line = match n {
            1 => format!("{}, {}", one.case, name(one.verdict)),
            n => format!("{} of {}", count(*n, "case"), one.case_file),
        };
        let line = format!(
            "{sign} {}  {}  {line}",
            phrases::side(one.side),
            one.adapter
        );
        text.push_str(&format!("{}\n", plain(&line, 400)));
    }
    if files.len() > LINES {
        text.push_str(&format!(
            "and of {} more\n",
            count((files.len() - LINES) as u64, "case file")
        ));
    }
}

fn times(text: &mut String, diff: &RunDiff, options: TableOptions) {
    if diff.times.is_empty() && diff.methods.is_empty() {
        return;
    }
    text.push_str(&format!("\nTimes. {STATEMENT}\n"));
    if !diff.times.is_empty() {
        text.push_str(&areas(&diff.times, options));
    }
    if !diff.methods.is_empty() {
        text.push_str(&methods(&diff.methods, options));
    }
    text.push('\n');
}

fn areas(times: &[AreaTime], options: TableOptions) -> String {
    let mut builder = Builder::default();
    builder.push_record([
        "adapter",
        "area",
        "cases",
        "sum before",
        "after",
        "change",
        "median before",
        "after",
        "change",
    ]);
    for time in times {
        let [sum_before, sum_after] = time.sum.map(duration);
        let [before, after] = time.median.map(duration);
        builder.push_record([
            plain(&both_names(&time.adapter), 120),
            plain(&time.area, 60),
            time.cases.to_string(),
            sum_before,
            sum_after,
            phrases::ratio(time.sum),
            before,
            after,
            phrases::ratio(time.median),
        ]);
    }
    text_of(builder, options, 2)
}

fn methods(times: &[MethodTime], options: TableOptions) -> String {
    let mut sorted: Vec<&MethodTime> = times.iter().collect();
    let far = |t: &MethodTime| (t.wall[1] / t.wall[0]).ln().abs();
    sorted.sort_by(|a, b| far(b).total_cmp(&far(a)));
    let mut builder = Builder::default();
    builder.push_record(["method", "adapter", "frame before", "after", "change"]);
    for time in sorted.iter().take(LINES) {
        let [before, after] = time.wall.map(duration);
        builder.push_record([
            plain(&time.case, 160),
            plain(&both_names(&time.adapter), 120),
            before,
            after,
            phrases::ratio(time.wall),
        ]);
    }
    let table = text_of(builder, options, 2);
    match times.len().saturating_sub(LINES) {
        0 => table,
        rest => format!(
            "{table}and {} that changed less\n",
            count(rest as u64, "method")
        ),
    }
}

/// The last line, in the colour of its conclusion: green only if everything could be told.
fn sum(diff: &RunDiff, options: TableOptions) -> String {
    let [worse, better, other] = Direction::ALL.map(|d| diff.count(d));
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
