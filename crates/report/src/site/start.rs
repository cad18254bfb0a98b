//! The start page of a site.

use super::runs::{FolderFacts, RecordedFolder};
use crate::page::Page;
use crate::table::Table;
use maud::{Markup, html};

/// The folder of the page that tests the visitor's device.
pub(super) const PAGE: &str = "page";
const STYLE: &str = include_str!("site.css");

/// Returns the page.
pub(super) fn page(runs: &[RecordedFolder], tests_visitor: bool) -> String {
    let shown = runs.iter().find(|run| !run.galleries().is_empty());
    let main = html! {
        header {
            h1 { "etalon" }
            p.lead { "Conformance, speed and accuracy of graphics drivers' per-fragment operations." }
            nav aria-label="Parts of the page" {
                a href="#reports" { "Reports" } " "
                @if shown.is_some() { a href="#cases" { "Cases" } " " }
                @if tests_visitor { a href={ (PAGE) "/index.html" } { "Test this device" } }
            }
        }
        (reports(runs))
        @if let Some(run) = shown { (galleries(run)) }
    };
    Page::new("etalon", "recorded folders", &main)
        .style(STYLE)
        .html()
}

fn reports(runs: &[RecordedFolder]) -> Markup {
    let table = Table::new("stacked")
        .head("Report", |run: &&RecordedFolder| {
            let first = run.pages().first().map(|page| address(run, page));
            html! { @if let Some(first) = first { a href=(first) { (run.name) } } @else { (run.name) } }
        })
        .text("Started", |run| &*run.facts.started)
        .text("Drawn", |run| &*run.facts.drawn)
        .text("Result", |run| run.facts.result.clone())
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

/// Returns the title of a page, by its file's name.
fn title<'a>(page: &'a str, facts: &FolderFacts) -> &'a str {
    match page {
        "index.html" => facts.index,
        "details.html" => "details",
        "methods.html" => "accuracy against speed",
        "versions.html" => "releases",
        "mutants.html" => "planted bugs",
        "diff.html" => "difference",
        other => other.trim_end_matches(".html"),
    }
}

/// Returns the relative address of a file of a recorded folder.
fn address(run: &RecordedFolder, file: &str) -> String {
    format!("runs/{}/{file}", run.name)
}

fn galleries(run: &RecordedFolder) -> Markup {
    let index = address(run, "index.html");
    html! {
        section id="cases" {
            h2 { "Cases" }
            p {
                "Every case as intended: picture, scene, shader and JSON, by area; or "
                a href={ (index) "#cases" } { "all in a table" } " with search and filters."
            }
            ul.areas {
                @for area in run.galleries() { li { a href={ (index) "#gallery=" (area) } { (area) } } }
            }
        }
    }
}
