//! Cells of the performance matrix: two cases that differ only in their number of layers.
//!
//! A cell has no time of its own. Its rate is the slope between the times of its two cases, over the
//! difference of their work, which is recorded with their pictures.

use super::record::BenchRecord;
use super::time::Time;
use etalon_frame::{Work, state_enum};
use etalon_stats::{Slope, WorkTimes, quantile};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The cases that form cells.
const AREA: &str = "perf/matrix/";
/// The axis in which the cases of a cell differ.
const LAYERS: &str = "layers=";
/// The maximum size, in texels, of a triangle that is counted as a triangle. The time of larger ones depends on
/// their texels.
const LARGEST: u64 = 1024;

/// Returns the name of the cell that a case belongs to: its id without the number of layers. `None` outside the
/// matrix.
pub fn cell(case: &str) -> Option<String> {
    let path = case.strip_prefix(AREA)?;
    let parts = || path.split('/');
    parts().find(|part| part.starts_with(LAYERS))?;
    let kept: Vec<&str> = parts().filter(|part| !part.starts_with(LAYERS)).collect();
    Some(format!("{AREA}{}", kept.join("/")))
}

state_enum! {
    /// The unit of a cell's work.
    Measure {
        /// Texels that triangles cover.
        Texels = "texels",
        /// Triangles that are drawn.
        Triangles = "triangles",
        /// Texels that are cleared.
        Cleared = "cleared",
        /// Texels that a resolve writes.
        Resolved = "resolved",
        /// Texels that are read back.
        Read = "read",
    }
}

impl Measure {
    /// Returns the unit in which two amounts of work differ, and the difference; `None` if `more` is not
    /// the larger one.
    pub fn between(less: Work, more: Work) -> Option<(Self, u64)> {
        let difference = |f: fn(Work) -> u64| f(more).checked_sub(f(less));
        let passes = [
            (Self::Read, difference(|w| w.read)?),
            (Self::Cleared, difference(|w| w.cleared)?),
            (Self::Resolved, difference(|w| w.resolved)?),
        ];
        let (texels, triangles) = (difference(|w| w.texels)?, difference(|w| w.triangles)?);
        let draws = if texels <= LARGEST.saturating_mul(triangles) {
            (Self::Triangles, triangles)
        } else {
            (Self::Texels, texels)
        };
        // Clears, resolves and read-backs of whole attachments outweigh the few texels that passes draw.
        let found = passes.into_iter().find(|(_, amount)| *amount > 0);
        found.or((draws.1 > 0).then_some(draws))
    }
}

/// The rate of a cell on an adapter.
#[derive(Clone, Debug, PartialEq)]
pub struct CellRate {
    /// The unit in which the work is counted.
    pub measure: Measure,
    /// The difference of the two cases' work.
    pub work: u64,
    /// The bytes that the additional work moves, and its arithmetic operations; 0 if they were not counted.
    pub traffic: [u64; 2],
    /// The kind of time that was compared.
    pub time: Time,
    /// The slope between the two cases.
    pub slope: Slope,
    /// The median time of each round, first for the case with less work, then for the case with more.
    pub medians: [Vec<f64>; 2],
}

impl CellRate {
    /// Computes the rate from the records of a cell's cases, in either order. `None` if the cases share no
    /// round, or if their work does not differ. Uses GPU timestamps if all rounds have them and the adapter
    /// is not the processor itself, and wall time otherwise; cells that read back use the time of reading
    /// back.
    pub fn new(first: &BenchRecord, other: &BenchRecord, software: bool) -> Option<Self> {
        let works = (first.picture.work?, other.picture.work?);
        let (less, more, (measure, work)) = match Measure::between(works.0, works.1) {
            Some(found) => (first, other, found),
            None => (other, first, Measure::between(works.1, works.0)?),
        };
        let both = || less.rounds.iter().zip(&more.rounds);
        let stamped = both().all(|(a, b)| !a.gpu.is_empty() && !b.gpu.is_empty());
        let time = match measure {
            Measure::Read => Time::ReadBack,
            _ if stamped && !software => Time::Gpu,
            _ => Time::Wall,
        };
        let pairs: Vec<WorkTimes<'_>> = both()
            .map(|(less, more)| WorkTimes {
                less: less.samples(time),
                more: more.samples(time),
            })
            .collect();
        let medians =
            |times: fn(&WorkTimes<'_>) -> Option<f64>| pairs.iter().filter_map(times).collect();
        let difference = |f: fn(Work) -> u64| {
            let [less, more] = [less, more].map(|r| r.picture.work.map_or(0, f));
            more.saturating_sub(less)
        };
        let traffic = match measure {
            Measure::Read => [difference(|w| w.read_bytes), 0],
            // The few texels that its passes draw are not its work.
            Measure::Cleared => [difference(|w| w.bytes), 0],
            _ => [difference(|w| w.bytes), difference(|w| w.operations)],
        };
        Some(Self {
            measure,
            work,
            traffic,
            time,
            slope: Slope::new(&pairs, work)?,
            medians: [medians(|p| median(p.less)), medians(|p| median(p.more))],
        })
    }
}

fn median(times: &[f64]) -> Option<f64> {
    let mut sorted = times.to_vec();
    sorted.sort_unstable_by(f64::total_cmp);
    quantile(&sorted, 0.5)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_cell_is_its_cases_without_the_layers() {
        let name = "perf/matrix/fill/blend=over/format=r8unorm/samples=1";
        let case = "perf/matrix/fill/blend=over/format=r8unorm/layers=12/samples=1";
        assert_eq!(cell(case).as_deref(), Some(name));
        for other in [
            "perf/quad/size=1",
            name,
            "methods/a/layers=4",
            "perf/matrix",
        ] {
            assert_eq!(cell(other), None, "{other}");
        }
    }

    #[test]
    fn the_measure_of_a_cell_is_the_work_that_differs() {
        let work = |triangles, texels, cleared, resolved, read| Work {
            triangles,
            texels,
            cleared,
            resolved,
            read,
            ..Work::default()
        };
        let between = |a, b| Measure::between(a, b);
        let none = work(4, 4000, 10, 0, 10);
        for (more, expected) in [
            (
                work(12, 4_000_000, 10, 0, 10),
                Some((Measure::Texels, 3_996_000)),
            ),
            (work(12, 4016, 10, 0, 10), Some((Measure::Triangles, 8))),
            (work(12, 4000, 10, 0, 10), Some((Measure::Triangles, 8))),
            (work(6, 4128, 90, 0, 10), Some((Measure::Cleared, 80))),
            (work(6, 4128, 10, 70, 10), Some((Measure::Resolved, 70))),
            (work(4, 4000, 10, 0, 30), Some((Measure::Read, 20))),
            (none, None),
            (work(4, 3999, 10, 0, 10), None),
        ] {
            assert_eq!(between(none, more), expected, "{more:?}");
        }
    }
}
