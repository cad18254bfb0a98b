//! The data of the page's script: a list of all cases, and for each area the facts and the pictures of its records.
//!
//! A browser lets a page from the file system read its neighbours only by running them as scripts, so each file is a
//! call of one function with one value. The page loads them when a view needs them. Names and texts are strings of
//! JSON.

use super::bodies;
use super::consensus::Consensus;
use super::facts::{self, Label};
use crate::error::ReportError;
use crate::files::Destination;
use crate::lists::Interner;
use crate::mark::class;
use crate::run::grid::{AreaFiles, RunGrid, VerdictTally};
use crate::run::reasons::PageReasons;
use crate::threads::on_threads;
use crate::words::{self, Tone};
use etalon_record::{Record, Verdict};
use maud::{Markup, PreEscaped, html};
use serde::Serialize;
use std::collections::HashMap;
use std::path::Path;

/// The folder of the scripts in a run folder.
pub(crate) const RECORDS: &str = "records";
/// The maximum number of bytes that the messages and other texts of an area take together.
const TEXT_BYTES: usize = 8 << 20;
/// Signs for the kinds of cells; more than there are verdicts and tones.
const SIGNS: &[u8] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789";
/// The sign of a cell without a record.
const NO_RECORD: char = '.';

/// What the page's script needs at once.
#[derive(Serialize)]
struct Data<'a> {
    adapters: &'a [&'a str],
    areas: Vec<&'a str>,
    /// Area and path of the scripts with the cases as intended.
    scripts: &'a [(String, String)],
}

#[derive(Serialize)]
struct CaseList<'a> {
    /// The meaning of each sign, the most serious first.
    cells: Vec<CellLook>,
    /// Text, distribution of votes, odd adapters.
    consensus: Interner<(String, &'static str, Vec<usize>)>,
    /// The rows of cases.
    rows: Interner<CaseLook>,
    /// The reasons for which records count for nothing.
    reasons: Vec<&'a str>,
    files: Vec<ListedFile<'a>>,
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
    due: bool,
    excused: bool,
    unexpected: bool,
    right: bool,
}

/// A sign per adapter, the consensus, and pairs of an adapter and the reason of its record.
#[derive(Serialize, Clone, PartialEq, Eq, Hash)]
struct CaseLook(String, usize, Vec<usize>);

#[derive(Serialize)]
struct ListedFile<'a> {
    name: &'a str,
    area: usize,
    /// The id behind the file's name, and the row.
    cases: Vec<(&'a str, usize)>,
}

/// The facts of an area's records.
#[derive(Serialize, Default)]
struct AreaFacts {
    /// The labels of facts: words, form, and true if the record's pictures come with the same.
    labels: Interner<Label>,
    texts: Interner<String>,
    /// Lists of label, text, label, text, …; the first list is empty.
    facts: Interner<Vec<usize>>,
    /// By case, for each record in turn: the microseconds of drawing and judging, and its list.
    cases: Vec<(Vec<u64>, Vec<usize>)>,
}

/// Returns the block for the page.
pub(crate) fn block(grid: &RunGrid<'_>, scripts: &[(String, String)]) -> Markup {
    let data = Data {
        adapters: &grid.adapters,
        areas: grid.areas.iter().map(|area| area.name).collect(),
        scripts,
    };
    // Hostile names do not end the block.
    let json = json(&data).replace('<', "\\u003c");
    html! { script type="application/json" id="data" { (PreEscaped(json)) } }
}

/// Returns the text. All data can be written as JSON, so this cannot fail; the script would report an empty value.
fn json(data: &impl Serialize) -> String {
    serde_json::to_string(data).unwrap_or_else(|_| "null".to_owned())
}

/// Writes the scripts, and returns their paths.
///
/// # Errors
/// Returns an error if a script cannot be written.
pub(crate) fn write(
    to: &dyn Destination,
    folder: &Path,
    grid: &RunGrid<'_>,
    reasons: &PageReasons,
) -> Result<Vec<String>, ReportError> {
    let write = |name: &str, call: &str, json: &str| {
        let (path, key) = (
            format!("{RECORDS}/{name}.js"),
            name.trim_end_matches("-pictures"),
        );
        let text = format!("{call}({key:?}, {json});\n");
        to.write(&path, text.as_bytes()).map(|_| path)
    };
    let mut paths = vec![write("cases", "etalonCases", &json(&cases(grid, reasons)))?];
    let areas: Vec<usize> = (0..grid.areas.len()).collect();
    let written = on_threads(&areas, |number| -> Result<_, ReportError> {
        let area = &grid.areas[*number];
        let facts = json(&area_facts(grid, area));
        let bodies = json(&bodies::of_area(folder, grid, area));
        let name = number.to_string();
        Ok([
            write(&name, "etalonFacts", &facts)?,
            write(&format!("{name}-pictures"), "etalonPictures", &bodies)?,
        ])
    });
    for written in written {
        paths.extend(written?);
    }
    Ok(paths)
}

fn cases<'a>(grid: &'a RunGrid<'_>, reasons: &'a PageReasons) -> CaseList<'a> {
    let (cells, signs) = cells(grid);
    let mut consensus = Interner::default();
    let mut rows = Interner::default();
    let mut files = Vec::new();
    for (area, files_of) in grid.areas.iter().enumerate() {
        for file in &files_of.files {
            let cases = file.cases.iter().map(|case| {
                let found = Consensus::of(grid, case);
                let found = consensus.place((found.text, found.votes.name(), found.odd));
                let mut look = CaseLook(String::new(), found, Vec::new());
                for (column, index) in case.records.iter().enumerate() {
                    let record = index.map(|index| grid.record(index));
                    let key = record.map(|record| (record.verdict, Tone::of(record)));
                    let sign = key.and_then(|key| signs.get(&key).copied());
                    look.0.push(sign.unwrap_or(NO_RECORD));
                    let reasons = record.into_iter().flat_map(|record| reasons.of(record));
                    look.2.extend(reasons.flat_map(|reason| [column, reason]));
                }
                (
                    case.id.strip_prefix(file.name).unwrap_or(case.id),
                    rows.place(look),
                )
            });
            files.push(ListedFile {
                cases: cases.collect(),
                name: file.name,
                area,
            });
        }
    }
    CaseList {
        cells,
        consensus,
        rows,
        reasons: reasons.texts(),
        files,
    }
}

fn area_facts(grid: &RunGrid<'_>, area: &AreaFiles<'_>) -> AreaFacts {
    let cases = || area.files.iter().flat_map(|file| &file.cases);
    let mut found = AreaFacts::default();
    let lists = facts_of_all(
        grid,
        cases().flat_map(|c| c.records.iter().flatten()),
        &mut found,
    );
    for case in cases() {
        let (mut times, mut facts) = (Vec::new(), Vec::new());
        for index in case.records.iter().flatten() {
            let micros = |s: f64| (s * 1e6).round() as u64;
            let seconds = &grid.record(*index).seconds;
            times.extend([micros(seconds.draw), micros(seconds.judge)]);
            facts.push(lists[index]);
        }
        found.cases.push((times, facts));
    }
    found
}

/// Returns the list of facts of each record. Unexpected records get their texts first, while there is room.
fn facts_of_all<'i>(
    grid: &RunGrid<'_>,
    records: impl Iterator<Item = &'i usize>,
    found: &mut AreaFacts,
) -> HashMap<usize, usize> {
    found.facts.place(Vec::new());
    let mut order: Vec<usize> = records.copied().collect();
    order.sort_by_key(|index| kind(grid.record(*index)));
    let mut lists = HashMap::new();
    let mut bytes = 0;
    for index in order {
        let mut facts = facts::of(grid.record(index));
        let new = facts.iter().filter(|(_, text)| !found.texts.has(text));
        let cost: usize = new.map(|(_, text)| escaped(text)).sum();
        if cost > TEXT_BYTES.saturating_sub(bytes) {
            facts = vec![facts::no_room()];
        } else {
            bytes += cost;
        }
        let mut list = Vec::new();
        for (label, text) in facts {
            list.extend([found.labels.place(label), found.texts.place(text)]);
        }
        lists.insert(index, found.facts.place(list));
    }
    lists
}

/// Returns 0 for unexpected records, 1 for expected or due ones, 2 for imprecise and all others.
fn kind(record: &Record) -> usize {
    match (record.unexpected(), record.verdict.is_bad()) {
        (true, _) => 0,
        (false, true) => 1,
        (false, false) => 2,
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
                due: tone == Tone::Due,
                excused: matches!(tone, Tone::Excused | Tone::Due),
                unexpected: tone == Tone::Missed || plain && verdict.is_bad(),
                right: tone.is_right(verdict),
            }
        });
    (cells.collect(), signs)
}

/// Returns the number of bytes that a text takes in a script.
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

    #[test]
    fn hostile_names_do_not_end_the_data_block() {
        let hostile = "</script><!--<script>\u{0}\u{2028}\"\\";
        let run = run(vec![Record::new(
            format!("{hostile}/b"),
            hostile,
            Verdict::Crash,
        )]);
        let grid = RunGrid::new(&run);
        let block = block(&grid, &[]).into_string();
        let inner = block.split_once('>').unwrap().1;
        let inner = inner.strip_suffix("</script>").unwrap();
        assert!(!inner.contains('<'));
        let json: serde_json::Value = serde_json::from_str(inner).unwrap();
        assert_eq!(json["adapters"][0], hostile);
        assert!(hostile.starts_with(json["areas"][0].as_str().unwrap()));
    }

    #[test]
    fn texts_fill_the_room_and_unexpected_records_go_first() {
        let mut records: Vec<Record> = (0..5000)
            .map(|i| {
                let mut r = Record::new(format!("a/{i}"), "b", Verdict::Pass);
                let text = format!("{i} {}", "\n".repeat(1000));
                r.reasons = vec![Reason::Text(text)];
                r
            })
            .collect();
        records[4999].verdict = Verdict::Crash;
        let run = run(records);
        let grid = RunGrid::new(&run);
        let facts = json(&area_facts(&grid, &grid.areas[0]));
        assert!(facts.len() < TEXT_BYTES + (1 << 20), "{}", facts.len());
        assert!(facts.contains("\"4999 \\n"));
        assert!(facts.contains("\"0 \\n") && !facts.contains("\"4998 \\n"));
        assert!(facts.contains("left out to keep the page small"));
    }

    #[test]
    fn every_kind_of_cell_has_a_sign() {
        assert!(SIGNS.len() >= Verdict::ALL.len() * 3);
        assert!(!SIGNS.contains(&(NO_RECORD as u8)));
    }
}
