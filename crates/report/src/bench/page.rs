//! `index.html` of a bench.

use super::figures::{CaseFigures, Figures, Timed};
use super::kind::KINDS;
use super::ruler::drift;
use super::spread::{Times, strip};
use crate::numbers::{change, count, duration, percent, round_duration};
use crate::page::Page;
use crate::page::adapter::{breakable, details};
use crate::page::origin::Origin;
use crate::words;
use etalon_record::{Bench, BenchRecord, Time, Verdict, cell};
use etalon_stats::{CONFIDENCE, MIN_ROUNDS, POWER, Summary};
use maud::{Markup, html};

const OWN_STYLE: &str = include_str!("bench.css");

/// The page.
pub(super) fn page(bench: &Bench, figures: &Figures<'_>) -> String {
    let main = html! {
        (head(bench, figures))
        (explanation())
        @if figures.cases.is_empty() {
            p { "No case was drawn, so there is nothing to report." }
        } @else {
            @for (kind, title) in KINDS { (overview(figures, kind, title)) }
            (ruler(bench))
            section id="cases" {
                h2 { "Cases" }
                @for (i, case) in figures.cases.iter().enumerate() { (of_case(case, i)) }
            }
        }
        section id="adapters" {
            h2 { "Adapters" }
            @if bench.header.adapters.is_empty() { p { "None." } }
            @for adapter in &bench.header.adapters { (details(adapter)) }
            @for absent in &bench.header.absent {
                p.soft { (absent.name) ": " (absent.reason) "; " (absent.remedy) }
            }
        }
    };
    Page {
        title: &format!("etalon bench {}", bench.header.started),
        styles: &[OWN_STYLE],
        script: None,
        beside: false,
        main,
        source: "bench.jsonl in this folder",
    }
    .html()
}

fn head(bench: &Bench, figures: &Figures<'_>) -> Markup {
    let h = &bench.header;
    let untimed = figures.cases.iter().flat_map(|c| &c.untimed);
    let bad = untimed.filter(|r| verdict(r).is_bad()).count() as u64;
    let origin = Origin {
        started: &h.started,
        command: &h.command,
        machine: &h.machine,
        etalon: &h.etalon,
        commit: h.commit.as_deref(),
    };
    html! {
        header {
            h1 { "etalon bench" }
            p.lead { "Frame times of graphics drivers, of frames that were judged right." }
            @if bench.truncated || bench.missing() > 0 {
                p.state.bad { b { "! Incomplete. " } (count(bench.missing(), "round")) " missing." }
            }
            @if bad > 0 {
                p.state.bad {
                    b { "✗ " (count(bad, "picture")) " wrong, broken or unjudged" }
                    ": no frame time, and listed below with the reason."
                }
            }
            dl.facts {
                (origin.facts())
                dt { "Scope" } dd {
                    (count(h.cases, "case")) " (" (h.profile) ") on " (count(h.adapters.len() as u64, "adapter"))
                    ", " (count(u64::from(h.rounds), "round")) " each"
                }
                dt { "Shader caches" } dd { (h.shader_cache.name()) }
                dt { "Ruler" } dd { (h.ruler) }
                @if let Some(share) = h.settings.within {
                    dt { "Enough" } dd { "intervals within " (percent(share, 1)) }
                }
                @if let Some(limit) = h.settings.limit {
                    dt { "Time limit" } dd { (round_duration(limit)) " of rounds on each adapter" }
                }
            }
            @if figures.cases.iter().any(|c| cell(c.case).is_some()) {
                nav { a href="matrix.html" { "Performance matrix" } }
            }
        }
    }
}

fn explanation() -> Markup {
    html! {
        details {
            summary { "Reading this page" }
            p {
                "A round prepares the scene anew, draws some frames of warm-up, which are counted and discarded, and "
                "some timed frames, all of which count. Rounds of all cases and adapters interleave, so that drift "
                "affects all alike."
            }
            p {
                b { "Median" } " is the median of the rounds' medians; the " b { "interval" }
                " holds it with a confidence of " (CONFIDENCE * 100.0) " %, by drawing rounds with replacement (at least "
                (MIN_ROUNDS) " rounds). " b { "p50" } " and " b { "p95" } " are over all frames. "
                b { "Visible" } " is the smallest change that a diff with another bench like this one "
                "finds with a probability of " (POWER) "."
            }
            p {
                b { "Wall" } " lasts until the device is done, " b { "cpu" }
                " until the last call that submits work has returned, " b { "gpu" }
                " is between timestamps of the device. " b { "Prepare" } " and " b { "first" }
                " are what a scene costs once. Adapters with the same rank do not differ provably. Software "
                "and hardware have tables of their own."
            }
        }
    }
}

/// Medians of all cases on all adapters of a kind.
fn overview(figures: &Figures<'_>, kind: bool, title: &str) -> Markup {
    let mut adapters: Vec<&str> = Vec::new();
    for timed in figures.cases.iter().flat_map(|c| c.of_kind(kind)) {
        if !adapters.contains(&timed.adapter()) {
            adapters.push(timed.adapter());
        }
    }
    adapters.sort_unstable();
    let cell = |case: &CaseFigures<'_>, adapter: &str| {
        let timed = case.of_kind(kind).iter().find(|t| t.adapter() == adapter);
        html! {
            @match timed {
                Some(t) if t.rank == 1 && adapters.len() > 1 => td.num.best { (duration(t.wall.median)) },
                Some(t) => td.num { (duration(t.wall.median)) },
                None => td.soft { "–" },
            }
        }
    };
    html! {
        @if !adapters.is_empty() {
            section {
                h2 { (title) " adapters, wall time per frame" }
                div.wide { table.times {
                    thead { tr { th { "Case" } @for a in &adapters { th { (breakable(a)) } } } }
                    tbody { @for (i, case) in figures.cases.iter().enumerate() {
                        tr {
                            th scope="row" { a href={ "#case-" (i) } { (case.case) } }
                            @for a in &adapters { (cell(case, a)) }
                        }
                    } }
                } }
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

fn table(rows: &[Timed<'_>], title: &str) -> Markup {
    let scale = Times::of(rows);
    let shown: Vec<Time> = Time::ALL
        .into_iter()
        .filter(|t| rows.iter().any(|r| r.others.contains_key(t)))
        .collect();
    html! {
        div.wide { table.times.stacked {
            thead { tr {
                th { "Rank" } th { (title) " adapter" } th { "Picture" } th { "Median" } th { "Interval" }
                th { "p50" } th { "p95" } th { "Rounds × frames" } th { "Discarded" } th { "Visible" }
                @for time in &shown { th { (time.name()) } }
                th { "Spread" br; small { (scale.caption()) } }
            } }
            tbody { @for row in rows {
                tr {
                    td.num data-head="Rank" { (row.rank) }
                    th scope="row" { (breakable(row.adapter())) }
                    td data-head="Picture" { (words::name(row.record.picture.verdict)) small { " " (share(row.record)) } (ended(row.record)) }
                    (figures_of(&row.wall))
                    td.num data-head="Rounds × frames" { (row.wall.rounds) " × " (row.wall.samples / row.wall.rounds.max(1)) }
                    td.num data-head="Discarded" { (row.record.discarded()) }
                    td.num data-head="Visible" { @match row.wall.visible { Some(v) => (change(v)), None => "–" } }
                    @for time in &shown {
                        td.num data-head=(time.name()) { @match row.others.get(time) { Some(s) => (duration(s.median)), None => "–" } }
                    }
                    td data-head="Spread" { (strip(row, scale)) }
                }
            } }
        } }
    }
}

fn figures_of(s: &Summary) -> Markup {
    html! {
        td.num data-head="Median" { b { (duration(s.median)) } }
        td.num data-head="Interval" {
            @match s.interval {
                Some([low, high]) => { (duration(low)) " to " (duration(high)) }
                None => "–",
            }
        }
        td.num data-head="p50" { (duration(s.p50)) }
        td.num data-head="p95" { (duration(s.p95)) }
    }
}

/// The share of the picture that was asserted.
fn share(record: &BenchRecord) -> String {
    format!("{} asserted", percent(record.picture.asserted, 1))
}

fn ended(record: &BenchRecord) -> Markup {
    html! {
        @if let Some(ended) = &record.ended {
            small { ", then " (words::name(ended.verdict)) ": " (ended.message) }
        }
    }
}

fn verdict(record: &BenchRecord) -> Verdict {
    let ended = record.ended.as_ref().map(|e| e.verdict);
    ended.unwrap_or(record.picture.verdict)
}

fn untimed(record: &BenchRecord) -> Markup {
    let v = verdict(record);
    let p = &record.picture;
    let message = record.ended.as_ref().map_or(&p.message, |e| &e.message);
    html! {
        li {
            (breakable(&p.adapter)) ": " (words::symbol(v)) " " (words::name(v)) ", no frame time"
            @if !message.is_empty() { small { " " (message) } }
        }
    }
}
