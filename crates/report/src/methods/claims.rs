//! Claims of the literature, compared with the measurements of a run.

mod check;
mod outcome;
mod words;

use super::data::Methods;
use crate::lists::{distinct, grouped};
use crate::numbers::count;
use crate::table::{Cell, Table};
use check::{Checked, check};
use etalon_methods::claims;
use maud::{Markup, html};
use outcome::{CaseFigure, Holds, Reproduction};

/// Returns the checked claims that the run has measurements for, and the others.
fn checked<'a>(methods: &Methods<'a>) -> (Vec<Checked<'a>>, Vec<Checked<'a>>) {
    claims().map(|c| check(c, methods)).partition(|checked| {
        !(checked.figures.is_empty() && checked.counting_before_depth_test.is_empty())
    })
}

/// Returns the outcomes of claims for a terminal.
pub(super) fn lines(methods: &Methods<'_>) -> Vec<String> {
    let (drawn, others) = checked(methods);
    let line = |checked: &Checked<'_>| {
        let found = Reproduction::of(&checked.figures);
        format!("{}: {}", found.text(), checked.claim.title)
    };
    let mut lines: Vec<String> = drawn.iter().map(line).collect();
    if !others.is_empty() {
        let others = count(others.len() as u64, "claim");
        lines.push(format!("– {others} that this run did not draw"));
    }
    lines
}

/// Returns the table of claims.
pub(super) fn section(methods: &Methods<'_>) -> Markup {
    let (drawn, others) = checked(methods);
    html! {
        p {
            "Claims of publications, and this run's measurements of them. A claim is checked in every case where all that it "
            "compares was drawn at the same parameters of the same scene on the same adapter. Times are ratios of medians, with the interval that the "
            "intervals of both leave; a case whose interval reaches over the limit decides nothing. A claim is reproduced if it holds in every "
            "case, and not reproduced if it holds in none."
        }
        @if !drawn.is_empty() { (table(&drawn)) }
        @if !others.is_empty() {
            details open[drawn.is_empty()] {
                summary { (count(others.len() as u64, "claim")) " that this run did not draw" }
                (table(&others))
            }
        }
    }
}

fn table(claims: &[Checked<'_>]) -> Markup {
    Table::new("text stacked")
        .head("Claim", |checked: &&Checked<'_>| {
            html! { (checked.claim.title) br; cite { (checked.claim.source) } }
        })
        .text("Compared", |checked| words::compared(checked.claim))
        .text("Measured", |checked| measured(checked))
        .text("Outcome", |checked| {
            let found = Reproduction::of(&checked.figures);
            let shown = html! { span class={ "chip " (found.class()) } { (found.text()) } };
            Cell::from(shown).class("verdict").class(found.class())
        })
        .page(claims)
}

fn measured(checked: &Checked<'_>) -> Markup {
    html! {
        @if checked.figures.is_empty() { "–" }
        @for figures in together(&checked.figures) {
            div {
                @if let Some(sign) = figures.holds.sign() { (sign) " " }
                b { (figures.text) } small { " " (figures.places) }
            }
        }
        @if !checked.counting_before_depth_test.is_empty() {
            div.u { span.chip.u { "not measured" } " on " (checked.counting_before_depth_test.join(", ")) ", where fragments are counted before the depth test" }
        }
    }
}

/// Figures of one outcome, as a range.
struct FigureRange {
    holds: Holds,
    text: String,
    places: String,
}

/// Joins equal figures of a scene into one entry, with the adapters and the settings at which they were found.
fn together(figures: &[CaseFigure]) -> Vec<FigureRange> {
    let groups = grouped(figures.iter().map(|f| ((f.holds, &*f.scene, f.text()), f)));
    let texts = groups.into_iter().map(|((holds, scene, _), figures)| {
        let adapters = distinct(figures.iter().map(|f| f.adapter.as_str()));
        let settings = distinct(figures.iter().map(|f| f.setting.as_str()));
        let place = match settings.as_slice() {
            [] | [""] => String::new(),
            [setting] => format!(" at {setting}"),
            some => format!(
                " in {} cases, {} to {}",
                some.len(),
                some[0],
                some[some.len() - 1]
            ),
        };
        FigureRange {
            holds,
            text: CaseFigure::range(&figures),
            places: format!("{scene}{place} on {}", adapters.join(", ")),
        }
    });
    texts.collect()
}

#[cfg(test)]
mod tests;
