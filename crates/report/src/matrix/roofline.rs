//! The roofline: how near the cells of software adapters come to the limits of memory and of arithmetic.

use super::data::{Matrix, MatrixCell};
use super::reached::Reached;
use crate::chart::{HEIGHT, Plot, Scale, chart, key, marker, polyline};
use crate::numbers::{count, digits};
use crate::page::adapter::breakable;
use etalon_record::ProcessorLimits;
use maud::{Markup, html};

/// Returns the limits in words.
pub(super) fn in_words(limits: &[ProcessorLimits]) -> String {
    let each = limits.iter().map(|limit| {
        format!(
            "{}: {} GB/s copied, {} Gop/s computed",
            count(u64::from(limit.threads), "thread"),
            giga(limit.bytes),
            giga(limit.operations)
        )
    });
    match each.collect::<Vec<_>>() {
        none if none.is_empty() => "not measured".to_owned(),
        each => each.join("; "),
    }
}

/// Returns billions, in three digits.
pub(super) fn giga(amount: f64) -> String {
    digits(amount / 1e9, 3)
}

/// Returns the chart of all cells with arithmetic, or `None` without one.
pub(super) fn section(matrix: &Matrix<'_>) -> Option<Markup> {
    let adapters = matrix.adapters.iter().enumerate();
    let points: Vec<(usize, &MatrixCell, Reached)> = adapters
        .flat_map(|(style, adapter)| {
            let cells = matrix.cells.iter();
            cells.filter_map(move |cell| Some((style, cell, cell.results.get(*adapter)?.reached?)))
        })
        .filter(|(.., reached)| reached.operations > 0.0)
        .collect();
    let intensity = |reached: &Reached| reached.operations / reached.bytes;
    let limits = &matrix.bench.header.limits;
    let ridges = limits.iter().map(|l| l.operations / l.bytes);
    let peaks = limits.iter().map(|l| l.operations);
    let plot = Plot {
        x: Scale::log(points.iter().map(|p| intensity(&p.2)).chain(ridges)),
        y: Scale::log(points.iter().map(|p| p.2.operations).chain(peaks)),
        zero: 0.0,
    };
    let (left, right) = plot.x.ends();
    let (bottom, _) = plot.y.ends();
    let roof = |limit: &ProcessorLimits| {
        let ridge = limit.operations / limit.bytes;
        let start = left.max(bottom / limit.bytes);
        let corners = [
            (start, start * limit.bytes),
            (ridge, limit.operations),
            (right, limit.operations),
        ];
        polyline(&corners.map(|(x, y)| (plot.x(x), plot.y(y))))
    };
    let body = html! {
        (plot.frame(|x| digits(x, 2), giga, "operations per byte", "Gop/s"))
        @for (number, limit) in limits.iter().enumerate() {
            @let class = if number + 1 == limits.len() { "front" } else { "group" };
            path class=(class) d=(roof(limit)) {}
        }
        @for (style, cell, reached) in &points {
            @let place = (plot.x(intensity(reached)), plot.y(reached.operations));
            (marker(*style, place, true, &format!("{}: {}", cell.short(), words(reached))))
        }
    };
    let about = "Operations per second over operations per byte, both logarithmic.";
    let shown: Vec<usize> = (0..matrix.adapters.len())
        .filter(|style| points.iter().any(|p| p.0 == *style))
        .collect();
    (!points.is_empty()).then(|| {
        html! {
            section id="roofline" {
                h2 { "Roofline" }
                p {
                    "The sloping line is the limit of memory, the level line that of arithmetic, with all threads (solid) and with "
                    "one (dashed). A cell above a line keeps its texels in caches, or skips work. Cells without arithmetic, such as clears, have no point."
                }
                div.charts { (chart(HEIGHT, "Operations over bytes", about, &body)) }
                p.legend {
                    @for style in shown { span.key { (key(style)) " " (breakable(matrix.adapters[style])) } }
                }
            }
        }
    })
}

/// Returns what a cell reaches, in words.
pub(super) fn words(reached: &Reached) -> String {
    let memory = of_limit(reached.of_memory());
    let arithmetic = of_limit(reached.of_arithmetic());
    let bytes = format!("{} GB/s, {memory} of memory's limit", giga(reached.bytes));
    if reached.operations == 0.0 {
        return bytes;
    }
    let operations = giga(reached.operations);
    format!("{bytes}; {operations} Gop/s, {arithmetic} of arithmetic's")
}

/// Returns a share of a limit.
pub(super) fn of_limit(share: f64) -> String {
    format!("{} %", digits(share * 100.0, 2))
}
