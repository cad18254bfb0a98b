//! Text labels next to the points of a chart.

use super::plot::{BOTTOM, LEFT, RIGHT, TOP};
use super::tick::advance;

/// The height of letters above the baseline, and below it.
const ABOVE: f64 = 11.0;
const BELOW: f64 = 3.0;

/// The distance between the samples of a line, in chart units.
const STEP: f64 = 4.0;

/// Places labels so that each covers no point, line or other label. A label without such a position is left
/// out; the legend, hover text and table also show it.
pub(crate) struct LabelPlaces {
    taken: Vec<[f64; 4]>,
    bottom: f64,
}

impl LabelPlaces {
    /// Prepares labels for a chart with points at these positions.
    pub(crate) fn new(points: impl IntoIterator<Item = (f64, f64)>) -> Self {
        let around = |(x, y): (f64, f64)| [x - 5.0, y - 5.0, x + 5.0, y + 5.0];
        Self {
            taken: points.into_iter().map(around).collect(),
            bottom: BOTTOM,
        }
    }

    /// Sets the bottom of a chart that is lower or higher than usual.
    pub(crate) fn down_to(self, bottom: f64) -> Self {
        Self { bottom, ..self }
    }

    /// Keeps texts clear of a line through these corners.
    pub(crate) fn avoid(&mut self, corners: &[(f64, f64)]) {
        for pair in corners.windows(2) {
            let [(x0, y0), (x1, y1)] = [pair[0], pair[1]];
            let steps = ((x1 - x0).hypot(y1 - y0) / STEP).ceil().clamp(1.0, 500.0);
            for i in 0..=steps as u32 {
                let t = f64::from(i) / steps;
                let (x, y) = (x0 + (x1 - x0) * t, y0 + (y1 - y0) * t);
                self.taken.push([x - 1.5, y - 1.5, x + 1.5, y + 1.5]);
            }
        }
    }

    /// Returns the position of a point's label: its left end and its baseline.
    pub(crate) fn place(&mut self, text: &str, (x, y): (f64, f64)) -> Option<(f64, f64)> {
        let width: f64 = text.chars().map(advance).sum();
        let places = [
            (x + 6.0, y - 7.0),
            (x + 8.0, y + 5.0),
            (x + 6.0, y + 17.0),
            (x - width - 8.0, y + 5.0),
            (x - width / 2.0, y - 9.0),
            (x - width / 2.0, y + 20.0),
            (x - width - 6.0, y - 7.0),
            (x - width - 6.0, y + 17.0),
        ];
        let found = places.into_iter().find(|(left, base)| {
            let text = [*left, base - ABOVE, left + width, base + BELOW];
            let inside = text[0] >= LEFT + 2.0
                && text[2] <= RIGHT - 2.0
                && text[1] >= TOP + 1.0
                && text[3] <= self.bottom - 1.0;
            let apart =
                |o: &[f64; 4]| text[2] < o[0] || o[2] < text[0] || text[3] < o[1] || o[3] < text[1];
            inside && self.taken.iter().all(apart)
        })?;
        let (left, base) = found;
        self.taken
            .push([left, base - ABOVE, left + width, base + BELOW]);
        Some(found)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn labels_cover_nothing() {
        let mut labels = LabelPlaces::new([(100.0, 100.0), (112.0, 100.0)]);
        let (left, base) = labels.place("a method", (100.0, 100.0)).unwrap();
        let across = left < 117.0 && left + 8.0 * 7.7 > 107.0;
        let along = base - ABOVE < 105.0 && base + BELOW > 95.0;
        assert!(!(across && along), "{left} {base}");
        let places: Vec<_> = (0..20)
            .map_while(|_| labels.place("a method", (100.0, 100.0)))
            .collect();
        assert!(places.len() < 8, "no room for all");
    }

    #[test]
    fn no_line_strikes_through_a_label() {
        let free = LabelPlaces::new([(200.0, 150.0)]).place("method", (200.0, 150.0));
        let (left, base) = free.unwrap();
        let mut labels = LabelPlaces::new([(200.0, 150.0)]);
        // A step of a front runs through the label's default position.
        labels.avoid(&[(200.0, base - 4.0), (300.0, base - 4.0), (300.0, 40.0)]);
        let (x, y) = labels.place("method", (200.0, 150.0)).unwrap();
        assert_ne!((x, y), (left, base));
        let line = base - 4.0;
        assert!(
            y + BELOW < line || y - ABOVE > line || x + 6.0 * 7.7 < 200.0,
            "{x} {y}"
        );
    }
}
