//! Markers: a colour, a shape and a line pattern per method or adapter.

use super::plot::n;
use maud::{Markup, html};

/// The number of colours, shapes and line patterns. Colour alone, shape alone or pattern alone distinguishes
/// this number of methods.
pub(crate) const STYLES: usize = 16;

/// Outlines around the origin, of about the same visual weight, one for each method of a chart. Colours alone
/// are lost in greyscale and to some eyes.
const SHAPES: [&str; STYLES] = [
    "M-4.5 0a4.5 4.5 0 1 0 9 0a4.5 4.5 0 1 0-9 0z",
    "M-4-4H4V4H-4z",
    "M0-5.5L5.2 4H-5.2z",
    "M0-5.8L5.8 0L0 5.8L-5.8 0z",
    "M0 5.5L5.2-4H-5.2z",
    "M-1.7-5.5H1.7V-1.7H5.5V1.7H1.7V5.5H-1.7V1.7H-5.5V-1.7H-1.7z",
    "M-5-2.8L-2.8-5L0-2.2L2.8-5L5-2.8L2.2 0L5 2.8L2.8 5L0 2.2L-2.8 5L-5 2.8L-2.2 0z",
    // A star.
    "M0-6L1.6-2.2L5.7-1.9L2.6 .8L3.5 4.9L0 2.7L-3.5 4.9L-2.6 .8L-5.7-1.9L-1.6-2.2z",
    // A ring.
    "M-5 0a5 5 0 1 0 10 0a5 5 0 1 0-10 0zM-2.6 0a2.6 2.6 0 1 1 5.2 0a2.6 2.6 0 1 1-5.2 0z",
    // A frame.
    "M-4.6-4.6H4.6V4.6H-4.6zM-2.3-2.3V2.3H2.3V-2.3z",
    // Triangles to the left and to the right.
    "M-5.5 0L4-5.2V5.2z",
    "M5.5 0L-4-5.2V5.2z",
    // An hourglass and a bow.
    "M-4.6-5H4.6L0 0L4.6 5H-4.6L0 0z",
    "M-5-4.6V4.6L0 0L5 4.6V-4.6L0 0z",
    // A pentagon and a bar.
    "M0-5.6L5.3-1.7L3.3 4.6H-3.3L-5.3-1.7z",
    "M-5.8-2.2H5.8V2.2H-5.8z",
];

/// Patterns of lines: lengths of strokes and gaps.
const DASHES: [&str; STYLES] = [
    "none",
    "7 3",
    "2 2",
    "9 3 2 3",
    "4 4",
    "1 3",
    "12 4",
    "6 2 2 2 2 2",
    "5 1.5",
    "2 5",
    "14 3 4 3",
    "3 1 1 1",
    "8 2 1 2 1 2 1 2",
    "1 1.5",
    "10 3 3 3",
    "6 6",
];

/// Returns the classes of the `index`-th method: its colour, and the name by which a legend finds it.
pub(crate) fn color(index: usize) -> String {
    let index = index % STYLES;
    format!("k{index} m{index}")
}

/// Returns the line pattern of the `index`-th method, as `stroke-dasharray`.
pub(crate) fn dash(index: usize) -> &'static str {
    DASHES[index % STYLES]
}

/// Returns the marker of the `index`-th method, with hover text.
pub(crate) fn marker(index: usize, (x, y): (f64, f64), small: bool, hover: &str) -> Markup {
    let shape = SHAPES[index % STYLES];
    let place = if small {
        format!("translate({} {}) scale(.7)", n(x), n(y))
    } else {
        format!("translate({} {})", n(x), n(y))
    };
    html! {
        path class={ "mark " (color(index)) } d=(shape) transform=(place) {
            @if !hover.is_empty() { title { (hover) } }
        }
    }
}

/// Returns the marker for legends.
pub(crate) fn key(index: usize) -> Markup {
    html! {
        svg.keymark viewBox="-7 -7 14 14" width="14" height="14" aria-hidden="true" {
            (marker(index, (0.0, 0.0), false, ""))
        }
    }
}

/// Returns the marker on its line, for legends of curves.
pub(crate) fn line_key(index: usize) -> Markup {
    html! {
        svg.keymark viewBox="-19 -7 38 14" width="38" height="14" aria-hidden="true" {
            path class={ "curve " (color(index)) } d="M-18 0H18" stroke-dasharray=(dash(index)) {}
            (marker(index, (0.0, 0.0), false, ""))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeSet;

    #[test]
    fn sixteen_methods_differ_in_shape_line_and_hue() {
        let different = |style: &dyn Fn(usize) -> String| {
            let styles: BTreeSet<String> = (0..STYLES).map(style).collect();
            assert_eq!(styles.len(), STYLES, "{styles:?}");
        };
        different(&|i| SHAPES[i].to_owned());
        different(&|i| dash(i).to_owned());
        let sheet = super::super::style();
        for theme in sheet.split("--k0:").skip(1) {
            let theme = format!("--k0:{theme}");
            different(&|i| {
                let (_, behind) = theme.split_once(&format!("--k{i}:")).unwrap();
                behind.split(';').next().unwrap().trim().to_owned()
            });
        }
    }
}
