//! Charts as SVG, drawn by hand: a page may hold hundreds, and a library of charts would bring a script.

mod label;
mod marker;
mod plot;
mod scale;

pub(crate) use label::Labels;
pub(crate) use marker::{color, dash, key, line_key, marker};
pub(crate) use plot::{BOTTOM, HEIGHT, LEFT, Plot, RIGHT, TOP, chart, n, polyline, zero_band};
pub(crate) use scale::Scale;

/// The style sheet of charts. A legend shows where its method is; without scripts too.
pub(crate) fn style() -> String {
    let sheet = include_str!("chart/chart.css").to_owned();
    let rule = |i: usize| {
        format!(
            ".k{i} {{ --k: var(--k{i}); }} .scene:has(.key.m{i}:is(:hover, :focus-visible, [aria-pressed=\"true\"])) \
             .chart .of:not(.m{i}) {{ opacity: .1; }}\n"
        )
    };
    (0..marker::STYLES)
        .map(rule)
        .fold(sheet, |sheet, rule| sheet + &rule)
}
