//! The matrix for a terminal.

use super::csv::state;
use super::data::{Cell, Entry, Matrix, unit};
use crate::numbers::digits;
use crate::terminal::{self, TableOptions, wrapped};
use crate::words::plain;
use etalon_record::Bench;
use tabled::builder::Builder;

/// A row per cell with its rate on each adapter; empty where the bench has no cell.
pub fn matrix_table(bench: &Bench, options: TableOptions) -> String {
    let matrix = Matrix::new(bench);
    let mut text = String::new();
    for size in matrix.sizes() {
        let mut builder = Builder::default();
        let mut head = vec!["cell".to_owned(), "unit".to_owned()];
        head.extend(matrix.adapters.iter().map(|a| plain(a, 40)));
        builder.push_record(head);
        let cells: Vec<&Cell> = matrix.cells.iter().filter(|c| c.size == size).collect();
        for cell in &cells {
            let mut row = row(cell, &matrix.adapters);
            row.insert(0, plain(&short(cell, &cells), 100));
            builder.push_record(row);
        }
        let table = wrapped(terminal::table(builder, options, 2), options);
        text.push_str(&format!("Matrix, {}\n{table}\n\n", plain(size, 40)));
    }
    if !text.is_empty() {
        text.push_str(
            "Rate between two numbers of layers, the larger half of its 95 % interval, and the share of the plain fill's rate.\n\
             below: less time than single times scatter.\n",
        );
    }
    text
}

/// The group and the axes in which its cells differ.
fn short(cell: &Cell, cells: &[&Cell]) -> String {
    let differ = |axis: &str| {
        let mut same = cells.iter().filter(|c| c.group == cell.group);
        same.any(|c| c.axis(axis) != cell.axis(axis))
    };
    let axes = cell.axes.iter().filter(|(axis, _)| differ(axis));
    let axes = axes.map(|(axis, value)| format!(" {axis}={value}"));
    format!("{}{}", cell.group, axes.collect::<String>())
}

fn row(cell: &Cell, adapters: &[&str]) -> Vec<String> {
    let measure = cell.results.values().find_map(|e| e.outcome.times());
    let unit = measure.map_or("·", |t| unit(t.measure).0);
    let mut row = vec![unit.to_owned()];
    let entry = |adapter: &&str| match cell.results.get(*adapter) {
        Some(entry) => figures(entry),
        None => "·".to_owned(),
    };
    row.extend(adapters.iter().map(entry));
    row
}

fn figures(entry: &Entry) -> String {
    let times = entry.outcome.times();
    let Some((times, rate)) = times.and_then(|t| Some((t, t.slope.rate()?))) else {
        return match state(&entry.outcome).0.as_str() {
            "below-resolution" => "below".to_owned(),
            other => other.to_owned(),
        };
    };
    let mut text = digits(rate / unit(times.measure).1, 3);
    if let Some(share) = half_width(times.slope.rate_interval(), rate) {
        text.push_str(&format!(" ±{}%", digits(share * 100.0, 2)));
    }
    if let Some(share) = entry.of_base {
        text.push_str(&format!(" {}%", digits(share * 100.0, 3)));
    }
    text
}

/// The share of a rate by which the farther end of its interval differs from it.
pub(super) fn half_width(interval: Option<[f64; 2]>, rate: f64) -> Option<f64> {
    let ends = interval?.map(|end| (end / rate - 1.0).abs());
    Some(ends[0].max(ends[1]))
}
