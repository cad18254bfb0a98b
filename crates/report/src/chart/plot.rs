//! The frame of a chart: its size, box, grid, ticks and axis names.

use super::scale::Scale;
use super::tick::tick_labels;
use maud::{Markup, html};

/// The width and height of a chart in its own units, which are pixels at full size.
pub(crate) const WIDTH: f64 = 400.0;
pub(crate) const HEIGHT: f64 = 280.0;
/// The edges of the plot within the chart.
pub(crate) const LEFT: f64 = 86.0;
pub(crate) const RIGHT: f64 = WIDTH - 22.0;
pub(crate) const TOP: f64 = 10.0;
pub(crate) const BOTTOM: f64 = HEIGHT - 42.0;

/// Returns the height of the band for pictures without error, or 0 if there are no such pictures.
pub(crate) fn zero_band(mut errors: impl Iterator<Item = f64>) -> f64 {
    if errors.any(|e| e == 0.0) { 20.0 } else { 0.0 }
}

/// The two scales of a plot, in chart units.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Plot {
    pub(crate) x: Scale,
    pub(crate) y: Scale,
    /// The height of a band below the scale for values that are exactly zero.
    pub(crate) zero: f64,
}

impl Plot {
    pub(crate) fn x(&self, value: f64) -> f64 {
        LEFT + self.x.at(value) * (RIGHT - LEFT)
    }

    pub(crate) fn y(&self, value: f64) -> f64 {
        if self.zero > 0.0 && value <= 0.0 {
            return BOTTOM - self.zero / 2.0;
        }
        let bottom = BOTTOM - self.zero;
        bottom - self.y.at(value) * (bottom - TOP)
    }

    /// Returns the box, the grid lines and the tick labels.
    pub(crate) fn frame(
        &self,
        x_label: impl Fn(f64) -> String,
        y_label: impl Fn(f64) -> String,
        x_name: &str,
        y_name: &str,
    ) -> Markup {
        let middle = f64::midpoint(TOP, BOTTOM);
        html! {
            @if self.zero > 0.0 {
                rect.zero x=(n(LEFT)) y=(n(BOTTOM - self.zero)) width=(n(RIGHT - LEFT)) height=(n(self.zero)) {}
                text.tick x=(n(LEFT - 5.0)) y=(n(BOTTOM - self.zero / 2.0 + 5.0)) text-anchor="end" { "exact" }
            }
            @for tick in self.x.ticks(3) { path.grid d={ "M" (n(self.x(tick))) " " (n(TOP)) "V" (n(BOTTOM)) } {} }
            @for (x, label) in tick_labels(0.0, self.x.ticks(3).into_iter().map(|tick| (self.x(tick), x_label(tick)))) {
                text.tick x=(n(x)) y=(n(BOTTOM + 17.0)) text-anchor="middle" { (label) }
            }
            @for tick in self.y.ticks(7) {
                @let y = self.y(tick);
                path.grid d={ "M" (n(LEFT)) " " (n(y)) "H" (n(RIGHT)) } {}
                text.tick x=(n(LEFT - 5.0)) y=(n(y + 5.0)) text-anchor="end" { (y_label(tick)) }
            }
            rect.box x=(n(LEFT)) y=(n(TOP)) width=(n(RIGHT - LEFT)) height=(n(BOTTOM - TOP)) {}
            text.axis x=(n(f64::midpoint(LEFT, RIGHT))) y=(n(HEIGHT - 8.0)) text-anchor="middle" { (x_name) }
            text.axis transform={ "translate(13 " (n(middle)) ") rotate(-90)" } text-anchor="middle" { (y_name) }
        }
    }
}

/// Returns a line through these points.
pub(crate) fn polyline(places: &[(f64, f64)]) -> String {
    let place = |(i, (x, y)): (usize, &(f64, f64))| {
        let pen = if i == 0 { 'M' } else { 'L' };
        format!("{pen}{} {}", n(*x), n(*y))
    };
    places.iter().enumerate().map(place).collect()
}

/// Returns one chart: an image with a description for screen readers, below a title that can take several
/// lines.
pub(crate) fn chart(height: f64, title: &str, about: &str, body: &Markup) -> Markup {
    let view = format!("0 0 {WIDTH} {height}");
    html! {
        figure.plot {
            figcaption.head { (title) }
            svg.chart viewBox=(view) width=(WIDTH) height=(height) role="img" {
                title { (title) ". " (about) }
                (body)
            }
        }
    }
}

/// Returns a coordinate with at most one decimal.
pub(crate) fn n(value: f64) -> String {
    let text = format!("{value:.1}");
    match text.strip_suffix(".0") {
        Some("-0") => "0".to_owned(),
        Some(integer) => integer.to_owned(),
        None => text,
    }
}

#[cfg(test)]
mod tests {
    #[test]
    fn coordinates_are_short() {
        assert_eq!(super::n(-0.04), "0");
        assert_eq!(super::n(12.0), "12");
        assert_eq!(super::n(12.34), "12.3");
    }
}
