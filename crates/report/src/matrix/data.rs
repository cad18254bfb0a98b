//! The cells of a bench: their rates, and the rates they are compared with.

use super::reached::Reached;
use crate::bench::figures::{end, software};
use crate::lists::{distinct, grouped};
use etalon_record::{Bench, BenchRecord, CellRate, Measure, Verdict, cell};
use std::collections::BTreeMap;

/// The cells of a bench.
pub(crate) struct Matrix<'a> {
    pub(crate) bench: &'a Bench,
    /// The cells in the order of the bench.
    pub(crate) cells: Vec<MatrixCell>,
    /// The adapters that have a cell, in the order of the bench.
    pub(crate) adapters: Vec<&'a str>,
}

/// A cell on all adapters.
pub(crate) struct MatrixCell {
    /// The id of the cell's cases without the number of layers.
    pub(crate) name: String,
    /// The name of the cell's case file.
    pub(crate) group: String,
    /// Axes and their values, except the size.
    pub(crate) axes: BTreeMap<String, String>,
    /// The size of the cell's attachments.
    pub(crate) size: String,
    /// The entry of each adapter.
    pub(crate) results: BTreeMap<String, MatrixEntry>,
}

/// A cell on one adapter.
pub(crate) struct MatrixEntry {
    pub(crate) outcome: CellOutcome,
    /// The cell's rate divided by the base cell's, if both count texels.
    pub(crate) of_base: Option<f64>,
    /// The cell's rate divided by the rate of clearing.
    pub(crate) of_clear: Option<f64>,
    /// The shares of the processor's limits that the cell reaches, if the adapter draws with the processor and
    /// they were measured.
    pub(crate) reached: Option<Reached>,
}

/// The rate of a cell on an adapter, or the reason why it has none.
pub(crate) enum CellOutcome {
    /// The cell was measured.
    Rate(CellRate),
    /// The work takes less time than the scatter of single times.
    Below(CellRate),
    /// One of the cell's pictures must not be timed.
    Untimed(Verdict, String),
    /// No round timed both cases, or only one of the cases was drawn.
    Incomplete,
}

impl CellOutcome {
    /// Returns the rate in units per second.
    pub(crate) fn rate(&self) -> Option<f64> {
        match self {
            Self::Rate(rate) => rate.slope.rate(),
            _ => None,
        }
    }

    /// Returns the times, even if they give no rate.
    pub(crate) fn times(&self) -> Option<&CellRate> {
        match self {
            Self::Rate(rate) | Self::Below(rate) => Some(rate),
            _ => None,
        }
    }

    fn new(records: &[&BenchRecord], software: bool) -> Self {
        let wrong = records.iter().find(|r| {
            let ended = r.ended.as_ref().is_some_and(|e| e.verdict.is_bad());
            ended || !r.picture.may_be_timed()
        });
        if let Some(record) = wrong {
            let (verdict, message) = end(record);
            return Self::Untimed(verdict, message);
        }
        let [first, other] = records else {
            return Self::Incomplete;
        };
        match CellRate::new(first, other, software) {
            Some(rate) if rate.slope.below_resolution => Self::Below(rate),
            Some(rate) => Self::Rate(rate),
            None => Self::Incomplete,
        }
    }
}

/// The cell that others are compared with: an opaque fill of the most common format with all tests off.
const BASE: (&str, &[(&str, &str)]) = (
    "fill",
    &[
        ("blend", "none"),
        ("format", "rgba8unorm"),
        ("samples", "1"),
    ],
);
/// The file and the axis values of the cell for clears.
const CLEAR: (&str, &[(&str, &str)]) = ("clear", &[("format", "rgba8unorm")]);

impl<'a> Matrix<'a> {
    pub(crate) fn new(bench: &'a Bench) -> Self {
        let records = bench.records.iter();
        let named = records.filter_map(|r| Some((cell(&r.picture.case)?, r)));
        let named: Vec<(String, &'a BenchRecord)> = named.collect();
        let adapters = distinct(named.iter().map(|(_, r)| r.picture.adapter.as_str()));
        let cells = grouped(named).into_iter();
        let mut cells: Vec<MatrixCell> = cells
            .map(|(name, records)| MatrixCell::new(bench, name, records))
            .collect();
        hold_against(&mut cells, &adapters);
        Self {
            bench,
            cells,
            adapters,
        }
    }

    /// Returns the sizes of attachments, in the order of the bench.
    pub(crate) fn sizes(&self) -> Vec<&str> {
        distinct(self.cells.iter().map(|c| c.size.as_str()))
    }
}

impl MatrixCell {
    fn new(bench: &Bench, name: String, records: Vec<&BenchRecord>) -> Self {
        let mut parts = name.split('/').skip(2);
        let group = parts.next().unwrap_or_default().to_owned();
        let axis = |part: &str| {
            let (axis, value) = part.split_once('=')?;
            Some((axis.to_owned(), value.to_owned()))
        };
        let mut axes: BTreeMap<String, String> = parts.filter_map(axis).collect();
        let size = axes.remove("size").unwrap_or_default();
        let results = grouped(records.into_iter().map(|r| (r.picture.adapter.as_str(), r)));
        let results = results.into_iter().map(|(adapter, records)| {
            let software = software(bench.header.adapter(adapter));
            let outcome = CellOutcome::new(&records, software);
            let limits = bench.header.limits.last().filter(|_| software);
            let entry = MatrixEntry {
                of_base: None,
                of_clear: None,
                reached: limits.and_then(|limits| Reached::new(outcome.times()?, *limits)),
                outcome,
            };
            (adapter.to_owned(), entry)
        });
        Self {
            group,
            axes,
            size,
            results: results.collect(),
            name,
        }
    }

    /// Returns the value of an axis.
    pub(crate) fn axis(&self, name: &str) -> Option<&str> {
        self.axes.get(name).map(String::as_str)
    }

    /// Returns the name without the area and the size.
    pub(crate) fn short(&self) -> String {
        let axes = self
            .axes
            .iter()
            .map(|(axis, value)| format!(" {axis}={value}"));
        format!("{}{}", self.group, axes.collect::<String>())
    }

    fn is(&self, (group, axes): (&str, &[(&str, &str)]), size: &str) -> bool {
        let same = |(axis, value): &(&str, &str)| self.axis(axis) == Some(*value);
        self.group == group && self.size == size && axes.iter().all(same)
    }
}

/// Divides each rate by the base cell's rate and by the rate of clearing.
fn hold_against(cells: &mut [MatrixCell], adapters: &[&str]) {
    let sizes = distinct(cells.iter().map(|c| c.size.as_str()));
    let sizes: Vec<String> = sizes.into_iter().map(str::to_owned).collect();
    for size in &sizes {
        for adapter in adapters {
            let clocks = |which| {
                let cell = cells.iter().find(|c| c.is(which, size))?;
                cell.results.get(*adapter)?.outcome.rate()
            };
            let (base, clear) = (clocks(BASE), clocks(CLEAR));
            let same_size = cells.iter_mut().filter(|c| c.size == *size);
            for entry in same_size.filter_map(|c| c.results.get_mut(*adapter)) {
                let texels = entry
                    .outcome
                    .times()
                    .is_some_and(|t| t.measure != Measure::Triangles);
                let rate = entry.outcome.rate().filter(|_| texels);
                entry.of_base = rate.zip(base).map(|(rate, base)| rate / base);
                entry.of_clear = rate.zip(clear).map(|(rate, clear)| rate / clear);
            }
        }
    }
}

/// Returns the unit of a rate, and the divisor from units per second to it.
pub(crate) fn unit(measure: Measure) -> (&'static str, f64) {
    match measure {
        Measure::Triangles => ("Mtri/s", 1e6),
        Measure::Texels | Measure::Cleared | Measure::Resolved | Measure::Read => ("Gpix/s", 1e9),
    }
}
