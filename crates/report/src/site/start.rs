//! The start page of a site.

use super::docs::Docs;
use super::runs::{Facts, Recorded, RunFacts};
use crate::numbers::{count, thousands};
use crate::page::Page;
use maud::{Markup, html};
use std::collections::BTreeMap;
use std::path::Path;

/// The style of the start page and of documents.
pub(super) const STYLE: &str = include_str!("site.css");

/// The page.
pub(super) fn page(runs: &[Recorded], docs: Option<&Docs>) -> String {
    let shown = runs.iter().find(|run| !run.galleries().is_empty());
    let main = html! {
        header {
            h1 { "etalon" }
            p.lead { "Conformance, speed and accuracy of graphics drivers' per-fragment operations." }
            nav aria-label="Parts of the page" {
                @if !runs.is_empty() { a href="#reports" { "Reports" } " " }
                @if shown.is_some() { a href="#cases" { "Cases" } " " }
                @if docs.is_some() { a href="#documents" { "Documents" } }
            }
        }
        @if !runs.is_empty() { (reports(runs)) }
        @if let Some(run) = shown { (galleries(run)) }
        @if let Some(docs) = docs { (documents(docs)) }
    };
    Page {
        title: "etalon",
        styles: &[STYLE],
        script: None,
        beside: false,
        main,
        source: "recorded folders and documents",
    }
    .html()
}

fn reports(runs: &[Recorded]) -> Markup {
    html! {
        section id="reports" {
            h2 { "Reports" }
            div.wide { table.stacked {
                thead { tr {
                    th scope="col" { "Report" } th scope="col" { "Started" } th scope="col" { "Drawn" }
                    th scope="col" { "Result" } th scope="col" { "Pages" } th scope="col" { "Files" }
                } }
                tbody { @for run in runs { (report(run)) } }
            } }
        }
    }
}

fn report(run: &Recorded) -> Markup {
    let first = run.pages().first().map(|page| address(run, page));
    let (started, drawn) = match &run.facts {
        Facts::Run(facts) => (facts.started.as_str(), scope(facts.cases, &facts.adapters)),
        Facts::Bench(started, cases, adapters) => (started.as_str(), scope(*cases, adapters)),
        Facts::Other => ("", String::new()),
    };
    let beside: Vec<&str> = run
        .files
        .iter()
        .filter_map(|file| file.to_str())
        .filter(|name| !name.ends_with(".html") && !name.contains('/'))
        .collect();
    html! {
        tr {
            th scope="row" {
                @if let Some(first) = first { a href=(first) { (run.name) } } @else { (run.name) }
            }
            td data-head="Started" { (started) }
            td data-head="Drawn" { (drawn) }
            td data-head="Result" {
                @match &run.facts {
                    Facts::Run(facts) => (result(facts)),
                    Facts::Bench(..) => "frame times",
                    Facts::Other => "",
                }
            }
            td data-head="Pages" {
                @for page in run.pages() { a href=(address(run, page)) { (title(page, &run.facts)) } " " }
            }
            td data-head="Files" {
                @for name in beside { a href=(address(run, name)) { (name) } " " }
            }
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

fn documents(docs: &Docs) -> Markup {
    let mut folders: BTreeMap<&Path, Vec<(String, &str)>> = BTreeMap::new();
    for (path, page) in &docs.pages {
        let folder = path.parent().unwrap_or(Path::new(""));
        let to = format!("docs/{}", path.with_extension("html").display());
        let pages = folders.entry(folder).or_default();
        match path.ends_with("README.md") {
            true => pages.insert(0, (to, &page.title)),
            false => pages.push((to, &page.title)),
        }
    }
    html! {
        section id="documents" {
            h2 { "Documents" }
            @for (folder, pages) in folders {
                @if !folder.as_os_str().is_empty() { h3 { code { (folder.display()) "/" } } }
                ul { @for (to, title) in pages { li { a href=(to) { (title) } } } }
            }
        }
    }
}
