//! Charts as SVG, drawn by hand: a page may hold hundreds, and a library of charts would bring a script.

mod label;
mod marker;
mod plot;
mod scale;

pub(crate) use label::Labels;
pub(crate) use marker::{color, dash, key, line_key, marker};
pub(crate) use plot::{BOTTOM, HEIGHT, LEFT, Plot, RIGHT, TOP, chart, n, polyline, zero_band};
pub(crate) use scale::Scale;

/// The style sheet of charts.
pub(crate) const STYLE: &str = include_str!("chart/chart.css");
