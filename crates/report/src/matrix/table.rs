//! The matrix for a terminal.

use super::csv::state;
use super::data::{CellOutcome, Matrix, MatrixCell, MatrixEntry, unit};
use crate::numbers::digits;
use crate::table::Table;
use crate::terminal::TableOptions;
use crate::words::plain;
use etalon_record::Bench;

/// Returns a row per cell with its rate on each adapter; empty if the bench has no cell.
pub fn matrix_table(bench: &Bench, options: TableOptions) -> String {
    let matrix = Matrix::new(bench);
    let mut text = String::new();
    for size in matrix.sizes() {
        let cells: Vec<&MatrixCell> = matrix.cells.iter().filter(|c| c.size == size).collect();
        let mut table = Table::<&MatrixCell>::new("")
            .text("cell", |cell| short(cell, &cells))
            .text("unit", |cell| {
                let measure = cell.results.values().find_map(|e| e.outcome.times());
                measure.map(|t| unit(t.measure).0)
            });
        for adapter in &matrix.adapters {
            table = table.number(*adapter, |cell| cell.results.get(*adapter).map(figures));
        }
        let (table, _) = table.terminal(cells.iter().copied(), options, &[]);
        text += &format!("Matrix, {}\n{table}\n\n", plain(size, 40));
    }
    if !text.is_empty() {
        text.push_str(
            "Rate between two numbers of layers, the larger half of its 95 % interval, and the share of the plain fill's rate.\n\
             below: less time than the scatter of single times.\n",
        );
    }
    text
}

/// Returns the group and the axes in which its cells differ.
fn short(cell: &MatrixCell, cells: &[&MatrixCell]) -> String {
    let differ = |axis: &str| {
        let mut same = cells.iter().filter(|c| c.group == cell.group);
        same.any(|c| c.axis(axis) != cell.axis(axis))
    };
    let axes = cell.axes.iter().filter(|(axis, _)| differ(axis));
    let axes = axes.map(|(axis, value)| format!(" {axis}={value}"));
    format!("{}{}", cell.group, axes.collect::<String>())
}

/// Returns the rate, the half width of its interval and its share of the plain fill's rate, or the state of a cell without
/// a rate.
fn figures(entry: &MatrixEntry) -> String {
    let times = entry.outcome.times();
    let Some((times, rate)) = times.and_then(|t| Some((t, t.slope.rate()?))) else {
        return match &entry.outcome {
            CellOutcome::Below(_) => "below".to_owned(),
            outcome => state(outcome).0,
        };
    };
    let mut text = digits(rate / unit(times.measure).1, 3);
    if let Some(share) = half_width(times.slope.rate_interval(), rate) {
        text += &format!(" ±{}%", digits(share * 100.0, 2));
    }
    if let Some(share) = entry.of_base {
        text += &format!(" {}%", digits(share * 100.0, 3));
    }
    text
}

/// Returns the half width of an interval relative to the rate: the distance to the farther end.
pub(super) fn half_width(interval: Option<[f64; 2]>, rate: f64) -> Option<f64> {
    let ends = interval?.map(|end| (end / rate - 1.0).abs());
    Some(ends[0].max(ends[1]))
}
