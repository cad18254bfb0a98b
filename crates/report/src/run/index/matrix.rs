//! Areas against adapters: a cell is a number and a bar, its words are its title and the list that it leads to.

use super::parts::{INDEX, SAME_PAGE};
use crate::lists::grouped;
use crate::mark::class;
use crate::page::adapter::breakable;
use crate::page::link;
use crate::run::grid::{RunGrid, VerdictTally};
use crate::words::{Tone, api_name, name};
use etalon_frame::AdapterName;
use etalon_record::Record;
use maud::{Markup, html};

/// A table with more columns than this has upright names.
const LYING: usize = 14;

/// Columns under one head.
type ColumnGroup<'a> = (&'a str, Vec<usize>);

/// Returns the section: areas by API. The page's script opens areas into case files.
pub(crate) fn section(grid: &RunGrid<'_>) -> Markup {
    let columns = grid.adapters.iter().enumerate();
    let api_of = |name: &str| match grid.run.header.adapter(name) {
        Some(adapter) => api_name(adapter.limits.api),
        None => "unknown",
    };
    let by_api = grouped(columns.map(|(column, name)| (api_of(name), column)));
    html! {
        section id="matrix" {
            h2 { "Areas and adapters" }
            (legend())
            (table(grid, &by_api, "Verdicts by area and adapter, adapters by API", SAME_PAGE))
        }
    }
}

/// Returns the same section by driver, for another page.
pub(crate) fn by_driver(grid: &RunGrid<'_>) -> Markup {
    let columns = grid.adapters.iter().enumerate();
    let driver = |name| AdapterName::new(name).driver();
    let groups = grouped(columns.map(|(column, name)| (driver(name), column)));
    html! {
        section id="by-driver" {
            h2 { "The matrix by driver" }
            (legend())
            (table(grid, &groups, "Verdicts by area and adapter, adapters by driver", INDEX))
        }
    }
}

fn legend() -> Markup {
    html! {
        p.legend {
            @for (style, meaning) in [("--x:100%", "unexpected"), ("--y:100%", "known"), ("--z:100%", "right"), ("", "not drawn, or nothing asserted")] {
                span.key { i.bar style=(style) {} " " (meaning) }
            }
            "A bold number counts bad verdicts that nothing expected, any other number known ones. A cell leads to its cases."
        }
    }
}

/// Returns a table. `page` is the page that lists the cases.
fn table(grid: &RunGrid<'_>, groups: &[ColumnGroup<'_>], caption: &str, page: &str) -> Markup {
    let columns: Vec<usize> = groups.iter().flat_map(|(_, c)| c).copied().collect();
    // The first column of each group has an edge.
    let edges: Vec<usize> = groups
        .iter()
        .filter_map(|(_, c)| c.first().copied())
        .collect();
    let edge = |column: &usize| edges.contains(column);
    let upright = columns.len() > LYING;
    html! {
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
            @for (number, area) in grid.areas.iter().enumerate() {
                tbody data-area=(number) {
                    tr {
                        th scope="row" { a href={ (page) (link::area(area.name)) } { (area.name) } }
                        @for column in &columns {
                            (cell(grid, *column, area.on(*column).map(|i| grid.record(i)), edge(column), |adapter, bad| {
                                format!("{page}{}", link::cell(Some(area.name), adapter, bad))
                            }))
                        }
                    }
                }
            }
            tbody { tr.sum {
                th scope="row" { "all" }
                @for column in &columns {
                    (cell(grid, *column, grid.on(*column), edge(column), |adapter, bad| format!("{page}{}", link::cell(None, adapter, bad))))
                }
            } }
        }
    }
}

/// Returns the cell of some records of a column: a number and a bar. `edge` is true in the first column of a group.
/// `list` returns the link to the records of an adapter, or to the bad ones among them.
fn cell<'r>(
    grid: &RunGrid<'_>,
    column: usize,
    records: impl Iterator<Item = &'r Record>,
    edge: bool,
    list: impl FnOnce(&str, bool) -> String,
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
    let adapter = grid.adapters[column];
    html! {
        td class=[(!classes.is_empty()).then(|| classes.join(" "))] data-column=(column) data-head=(adapter) title=(words(&tally)) {
            @if tally.total > 0 {
                a href=(list(adapter, kind.is_some())) { (number) i.bar style=(bar(&tally)) {} }
            } @else { (number) }
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
