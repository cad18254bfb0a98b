//! Markers: a colour and a shape per method or adapter.

use super::number::n;
use maud::{Markup, html};

/// The number of colours.
const COLORS: usize = 7;

/// Outlines around the origin, about as heavy as each other. Their number and that of colours have
/// no common divisor, so that many methods get a pair of their own.
const SHAPES: [&str; 8] = [
    "M-4.5 0a4.5 4.5 0 1 0 9 0a4.5 4.5 0 1 0-9 0z",
    "M-4-4H4V4H-4z",
    "M0-5.5L5.2 4H-5.2z",
    "M0-5.8L5.8 0L0 5.8L-5.8 0z",
    "M0 5.5L5.2-4H-5.2z",
    "M-1.7-5.5H1.7V-1.7H5.5V1.7H1.7V5.5H-1.7V1.7H-5.5V-1.7H-1.7z",
    "M-5-2.8L-2.8-5L0-2.2L2.8-5L5-2.8L2.2 0L5 2.8L2.8 5L0 2.2L-2.8 5L-5 2.8L-2.2 0z",
    "M0-5.6L5.3-1.7L3.3 4.5H-3.3L-5.3-1.7z",
];

/// The class that colours the `index`-th method.
pub(crate) fn color(index: usize) -> String {
    format!("k{}", index % COLORS)
}

/// The marker of the `index`-th method, with a text to hover over.
pub(crate) fn marker(index: usize, (x, y): (f64, f64), faint: bool, hover: &str) -> Markup {
    let shape = SHAPES[index % SHAPES.len()];
    let place = if faint {
        format!("translate({} {}) scale(.6)", n(x), n(y))
    } else {
        format!("translate({} {})", n(x), n(y))
    };
    let class = format!("mark {}{}", color(index), if faint { " faint" } else { "" });
    html! {
        path class=(class) d=(shape) transform=(place) {
            @if !hover.is_empty() { title { (hover) } }
        }
    }
}

/// The marker alone, for legends.
pub(crate) fn key(index: usize) -> Markup {
    html! {
        svg.keymark viewBox="-7 -7 14 14" width="14" height="14" aria-hidden="true" {
            (marker(index, (0.0, 0.0), false, ""))
        }
    }
}
