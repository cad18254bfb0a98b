//! Texts beside the points of a chart.

use super::plot::{BOTTOM, LEFT, RIGHT, TOP};

/// Texts beside points, each where it covers neither a point nor another text; a text that finds no
/// such place is left out, since hover text and table have it too.
pub(crate) struct Labels {
    taken: Vec<[f64; 4]>,
}

impl Labels {
    /// Labels of a chart with points at these places.
    pub(crate) fn new(points: impl IntoIterator<Item = (f64, f64)>) -> Self {
        let around = |(x, y): (f64, f64)| [x - 5.0, y - 5.0, x + 5.0, y + 5.0];
        Self {
            taken: points.into_iter().map(around).collect(),
        }
    }

    /// The place of a text that belongs to a point: its left end and its base line.
    pub(crate) fn place(&mut self, text: &str, (x, y): (f64, f64)) -> Option<(f64, f64)> {
        let width = 5.6 * text.chars().count() as f64;
        let places = [
            (x + 6.0, y - 7.0),
            (x + 8.0, y + 3.5),
            (x + 6.0, y + 14.0),
            (x - width - 8.0, y + 3.5),
            (x - width / 2.0, y - 9.0),
            (x - width / 2.0, y + 17.0),
            (x - width - 6.0, y - 7.0),
            (x - width - 6.0, y + 14.0),
        ];
        let found = places.into_iter().find(|(left, base)| {
            let text = [*left, base - 8.5, left + width, base + 2.0];
            let inside = text[0] >= LEFT + 2.0
                && text[2] <= RIGHT - 2.0
                && text[1] >= TOP + 1.0
                && text[3] <= BOTTOM - 1.0;
            let apart =
                |o: &[f64; 4]| text[2] < o[0] || o[2] < text[0] || text[3] < o[1] || o[3] < text[1];
            inside && self.taken.iter().all(apart)
        })?;
        let (left, base) = found;
        self.taken
            .push([left, base - 8.5, left + width, base + 2.0]);
        Some(found)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn labels_cover_nothing() {
        let mut labels = Labels::new([(100.0, 100.0), (112.0, 100.0)]);
        let (left, base) = labels.place("a method", (100.0, 100.0)).unwrap();
        let across = left < 117.0 && left + 8.0 * 5.6 > 107.0;
        let along = base - 8.5 < 105.0 && base + 2.0 > 95.0;
        assert!(!(across && along), "{left} {base}");
        let places: Vec<_> = (0..20)
            .map_while(|_| labels.place("a method", (100.0, 100.0)))
            .collect();
        assert!(places.len() < 8, "no room for all");
    }
}
