//! What became of planted bugs: `mutants.html` and the summary for a terminal.

mod page;
mod terminal;

pub use terminal::hunt_table;

use crate::{ReportError, replace};
use etalon_record::{Catch, Hunt, MutantRecord};
use std::path::{Path, PathBuf};

/// The files that [`write_hunt`] made.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct WrittenHunt {
    /// The page for people.
    pub html: PathBuf,
    /// The hunt itself.
    pub json: PathBuf,
}

/// Writes `mutants.json` and `mutants.html` into a folder, which is made when it does not exist.
///
/// # Errors
/// When the folder cannot be written to.
pub fn write_hunt(folder: &Path, hunt: &Hunt) -> Result<WrittenHunt, ReportError> {
    let json = hunt.write(folder)?;
    let html = replace(folder, "mutants.html", page::page(hunt).as_bytes())?;
    Ok(WrittenHunt { html, json })
}

/// One area's share in the hunt.
struct AreaRow<'a> {
    area: &'a str,
    /// Bugs that this area must catch by itself.
    own: usize,
    /// Those of them whose outcome the area reaches by itself.
    own_reached: usize,
    /// Bugs of any area that it caught, noticed without catching, and passed.
    counts: [usize; 3],
}

/// The share of every area, in alphabetical order.
fn areas(hunt: &Hunt) -> Vec<AreaRow<'_>> {
    let tallies = || hunt.mutants.iter().flat_map(|m| &m.areas);
    let mut names: Vec<&str> = tallies().map(|t| t.area.as_str()).collect();
    names.sort_unstable();
    names.dedup();
    let row = |area| {
        let mut row = AreaRow {
            area,
            own: 0,
            own_reached: 0,
            counts: [0; 3],
        };
        for mutant in &hunt.mutants {
            if mutant.mutant.area == area {
                row.own += 1;
                row.own_reached += usize::from(mutant.by_own_area());
            }
            let tally = mutant.areas.iter().find(|t| t.area == area);
            let place = tally.map_or(2, |t| match (t.fail, t.imprecise) {
                (1.., _) => 0,
                (0, 1..) => 1,
                (0, 0) => 2,
            });
            row.counts[place] += 1;
        }
        row
    };
    names.into_iter().map(row).collect()
}

/// Bugs that reached their outcome only through another area's cases.
fn elsewhere(hunt: &Hunt) -> Vec<&MutantRecord> {
    let seen = |m: &&MutantRecord| matches!(m.outcome, Catch::Caught | Catch::Noticed);
    let all = hunt.mutants.iter().filter(seen);
    all.filter(|m| !m.by_own_area()).collect()
}

/// The totals in one line.
fn totals(hunt: &Hunt) -> String {
    let of = |outcome: Catch| format!("{} {}", hunt.count(outcome), outcome.name());
    let mut parts = vec![of(Catch::Caught), of(Catch::Noticed), of(Catch::Survived)];
    if hunt.count(Catch::Broken) > 0 {
        parts.push(of(Catch::Broken));
    }
    format!(
        "{} planted bugs, {} cases, {:.1} s: {}",
        hunt.mutants.len(),
        hunt.cases,
        hunt.seconds,
        parts.join(", ")
    )
}
