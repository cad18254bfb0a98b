//! The comparison of two runs: two drivers, two versions of a driver, or two commits. Changes of verdicts,
//! pixels and times as data, for a terminal, and as a page.
//!
//! Records are matched by case and adapter. `etalon diff` exits with 1 if anything is *worse*:
//!
//! - a case changed for the worse, by the table of [`CaseChange`](etalon_record::Change::between);
//! - both runs select a case, by their lists of cases, and the second has no record of it;
//! - the second run lacks an adapter of the first, unless the pair to compare was named.
//!
//! If nothing is worse, and a run is empty or incomplete, the exit code is 3: what it lacks can be worse.
//! *Better* and *other* are by the same table. A case that one run does not select is neither, and so are other
//! pixels, counters or distances under the same verdict. Times decide nothing, because a run takes each once and
//! while doing other work.

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
    AdapterPair, AreaTime, CaseChange, ChangeDirection, Detail, Fact, FrameChange, ImageChange,
    MethodTime, Only, RunDiff, RunSide, Transition, Unpaired,
};
pub use page::write_page;
pub use table::table;

use crate::error::ReportError;
use crate::export::status::incomplete;
use crate::numbers::{capital, count};
use etalon_record::{Record, Run, Shard, read_cases, shard_of};
use pairs::{Folder, Matched};
use std::cmp::Reverse;
use std::collections::HashSet;
use std::path::Path;

/// Compares the run in the second folder with the run in the first.
///
/// `adapters` names the adapter of the first run and the adapter of the second to compare. Without it, runs
/// of one adapter each are compared with each other, and other runs by adapters of the same name.
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
    let selection = CasesToDraw::read(after, &runs[1], same_selection)?;
    let mut found = RunDiff {
        kind: "runs",
        warnings: warnings(&runs, same_selection),
        facts: facts::of_headers(&runs[0].header, &runs[1].header),
        untold: untold(&runs),
        incomplete: untold(&runs),
        unpaired: pairs::unpaired(first, second, &chosen, adapters.is_some()),
        ..RunDiff::default()
    };
    for adapter in chosen {
        of_pair(&mut found, &folders, adapter, &selection);
    }
    if matches!(selection, CasesToDraw::Unknown) {
        let alone = found.only.iter().filter(|o| o.side == RunSide::Before);
        match alone.count() as u64 {
            0 => {}
            n => found.untold.push(format!(
                "{} of the first run alone, as the selections of cases are not known",
                count(n, "record")
            )),
        }
    }
    let unreadable = found.changes.iter().filter_map(|c| c.frame_error.as_ref());
    if let Some(first) = unreadable.clone().next() {
        let message = format!(
            "{} of frames of changed cases could not be compared: {first}",
            count(unreadable.count() as u64, "pair")
        );
        found.warnings.push(message.clone());
        found.untold.push(message);
    }
    found.changes.sort_by(|a, b| order(a).cmp(&order(b)));
    Ok(found)
}

/// Returns the sort key: first the direction (worse, better, other), then the severity, then case file and case.
fn order(change: &CaseChange) -> (ChangeDirection, Reverse<u8>, &str, &str, &[String; 2]) {
    let severity = match change.direction {
        ChangeDirection::Better => change.verdict[0],
        ChangeDirection::Worse | ChangeDirection::Other => change.verdict[1],
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
    selection: &CasesToDraw,
) {
    let matched = Matched::new(folders, adapter);
    let mut pair = AdapterPair::new(adapter, facts::of_adapters(folders, adapter));
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
        (RunSide::Before, &matched.before),
        (RunSide::After, &matched.after),
    ] {
        pair.only[side as usize] = records.len() as u64;
        for record in records {
            found.only.push(Only {
                case: record.case.clone(),
                case_file: record.parts().file().to_owned(),
                adapter: record.adapter.clone(),
                side,
                verdict: record.verdict,
                worse: side == RunSide::Before && selection.has(&record.case),
            });
        }
    }
    let both: Vec<[&Record; 2]> = matched.both;
    found.times.extend(times::areas(adapter, &both));
    found.methods.extend(times::methods(&both));
    found.pairs.push(pair);
}

/// Which cases the second run should draw.
enum CasesToDraw {
    /// The cases of the first run.
    Same,
    /// The cases of a list and a shard.
    Listed(HashSet<String>, Option<Shard>),
    /// Unknown, because the selections differ and the second run does not list its cases.
    Unknown,
}

impl CasesToDraw {
    fn read(folder: &Path, run: &Run, same: bool) -> Result<Self, ReportError> {
        if same {
            return Ok(Self::Same);
        }
        let settings = &run.header.settings;
        let list = match &*settings.selection {
            "" => None,
            _ => read_cases(folder, &run.header)?,
        };
        Ok(list.map_or(Self::Unknown, |ids| {
            Self::Listed(ids.into_iter().collect(), settings.shard)
        }))
    }

    /// Returns true if the second run should have a record of a case.
    fn has(&self, case: &str) -> bool {
        match self {
            Self::Same => true,
            Self::Listed(ids, shard) => {
                let drawn = |shard: Shard| shard_of(case, shard.count) == shard.index;
                ids.contains(case) && shard.is_none_or(drawn)
            }
            Self::Unknown => false,
        }
    }
}

/// Returns the reasons why the runs are incomplete.
fn untold(runs: &[Run; 2]) -> Vec<String> {
    let each = runs.iter().zip(["first", "second"]);
    let each = each.filter_map(|(run, which)| {
        let why = incomplete(run)?;
        Some(format!("the {which} run is incomplete: {why}"))
    });
    each.collect()
}

/// Returns reasons why the comparison can mislead.
fn warnings(runs: &[Run; 2], same_selection: bool) -> Vec<String> {
    let untold = untold(runs).into_iter();
    let mut warnings: Vec<String> = untold.map(|why| format!("{}.", capital(&why))).collect();
    if !same_selection {
        warnings.push(
            "The runs are of different selections of cases: a case that one of them does not select is \
             no finding."
                .to_owned(),
        );
    }
    let [before, after] = [&runs[0].header, &runs[1].header];
    if before.provenance.machine != after.provenance.machine {
        warnings.push("The machines differ, so times do not compare the drivers.".to_owned());
    }
    warnings
}
