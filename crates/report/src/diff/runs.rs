//! The comparison of two runs: of two drivers, two versions of one, two commits. Changes of verdicts, pixels
//! and times as data, for a terminal, and as a page.
//!
//! Records are matched by case and adapter. *Worse*, which `etalon diff` exits with 1 for, is
//!
//! - a record that is unexpected and whose partner in the first run is not;
//! - a right verdict (Pass, Imprecise, Measured; for a selftest that is due to fail: Fail) that became a
//!   wrong one (all bad verdicts, Open among them), and a wrong one that became one of a greater
//!   [`Verdict::severity`](etalon_record::Verdict::severity), expected or not;
//! - a case that was drawn, right or wrong, and is Blocked;
//! - a case that was right and is not supported any more;
//! - a case that the second run was to draw, being of the same selection, and holds no record of.
//!
//! *Better* is the way back: wrong to right or to a smaller severity, not supported to right. All else is
//! neither: Pass to Imprecise, which is legal; Blocked to wrong, which may have been so before; wrong to not supported; right to skipped, which is
//! intended; a case of another selection; and other pixels, counters or distances under the same verdict.
//! Times decide nothing, since a run's are taken once and beside other work.

mod compare;
mod data;
mod facts;
mod page;
mod pairs;
mod phrases;
mod pixels;
mod table;
mod times;

pub use data::{
    AreaTime, Change, Detail, Direction, Fact, FrameChange, ImageChange, MethodTime, Only, Pair,
    RunDiff, Side, Transition, Unpaired,
};
pub use page::write_page;
pub use table::table;

use crate::error::ReportError;
use crate::export::status::incomplete;
use crate::numbers::count;
use etalon_record::{Record, Run};
use pairs::{Folder, Matched};
use std::cmp::Reverse;
use std::path::Path;

/// Compares the run in the second folder with the one in the first. With `adapters`, compares the records of
/// the one in the first run with those of the other in the second; else, if each run has one adapter, those
/// two; else those of the same name.
///
/// # Errors
/// Returns an error if a folder holds no readable run, a named adapter is in no record or header, or the runs
/// have no adapter of the same name.
pub fn diff(
    before: &Path,
    after: &Path,
    adapters: Option<[&str; 2]>,
) -> Result<RunDiff, ReportError> {
    let runs = [Run::read(before)?, Run::read(after)?];
    let folders = [Folder::new(before, &runs[0]), Folder::new(after, &runs[1])];
    let [first, second] = &folders;
    let chosen = pairs::choose(first, second, adapters)?;
    let same_selection = facts::same_selection(&runs[0].header, &runs[1].header);
    let mut found = RunDiff {
        kind: "runs",
        warnings: warnings(&runs, same_selection),
        facts: facts::of_headers(&runs[0].header, &runs[1].header),
        unpaired: pairs::unpaired(first, second, &chosen),
        pairs: Vec::new(),
        changes: Vec::new(),
        only: Vec::new(),
        times: Vec::new(),
        methods: Vec::new(),
    };
    for adapter in chosen {
        of_pair(&mut found, &folders, adapter, same_selection);
    }
    let unreadable = found.changes.iter().filter_map(|c| c.frame_error.as_ref());
    if let Some(first) = unreadable.clone().next() {
        found.warnings.push(format!(
            "{} of frames of changed cases could not be compared: {first}",
            count(unreadable.count() as u64, "pair")
        ));
    }
    found.changes.sort_by(|a, b| order(a).cmp(&order(b)));
    Ok(found)
}

/// Worse, better, other; the gravest first; by case file and case.
fn order(change: &Change) -> (Direction, Reverse<u8>, &str, &str, &[String; 2]) {
    let severity = match change.direction {
        Direction::Better => change.verdict[0],
        Direction::Worse | Direction::Other => change.verdict[1],
    };
    (
        change.direction,
        Reverse(severity.severity()),
        &change.case_file,
        &change.case,
        &change.adapter,
    )
}

fn of_pair(
    found: &mut RunDiff,
    folders: &[Folder<'_>; 2],
    adapter: [&str; 2],
    same_selection: bool,
) {
    let matched = Matched::new(folders, adapter);
    let mut pair = Pair::new(adapter, facts::of_adapters(folders, adapter));
    for both in &matched.both {
        pair.add(both);
        if let Some(change) = compare::change(folders, adapter, both) {
            pair.count(change.direction);
            found.changes.push(change);
        } else {
            pair.same += 1;
        }
    }
    for (side, records) in [
        (Side::Before, &matched.before),
        (Side::After, &matched.after),
    ] {
        pair.only[side as usize] = records.len() as u64;
        for record in records {
            found.only.push(Only {
                case: record.case.clone(),
                case_file: record.case_file().to_owned(),
                adapter: record.adapter.clone(),
                side,
                verdict: record.verdict,
                // The first run held it, and the second was to draw it.
                worse: side == Side::Before && same_selection,
            });
        }
    }
    let both: Vec<[&Record; 2]> = matched.both;
    found.times.extend(times::areas(adapter, &both));
    found.methods.extend(times::methods(&both));
    found.pairs.push(pair);
}

/// Reasons for which the comparison may mislead.
fn warnings(runs: &[Run; 2], same_selection: bool) -> Vec<String> {
    let mut warnings = Vec::new();
    for (run, which) in runs.iter().zip(["first", "second"]) {
        if let Some(why) = incomplete(run) {
            warnings.push(format!("The {which} run is incomplete: {why}."));
        }
    }
    if !same_selection {
        warnings.push(
            "The runs are of different selections of cases: cases in one run only are no finding."
                .to_owned(),
        );
    }
    let [before, after] = [&runs[0].header, &runs[1].header];
    if before.machine != after.machine {
        warnings.push("The machines differ, so times do not compare the drivers.".to_owned());
    }
    warnings
}
