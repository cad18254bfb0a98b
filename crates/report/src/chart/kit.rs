//! What all charts are made of: scales, ticks, markers and frames.

use maud::{Markup, html};

/// Width and height of a chart in its own units, which are pixels at full size.
pub(crate) const WIDTH: f64 = 400.0;
pub(crate) const HEIGHT: f64 = 300.0;
/// The plot's place within.
pub(crate) const LEFT: f64 = 58.0;
pub(crate) const RIGHT: f64 = WIDTH - 12.0;
pub(crate) const TOP: f64 = 30.0;
pub(crate) const BOTTOM: f64 = HEIGHT - 42.0;

/// From values to a place between 0 and 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Scale {
    /// Between two values.
    Linear { low: f64, high: f64 },
    /// Between the decimal logarithms of two values.
    Log { low: f64, high: f64 },
}

impl Scale {
    /// A linear scale with all values inside.
    pub(crate) fn linear(values: impl IntoIterator<Item = f64>) -> Self {
        let (low, high) = ends(values).unwrap_or((0.0, 1.0));
        let pad = match high - low {
            0.0 => low.abs().max(1.0) * 0.5,
            span => span * 0.04,
        };
        Self::Linear {
            low: low - pad,
            high: high + pad,
        }
    }

    /// A logarithmic scale with all values, which must be positive, inside, over a factor of two at
    /// least.
    pub(crate) fn log(values: impl IntoIterator<Item = f64>) -> Self {
        let logs = values.into_iter().map(f64::log10);
        let (low, high) = ends(logs).unwrap_or((0.0, 1.0));
        let pad = ((high - low) * 0.06)
            .max((0.31 - (high - low)) / 2.0)
            .max(0.02);
        Self::Log {
            low: low - pad,
            high: high + pad,
        }
    }

    /// Logarithmic where positive values lie far apart, else linear.
    pub(crate) fn fitting(values: &[f64]) -> Self {
        match ends(values.iter().copied()) {
            Some((low, high)) if low > 0.0 && high / low >= 20.0 => {
                Self::log(values.iter().copied())
            }
            _ => Self::linear(values.iter().copied()),
        }
    }

    /// Where a value lies.
    pub(crate) fn at(self, value: f64) -> f64 {
        let (low, high, value) = match self {
            Self::Linear { low, high } => (low, high, value),
            Self::Log { low, high } => (low, high, value.log10()),
        };
        ((value - low) / (high - low)).clamp(0.0, 1.0)
    }

    /// Round values inside, about as many as asked for and never more than twice as many.
    pub(crate) fn ticks(self, wanted: usize) -> Vec<f64> {
        match self {
            Self::Linear { low, high } => linear_ticks(low, high, wanted),
            Self::Log { low, high } => {
                let decades = high - low;
                if decades < 0.7 {
                    let ticks = linear_ticks(10_f64.powf(low), 10_f64.powf(high), wanted);
                    return ticks.into_iter().filter(|t| *t > 0.0).collect();
                }
                let step = (decades / wanted as f64).ceil().max(1.0);
                let parts: &[f64] = match () {
                    () if decades * 3.0 <= wanted as f64 * 1.6 => &[1.0, 2.0, 5.0],
                    () if decades * 2.0 <= wanted as f64 * 1.6 => &[1.0, 3.0],
                    () => &[1.0],
                };
                let first = (low / step).floor() * step;
                let count = ((high - first) / step).ceil() as usize + 1;
                (0..count)
                    .map(|i| first + i as f64 * step)
                    .flat_map(|e| parts.iter().map(move |p| (e + p.log10(), *p, e)))
                    .filter(|(at, _, _)| (low..=high).contains(at))
                    .map(|(_, p, e)| power(p, e))
                    .collect()
            }
        }
    }
}

/// A digit times a power of ten, as near as it gets.
fn power(digit: f64, exponent: f64) -> f64 {
    format!("{digit}e{exponent}")
        .parse()
        .unwrap_or_else(|_| digit * 10_f64.powf(exponent))
}

fn ends(values: impl IntoIterator<Item = f64>) -> Option<(f64, f64)> {
    let finite = values.into_iter().filter(|v| v.is_finite());
    finite.fold(None, |ends, v| match ends {
        None => Some((v, v)),
        Some((low, high)) => Some((low.min(v), high.max(v))),
    })
}

fn linear_ticks(low: f64, high: f64, wanted: usize) -> Vec<f64> {
    let raw = (high - low) / wanted.max(1) as f64;
    let magnitude = 10_f64.powf(raw.log10().floor());
    let step = [1.0, 2.0, 5.0, 10.0]
        .into_iter()
        .map(|m| m * magnitude)
        .find(|s| *s >= raw * 0.999)
        .unwrap_or(raw);
    let first = (low / step).ceil();
    (0..=2 * wanted)
        .map(|i| (first + i as f64) * step)
        .take_while(|t| *t <= high)
        .collect()
}

/// Height of the band for pictures that are exactly right: none where there are no such pictures.
pub(crate) fn zero_band(mut errors: impl Iterator<Item = f64>) -> f64 {
    if errors.any(|e| e == 0.0) { 20.0 } else { 0.0 }
}

/// The two scales of a plot, in chart units.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Plot {
    pub(crate) x: Scale,
    pub(crate) y: Scale,
    /// Height of a band below the scale for what is exactly zero.
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

    /// The box, the grid lines and the tick labels.
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
                text.tick x=(n(LEFT - 5.0)) y=(n(BOTTOM - self.zero / 2.0 + 3.5)) text-anchor="end" { "exact" }
            }
            @for tick in self.x.ticks(5) {
                @let x = self.x(tick);
                path.grid d={ "M" (n(x)) " " (n(TOP)) "V" (n(BOTTOM)) } {}
                text.tick x=(n(x)) y=(n(BOTTOM + 14.0)) text-anchor="middle" { (x_label(tick)) }
            }
            @for tick in self.y.ticks(7) {
                @let y = self.y(tick);
                path.grid d={ "M" (n(LEFT)) " " (n(y)) "H" (n(RIGHT)) } {}
                text.tick x=(n(LEFT - 5.0)) y=(n(y + 3.5)) text-anchor="end" { (y_label(tick)) }
            }
            rect.box x=(n(LEFT)) y=(n(TOP)) width=(n(RIGHT - LEFT)) height=(n(BOTTOM - TOP)) {}
            text.axis x=(n(f64::midpoint(LEFT, RIGHT))) y=(n(HEIGHT - 8.0)) text-anchor="middle" { (x_name) }
            text.axis transform={ "translate(11 " (n(middle)) ") rotate(-90)" } text-anchor="middle" { (y_name) }
        }
    }
}

/// One chart: an image with a title and a description for whoever does not see it.
pub(crate) fn chart(height: f64, title: &str, about: &str, body: &Markup) -> Markup {
    let view = format!("0 0 {WIDTH} {height}");
    html! {
        svg.chart viewBox=(view) width=(WIDTH) height=(height) role="img" {
            title { (title) ". " (about) }
            text.head x=(n(LEFT)) y="18" { (title) }
            (body)
        }
    }
}

/// A coordinate with one decimal at most.
pub(crate) fn n(value: f64) -> String {
    let text = format!("{value:.1}");
    match text.strip_suffix(".0") {
        Some("-0") => "0".to_owned(),
        Some(whole) => whole.to_owned(),
        None => text,
    }
}

/// How many colours there are.
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

    /// Where to write a text that belongs to a point: the text's left end and its base line.
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

/// A time with its unit: `3.4 ms`.
pub(crate) fn seconds(value: f64) -> String {
    let (scaled, unit) = match value {
        v if v < 1e-6 => (v * 1e9, "ns"),
        v if v < 1e-3 => (v * 1e6, "µs"),
        v if v < 1.0 => (v * 1e3, "ms"),
        v => (v, "s"),
    };
    format!("{}\u{a0}{unit}", digits(scaled, 3))
}

/// A share of full brightness in percent: `0.25 %`.
pub(crate) fn share(value: f64) -> String {
    match value * 100.0 {
        0.0 => "0".to_owned(),
        v if v < 9.5e-5 => format!("{v:.0e}\u{a0}%"),
        v => format!("{}\u{a0}%", digits(v, 3)),
    }
}

/// A number with so many significant digits, without zeros at its end.
pub(crate) fn digits(value: f64, significant: i32) -> String {
    if value == 0.0 || !value.is_finite() {
        return format!("{value}");
    }
    let magnitude = value.abs().log10().floor() as i32;
    if !(-7..15).contains(&magnitude) {
        return format!("{value:.2e}");
    }
    let decimals = usize::try_from(significant - 1 - magnitude).unwrap_or(0);
    let text = format!("{value:.decimals$}");
    match text.contains('.') {
        true => text.trim_end_matches('0').trim_end_matches('.').to_owned(),
        false => text,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn scales_hold_their_values_and_their_ticks() {
        for values in [
            vec![1.0],
            vec![0.0, 0.0],
            vec![-3.0, 12.0],
            vec![1e-12, 1e12],
            vec![0.1, 0.100001],
        ] {
            let mut scales = vec![
                Scale::linear(values.iter().copied()),
                Scale::fitting(&values),
            ];
            if values.iter().all(|v| *v > 0.0) {
                scales.push(Scale::log(values.iter().copied()));
            }
            for scale in scales {
                for v in &values {
                    let at = scale.at(*v);
                    assert!(at > 0.0 && at < 1.0, "{scale:?} {v} {at}");
                }
                let ticks = scale.ticks(5);
                assert!((2..=12).contains(&ticks.len()), "{scale:?} {ticks:?}");
                assert!(ticks.is_sorted());
                assert!(ticks.iter().all(|t| t.is_finite()), "{ticks:?}");
            }
        }
        let ticks = Scale::log([0.001, 0.1]).ticks(5);
        assert_eq!(ticks, [0.001, 0.002, 0.005, 0.01, 0.02, 0.05, 0.1]);
        let ticks = Scale::log([1e-6, 1.0]).ticks(5);
        assert_eq!(ticks, [1e-6, 1e-4, 0.01, 1.0]);
        assert!(matches!(Scale::fitting(&[1.0, 4.0]), Scale::Linear { .. }));
        assert!(matches!(Scale::fitting(&[1.0, 64.0]), Scale::Log { .. }));
    }

    #[test]
    fn figures_are_short() {
        assert_eq!(seconds(0.00123456), "1.23\u{a0}ms");
        assert_eq!(seconds(0.0002), "200\u{a0}µs");
        assert_eq!(seconds(12.0), "12\u{a0}s");
        assert_eq!(share(0.01), "1\u{a0}%");
        assert_eq!(share(0.00113), "0.113\u{a0}%");
        assert_eq!(share(0.0), "0");
        assert_eq!(share(1e-9), "1e-7\u{a0}%");
        assert_eq!(digits(1234.5, 3), "1234");
        assert_eq!(digits(0.63, 3), "0.63");
        assert_eq!(n(-0.04), "0");
    }

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
