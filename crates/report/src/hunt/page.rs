//! `mutants.html`.

use super::summary::{areas, elsewhere};
use crate::numbers::{count, duration};
use crate::page::Page;
use crate::page::origin::Origin;
use etalon_record::{AreaTally, Catch, Hunt, MutantRecord, Sighting};
use maud::{Markup, html};

/// The page.
pub(super) fn page(hunt: &Hunt) -> String {
    let main = html! {
        (head(hunt))
        (by_area(hunt))
        (noted(hunt))
        (all(hunt))
    };
    Page {
        title: &format!("etalon mutants {}", hunt.started),
        styles: &[],
        script: None,
        beside: false,
        main,
        source: "mutants.json in this folder",
    }
    .html()
}

fn head(hunt: &Hunt) -> Markup {
    let complaints: Vec<_> = hunt.complaints().collect();
    let origin = Origin {
        started: &hunt.started,
        command: &hunt.command,
        machine: &hunt.machine,
        etalon: &hunt.etalon,
        commit: hunt.commit.as_deref(),
    };
    html! {
        header {
            h1 { "etalon mutants" }
            p.lead { "Bugs planted in a rasterizer that passes the suite, and the cases that catch them." }
            @if complaints.is_empty() {
                p.state.good { b { "✓ Every planted bug is caught, or proven to be legal." } }
            } @else {
                p.state.bad {
                    b { "✗ " (count(complaints.len() as u64, "planted bug")) " with a wrong outcome." }
                }
                ul { @for (mutant, why) in &complaints {
                    li { a href={ "#" (mutant.mutant.name) } { (mutant.mutant.name) } ": " (why) }
                } }
            }
            dl.facts {
                (origin.facts())
                dt { "Scope" } dd {
                    (count(hunt.mutants.len() as u64, "planted bug")) ", "
                    (count(hunt.cases, "case")) ", " (duration(hunt.seconds))
                    @if !hunt.full { "; an area ends at a bug's first Fail" }
                }
            }
        }
        section {
            h2 { "Totals" }
            ul.totals {
                @for (outcome, about) in [
                    (Catch::Caught, "Some case failed."),
                    (Catch::Noticed, "Legal: some texels lie outside the yardstick, none is wrong."),
                    (Catch::Survived, "Every case passed."),
                    (Catch::Broken, "It could not be drawn: a bug of the mutant."),
                ] {
                    @let n = hunt.count(outcome);
                    @if n > 0 || outcome != Catch::Broken {
                        li class=(class(outcome)) {
                            span.big { (n) } " " span.m { (outcome.name()) } small { (about) }
                        }
                    }
                }
            }
        }
    }
}

/// The class that colours an outcome: a fixed letter.
fn class(outcome: Catch) -> &'static str {
    match outcome {
        Catch::Caught => "p",
        Catch::Noticed => "i",
        Catch::Survived => "o",
        Catch::Broken => "b",
    }
}

fn by_area(hunt: &Hunt) -> Markup {
    html! {
        section {
            h2 { "By area" }
            p {
                "Which area's cases see which bugs. A bug has one area that must see it alone; the last "
                "column counts those that it does."
            }
            div.wide { table {
                thead { tr {
                    th { "Area" } th { "caught" } th { "noticed" } th { "passed" } th { "of its own" }
                } }
                tbody { @for row in areas(hunt) { tr {
                    th scope="row" { (row.area) }
                    @for n in row.counts { td.num { (n) } }
                    td.num { (row.own_reached) " of " (row.own) }
                } } }
            } }
        }
    }
}

fn noted(hunt: &Hunt) -> Markup {
    let of = |outcome| hunt.mutants.iter().filter(move |m| m.outcome == outcome);
    html! {
        (noted_list("Noticed", of(Catch::Noticed).collect()))
        (noted_list("Survived", of(Catch::Survived).collect()))
        (noted_list("Caught by other areas only", elsewhere(hunt)))
    }
}

fn noted_list(title: &str, mutants: Vec<&MutantRecord>) -> Markup {
    html! {
        @if !mutants.is_empty() {
            section {
                h2 { (title) }
                ul { @for m in mutants { li {
                    a href={ "#" (m.mutant.name) } { (m.mutant.name) } ": " (m.mutant.about) " "
                    @if let Some(why) = &m.mutant.legal { cite { (why) } }
                    @else if m.complaint().is_some() { b { "No proof." } }
                } } }
            }
        }
    }
}

fn all(hunt: &Hunt) -> Markup {
    html! {
        section {
            h2 { "All planted bugs" }
            div.wide { table.figures {
                thead { tr {
                    th { "Name" } th { "Effect" } th { "Source" } th { "Outcome" }
                    th { "Cases that failed / were imprecise / passed" } th { "First seen" }
                } }
                tbody { @for m in &hunt.mutants { (row(m)) } }
            } }
        }
    }
}

fn row(m: &MutantRecord) -> Markup {
    html! {
        tr id=(m.mutant.name) {
            th scope="row" { (m.mutant.name) }
            td { (m.mutant.about) }
            td { (m.mutant.source) }
            td class=(class(m.outcome)) {
                span.chip { (m.outcome.name()) }
                @if m.mutant.legal.is_some() { small { " legal" } }
            }
            td { @for area in &m.areas { (tally(area, area.area == m.mutant.area)) } }
            td { @if let Some(first) = &m.first { (sighting(first)) } }
        }
    }
}

fn tally(area: &AreaTally, own: bool) -> Markup {
    html! {
        @if area.fail + area.imprecise + area.broken > 0 || own {
            div {
                @if own { b { (area.area) } } @else { (area.area) }
                " " (area.fail) " / " (area.imprecise) " / " (area.pass)
                @if area.broken > 0 { ", " (area.broken) " broken" }
            }
        }
    }
}

fn sighting(first: &Sighting) -> Markup {
    html! {
        code { (first.case) }
        @if let Some(texel) = &first.texel {
            small {
                " (" (texel.x) ", " (texel.y) ")"
                @if let Some(c) = texel.channels.first() {
                    " " (c.attachment) " " (c.aspect) " channel " (c.channel) ": " (c.actual)
                    ", due "
                    @if c.low == c.high { (c.low) } @else { (c.low) " to " (c.high) }
                }
            }
        }
        @if !first.message.is_empty() { small { " " (first.message) } }
    }
}
