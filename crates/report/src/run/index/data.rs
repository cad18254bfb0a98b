//! The data of the page's script: one JSON block with every case on every adapter.
//!
//! The data is in the page and not in a separate file, since a browser lets no page that was opened from the
//! file system read its neighbours. Names and texts are strings of JSON, in which `<` is escaped, so none of
//! them can end the block.

use super::consensus::Consensus;
use super::facts::{self, Label};
use super::findings::{FindingPlan, kind};
use crate::lists::Interner;
use crate::mark::class;
use crate::run::grid::{RunGrid, VerdictTally};
use crate::words::{self, Tone};
use etalon_record::Verdict;
use maud::{Markup, PreEscaped, html};
use serde::Serialize;
use std::collections::HashMap;

/// The maximum number of bytes that messages and other texts take together.
const TEXT_BYTES: usize = 8 << 20;
/// Signs for the kinds of cells; more than there are verdicts and tones.
const SIGNS: &[u8] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789";
/// The sign of a cell without a record.
const NO_RECORD: char = '.';

#[derive(Serialize)]
struct Data<'a> {
    adapters: &'a [&'a str],
    /// The meaning of each sign, the most serious first.
    cells: Vec<CellLook>,
    /// Text, distribution of votes, odd adapters.
    consensus: Interner<(String, &'static str, Vec<usize>)>,
    /// The labels of facts: words, form, and true if an entry under Findings has the same.
    labels: Interner<Label>,
    texts: Interner<String>,
    /// The facts of a record: label, text, label, text, …; the first list is empty.
    facts: Interner<Vec<usize>>,
    files: Vec<ListedFile<'a>>,
    /// Case, adapter and record of entries under Findings with all facts.
    bodies: Vec<[usize; 3]>,
    /// Area and path of the scripts with the cases as intended.
    scripts: &'a [(String, String)],
}

#[derive(Serialize)]
struct CellLook {
    sign: char,
    /// The verdict's name in records.
    verdict: &'static str,
    word: String,
    symbol: &'static str,
    class: &'static str,
    bad: bool,
    excused: bool,
    unexpected: bool,
}

#[derive(Serialize)]
struct ListedFile<'a> {
    name: &'a str,
    area: usize,
    cases: Vec<ListedCase<'a>>,
}

/// The id behind the file's name, a sign per adapter, the consensus; for each record in turn the
/// microseconds of drawing and judging; for each record the facts.
#[derive(Serialize)]
struct ListedCase<'a>(&'a str, String, usize, Vec<u64>, Vec<usize>);

/// Returns the block, ready to be put into a page.
pub(crate) fn block(
    grid: &RunGrid<'_>,
    plan: &FindingPlan,
    scripts: &[(String, String)],
) -> Markup {
    let mut data = data(grid, plan);
    data.scripts = scripts;
    let json = serde_json::to_string(&data);
    // All data can be written as JSON, so this cannot fail. The script would report an empty block.
    let json = json.unwrap_or_else(|_| "null".to_owned());
    let json = json.replace('<', "\\u003c");
    html! { script type="application/json" id="data" { (PreEscaped(json)) } }
}

fn data<'a>(grid: &'a RunGrid<'_>, plan: &FindingPlan) -> Data<'a> {
    let (facts, facts_of, texts, labels) = facts_of_all(grid);
    let (cells, signs) = cells(grid);
    let mut consensus = Interner::default();
    let mut bodies = Vec::new();
    let mut number = 0;
    let mut files = Vec::new();
    for (a, area) in grid.areas.iter().enumerate() {
        for file in &area.files {
            let mut cases = Vec::new();
            for case in &file.cases {
                let found = Consensus::of(grid, case);
                let found = consensus.place((found.text, found.votes.name(), found.odd));
                let id = case.id.strip_prefix(file.name).unwrap_or(case.id);
                let mut row = ListedCase(id, String::new(), found, Vec::new(), Vec::new());
                for (column, index) in case.records.iter().enumerate() {
                    let Some(index) = *index else {
                        row.1.push(NO_RECORD);
                        continue;
                    };
                    let record = grid.record(index);
                    let key = (record.verdict, Tone::of(record));
                    row.1.push(signs.get(&key).copied().unwrap_or(NO_RECORD));
                    let micros = |s: f64| (s * 1e6).round() as u64;
                    row.3.push(micros(record.seconds.draw));
                    row.3.push(micros(record.seconds.judge));
                    row.4.push(facts_of[index]);
                    if plan.whole(index) {
                        bodies.push([number, column, index]);
                    }
                }
                cases.push(row);
                number += 1;
            }
            let (name, area) = (file.name, a);
            files.push(ListedFile { name, area, cases });
        }
    }
    Data {
        adapters: &grid.adapters,
        cells,
        consensus,
        labels,
        texts,
        facts,
        files,
        bodies,
        scripts: &[],
    }
}

/// Returns the kinds of cells that the run has, the most serious first, with the sign of each.
fn cells(grid: &RunGrid<'_>) -> (Vec<CellLook>, HashMap<(Verdict, Tone), char>) {
    let tally = VerdictTally::of(&grid.run.records);
    let mut signs = HashMap::new();
    let cells = tally
        .entries()
        .zip(SIGNS)
        .map(|((verdict, tone, _), sign)| {
            let sign = char::from(*sign);
            signs.insert((verdict, tone), sign);
            let plain = tone == Tone::Plain;
            CellLook {
                sign,
                verdict: verdict.name(),
                word: format!("{}{}", words::name(verdict), tone.suffix()),
                symbol: words::symbol(verdict),
                class: class(verdict, tone),
                bad: verdict.is_bad(),
                excused: tone == Tone::Excused,
                unexpected: tone == Tone::Missed || plain && verdict.is_bad(),
            }
        });
    (cells.collect(), signs)
}

/// All lists of facts, the list of every record by its position in the run, all texts, and all labels.
type FactLists = (
    Interner<Vec<usize>>,
    Vec<usize>,
    Interner<String>,
    Interner<Label>,
);

fn facts_of_all(grid: &RunGrid<'_>) -> FactLists {
    let records = &grid.run.records;
    let mut texts: Interner<String> = Interner::default();
    let mut labels = Interner::default();
    let mut lists: Interner<Vec<usize>> = Interner::default();
    lists.place(Vec::new());
    let mut group_of = vec![0; records.len()];
    // Unexpected records get their texts first, while there is room.
    let mut order: Vec<usize> = (0..records.len()).collect();
    order.sort_by_key(|i| kind(&records[*i]));
    let mut bytes = 0;
    for index in order {
        let mut facts = facts::of(&records[index]);
        let new = facts.iter().filter(|(_, text)| !texts.has(text));
        let cost: usize = new.map(|(_, text)| escaped(text)).sum();
        if cost > TEXT_BYTES.saturating_sub(bytes) {
            facts = vec![facts::no_room()];
        } else {
            bytes += cost;
        }
        let facts = facts.into_iter();
        let list = facts.flat_map(|(label, text)| [labels.place(label), texts.place(text)]);
        group_of[index] = lists.place(list.collect());
    }
    (lists, group_of, texts, labels)
}

/// Returns the number of bytes that a text takes in the block.
fn escaped(text: &str) -> usize {
    let escaped = |c: char| match c {
        '<' => 6,
        '"' | '\\' | '\n' => 2,
        c if c.is_ascii_control() => 6,
        c => c.len_utf8(),
    };
    text.chars().map(escaped).sum::<usize>() + 3
}

#[cfg(test)]
mod tests {
    use super::*;
    use etalon_record::{Header, Reason, Record, Run};

    fn run(records: Vec<Record>) -> Run {
        let header = Header::new(Vec::new(), records.len() as u64);
        Run {
            header,
            records,
            beside: Vec::new(),
            truncated: false,
        }
    }

    fn block_of(records: Vec<Record>) -> String {
        let run = run(records);
        let grid = RunGrid::new(&run);
        block(&grid, &FindingPlan::new(&grid), &[]).into_string()
    }

    #[test]
    fn hostile_texts_do_not_end_the_data_block() {
        let hostile = "</script><!--<script>\u{0}\u{2028}\"\\";
        let mut record = Record::new(format!("a/{hostile}"), hostile, Verdict::Crash);
        record.reasons = vec![Reason::Text(hostile.to_owned())];
        let block = block_of(vec![record]);
        let inner = block.split_once('>').unwrap().1;
        let inner = inner.strip_suffix("</script>").unwrap();
        assert!(!inner.contains('<'));
        let json: serde_json::Value = serde_json::from_str(inner).unwrap();
        assert_eq!(json["adapters"][0], hostile);
        let id = json["files"][0]["name"].as_str().unwrap().to_owned()
            + json["files"][0]["cases"][0][0].as_str().unwrap();
        assert_eq!(id, format!("a/{hostile}"));
        let texts = json["texts"].as_array().unwrap();
        assert!(texts.iter().any(|t| t == hostile));
    }

    #[test]
    fn texts_fill_the_room_and_unexpected_records_go_first() {
        let mut records: Vec<Record> = (0..4000)
            .map(|i| {
                let mut r = Record::new(format!("a/{i}"), "b", Verdict::Pass);
                let text = format!("{i} {}", "<".repeat(1000));
                r.reasons = vec![Reason::Text(text)];
                r
            })
            .collect();
        records[3999].verdict = Verdict::Crash;
        let block = block_of(records);
        assert!(block.len() < TEXT_BYTES + (1 << 20), "{}", block.len());
        assert!(block.contains("\"3999 \\u003c"));
        assert!(block.contains("\"0 \\u003c") && !block.contains("\"3998 \\u003c"));
        assert!(block.contains("left out to keep the page small"));
    }

    #[test]
    fn every_kind_of_cell_has_a_sign() {
        assert!(SIGNS.len() >= Verdict::ALL.len() * 3);
        assert!(!SIGNS.contains(&(NO_RECORD as u8)));
    }
}
