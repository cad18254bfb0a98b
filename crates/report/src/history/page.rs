//! The start page.

use super::matrix;
use super::model::{Model, Timeline};
use super::news::{Item, News};
use super::sparkline::{moves, sparkline};
use crate::numbers::{count, percent, thousands};
use crate::page::adapter::breakable;
use crate::page::{self, Page, link};
use crate::table::{Cell, Table};
use etalon_stats::Score;
use maud::{Markup, PreEscaped, html};

/// The script, inside one function so that the page adds no global names.
const SCRIPT: &str = concat!(
    "(() => {\n\"use strict\";\n",
    include_str!("../page/base.js"),
    include_str!("script/load.js"),
    include_str!("script/runs.js"),
    include_str!("script/case.js"),
    include_str!("script/chart.js"),
    include_str!("script/lists.js"),
    include_str!("script/route.js"),
    "})();\n",
);

/// Returns the HTML of the start page. `index` has the numbers by which the script finds files, as JSON.
pub(super) fn page(model: &Model<'_>, found: &News, index: &str) -> String {
    let places = model.places;
    let (first, last) = (places.day(0), places.day(places.runs.len() - 1));
    let runs = count(places.runs.len() as u64, "run");
    let file = model.history.path().file_name();
    let source = file.map_or_else(String::new, |name| name.to_string_lossy().into_owned());
    let main = html! {
        div id="start" {
            h1 { "History" }
            p.lead {
                (runs) ", " (first) " to " (last) ", of " (thousands(model.cases.len() as u64)) " cases on "
                (count(places.timelines.len() as u64, "adapter")) "."
            }
            form.find id="find" role="search" hidden {
                label for="q" { "Case" }
                input id="q" type="search" autocomplete="off" spellcheck="false" placeholder="words of an id";
                span.soft { kbd { "/" } " searches, " kbd { "j" } " and " kbd { "k" } " go through links, " kbd { "Esc" } " goes back" }
            }
            noscript { p.state.bad { "The pages of cases, runs and adapters need scripts, which are disabled here. The rest of this page does not." } }
            (news(found))
            (last_runs(model, found))
            section id="over-time" {
                h2 { "Areas over time" }
                @for number in 0..model.timelines.len() { (matrix::table(model, number)) }
            }
            (families(model))
        }
        article id="view" aria-labelledby="view-title" hidden {}
        p id="view-state" role="status" {}
        // The JSON contains no `<`, so nothing in it can end the element.
        script type="application/json" id="index" { (PreEscaped(index.replace('<', "\\u003c"))) }
        (page::script(SCRIPT))
    };
    Page::new("History – etalon", &source, &main)
        .style(include_str!("history.css"))
        .script(SCRIPT, true)
        .html()
}

fn news(news: &News) -> Markup {
    let screen = news.screen();
    let items = news.items.len();
    html! {
        section id="news" {
            h2 { "Since the last run" }
            @if screen.is_empty() {
                p.state.good { "Nothing changed." }
            } @else {
                ul.news { @for item in &screen { (line(item)) } }
                @if items > screen.len() {
                    p { a href="#all-news" { "All " (thousands(items as u64)) " changes" } }
                }
            }
        }
    }
}

fn line(item: &Item) -> Markup {
    let href = if item.is_family {
        format!("#q={}", link::encoded(&item.subject))
    } else {
        link::case(&item.subject)
    };
    html! {
        li class=(item.kind.colour()) {
            b { (item.word) } " " a href=(href) { code { (item.subject) } }
            @if !item.chip.is_empty() { span.chip { (item.chip) } }
            " " span.h { (item.text) }
        }
    }
}

/// Returns the last run of each adapter, with counts of its changes.
fn last_runs(model: &Model<'_>, news: &News) -> Markup {
    let places = model.places;
    let run = |line: &Timeline<'_>, index: usize| {
        let run = &line.line.runs[index];
        html! {
            a href={ "#run=" (places.runs[run.place].id) } { (places.day(run.place)) }
            " " (run.part.adapter.shown_version())
        }
    };
    type Row<'a> = (&'a Timeline<'a>, &'a [u64; 5]);
    let mut table = Table::<Row<'_>>::new("last")
        .caption("Each adapter against its run before")
        .head("Adapter", |(line, _)| {
            let name = &line.line.name;
            html! { a href={ "#adapter=" (link::encoded(name)) } { (breakable(name)) } }
        })
        .text("Last run", |(line, _)| {
            html! { (run(line, line.last)) @if !line.line.runs[line.last].whole { " " small { "(a part)" } } }
        })
        .text("Run before", |(line, _)| line.last.checked_sub(1).map(|index| run(line, index)));
    let words = ["Broken", "Flaky", "Fixed", "Appeared", "Gone"];
    for (kind, (word, colour)) in words.into_iter().zip(["f", "o", "p", "", ""]).enumerate() {
        table = table.number(word, move |(_, counts)| {
            Cell::from(counts[kind]).class(if counts[kind] > 0 { colour } else { "" })
        });
    }
    table
        .text("Last change", |(line, _)| {
            last_change(line).map(|index| run(line, index))
        })
        .page(model.timelines.iter().zip(&news.counts))
}

/// Returns the last run that shows an event.
fn last_change(line: &Timeline<'_>) -> Option<usize> {
    let courses = line.courses.of.iter().flatten();
    let events = courses.flat_map(|course| &course.events);
    events.map(|event| event.at as usize).max()
}

/// Returns a curve per family and adapter. Families whose score never changed are folded away.
fn families(model: &Model<'_>) -> Markup {
    let scores: Vec<Vec<Vec<Score>>> = (0..model.families.names.len())
        .map(|family| {
            let scores_of = |timeline: &Timeline<'_>| {
                let complete_runs =
                    (0..timeline.line.runs.len()).filter(|index| timeline.line.runs[*index].whole);
                complete_runs
                    .map(|index| timeline.scores.common(family, index))
                    .collect()
            };
            model.timelines.iter().map(scores_of).collect()
        })
        .collect();
    let is_moving = |family: &usize| scores[*family].iter().any(|row| moves(row));
    let (moving, still): (Vec<usize>, Vec<usize>) = (0..scores.len()).partition(is_moving);
    html! {
        section id="families" {
            h2 { "Families" }
            p.cap { "The share of good cases among those that all whole runs of an adapter have, from the first run to the last. The height spans a curve's lowest and highest value." }
            @if !moving.is_empty() { (curves(model, &scores, &moving, "Families whose score moved")) }
            @if !still.is_empty() {
                details {
                    summary { (still.len()) " without a change" }
                    (curves(model, &scores, &still, "Families whose score never moved"))
                }
            }
        }
    }
}

fn curves(model: &Model<'_>, scores: &[Vec<Vec<Score>>], shown: &[usize], caption: &str) -> Markup {
    let mut table = Table::<&usize>::new("curves")
        .spoken(caption)
        .head("Family", |family| {
            let name = &model.families.names[**family];
            html! { a href={ "#q=" (link::encoded(name)) } { (name) } }
        });
    for (i, timeline) in model.timelines.iter().enumerate() {
        table = table.text(breakable(&timeline.line.name), move |family| {
            curve(&scores[**family][i])
        });
    }
    table.page(shown)
}

fn curve(scores: &[Score]) -> Cell {
    let last = scores.last().copied().unwrap_or_default();
    match last.share() {
        Some(share) => Cell::from(html! {
            @if moves(scores) { (sparkline(scores)) " " }
            small { (percent(share, 1)) " of " (thousands(last.of as u64)) }
        }),
        None => Cell::from(html! { small { "no common case" } }).class("u"),
    }
}
