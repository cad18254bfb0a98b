//! Checks a claim against the records of a run, from the claim's data alone.

use super::outcome::{CaseFigure, Holds, Unit};
use crate::methods::breaks::{self, Break, LIMIT};
use crate::methods::data::{MethodSeries, Methods, SceneSeries, SceneSetting, SeriesPoint, usable};
use crate::numbers::{digits, share};
use etalon_methods::{Claim, ClaimedValues, FigureCondition, Quantity, Test};

/// Half a step between two 8-bit codes.
const HALF_CODE: f64 = 0.5 / 255.0;

/// The factor up to which two errors count as the same.
const ALIKE: f64 = 1.5;

/// A claim and what the records show about it.
pub(super) struct Checked<'a> {
    pub(super) claim: &'static Claim,
    pub(super) figures: Vec<CaseFigure>,
    /// Adapters that count fragments before the depth test, for claims that depend on it.
    pub(super) blind: Vec<&'a str>,
}

/// Returns the figures for and against a claim.
pub(super) fn check<'a>(claim: &'static Claim, methods: &Methods<'a>) -> Checked<'a> {
    let mut checked = Checked {
        claim,
        figures: Vec::new(),
        blind: Vec::new(),
    };
    let scenes = methods.scenes().filter(|s| {
        s.question == claim.question
            && (claim.families.is_empty() || claim.families.contains(&s.name))
    });
    for scene in scenes {
        for (index, adapter) in methods.adapters.iter().enumerate() {
            let on = On {
                claim,
                scene,
                adapter: index,
                name: adapter.name,
            };
            let mut figures = on.figures();
            if figures.is_empty() {
                continue;
            }
            if claim.fewer.is_some() {
                figures.retain(|(setting, _)| setting.as_ref().is_some_and(|s| on.counts(s)));
                if figures.is_empty() {
                    if !checked.blind.contains(&adapter.name) {
                        checked.blind.push(adapter.name);
                    }
                    continue;
                }
            }
            checked.figures.extend(figures.into_iter().map(|(_, f)| f));
        }
    }
    checked
}

/// A claim, checked on a family of cases and an adapter.
struct On<'s, 'a> {
    claim: &'static Claim,
    scene: &'s SceneSeries<'a>,
    adapter: usize,
    name: &'a str,
}

/// A figure and its setting; `None` for a figure of a whole curve.
type Found<'a> = (Option<SceneSetting<'a>>, CaseFigure);

impl<'a> On<'_, 'a> {
    fn figures(&self) -> Vec<Found<'a>> {
        match self.claim.test {
            Test::Value {
                quantity,
                of,
                holds,
            } => self.at_settings(|s| {
                let (value, interval) = self.quantity(s, of, quantity)?;
                let unit = match quantity {
                    Quantity::Rmse | Quantity::Largest => Unit::Share,
                    other => Unit::Count(other.name()),
                };
                Some((unit, value, interval, holds))
            }),
            Test::Ratio {
                quantity,
                of,
                over,
                holds,
            } => self.at_settings(|s| {
                let (top, [top_low, top_high]) = self.sum(s, of, quantity)?;
                let (bottom, [bottom_low, bottom_high]) = self.sum(s, over, quantity)?;
                let interval = [top_low / bottom_high, top_high / bottom_low];
                let known = bottom_low > 0.0 && top_low >= 0.0;
                known.then_some((Unit::Factor, top / bottom, interval, holds))
            }),
            Test::Same { methods: [a, b] } => self.same(a, b),
            Test::HalfCodes { of, holds } => self.at_settings(|s| {
                let (_, parameter) = s.parameter.filter(|(_, v)| *v > 0.0)?;
                let (largest, _) = self.quantity(s, of, Quantity::Largest)?;
                let value = largest * parameter / HALF_CODE;
                let unit = Unit::Count("halves of a code over alpha");
                Some((unit, value, [value; 2], holds))
            }),
            Test::Trend {
                quantity,
                of,
                holds,
            } => self.per_series(of, |series| {
                let points = self.points(series);
                let (first, last) = (points.first()?, points.last()?);
                let (start, [start_low, start_high]) = measured(first, quantity)?;
                let (end, [low, high]) = measured(last, quantity)?;
                (points.len() > 1 && start_low > 0.0).then(|| {
                    let interval = [low / start_high, high / start_low];
                    self.figure("", Unit::Factor, end / start, interval, holds)
                })
            }),
            Test::Unlike { right, wrong } => self.unlike(right, wrong),
            Test::Halves { of, over } => self.halves(of, over),
            Test::Narrowest { of, over, holds } => self.narrowest(of, over, holds),
            Test::Levels { of, samples } => self.per_series(of, |s| self.levels(s, samples)),
        }
    }

    /// Returns true if the depth test lowers the adapter's count at a setting.
    fn counts(&self, setting: &SceneSetting<'a>) -> bool {
        let Some([less, more]) = self.claim.fewer else {
            return true;
        };
        let fragments = |method| self.quantity(setting, method, Quantity::Fragments);
        matches!((fragments(less), fragments(more)), (Some((less, _)), Some((more, _))) if less < more)
    }

    fn counted(&self, value: Option<f64>) -> bool {
        match (self.claim.values, value) {
            (ClaimedValues::All, _) => true,
            (ClaimedValues::Between(low, high), Some(v)) => (low..=high).contains(&v),
            (ClaimedValues::Between(..), None) => false,
        }
    }

    /// Returns the figure at each setting that counts, if it has one.
    fn at_settings(
        &self,
        figure: impl Fn(&SceneSetting<'a>) -> Option<(Unit, f64, [f64; 2], FigureCondition)>,
    ) -> Vec<Found<'a>> {
        let settings = self.scene.settings().into_iter();
        let counted = settings.filter(|s| self.counted(s.parameter.map(|(_, value)| value)));
        let found = counted.filter_map(|s| {
            let (unit, value, interval, holds) = figure(&s)?;
            let finite = value.is_finite() && interval.iter().all(|v| v.is_finite());
            finite.then(|| {
                let figure = self.figure(&s.text(), unit, value, interval, holds);
                (Some(s), figure)
            })
        });
        found.collect()
    }

    /// Returns a figure of each curve of a method.
    fn per_series(
        &self,
        method: &str,
        figure: impl Fn(&MethodSeries<'a>) -> Option<CaseFigure>,
    ) -> Vec<Found<'a>> {
        let series = self.scene.series.iter().filter(|s| s.method == method);
        series.filter_map(|s| Some((None, figure(s)?))).collect()
    }

    fn figure(
        &self,
        setting: &str,
        unit: Unit,
        value: f64,
        interval: [f64; 2],
        holds: FigureCondition,
    ) -> CaseFigure {
        CaseFigure {
            scene: self.scene.name.to_owned(),
            setting: setting.to_owned(),
            adapter: self.name.to_owned(),
            unit,
            value,
            interval,
            holds: Holds::of(|v| holds.met(v), value, interval),
        }
    }

    fn told(&self, setting: &str, text: String, holds: bool) -> CaseFigure {
        CaseFigure {
            holds: holds.into(),
            ..self.figure(
                setting,
                Unit::Text(text),
                0.0,
                [0.0; 2],
                FigureCondition::AtMost(0.0),
            )
        }
    }

    fn point(&self, setting: &SceneSetting<'a>, method: &str) -> Option<&SeriesPoint<'a>> {
        let series = self.scene.series.iter().filter(|s| s.method == method);
        let mut points = series.flat_map(|s| s.on(self.adapter).map(move |p| (s, p)));
        points.find_map(|(s, p)| (s.setting(p) == *setting).then_some(p))
    }

    fn quantity(
        &self,
        setting: &SceneSetting<'a>,
        method: &str,
        quantity: Quantity,
    ) -> Option<(f64, [f64; 2])> {
        measured(self.point(setting, method)?, quantity)
    }

    /// Returns a sum over methods, or `None` unless all of them were measured.
    fn sum(
        &self,
        setting: &SceneSetting<'a>,
        terms: &[(&str, f64)],
        quantity: Quantity,
    ) -> Option<(f64, [f64; 2])> {
        let mut sum = (0.0, [0.0; 2]);
        for (method, sign) in terms {
            let (value, [low, high]) = self.quantity(setting, method, quantity)?;
            sum.0 += sign * value;
            let ends = if *sign < 0.0 {
                [high, low]
            } else {
                [low, high]
            };
            sum.1[0] += sign * ends[0];
            sum.1[1] += sign * ends[1];
        }
        Some(sum)
    }

    /// Returns the points of a curve that count, in order.
    fn points<'p>(&self, series: &'p MethodSeries<'a>) -> Vec<&'p SeriesPoint<'a>> {
        let times = series.on(self.adapter);
        times
            .filter(|p| p.value.is_some() && self.counted(p.value))
            .collect()
    }

    fn same(&self, a: &str, b: &str) -> Vec<Found<'a>> {
        let settings = self.scene.settings().into_iter();
        let found = settings.filter_map(|s| {
            let [first, other] = [a, b].map(|method| {
                let distance = self.point(&s, method)?.measured.distance;
                Some((distance.rmse, distance.max))
            });
            let (first, other) = (first?, other?);
            let text = if first == other {
                "the same".to_owned()
            } else {
                format!("RMSE {} and {}", share(first.0), share(other.0))
            };
            let figure = self.told(&s.text(), text, first == other);
            Some((Some(s), figure))
        });
        found.collect()
    }

    /// Compares two methods at each value at which both were measured.
    fn unlike(&self, right: &str, wrong: &str) -> Vec<Found<'a>> {
        let settings = self.scene.settings().into_iter();
        let pairs: Vec<(f64, f64)> = settings
            .filter_map(|s| {
                let [a, b] = [right, wrong].map(|m| self.quantity(&s, m, Quantity::Rmse));
                Some((a?.0, b?.0))
            })
            .collect();
        if pairs.is_empty() {
            return Vec::new();
        }
        let [first, second] = [
            pairs.iter().filter(|p| p.0 <= LIMIT).count(),
            pairs.iter().filter(|p| p.1 <= LIMIT).count(),
        ];
        let compared = pairs.len();
        let text = format!("{right} right at {first} of {compared}, {wrong} at {second}");
        vec![(
            None,
            self.told("", text, first == compared && second < compared),
        )]
    }

    /// Compares each value of one method with twice the value of the other.
    fn halves(&self, method: &str, over: &str) -> Vec<Found<'a>> {
        let curve = |method: &str| -> Vec<(f64, f64, u32)> {
            let series = self.scene.series.iter().filter(|s| s.method == method);
            series
                .flat_map(|s| s.on(self.adapter))
                .filter_map(|p| Some((p.value?, p.error()?, p.measured.passes)))
                .collect()
        };
        let double = curve(over);
        let figures = curve(method)
            .into_iter()
            .filter_map(|(value, error, passes)| {
                let (_, twice_error, twice) = double.iter().find(|d| d.0 == 2.0 * value)?;
                let factor = (*twice_error > 0.0).then(|| error / twice_error)?;
                let half = passes < *twice && passes <= twice.div_ceil(2) + 2;
                let text = format!("{twice} → {passes} passes, RMSE ×{}", digits(factor, 2));
                let place = format!("{} against {}", digits(value, 3), digits(2.0 * value, 3));
                Some((None, self.told(&place, text, half && factor <= ALIKE)))
            });
        figures.collect()
    }

    /// Returns the first value after which a curve stays within the limit, `Some(None)` if it never does, and
    /// `None` if it has too few points to decide.
    fn resolved(&self, series: &MethodSeries<'a>) -> Option<Option<f64>> {
        let curve = series.curve(self.adapter);
        let ratio = curve.last()?.0 / curve.first()?.0;
        match breaks::find(&curve, ratio >= 20.0)? {
            Break::Never => Some(Some(curve.first()?.0)),
            Break::Always => Some(None),
            Break::Crossings(crossings) => {
                Some(crossings.last().filter(|c| !c.leaves).map(|c| c.value))
            }
        }
    }

    fn narrowest(
        &self,
        narrow: &'static str,
        wide: &'static str,
        holds: FigureCondition,
    ) -> Vec<Found<'a>> {
        let curves = |method: &'static str| {
            let series = self.scene.series.iter();
            series.filter(move |s| s.method == method)
        };
        let mut found = Vec::new();
        for base in curves(wide) {
            for other in curves(narrow).filter(|s| s.variant == base.variant) {
                // Only curves over the same values are compared.
                let same = base.values() == other.values();
                let (Some(a), Some(b)) = (self.resolved(other), self.resolved(base)) else {
                    continue;
                };
                let figure = match (a, b) {
                    _ if !same => continue,
                    // Neither method resolves any value.
                    (None, None) => continue,
                    (Some(a), Some(b)) => self.figure("", Unit::Factor, a / b, [a / b; 2], holds),
                    (Some(a), None) => {
                        self.told("", format!("{} against none", digits(a, 2)), holds.met(0.0))
                    }
                    (None, Some(b)) => self.told(
                        "",
                        format!("none against {}", digits(b, 2)),
                        holds.met(f64::INFINITY),
                    ),
                };
                found.push((None, figure));
            }
        }
        found
    }

    fn levels(&self, series: &MethodSeries<'a>, samples: u32) -> Option<CaseFigure> {
        let curve = series.curve(self.adapter);
        let range = |halves: bool| {
            let among = move |v: f64| {
                let steps = v * f64::from(2 * samples);
                (steps - steps.round()).abs() < 1e-6 && (steps.round() % 2.0 == 1.0) == halves
            };
            let values = curve.iter().filter(move |(v, _)| among(*v));
            values.map(|(_, e)| *e)
        };
        let on = range(false).reduce(f64::max)?;
        let between = range(true).reduce(f64::min)?;
        let text = format!(
            "at most {} on levels, at least {} between",
            share(on),
            share(between)
        );
        Some(self.told("", text, on <= 0.005 && between >= 4.0 * on))
    }
}

/// Returns a quantity of one record with its interval.
fn measured(point: &SeriesPoint<'_>, quantity: Quantity) -> Option<(f64, [f64; 2])> {
    let exact = |v: f64| (v, [v; 2]);
    let m = point.measured;
    match quantity {
        Quantity::Rmse => point.error().map(exact),
        Quantity::Largest => Some(m.distance.max).filter(|v| usable(*v)).map(exact),
        Quantity::Passes => Some(exact(f64::from(m.passes))),
        Quantity::Draws => Some(exact(f64::from(m.draws))),
        Quantity::Fragments => m.fragments.map(|n| exact(n as f64)),
        // A time without an interval does not show its uncertainty.
        Quantity::Time => Some((point.wall()?, point.interval()?)),
    }
}
