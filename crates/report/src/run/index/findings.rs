//! The findings by area and adapter: everything that is not a plain pass.

use super::consensus::Consensus;
use super::detail::{self, DetailBudget, DrawnFrame};
use crate::mark::{class, mark};
use crate::numbers::count;
use crate::page::link;
use crate::run::grid::{AreaFiles, GridFile, RunGrid, VerdictTally};
use crate::threads::on_threads;
use crate::words::{self, Tone};
use etalon_record::{Record, Verdict};
use maud::{Markup, html};
use std::collections::{BTreeMap, HashMap, HashSet};
use std::path::Path;

/// The maximum number of records that are shown with everything known about them.
const BODIES: usize = 160;
/// The maximum number of imprecise records of a case file and adapter that are shown with all facts.
const IMPRECISE_BODIES: usize = 3;
/// The maximum number of lines of a case file and adapter.
const LINES: usize = 20;
/// The maximum number of lines in total. The rest is only under "All cases", which costs a browser less.
const ALL_LINES: usize = 5000;

/// The listed records, and whether each is shown with all facts.
pub(crate) struct FindingPlan {
    bodies: HashMap<usize, bool>,
    /// Records whose adapter differs from all others that drew the case.
    odd: HashSet<usize>,
    /// The number of records that would be shown with all facts if there were room.
    cut: usize,
}

impl FindingPlan {
    pub(crate) fn new(grid: &RunGrid<'_>) -> Self {
        // The first of every case file and adapter go before any second one, and what is
        // unexpected before what is not.
        let mut lines = Vec::new();
        let mut complete = Vec::new();
        for file in grid.files() {
            for column in 0..grid.adapters.len() {
                let mut ranks = [0; 3];
                for index in listed(grid, file, column) {
                    let kind = kind(grid.record(index));
                    let rank = &mut ranks[kind];
                    if *rank < LINES {
                        lines.push((kind, *rank, index));
                    }
                    let most = if kind == 2 { IMPRECISE_BODIES } else { LINES };
                    // The page of a record with an example links to that case.
                    if *rank < most && grid.record(index).example.is_none() {
                        complete.push((kind, *rank, index));
                    }
                    *rank += 1;
                }
            }
        }
        lines.sort_unstable();
        complete.sort_unstable();
        let shown = lines.iter().take(ALL_LINES);
        let mut bodies: HashMap<usize, bool> = shown.map(|(_, _, i)| (*i, false)).collect();
        for (_, _, index) in complete.iter().take(BODIES) {
            bodies.insert(*index, true);
        }
        let odd = grid.cases().filter_map(|case| {
            let column = Consensus::of(grid, case).only()?;
            case.records[column]
        });
        Self {
            bodies,
            odd: odd.collect(),
            cut: complete.len().saturating_sub(BODIES),
        }
    }

    /// True if the record has an entry that can be linked to.
    pub(crate) fn lists(&self, index: usize) -> bool {
        self.bodies.contains_key(&index)
    }

    /// True if the record's entry has all facts.
    pub(crate) fn whole(&self, index: usize) -> bool {
        self.bodies.get(&index).copied().unwrap_or(false)
    }
}

/// Returns 0 for unexpected records, 1 for expected or due ones, 2 for imprecise and all others.
pub(crate) fn kind(record: &Record) -> usize {
    if record.unexpected() {
        0
    } else if record.verdict.is_bad() {
        1
    } else {
        2
    }
}

/// Returns the records of a case file on one adapter that get an entry, the most serious kind first.
fn listed(grid: &RunGrid<'_>, file: &GridFile<'_>, column: usize) -> Vec<usize> {
    let worth = |i: &usize| {
        let r = grid.record(*i);
        r.unexpected() || r.verdict.is_bad() || r.verdict == Verdict::Imprecise
    };
    let mut result: Vec<usize> = file.on(column).filter(worth).collect();
    result.sort_by_key(|i| (kind(grid.record(*i)), grid.record(*i).example.is_some()));
    result
}

/// Returns the frames of all records that are shown whole, by record. They are most of a page's cost and
/// independent of each other.
fn drawn(folder: &Path, grid: &RunGrid<'_>, plan: &FindingPlan) -> HashMap<usize, DrawnFrame> {
    let complete: Vec<usize> = plan
        .bodies
        .keys()
        .copied()
        .filter(|i| plan.whole(*i))
        .collect();
    let drawn = on_threads(&complete, |i| DrawnFrame::of(folder, grid.record(*i)));
    let drawn = complete.into_iter().zip(drawn);
    drawn.filter_map(|(i, drawn)| Some((i, drawn?))).collect()
}

pub(crate) fn section(folder: &Path, grid: &RunGrid<'_>, plan: &FindingPlan) -> Markup {
    let mut section = Section {
        grid,
        plan,
        drawn: drawn(folder, grid, plan),
        budget: DetailBudget::default(),
    };
    let areas = grid.areas.iter().enumerate();
    let areas: Vec<Markup> = areas.map(|(a, area)| section.area(a, area)).collect();
    html! {
        section id="findings" {
            h2 { "Findings" }
            p {
                "Everything that is not a plain pass, by area and adapter. An entry opens to its pictures, its "
                "wrong texels, and the operations at the first of them."
            }
            @if plan.cut > 0 {
                p.note {
                    "The page shows " (BODIES) " records with pictures; " (plan.cut)
                    " more have a line only. Their frames are under frames/."
                }
            }
            @if section.budget.cut > 0 {
                p.note { (count(section.budget.cut, "frame")) " were left out to keep the page small." }
            }
            @for area in areas { (area) }
        }
    }
}

/// The section that is being written.
struct Section<'a> {
    grid: &'a RunGrid<'a>,
    plan: &'a FindingPlan,
    drawn: HashMap<usize, DrawnFrame>,
    budget: DetailBudget,
}

impl Section<'_> {
    fn area(&mut self, a: usize, area: &AreaFiles<'_>) -> Markup {
        let grid = self.grid;
        html! {
            h3 id={ "a" (a) } { (area.name) }
            @for (column, adapter) in grid.adapters.iter().enumerate() {
                @let tally = VerdictTally::of(area.on(column).map(|i| grid.record(i)));
                @if tally.total > 0 {
                    div.list id={ "l" (a) "-" (column) } {
                        h4 {
                            code { (adapter) }
                            @for (verdict, tone, n) in tally.entries() {
                                span class={ "chip " (class(verdict, tone)) } { (n) " " (mark(verdict, tone)) }
                            }
                        }
                        @for file in &area.files { (self.file(file, column)) }
                        (not_supported(grid, area, column))
                    }
                }
            }
        }
    }

    fn file(&mut self, file: &GridFile<'_>, column: usize) -> Markup {
        let listed_cases = listed(self.grid, file, column);
        let (shown, others): (Vec<usize>, Vec<usize>) =
            listed_cases.into_iter().partition(|i| self.plan.lists(*i));
        html! {
            @for index in shown {
                @let record = self.grid.record(index);
                @if self.plan.whole(index) {
                    details.d {
                        summary { (self.line(index, record, html! { code { (record.case) } })) }
                        div.body id={ "r" (index) } {
                            (detail::body(record, self.drawn.get(&index), &mut self.budget))
                        }
                    }
                } @else {
                    p.d id={ "r" (index) } {
                        (self.line(index, record, html! { a href=(link::case(&record.case)) { code { (record.case) } } }))
                    }
                }
            }
            @if !others.is_empty() {
                p.d.more {
                    "and " (others.len()) " more of " code { (file.name) } ", under "
                    a href=(link::filter(file.name, self.grid.adapters[column])) { "All cases" }
                }
            }
        }
    }

    fn line(&self, index: usize, record: &Record, id: Markup) -> Markup {
        let tone = Tone::of(record);
        html! {
            span class={ "chip " (class(record.verdict, tone)) } { (mark(record.verdict, tone)) }
            " " (id)
            @if self.plan.odd.contains(&index) { " " span.chip.only { "differs only here" } }
            span.h { (words::headline(record)) }
        }
    }
}

/// Returns the cases that the adapter cannot draw, counted by what is missing.
fn not_supported(grid: &RunGrid<'_>, area: &AreaFiles<'_>, column: usize) -> Markup {
    let mut reasons: BTreeMap<String, u64> = BTreeMap::new();
    for index in area.on(column) {
        let record = grid.record(index);
        if record.verdict == Verdict::NotSupported {
            *reasons.entry(words::headline(record)).or_default() += 1;
        }
    }
    html! {
        @for (reason, n) in reasons {
            p.d {
                span.chip.u { (n) " " (mark(Verdict::NotSupported, Tone::Plain)) }
                " " span.h { (reason) }
            }
        }
    }
}
