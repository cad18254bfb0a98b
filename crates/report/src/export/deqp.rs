//! `results/<adapter>.csv`, in the format that deqp-runner writes and reads: `case,status,seconds`.
//!
//! A deqp-runner list belongs to one driver, so there is one list per adapter, sorted by case. Lines that
//! begin with `#` are comments. deqp-runner supports no quoting: it takes everything before the first comma
//! as the name, and refuses a whole list for one unreadable line or duplicate name. Records whose id it would
//! misread (an id with a comma or a control character, an id that begins with `#`, an empty id) are therefore
//! left out, and the first comment gives their number. Ids of the suite's cases need no such care.
//!
//! | status | records |
//! |---|---|
//! | `Pass` | Pass |
//! | `Warn` | Imprecise: legal, not precise, as dEQP's quality warnings |
//! | `Fail` | Fail, RequiredByCts, Disputed, Blocked, Open, ResourceError, InternalError, and a selftest that was due to fail and did not; dEQP's resource and internal errors are `Fail` too |
//! | `Crash` | Crash, DeviceLost |
//! | `Timeout` | Timeout |
//! | `Flake` | Flaky. deqp-runner lets flakes pass; here an unexpected flake fails the run |
//! | `KnownFlake` | Flaky, and expected |
//! | `ExpectedFail` | any other bad verdict that is expected, and a selftest that fails as it should |
//! | `UnexpectedImprovement(…)` | better than expected, with its status |
//! | `Skip` | NotSupported, Skipped, and Measured, which judges nothing |
//! | `Missing` | selected without a record, if the folder keeps the selected ids |

use crate::export::status::seconds;
use crate::files::file_name;
use crate::numbers::count;
use crate::run::grid::RunGrid;
use etalon_record::{Record, Run, Verdict, read_cases, shard_of};
use std::collections::BTreeSet;
use std::path::Path;

/// The folder of the lists, below the run folder.
pub(crate) const FOLDER: &str = "results";

/// A list: its file name and its text.
pub(crate) struct CaseList {
    pub(crate) name: String,
    pub(crate) text: String,
}

/// Returns a list per adapter of the run.
pub(crate) fn lists(folder: &Path, run: &Run, grid: &RunGrid<'_>) -> Vec<CaseList> {
    let selected = selected(folder, run);
    let mut names = BTreeSet::new();
    let adapters = grid.adapters.iter().enumerate();
    adapters
        .map(|(column, adapter)| CaseList {
            name: file_name(adapter, ".csv", &mut names),
            text: list(run, grid, column, &selected),
        })
        .collect()
}

fn list(run: &Run, grid: &RunGrid<'_>, column: usize, selected: &[String]) -> String {
    let mut lines = Vec::new();
    let mut refused = 0;
    let mut drawn = BTreeSet::new();
    for record in grid.on(column) {
        drawn.insert(record.case.as_str());
        if readable(&record.case) {
            let seconds = seconds(record);
            lines.push((record.case.as_str(), status(record), seconds));
        } else {
            refused += 1;
        }
    }
    let mut missing = run.header.cases.saturating_sub(drawn.len() as u64);
    let absent = selected.iter().filter(|id| !drawn.contains(id.as_str()));
    for id in absent.filter(|id| readable(id)) {
        lines.push((id, "Missing".to_owned(), 0.0));
        missing = missing.saturating_sub(1);
    }
    lines.sort_by(|a, b| a.0.cmp(b.0));
    let mut text = String::new();
    if refused > 0 {
        text += &format!(
            "# {} left out: deqp-runner could not read their ids\n",
            count(refused, "record")
        );
    }
    if missing > 0 {
        let records = count(missing, "record");
        text += &format!("# incomplete: {records} missing, and not listed here\n");
    }
    for (case, status, seconds) in lines {
        text += &format!("{case},{status},{}\n", seconds as f32);
    }
    text
}

/// Returns true if deqp-runner reads the id unchanged.
fn readable(case: &str) -> bool {
    !case.is_empty()
        && !case.starts_with('#')
        && !case.contains(|c: char| c == ',' || c.is_control())
}

/// Returns the status in deqp-runner's words.
fn status(record: &Record) -> String {
    let plain = match record.verdict {
        Verdict::Pass => "Pass",
        Verdict::Imprecise => "Warn",
        Verdict::Fail
        | Verdict::RequiredByCts
        | Verdict::Disputed
        | Verdict::Blocked
        | Verdict::Open
        | Verdict::ResourceError
        | Verdict::InternalError => "Fail",
        Verdict::Crash | Verdict::DeviceLost => "Crash",
        Verdict::Timeout => "Timeout",
        Verdict::Flaky => "Flake",
        Verdict::NotSupported | Verdict::Skipped | Verdict::Measured => "Skip",
    };
    if record.unexpected() {
        // A selftest that should have failed has a good verdict and is still unexpected.
        return if record.verdict.is_bad() {
            plain
        } else {
            "Fail"
        }
        .to_owned();
    }
    match record.verdict {
        Verdict::Flaky => "KnownFlake".to_owned(),
        verdict if verdict.is_bad() => "ExpectedFail".to_owned(),
        _ if record.improvement() => format!("UnexpectedImprovement({plain})"),
        _ => plain.to_owned(),
    }
}

/// Returns the ids that the run selected, if the run lacks records and its folder has the list. Otherwise
/// returns none.
fn selected(folder: &Path, run: &Run) -> Vec<String> {
    if run.missing() == 0 {
        return Vec::new();
    }
    // A damaged list, or a list of another run, is ignored; the comment then counts the missing records.
    let mut ids = read_cases(folder, &run.header)
        .ok()
        .flatten()
        .unwrap_or_default();
    if let Some(shard) = run.header.settings.shard {
        ids.retain(|id| shard_of(id, shard.count) == shard.index);
    }
    ids
}
