//! The comparison of two benches as a page.

use super::compare::{BenchDiff, BenchIdentity};
use super::instructions::{SMALLEST, instructions_table};
use super::table::changes_table;
use crate::bench::figures::KINDS;
use crate::error::ReportError;
use crate::files::replace_at;
use crate::numbers::{change, percent};
use crate::page::Page;
use crate::page::adapter::breakable;
use maud::{Markup, html};
use std::path::{Path, PathBuf};

const BENCH_STYLE: &str = include_str!("../../bench/bench.css");

/// Writes a comparison of two benches as one page.
///
/// # Errors
/// Returns an error if the path names no file, or the file cannot be written.
pub fn write_diff(path: &Path, diff: &BenchDiff) -> Result<PathBuf, ReportError> {
    replace_at(path, page(diff).as_bytes())
}

fn page(diff: &BenchDiff) -> String {
    let look = diff.look();
    let main = html! {
        header {
            h1 { "etalon diff" }
            p.lead { "Changes of " (diff.time) " times between two benches." }
            p class={ "state " (look.class) } { b { (look.sign) " " (diff.conclusion()) "." } }
            @for note in &diff.notes { p.state.bad { "! " (note) } }
        }
        @for (kind, title) in KINDS {
            @let changes = diff.of_kind(kind);
            @if !changes.is_empty() {
                section { h2 { (title) " adapters" } (changes_table().page(changes)) }
            }
        }
        @if !diff.instructions.is_empty() {
            section {
                h2 { "Instructions of a frame" }
                (instructions_table().page(&diff.instructions))
                p.cap {
                    "Counted in processes of their own, and compared apart from the times. A change counts if it is above "
                    (percent(SMALLEST, 0)) " and above the scatter of both counts."
                }
            }
        }
        @if !diff.gone.is_empty() {
            section {
                h2 { "Timed in one bench only" }
                ul { @for gone in &diff.gone {
                    li {
                        @if gone.worse { "✗ " }
                        code { (gone.case) } " " (breakable(&gone.adapter)) ", not "
                        @if gone.is_missing_after { "after" } @else { "before" } ": " (gone.why)
                    }
                } }
            }
        }
        section {
            h2 { "Comparison" }
            p {
                "The Wilcoxon–Mann–Whitney test compares the medians of rounds. Inverted, it gives "
                "the interval of their ratio, as measured and in units of the ruler. A case is faster or slower "
                "if both intervals lie beyond a change of " (change(diff.minimum)) ". Two benches "
                "of the same thing are called different with a probability of at most " (diff.level)
                " per comparison. Visible is the smallest change that would have been found with a "
                "probability of 0.9."
            }
        }
        section {
            h2 { "About the benches" }
            dl.facts { (identity("Before", &diff.before)) (identity("After", &diff.after)) }
        }
    };
    Page::new("etalon diff", "two recorded benches", &main)
        .style(BENCH_STYLE)
        .html()
}

fn identity(name: &str, bench: &BenchIdentity) -> Markup {
    html! {
        dt { (name) }
        dd {
            (bench.started) ", etalon " (bench.etalon)
            @if let Some(commit) = &bench.commit { ", commit " code { (commit) } }
            ", " (bench.machine) br; code { (bench.command) }
        }
    }
}
