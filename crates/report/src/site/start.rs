//! The start page of a site.

use super::runs::{Facts, Recorded, RunFacts};
use crate::numbers::{count, thousands};
use crate::page::Page;
use crate::table::Table;
use maud::{Markup, html};

const STYLE: &str = include_str!("site.css");

/// The page.
pub(super) fn page(runs: &[Recorded]) -> String {
    let shown = runs.iter().find(|run| !run.galleries().is_empty());
    let main = html! {
        header {
            h1 { "etalon" }
            p.lead { "Conformance, speed and accuracy of graphics drivers' per-fragment operations." }
            nav aria-label="Parts of the page" {
                a href="#reports" { "Reports" } " "
                @if shown.is_some() { a href="#cases" { "Cases" } }
            }
        }
        (reports(runs))
        @if let Some(run) = shown { (galleries(run)) }
    };
    Page::new("etalon", "recorded folders", &main)
        .style(STYLE)
        .html()
}

fn reports(runs: &[Recorded]) -> Markup {
    let table = Table::new("stacked")
        .head("Report", |run: &&Recorded| {
            let first = run.pages().first().map(|page| address(run, page));
            html! { @if let Some(first) = first { a href=(first) { (run.name) } } @else { (run.name) } }
        })
        .text("Started", |run| match &run.facts {
            Facts::Run(RunFacts { started, .. }) | Facts::Bench(started, ..) => started.clone(),
            Facts::Other => String::new(),
        })
        .text("Drawn", |run| match &run.facts {
            Facts::Run(RunFacts { cases, adapters, .. }) | Facts::Bench(_, cases, adapters) => {
                scope(*cases, adapters)
            }
            Facts::Other => String::new(),
        })
        .text("Result", |run| match &run.facts {
            Facts::Run(facts) => result(facts),
            Facts::Bench(..) => html! { "frame times" },
            Facts::Other => html! {},
        })
        .text("Pages", |run| {
            html! { @for page in run.pages() { a href=(address(run, page)) { (title(page, &run.facts)) } " " } }
        })
        .text("Files", |run| {
            html! { @for name in run.beside() { a href=(address(run, name)) { (name) } " " } }
        });
    html! {
        section id="reports" {
            h2 { "Reports" }
            (table.page(runs))
        }
    }
}

fn scope(cases: u64, adapters: &[String]) -> String {
    let cases = match cases {
        1 => "1 case".to_owned(),
        n => format!("{} cases", thousands(n)),
    };
    match adapters {
        few if few.len() <= 3 => format!("{cases} on {}", few.join(", ")),
        many => format!("{cases} on {} adapters", many.len()),
    }
}

fn result(facts: &RunFacts) -> Markup {
    html! {
        @if facts.missing > 0 {
            span.chip.f { (count(facts.missing, "missing record")) } " "
        }
        @match facts.unexpected {
            0 => span.chip.p { "✓ nothing unexpected" },
            n => span.chip.f { "✗ " (thousands(n)) " unexpected" },
        }
        " " (thousands(facts.passed)) " of " (thousands(facts.records)) " pass"
        @if facts.undrawn > 0 { ", " (thousands(facts.undrawn)) " not supported" }
    }
}

/// The words for a page, by its file's name.
fn title(page: &str, facts: &Facts) -> String {
    match (page, facts) {
        ("index.html", Facts::Bench(..)) => "frame times".to_owned(),
        ("index.html", _) => "conformance".to_owned(),
        ("methods.html", _) => "accuracy against speed".to_owned(),
        ("versions.html", _) => "releases".to_owned(),
        ("mutants.html", _) => "planted bugs".to_owned(),
        ("diff.html", _) => "difference".to_owned(),
        (other, _) => other.trim_end_matches(".html").to_owned(),
    }
}

/// The relative address of a file of a recorded folder.
fn address(run: &Recorded, file: &str) -> String {
    format!("runs/{}/{file}", run.name)
}

fn galleries(run: &Recorded) -> Markup {
    let index = address(run, "index.html");
    html! {
        section id="cases" {
            h2 { "Cases" }
            p {
                "Every case as it is meant: picture, scene, shader and JSON, by area; or "
                a href={ (index) "#cases" } { "all in a table" } " with search and filters."
            }
            ul.areas {
                @for area in run.galleries() { li { a href={ (index) "#gallery=" (area) } { (area) } } }
            }
        }
    }
}
