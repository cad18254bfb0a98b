//! The records that are shown with their pictures and operations, area by area.

use super::detail::{self, DetailBudget, DrawnFrame};
use crate::run::grid::{AreaFiles, RunGrid};
use etalon_record::{Record, Verdict};
use std::collections::{BTreeMap, HashSet};
use std::path::Path;

/// The maximum number of unexpected records of a case file and adapter that are shown whole.
const UNEXPECTED: usize = 20;
/// The maximum number of records of an area that are shown whole. The examples of others do not count.
const BODIES: usize = 400;

/// Returns the HTML of an area's records, by the case's place in the area and the adapter's column.
pub(super) fn of_area(
    folder: &Path,
    grid: &RunGrid<'_>,
    area: &AreaFiles<'_>,
) -> BTreeMap<String, String> {
    let mut budget = DetailBudget::default();
    let mut bodies = BTreeMap::new();
    for [place, column, index] in whole(grid, area) {
        let record = grid.record(index);
        let drawn = DrawnFrame::of(folder, record);
        let body = detail::body(record, drawn.as_ref(), &mut budget);
        bodies.insert(format!("{place} {column}"), body.into_string());
    }
    bodies
}

/// Returns the case, adapter and record of everything that is shown whole: real failures first, selftests last.
fn whole(grid: &RunGrid<'_>, area: &AreaFiles<'_>) -> Vec<[usize; 3]> {
    let mut examples = HashSet::new();
    for record in &grid.run.records {
        if let Some(example) = &record.example {
            examples.insert((example.as_str(), record.adapter.as_str()));
        }
    }
    let mut ranks: BTreeMap<_, usize> = BTreeMap::new();
    let mut whole = Vec::new();
    let mut place = 0;
    for file in &area.files {
        for case in &file.cases {
            let records = case.records.iter().enumerate();
            for (column, index) in records.filter_map(|(c, index)| Some((c, (*index)?))) {
                let record = grid.record(index);
                let is_example = examples.contains(&(case.id, &*record.adapter));
                let Some(weight) = weight(record, is_example) else {
                    continue;
                };
                // Selftests and imprecise records of a file differ little between adapters.
                let of_adapter = if weight < IMPRECISE { column } else { 0 };
                let rank = ranks.entry((file.name, of_adapter, weight)).or_default();
                let most = if weight < IMPRECISE { UNEXPECTED } else { 1 };
                if weight == EXAMPLE || *rank < most {
                    whole.push((weight, *rank, [place, column, index]));
                }
                *rank += 1;
            }
            place += 1;
        }
    }
    whole.sort_unstable();
    let examples = whole.partition_point(|(weight, ..)| *weight <= EXAMPLE);
    whole.truncate(examples.max(BODIES));
    whole.into_iter().map(|(.., place)| place).collect()
}

/// The weights of what is shown whole, the most important first.
const NEW: usize = 0;
const EXAMPLE: usize = 1;
const KNOWN: usize = 2;
const IMPRECISE: usize = 3;
const SELFTEST: usize = 4;

/// Returns the weight of a record; `None` if it is not shown whole.
fn weight(record: &Record, is_example: bool) -> Option<usize> {
    if record.unexpected() {
        Some(NEW)
    } else if record.due_fail {
        record.frame.is_some().then_some(SELFTEST)
    } else if is_example {
        Some(EXAMPLE)
    } else if record.verdict.is_bad() {
        // The page of a record with an example shows the example.
        record.example.is_none().then_some(KNOWN)
    } else {
        (record.verdict == Verdict::Imprecise).then_some(IMPRECISE)
    }
}
