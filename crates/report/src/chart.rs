//! Charts as SVG, written directly: a page can hold hundreds of charts, and a chart library would bring a
//! script.

mod label;
mod marker;
mod plot;
mod scale;
mod tick;

pub(crate) use label::LabelPlaces;
pub(crate) use marker::{color, dash, key, line_key, marker};
pub(crate) use plot::{BOTTOM, HEIGHT, LEFT, Plot, RIGHT, TOP, chart, n, polyline, zero_band};
pub(crate) use scale::Scale;
pub(crate) use tick::{tick_labels, tick_width};

/// Returns the style sheet of charts. A legend highlights its method in the chart, even without scripts.
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
