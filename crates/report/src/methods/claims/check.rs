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

/// The ratio of a curve's last value to its first from which on values are interpolated by their logarithms.
const LOGARITHMIC_SPAN: f64 = 20.0;

/// Passes that a method can need beside its parameter's count, such as a first and a last one.
const FURTHER_PASSES: u32 = 2;

/// The tolerance for a parameter on a half level, in half levels: parameters are read from decimal texts.
const ON_LEVEL: f64 = 1e-6;

/// The largest error of a value on a level, 1.3 codes of 8 bits, and the factor by which errors between levels
/// exceed the errors on them.
const LEVEL_ERROR: f64 = 0.005;
const LEVEL_CONTRAST: f64 = 4.0;

/// A number and the ends of its interval, which equal the number if it is exact.
#[derive(Clone, Copy, Debug, Default)]
struct Estimate {
    value: f64,
    low: f64,
    high: f64,
}

impl Estimate {
    fn exact(value: f64) -> Self {
        Self {
            value,
            low: value,
            high: value,
        }
    }

    fn plus(self, other: Self) -> Self {
        Self {
            value: self.value + other.value,
            low: self.low + other.low,
            high: self.high + other.high,
        }
    }

    fn scaled(self, factor: f64) -> Self {
        let Self { value, low, high } = self;
        let (low, high) = if factor < 0.0 {
            (high, low)
        } else {
            (low, high)
        };
        Self {
            value: factor * value,
            low: factor * low,
            high: factor * high,
        }
    }

    /// Returns the ratio; `None` unless this is at least zero and the other above zero for certain.
    fn over(self, other: Self) -> Option<Self> {
        (other.low > 0.0 && self.low >= 0.0).then(|| Self {
            value: self.value / other.value,
            low: self.low / other.high,
            high: self.high / other.low,
        })
    }

    fn is_finite(self) -> bool {
        [self.value, self.low, self.high]
            .iter()
            .all(|v| v.is_finite())
    }
}

/// The part of a curve that stays within the limit.
enum ResolvedRange {
    /// From this value on.
    From(f64),
    Nothing,
}

/// A claim and what the records show about it.
pub(super) struct Checked<'a> {
    pub(super) claim: &'static Claim,
    pub(super) figures: Vec<CaseFigure>,
    /// Adapters that count fragments before the depth test, which show nothing about a claim that depends on it.
    pub(super) counting_before_depth_test: Vec<&'a str>,
}

/// Returns the figures for and against a claim.
pub(super) fn check<'a>(claim: &'static Claim, methods: &Methods<'a>) -> Checked<'a> {
    let mut checked = Checked {
        claim,
        figures: Vec::new(),
        counting_before_depth_test: Vec::new(),
    };
    let scenes = methods.scenes().filter(|s| {
        s.question == claim.question
            && (claim.families.is_empty() || claim.families.contains(&s.name))
    });
    for scene in scenes {
        for (index, adapter) in methods.adapters.iter().enumerate() {
            let claim_check = ClaimCheck {
                claim,
                scene,
                adapter: index,
                name: adapter.name,
            };
            let mut figures = claim_check.figures();
            if figures.is_empty() {
                continue;
            }
            if claim.fewer.is_some() {
                figures.retain(|(setting, _)| {
                    let setting = setting.as_ref();
                    setting.is_some_and(|s| claim_check.depth_test_lowers_fragments(s))
                });
                if figures.is_empty() {
                    if !checked.counting_before_depth_test.contains(&adapter.name) {
                        checked.counting_before_depth_test.push(adapter.name);
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
struct ClaimCheck<'s, 'a> {
    claim: &'static Claim,
    scene: &'s SceneSeries<'a>,
    adapter: usize,
    name: &'a str,
}

/// A figure and its setting; `None` for a figure of a whole curve.
type SettingFigure<'a> = (Option<SceneSetting<'a>>, CaseFigure);

impl<'a> ClaimCheck<'_, 'a> {
    fn figures(&self) -> Vec<SettingFigure<'a>> {
        match self.claim.test {
            Test::Value {
                quantity,
                of,
                holds,
            } => self.at_settings(|s| {
                let unit = match quantity {
                    Quantity::Rmse | Quantity::Largest => Unit::Share,
                    other => Unit::Count(other.name()),
                };
                Some((unit, self.quantity(s, of, quantity)?, holds))
            }),
            Test::Ratio {
                quantity,
                of,
                over,
                holds,
            } => self.at_settings(|s| {
                let (top, bottom) = (self.sum(s, of, quantity)?, self.sum(s, over, quantity)?);
                Some((Unit::Factor, top.over(bottom)?, holds))
            }),
            Test::Same { methods: [a, b] } => self.same(a, b),
            Test::HalfCodes { of, holds } => self.at_settings(|s| {
                let (_, parameter) = s.parameter.filter(|(_, v)| *v > 0.0)?;
                let largest = self.quantity(s, of, Quantity::Largest)?.value;
                let halves = Estimate::exact(largest * parameter / HALF_CODE);
                Some((Unit::Count("halves of a code over alpha"), halves, holds))
            }),
            Test::Trend {
                quantity,
                of,
                holds,
            } => self.per_series(of, |series| {
                let points = self.points(series);
                let (first, last) = (points.first()?, points.last()?);
                let (start, end) = (measured(first, quantity)?, measured(last, quantity)?);
                let factor = end.over(start).filter(|_| points.len() > 1)?;
                Some(self.figure("", Unit::Factor, factor, holds))
            }),
            Test::Unlike { right, wrong } => self.unlike(right, wrong),
            Test::Halves { of, over } => self.halves(of, over),
            Test::Narrowest { of, over, holds } => self.narrowest(of, over, holds),
            Test::Levels { of, samples } => self.per_series(of, |s| self.levels(s, samples)),
        }
    }

    /// Returns true if the depth test lowers the adapter's count at a setting.
    fn depth_test_lowers_fragments(&self, setting: &SceneSetting<'a>) -> bool {
        let Some([less, more]) = self.claim.fewer else {
            return true;
        };
        let fragments = |method| self.quantity(setting, method, Quantity::Fragments);
        matches!((fragments(less), fragments(more)), (Some(less), Some(more)) if less.value < more.value)
    }

    /// Returns true if the claim is about a value of the parameter.
    fn is_claimed_value(&self, value: Option<f64>) -> bool {
        match (self.claim.values, value) {
            (ClaimedValues::All, _) => true,
            (ClaimedValues::Between(low, high), Some(v)) => (low..=high).contains(&v),
            (ClaimedValues::Between(..), None) => false,
        }
    }

    /// Returns the settings that the claim is about.
    fn claimed_settings(&self) -> impl Iterator<Item = SceneSetting<'a>> {
        let settings = self.scene.settings().into_iter();
        settings.filter(|s| self.is_claimed_value(s.parameter.map(|(_, value)| value)))
    }

    /// Returns the figure at each setting that the claim is about, if it has one.
    fn at_settings(
        &self,
        figure: impl Fn(&SceneSetting<'a>) -> Option<(Unit, Estimate, FigureCondition)>,
    ) -> Vec<SettingFigure<'a>> {
        let figures = self.claimed_settings().filter_map(|s| {
            let (unit, estimate, condition) = figure(&s)?;
            estimate.is_finite().then(|| {
                let figure = self.figure(&s.text(), unit, estimate, condition);
                (Some(s), figure)
            })
        });
        figures.collect()
    }

    /// Returns a figure of each curve of a method.
    fn per_series(
        &self,
        method: &str,
        figure: impl Fn(&MethodSeries<'a>) -> Option<CaseFigure>,
    ) -> Vec<SettingFigure<'a>> {
        let series = self.scene.series.iter().filter(|s| s.method == method);
        series.filter_map(|s| Some((None, figure(s)?))).collect()
    }

    fn figure(
        &self,
        setting: &str,
        unit: Unit,
        estimate: Estimate,
        condition: FigureCondition,
    ) -> CaseFigure {
        let Estimate { value, low, high } = estimate;
        CaseFigure {
            scene: self.scene.name.to_owned(),
            setting: setting.to_owned(),
            adapter: self.name.to_owned(),
            unit,
            value,
            interval: [low, high],
            holds: Holds::of(|v| condition.met(v), value, [low, high]),
        }
    }

    fn text_figure(&self, setting: &str, text: String, holds: bool) -> CaseFigure {
        CaseFigure {
            scene: self.scene.name.to_owned(),
            setting: setting.to_owned(),
            adapter: self.name.to_owned(),
            unit: Unit::Text(text),
            value: 0.0,
            interval: [0.0; 2],
            holds: holds.into(),
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
    ) -> Option<Estimate> {
        measured(self.point(setting, method)?, quantity)
    }

    /// Returns a sum over methods, or `None` unless all of them were measured.
    fn sum(
        &self,
        setting: &SceneSetting<'a>,
        terms: &[(&str, f64)],
        quantity: Quantity,
    ) -> Option<Estimate> {
        let mut sum = Estimate::default();
        for (method, sign) in terms {
            let term = self.quantity(setting, method, quantity)?;
            sum = sum.plus(term.scaled(*sign));
        }
        Some(sum)
    }

    /// Returns the points of a curve that the claim is about, in order.
    fn points<'p>(&self, series: &'p MethodSeries<'a>) -> Vec<&'p SeriesPoint<'a>> {
        let points = series.on(self.adapter);
        points
            .filter(|p| p.value.is_some() && self.is_claimed_value(p.value))
            .collect()
    }

    /// Compares the errors of two methods at each setting that the claim is about.
    fn same(&self, a: &str, b: &str) -> Vec<SettingFigure<'a>> {
        let figures = self.claimed_settings().filter_map(|s| {
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
            let figure = self.text_figure(&s.text(), text, first == other);
            Some((Some(s), figure))
        });
        figures.collect()
    }

    /// Compares two methods at each setting that the claim is about and at which both were measured.
    fn unlike(&self, right: &str, wrong: &str) -> Vec<SettingFigure<'a>> {
        let pairs: Vec<(f64, f64)> = self
            .claimed_settings()
            .filter_map(|s| {
                let [a, b] = [right, wrong].map(|m| self.quantity(&s, m, Quantity::Rmse));
                Some((a?.value, b?.value))
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
            self.text_figure("", text, first == compared && second < compared),
        )]
    }

    /// Compares a method at each value of the parameter with another method at twice the value.
    fn halves(&self, method: &str, over: &str) -> Vec<SettingFigure<'a>> {
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
                let half = passes < *twice && passes <= twice.div_ceil(2) + FURTHER_PASSES;
                let text = format!("{twice} → {passes} passes, RMSE ×{}", digits(factor, 2));
                let place = format!("{} against {}", digits(value, 3), digits(2.0 * value, 3));
                Some((
                    None,
                    self.text_figure(&place, text, half && factor <= ALIKE),
                ))
            });
        figures.collect()
    }

    /// Returns the values from which on a curve stays within the limit; `None` if it has too few points to
    /// decide.
    fn resolved(&self, series: &MethodSeries<'a>) -> Option<ResolvedRange> {
        let curve = series.curve(self.adapter);
        let ratio = curve.last()?.0 / curve.first()?.0;
        Some(match breaks::find(&curve, ratio >= LOGARITHMIC_SPAN)? {
            Break::Never => ResolvedRange::From(curve.first()?.0),
            Break::Always => ResolvedRange::Nothing,
            Break::Crossings(crossings) => match crossings.last().filter(|c| !c.leaves) {
                Some(crossing) => ResolvedRange::From(crossing.value),
                None => ResolvedRange::Nothing,
            },
        })
    }

    fn narrowest(
        &self,
        narrow: &'static str,
        wide: &'static str,
        condition: FigureCondition,
    ) -> Vec<SettingFigure<'a>> {
        use ResolvedRange::{From, Nothing};
        let curves = |method: &'static str| {
            let series = self.scene.series.iter();
            series.filter(move |s| s.method == method)
        };
        let mut figures = Vec::new();
        for base in curves(wide) {
            // Only curves over the same values are compared.
            let is_comparable =
                |s: &&MethodSeries<'a>| s.variant == base.variant && s.values() == base.values();
            for other in curves(narrow).filter(is_comparable) {
                let (Some(a), Some(b)) = (self.resolved(other), self.resolved(base)) else {
                    continue;
                };
                // A method that resolves nothing counts as infinitely wide.
                let figure = match (a, b) {
                    (Nothing, Nothing) => continue,
                    (From(a), From(b)) => {
                        let ratio = Estimate::exact(a / b);
                        if !ratio.is_finite() {
                            continue;
                        }
                        self.figure("", Unit::Factor, ratio, condition)
                    }
                    (From(a), Nothing) => {
                        let text = format!("{} against none", digits(a, 2));
                        self.text_figure("", text, condition.met(0.0))
                    }
                    (Nothing, From(b)) => {
                        let text = format!("none against {}", digits(b, 2));
                        self.text_figure("", text, condition.met(f64::INFINITY))
                    }
                };
                figures.push((None, figure));
            }
        }
        figures
    }

    fn levels(&self, series: &MethodSeries<'a>, samples: u32) -> Option<CaseFigure> {
        let curve = series.curve(self.adapter);
        let errors_at = |halves: bool| {
            let is_at = move |v: f64| {
                let steps = v * f64::from(2 * samples);
                (steps - steps.round()).abs() < ON_LEVEL && (steps.round() % 2.0 == 1.0) == halves
            };
            let values = curve.iter().filter(move |(v, _)| is_at(*v));
            values.map(|(_, e)| *e)
        };
        let worst_on_levels = errors_at(false).reduce(f64::max)?;
        let best_between = errors_at(true).reduce(f64::min)?;
        let text = format!(
            "at most {} on levels, at least {} between",
            share(worst_on_levels),
            share(best_between)
        );
        let holds =
            worst_on_levels <= LEVEL_ERROR && best_between >= LEVEL_CONTRAST * worst_on_levels;
        Some(self.text_figure("", text, holds))
    }
}

/// Returns a quantity of one record.
fn measured(point: &SeriesPoint<'_>, quantity: Quantity) -> Option<Estimate> {
    let m = point.measured;
    let exact = match quantity {
        Quantity::Rmse => point.error(),
        Quantity::Largest => Some(m.distance.max).filter(|v| usable(*v)),
        Quantity::Passes => Some(f64::from(m.passes)),
        Quantity::Draws => Some(f64::from(m.draws)),
        Quantity::Fragments => m.fragments.map(|n| n as f64),
        // A time without an interval does not show its uncertainty.
        Quantity::Time => {
            let (value, [low, high]) = (point.wall()?, point.interval()?);
            return Some(Estimate { value, low, high });
        }
    };
    exact.map(Estimate::exact)
}
