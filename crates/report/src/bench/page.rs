//! `index.html` of a bench.

use super::charts::{TimeRange, drift, strip};
use super::drivers;
use super::figures::{CaseFigures, KINDS, TimedCase, end, incomplete, limits};
use crate::chart;
use crate::numbers::{between, change, count, duration, percent};
use crate::page::Page;
use crate::page::adapter::{adapter as adapter_cell, breakable, section as adapters};
use crate::page::link::breakable_id;
use crate::page::origin::origin;
use crate::table::{Cell, Table, as_is};
use crate::words;
use etalon_record::{Bench, BenchRecord, Time, cell};
use etalon_stats::{CONFIDENCE, MIN_ROUNDS, POWER};
use maud::{Markup, html};
use std::collections::BTreeSet;

pub(crate) const STYLE: &str = include_str!("bench.css");

/// Returns the page.
pub(super) fn page(bench: &Bench, figures: &[CaseFigures<'_>]) -> String {
    let main = html! {
        (head(bench, figures))
        @if figures.is_empty() {
            p { "No case was drawn, so there is nothing to report." }
        } @else {
            @if let Some(chart) = drivers::section(bench, figures) { (chart) }
            @for (kind, title) in KINDS { (overview(figures, kind, title)) }
            section id="cases" {
                h2 { "Cases" }
                @for (i, case) in figures.iter().enumerate() { (of_case(case, i)) }
            }
            (explanation())
        }
        (adapters(&bench.header.adapters, &bench.header.absent))
        (about(bench))
        @if !figures.is_empty() { (ruler(bench)) }
    };
    Page::new(
        &format!("etalon bench {}", bench.header.provenance.started),
        "bench.jsonl in this folder",
        &main,
    )
    .style(&chart::style())
    .style(STYLE)
    .html()
}

fn head(bench: &Bench, figures: &[CaseFigures<'_>]) -> Markup {
    let h = &bench.header;
    let untimed = figures.iter().flat_map(|c| &c.untimed);
    let bad = untimed.filter(|r| end(r).0.is_bad()).count() as u64;
    html! {
        header {
            h1 { "etalon bench" }
            p.lead { "Errors and frame times of graphics drivers, of frames that were judged right." }
            (incomplete(bench))
            @if bad > 0 {
                p.state.bad {
                    b { "✗ " (count(bad, "picture")) " wrong, broken or unjudged" }
                    ": no frame time, and listed below with the reason."
                }
            }
            p.soft {
                (count(h.cases, "case")) " (" (h.profile) ") on " (count(h.adapters.len() as u64, "adapter"))
                ", " (count(u64::from(h.rounds), "round")) " each."
            }
            @if figures.iter().any(|c| cell(c.case).is_some()) {
                nav { a href="matrix.html" { "Performance matrix" } }
            }
        }
    }
}

/// Returns the section on the origin of the bench.
fn about(bench: &Bench) -> Markup {
    let h = &bench.header;
    html! {
        section id="about" {
            h2 { "About the bench" }
            dl.facts {
                (origin(&h.provenance))
                dt { "Shader caches" } dd { (h.shader_cache.name()) }
                dt { "Ruler" } dd { (h.ruler) }
                (limits(&h.settings))
            }
        }
    }
}

fn explanation() -> Markup {
    html! {
        details {
            summary { "Reading the tables" }
            p {
                "A round prepares the scene anew, draws some frames of warm-up, which are counted and discarded, and "
                "some timed frames, which all count. Rounds of all cases and adapters interleave, so that drift "
                "affects all alike."
            }
            p {
                b { "Median" } " is the median of the rounds' medians; the " b { "interval" }
                " contains it with a confidence of " (CONFIDENCE * 100.0) " %, by drawing rounds with replacement (at least "
                (MIN_ROUNDS) " rounds). " b { "p50" } " and " b { "p95" } " are over all frames. "
                b { "Visible" } " is the smallest change that a diff with another bench like this one "
                "finds with a probability of " (POWER) "."
            }
            p {
                b { "Wall" } " lasts until the device is done, " b { "cpu" }
                " until the last call that submits work has returned, " b { "gpu" }
                " is between timestamps of the device. " b { "Prepare" } " and " b { "first" }
                " are what a scene costs once. " b { "Instructions" } " of a frame are counted in processes of their own. Adapters with the same rank do not differ provably. Software "
                "and hardware have tables of their own."
            }
        }
    }
}

/// Returns a table of the medians of all cases on all adapters of a kind.
fn overview(figures: &[CaseFigures<'_>], kind: bool, title: &str) -> Markup {
    let timed = figures.iter().flat_map(|c| c.of_kind(kind));
    let adapters: BTreeSet<&str> = timed.map(TimedCase::adapter).collect();
    let several = adapters.len() > 1;
    let mut table = Table::<(usize, &CaseFigures<'_>)>::new("times").head("Case", |(i, case)| {
        html! { a href={ "#case-" (i) } { (breakable_id(case.case)) } }
    });
    for adapter in &adapters {
        table = table.number(adapter_cell(adapter), move |(_, case)| {
            let timed = case.of_kind(kind).iter().find(|t| t.adapter() == *adapter);
            timed.map(|t| {
                let best = if t.rank == 1 && several { "best" } else { "" };
                Cell::from(duration(t.wall.median)).class(best)
            })
        });
    }
    html! {
        @if !adapters.is_empty() {
            section {
                h2 { (title) " adapters, wall time per frame" }
                (table.page(figures.iter().enumerate()))
                p.cap { "Bold: first rank among these adapters. –: not timed." }
            }
        }
    }
}

fn ruler(bench: &Bench) -> Markup {
    html! {
        section id="ruler" {
            h2 { "The ruler" }
            @match drift(bench) {
                Some(chart) => {
                    p {
                        "Fixed work on the processor, timed before and after each round. Where the line moves, the speed of "
                        "the machine itself changed."
                    }
                    (chart)
                }
                None => p { "No round was measured." },
            }
        }
    }
}

fn of_case(case: &CaseFigures<'_>, number: usize) -> Markup {
    html! {
        h3 id={ "case-" (number) } { (case.case) }
        @for (kind, title) in KINDS {
            @let rows = case.of_kind(kind);
            @if !rows.is_empty() { (table(rows, title)) }
        }
        @if !case.untimed.is_empty() {
            ul { @for record in &case.untimed { (untimed(record)) } }
        }
    }
}

fn table(rows: &[TimedCase<'_>], title: &str) -> Markup {
    let scale = TimeRange::of(rows);
    let mut table = Table::<&TimedCase<'_>>::new("times stacked")
        .number("Rank", |row| row.rank)
        .head(format!("{title} adapter"), |row| breakable(row.adapter()))
        .text("Picture", |row| {
            let verdict = words::name(row.record.picture.verdict);
            html! { (verdict) small { " " (share(row.record)) } (ended(row.record)) }
        })
        .number("Median", |row| html! { b { (duration(row.wall.median)) } });
    if rows.iter().any(|row| row.instructions().is_some()) {
        table = table.number("Instructions", |row| row.instructions());
    }
    let mut table = table
        .number("Interval", |row| {
            row.wall.interval.map(|ends| between(ends, duration))
        })
        .number(as_is("p50"), |row| duration(row.wall.p50))
        .number(as_is("p95"), |row| duration(row.wall.p95))
        .number("Rounds × frames", |row| row.counted(" × "))
        .number("Discarded", |row| row.record.discarded().to_string())
        .number("Visible", |row| row.wall.visible.map(change));
    for time in Time::ALL {
        if rows.iter().any(|row| row.others.contains_key(&time)) {
            table = table.number(as_is(time.name()), move |row| row.other(time));
        }
    }
    let spread = html! { "Spread" br; small { (scale.caption()) } };
    let spread = Cell::from("Spread").on_page(spread);
    table.text(spread, |row| strip(row, scale)).page(rows)
}

/// Returns a text for the fraction of the picture that was asserted.
fn share(record: &BenchRecord) -> String {
    format!("{} asserted", percent(record.picture.asserted, 1))
}

fn ended(record: &BenchRecord) -> Markup {
    html! {
        @if let Some(ended) = &record.ended {
            small { ", then " (words::name(ended.verdict)) ": " (words::reasons_text(&ended.reasons)) }
        }
    }
}

fn untimed(record: &BenchRecord) -> Markup {
    let (v, message) = end(record);
    html! {
        li {
            (breakable(&record.picture.adapter)) ": " (words::symbol(v)) " " (words::name(v)) ", no frame time"
            @if !message.is_empty() { small { " " (message) } }
        }
    }
}
