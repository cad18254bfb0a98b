//! The layout of heat maps: the cells of each heat map and their positions.

use super::data::MatrixCell;
use crate::lists::distinct;

/// A heat map: rows are blending and format, columns tests and samples.
pub(super) struct Heat<'a> {
    pub(super) title: &'static str,
    pub(super) rows: Vec<Vec<&'a str>>,
    /// The names of the axes of a row.
    pub(super) row_axes: &'static [&'static str],
    /// The tests and the samples of each column.
    pub(super) columns: Vec<(String, &'a str)>,
    cells: Vec<&'a MatrixCell>,
}

const MAPS: [(&str, &[&str], &[&str]); 3] = [
    (
        "Fill and blend, tests off",
        &["fill", "dual-source", "logic"],
        &["blend", "format"],
    ),
    ("Depth", &["depth"], &["blend", "format"]),
    (
        "Stencil",
        &["stencil"],
        &["blend", "format", "depth_format"],
    ),
];

impl<'a> Heat<'a> {
    /// Returns the heat maps of the cells of one size.
    pub(super) fn all(cells: &[&'a MatrixCell]) -> Vec<Self> {
        let maps = MAPS.iter().map(|(title, groups, row_axes)| {
            let in_groups = |cell: &&&MatrixCell| groups.contains(&cell.group.as_str());
            let mut cells: Vec<&MatrixCell> = cells.iter().filter(in_groups).copied().collect();
            cells.sort_by_key(|c| groups.iter().position(|group| *group == c.group));
            let mut columns = distinct(cells.iter().map(|c| column(c, row_axes)));
            columns
                .sort_by_key(|(tests, samples)| (place(&cells, tests, row_axes), number(samples)));
            Self {
                title,
                rows: distinct(cells.iter().map(|c| key(c, row_axes))),
                row_axes,
                columns,
                cells,
            }
        });
        maps.filter(|m| !m.cells.is_empty()).collect()
    }

    /// Returns the cells that are in no heat map, by group.
    pub(super) fn rest(cells: &[&'a MatrixCell]) -> Vec<(&'a str, Vec<&'a MatrixCell>)> {
        let is_rest = |c: &&&MatrixCell| !MAPS.iter().any(|m| m.1.contains(&c.group.as_str()));
        let others: Vec<&MatrixCell> = cells.iter().filter(is_rest).copied().collect();
        let groups = distinct(others.iter().map(|c| c.group.as_str()));
        let in_group = |group| {
            others
                .iter()
                .filter(|c| c.group == group)
                .copied()
                .collect()
        };
        groups
            .into_iter()
            .map(|group| (group, in_group(group)))
            .collect()
    }

    pub(super) fn cell(&self, row: &[&str], column: &(String, &str)) -> Option<&'a MatrixCell> {
        let mut cells = self.cells.iter();
        let place = |c: &&&MatrixCell| {
            key(c, self.row_axes) == row && self::column(c, self.row_axes) == *column
        };
        cells.find(place).copied()
    }

    /// Returns the tests of the columns, each with its number of columns.
    pub(super) fn heads(&self) -> Vec<(&str, usize)> {
        let tests = distinct(self.columns.iter().map(|(tests, _)| tests.as_str()));
        let width = |t: &str| self.columns.iter().filter(|c| c.0 == t).count();
        tests.into_iter().map(|t| (t, width(t))).collect()
    }
}

fn key<'a>(cell: &'a MatrixCell, axes: &[&str]) -> Vec<&'a str> {
    axes.iter().map(|a| cell.axis(a).unwrap_or("off")).collect()
}

fn column<'a>(cell: &'a MatrixCell, row_axes: &[&str]) -> (String, &'a str) {
    let format = cell
        .axis("depth_format")
        .filter(|_| !row_axes.contains(&"depth_format"));
    let part = |axis: &str| match cell.axis(axis).unwrap_or("off") {
        "write" => "test and write".to_owned(),
        value => value.to_owned(),
    };
    let mut tests = format!("depth {}", part("depth"));
    if let Some(format) = format {
        tests = format!("{format} {}", part("depth"));
    }
    if cell.axis("stencil").is_some() {
        tests += &format!(", stencil {}", part("stencil"));
    }
    (tests, cell.axis("samples").unwrap_or("1"))
}

/// Returns the index of the first cell with these tests.
fn place(cells: &[&MatrixCell], tests: &str, row_axes: &[&str]) -> Option<usize> {
    cells.iter().position(|c| column(c, row_axes).0 == tests)
}

fn number(samples: &str) -> u32 {
    samples.parse().unwrap_or(u32::MAX)
}
