//! Areas against adapters: a cell is a number and a bar, its words are its title and the list that it leads to.

use crate::lists::grouped;
use crate::mark::class;
use crate::page::adapter::breakable;
use crate::page::link;
use crate::run::grid::{RunGrid, VerdictTally};
use crate::words::{Tone, api_name, name};
use etalon_frame::AdapterName;
use etalon_record::Record;
use maud::{Markup, html};

/// The most cells of case files; a page with more shows areas alone.
const FILE_CELLS: usize = 40_000;
/// A table with more columns than this has upright names.
const LYING: usize = 8;

/// Columns under one head.
type ColumnGroup<'a> = (&'a str, Vec<usize>);

/// Returns the section: areas and their case files by API, then areas by driver.
pub(crate) fn section(grid: &RunGrid<'_>) -> Markup {
    let columns = || grid.adapters.iter().enumerate();
    let api_of = |name: &str| match grid.run.header.adapter(name) {
        Some(adapter) => api_name(adapter.limits.api),
        None => "unknown",
    };
    let by_api = grouped(columns().map(|(column, name)| (api_of(name), column)));
    let by_driver =
        grouped(columns().map(|(column, name)| (AdapterName::new(name).driver(), column)));
    let files = grid.files().count() * grid.adapters.len() <= FILE_CELLS;
    html! {
        section id="matrix" {
            h2 { "Areas and adapters" }
            p {
                "A bold number on colour counts bad verdicts that nothing expected; any other number counts known ones. "
                "A dash means that nothing was drawn. An area opens into its case files, a cell leads to its list."
            }
            p aria-hidden="true" {
                @for (style, meaning) in [("--x:100%", "unexpected"), ("--y:100%", "known"), ("--z:100%", "right"), ("", "not drawn, or nothing asserted")] {
                    span.key { i.bar style=(style) {} " " (meaning) }
                }
            }
            (table(grid, &by_api, "Verdicts by area and adapter, adapters by API", files))
            @if by_driver.len() < grid.adapters.len() {
                details {
                    summary { "The same by driver" }
                    (table(grid, &by_driver, "Verdicts by area and adapter, adapters by driver", false))
                }
            }
        }
    }
}

fn table(grid: &RunGrid<'_>, groups: &[ColumnGroup<'_>], caption: &str, files: bool) -> Markup {
    let columns: Vec<usize> = groups.iter().flat_map(|(_, c)| c).copied().collect();
    // The first column of each group has an edge.
    let edges: Vec<usize> = groups
        .iter()
        .filter_map(|(_, c)| c.first().copied())
        .collect();
    let edge = |column: &usize| edges.contains(column);
    let upright = columns.len() > LYING;
    html! {
        div.pane {
            table.matrix.upright[upright] {
                caption.vh { (caption) }
                thead {
                    tr {
                        th scope="col" rowspan="2" { "Area" }
                        @for (group, columns) in groups {
                            th.edge scope="colgroup" colspan=(columns.len()) { (group) }
                        }
                    }
                    tr { @for column in &columns {
                        th.edge[edge(column)] scope="col" { span { (breakable(grid.adapters[*column])) } }
                    } }
                }
                @for (a, area) in grid.areas.iter().enumerate() {
                    tbody {
                        tr {
                            th scope="row" {
                                @if files { details { summary { (area.name) } a href={ "#a" (a) } { "list" } } }
                                @else { a href={ "#a" (a) } { (area.name) } }
                            }
                            @for column in &columns {
                                (cell(area.on(*column).map(|i| grid.record(i)), edge(column), |_| Some(format!("#l{a}-{column}"))))
                            }
                        }
                        @if files { @for file in &area.files {
                            tr.file {
                                th scope="row" { (within(area.name, file.name)) }
                                @for column in &columns {
                                    (cell(file.on(*column).map(|i| grid.record(i)), edge(column), |tally| {
                                        let bad = tally.unexpected + tally.known > 0;
                                        bad.then(|| link::filter(file.name, grid.adapters[*column]))
                                    }))
                                }
                            }
                        } }
                    }
                }
                tbody { tr.sum {
                    th scope="row" { "all" }
                    @for column in &columns { (cell(grid.on(*column), edge(column), |_| Some("#findings".to_owned()))) }
                } }
            }
        }
    }
}

/// Returns the name of a case file within its area.
fn within<'a>(area: &str, file: &'a str) -> &'a str {
    let name = file
        .strip_prefix(area)
        .and_then(|rest| rest.strip_prefix('/'));
    name.unwrap_or(file)
}

/// Returns the cell of some records: a number and a bar. `edge` is true in the first column of a group.
fn cell<'r>(
    records: impl Iterator<Item = &'r Record>,
    edge: bool,
    list: impl FnOnce(&VerdictTally) -> Option<String>,
) -> Markup {
    let tally = VerdictTally::of(records);
    let (number, kind) = match (tally.unexpected, tally.known, tally.right) {
        (0, 0, 0) => ("–".to_owned(), None),
        (0, 0, _) => ("0".to_owned(), None),
        (0, known, _) => (known.to_string(), Some("known")),
        (unexpected, ..) => (unexpected.to_string(), Some("new")),
    };
    let worst = tally.worst.map(|worst| class(worst, Tone::Plain));
    let classes = [worst, kind, edge.then_some("edge")];
    let classes: Vec<&str> = classes.into_iter().flatten().collect();
    let content = html! { (number) @if tally.total > 0 { i.bar style=(bar(&tally)) {} } };
    html! {
        td class=[(!classes.is_empty()).then(|| classes.join(" "))] title=(words(&tally)) {
            @match list(&tally).filter(|_| tally.total > 0) {
                Some(list) => a href=(list) { (content) },
                None => (content),
            }
        }
    }
}

/// Returns the ends of a bar's parts, in percent.
fn bar(tally: &VerdictTally) -> String {
    let mut end = 0;
    let parts = [
        ("x", tally.unexpected),
        ("y", tally.known),
        ("z", tally.right),
    ];
    let ends = parts.into_iter().filter_map(|(part, records)| {
        end += records;
        (records > 0).then(|| format!("--{part}:{}%", (end * 100).div_ceil(tally.total)))
    });
    ends.collect::<Vec<_>>().join(";")
}

/// Returns the counts in words: `3 fail, 12 fail (expected), 200 pass`.
fn words(tally: &VerdictTally) -> String {
    let entries = tally.entries();
    let words = entries.map(|(verdict, tone, n)| format!("{n} {}{}", name(verdict), tone.suffix()));
    match words.collect::<Vec<_>>() {
        none if none.is_empty() => "no record".to_owned(),
        words => words.join(", "),
    }
}
