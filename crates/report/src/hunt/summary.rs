//! The figures of a hunt that the page and the terminal share.

use crate::numbers::duration;
use etalon_record::{Catch, Hunt, MutantRecord};

/// One area's share in the hunt.
pub(super) struct AreaRow<'a> {
    pub(super) area: &'a str,
    /// Bugs that this area must catch by itself.
    pub(super) own: usize,
    /// Those of them whose outcome the area reaches by itself.
    pub(super) own_reached: usize,
    /// Bugs of any area that it caught, noticed without catching, and passed.
    pub(super) counts: [usize; 3],
}

/// The share of every area, in alphabetical order.
pub(super) fn areas(hunt: &Hunt) -> Vec<AreaRow<'_>> {
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
pub(super) fn elsewhere(hunt: &Hunt) -> Vec<&MutantRecord> {
    let seen = |m: &&MutantRecord| matches!(m.outcome, Catch::Caught | Catch::Noticed);
    let all = hunt.mutants.iter().filter(seen);
    all.filter(|m| !m.by_own_area()).collect()
}

/// The totals in one line.
pub(super) fn totals(hunt: &Hunt) -> String {
    let of = |outcome: Catch| format!("{} {}", hunt.count(outcome), outcome.name());
    let mut parts = vec![of(Catch::Caught), of(Catch::Noticed), of(Catch::Survived)];
    if hunt.count(Catch::Broken) > 0 {
        parts.push(of(Catch::Broken));
    }
    format!(
        "{} planted bugs, {} cases, {}: {}",
        hunt.mutants.len(),
        hunt.cases,
        duration(hunt.seconds),
        parts.join(", ")
    )
}
