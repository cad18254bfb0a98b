//! The percentage of good cases by area and version, one table per timeline.

use super::families::Families;
use super::model::{Model, Timeline};
use super::places::Line;
use crate::numbers::{percent, thousands};
use crate::page::adapter::breakable;
use crate::table::{Cell, Table};
use etalon_stats::{RunScore as Both, Score};
use maud::{Markup, html};
use serde_json::{Value, json};

/// The maximum number of columns of a table on the start page.
const COLUMNS: usize = 8;

/// Returns the runs that represent the versions: the last complete run of each version, or all complete runs
/// if the driver never changed.
fn columns(line: &Line<'_>) -> Vec<usize> {
    let complete_runs: Vec<usize> = (0..line.runs.len())
        .filter(|run| line.runs[*run].whole)
        .collect();
    let version = |run: &usize| line.runs[*run].part.adapter.shown_version();
    let stretches = complete_runs.chunk_by(|a, b| version(a) == version(b));
    let last: Vec<usize> = stretches
        .filter_map(|stretch| stretch.last().copied())
        .collect();
    match last.len() {
        1 => complete_runs,
        _ => last,
    }
}

/// Returns the table of a timeline.
pub(super) fn table(model: &Model<'_>, number: usize) -> Markup {
    let (places, families, timeline) = (model.places, &model.families, &model.timelines[number]);
    let line = timeline.line;
    let shown_runs = columns(line);
    let shown = &shown_runs[shown_runs.len().saturating_sub(COLUMNS)..];
    let common = timeline
        .scores
        .sum(0..families.names.len(), shown[0])
        .common
        .of;
    let areas = (0..families.areas.len())
        .map(|area| (Some(&*families.areas[area]), of_area(families, area)));
    let areas: Vec<(Option<&str>, Vec<usize>)> = areas
        .filter(|(_, family)| {
            let drawn = |run: &usize| timeline.scores.sum(family.iter().copied(), *run).own.of;
            shown.iter().any(|run| drawn(run) > 0)
        })
        .collect();
    let all_areas = (None, (0..families.names.len()).collect());
    let mut table = Table::<(Option<&str>, Vec<usize>)>::new("matrix over")
        .spoken(format!("Good cases by area and version on {}", line.name))
        .row_class(|(area, _)| area.map_or("sum", |_| ""))
        .head("Area", |(area, _)| html! { (area.unwrap_or("all")) });
    for (i, number) in shown.iter().enumerate() {
        let run = &line.runs[*number];
        let head = html! {
            a href={ "#run=" (places.runs[run.place].id) } {
                (run.part.adapter.shown_version()) " " small { (places.day(run.place)) }
            }
        };
        table = table.text(head, move |(_, cases)| {
            let sum = |run: usize| timeline.scores.sum(cases.iter().copied(), run);
            let before = i.checked_sub(1).map(|before| sum(shown[before]).common);
            cell(&sum(*number), before)
        });
    }
    html! {
        details open[number < 3] {
            summary { h3 { (breakable(&line.name)) } " " small { (of_all(shown_runs.len(), shown.len())) } }
            p.cap {
                "Large: the good share of the " (thousands(common as u64))
                " cases with a verdict in all whole runs of this adapter. Small: of all cases of that run. "
                a href={ "#adapter=" (crate::page::link::encoded(&line.name)) } { "Every run" } "."
            }
            (table.page(areas.into_iter().chain([all_areas])))
        }
    }
}

fn of_all(runs: usize, shown: usize) -> String {
    if runs == shown {
        format!("{runs} columns")
    } else {
        format!("the last {shown} of {runs} columns")
    }
}

fn of_area(families: &Families, area: usize) -> Vec<usize> {
    let families_of_cases = families.area_of.iter().enumerate();
    families_of_cases
        .filter(|(_, area_of)| **area_of == area)
        .map(|(family, _)| family)
        .collect()
}

fn cell(both: &Both, before: Option<Score>) -> Cell {
    let change = before.map_or(0, |b| both.common.good as i64 - b.good as i64);
    let shown = html! {
        @match both.common.share() {
            Some(share) => b { (percent(share, 2)) },
            None => b { "–" },
        }
        @if change != 0 {
            " " span.step.down[change < 0] { (if change < 0 { "▼" } else { "▲" }) (change.abs()) }
        }
        @if both.own.of > 0 && both.own != both.common {
            small.c { (both.own.share().map_or_else(String::new, |s| percent(s, 2))) " of " (thousands(both.own.of as u64)) }
        } @else if both.own.of == 0 {
            small.c { "no verdict" }
        }
    };
    let class = if both.own.of == 0 { "u" } else { "s" };
    Cell::from(shown)
        .class(class)
        .with("style", shade(both.common))
}

/// Returns a shade between the colours of bad and good cases, for 90 % to 100 % good cases.
fn shade(score: Score) -> Option<String> {
    let share = score.share()?;
    let good = ((share - 0.9) * 1000.0).round().clamp(0.0, 100.0);
    Some(format!("--s:{good}%"))
}

/// Returns the scores of all complete runs for the script, newest first: the run's index in the timeline,
/// then four numbers for each area: good cases and all cases, first of the common set and then of the run.
pub(super) fn data(families: &Families, timeline: &Timeline<'_>) -> Value {
    let complete_runs = (0..timeline.line.runs.len())
        .rev()
        .filter(|run| timeline.line.runs[*run].whole);
    let areas: Vec<Vec<usize>> = (0..families.areas.len())
        .map(|area| of_area(families, area))
        .collect();
    let rows = complete_runs.map(|run| {
        let cells = areas.iter().map(|family| {
            let both = timeline.scores.sum(family.iter().copied(), run);
            match both.own.of {
                0 => json!(0),
                _ => json!([both.common.good, both.common.of, both.own.good, both.own.of]),
            }
        });
        json!([run, cells.collect::<Vec<Value>>()])
    });
    json!({ "areas": families.areas, "rows": rows.collect::<Vec<Value>>() })
}
