//! The analysis of a series.

use super::change::{Cause, ChangePoint, Drift, ratio};
use super::clean::clean;
use super::point::{PointError, TimedRun, check};
use super::segmentation::{self, WINDOW};
use super::stretch::{MIN_RUNS, STEP, ShiftTest, Sums};
use crate::compare::{BEYOND_RULER, LEVEL, MINIMUM};
use crate::rank::upper_normal;
use crate::summary::CONFIDENCE;

/// The minimum number of runs that can drift.
const MIN_DRIFT: usize = 20;

/// The number of stretches, each at one of two levels, from which on a series counts as alternating: four
/// changes between the levels.
const VISITS: usize = 5;

/// The changes of a series.
#[derive(Clone, Debug, PartialEq)]
pub struct Changes {
    /// The change points, in order.
    pub points: Vec<ChangePoint>,
    /// The stretches that drift, in order.
    pub drifts: Vec<Drift>,
    /// The deviation of a run from the level of its stretch, as a logarithm: 0.01 is 1 %.
    pub noise: f64,
    /// The runs.
    runs: usize,
}

/// Finds the change points of a series, oldest run first.
///
/// All runs must be of one case, adapter, machine and ruler. A change is reported if it lasts for at least
/// [`MIN_RUNS`] runs, its size is at least [`STEP`], and Student's test at the chosen place rules out noise
/// at [`LEVEL`] per 100 runs, with a correction for the choice of the place.
///
/// Takes n log n steps for n runs, times the number of divisions that are kept; see [`Changes::append`].
///
/// # Errors
/// If a time is not finite and above zero, or an interval does not contain its median.
pub fn change_points(points: &[TimedRun]) -> Result<Changes, PointError> {
    check(points)?;
    let mut changes = analyze(points);
    mark_returns(&mut changes.points);
    Ok(changes)
}

impl Changes {
    /// Returns the smallest step, as a ratio above 1, that will be found with probability [`crate::POWER`]
    /// once `after` runs have followed it; `None` if no step could be found, with fewer than [`MIN_RUNS`]
    /// runs before or after.
    pub fn visible(&self, after: usize) -> Option<f64> {
        let last = self.points.last().map_or(0, |point| point.index);
        let before = self.runs - last;
        let enough = before.min(after) >= MIN_RUNS;
        enough.then(|| {
            ShiftTest::of_noise(self.noise, before, after)
                .visible()
                .exp()
        })
    }

    /// Returns the first run that can still matter to later ones: [`Changes::append`] reads none before it.
    ///
    /// That is the change before the last one that at least 50 runs have followed.
    pub fn settled(&self) -> usize {
        let ends = self.points.iter().skip(1).map(|point| point.index);
        let ends = ends.chain([self.runs]);
        let long = |(_, (point, end)): &(usize, (&ChangePoint, usize))| end - point.index >= WINDOW;
        let last = self.points.iter().zip(ends).enumerate().filter(long).last();
        let before = last.and_then(|(place, _)| place.checked_sub(1));
        before.map_or(0, |place| self.points[place].index)
    }

    /// Returns the changes of a series that has grown. `runs` contains the old runs and the new ones.
    ///
    /// Runs before [`Changes::settled`] are not analysed again, so the cost grows with the runs since then
    /// and not with the history. Their changes stay as they are.
    ///
    /// # Errors
    /// As for [`change_points`].
    pub fn append(&self, runs: &[TimedRun]) -> Result<Self, PointError> {
        let start = self.settled().min(runs.len());
        check(&runs[start..])?;
        let mut tail = analyze(&runs[start..]);
        for point in &mut tail.points {
            point.index += start;
            point.between = point.between.map(|index| index + start);
        }
        for drift in &mut tail.drifts {
            drift.from += start;
            drift.to += start;
        }
        let kept = self.points.iter().take_while(|point| point.index <= start);
        let mut points: Vec<ChangePoint> = kept.copied().collect();
        points.append(&mut tail.points);
        mark_returns(&mut points);
        let kept = self.drifts.iter().take_while(|drift| drift.to <= start);
        let mut drifts: Vec<Drift> = kept.copied().collect();
        drifts.append(&mut tail.drifts);
        Ok(Self {
            points,
            drifts,
            noise: tail.noise,
            runs: runs.len(),
        })
    }
}

/// The logarithms of a series, of the ruler, and of the series in units of the ruler: as measured, and
/// without a drift over the whole series.
struct Logs {
    measured: Sums,
    measured_ruler: Option<Sums>,
    level: Sums,
    ruled: Option<[Sums; 2]>,
}

/// Returns the changes of a series, and the series without its drift. If the series looks like stairs with
/// the same drift in each step, the changes are found again without that drift.
fn without_drift(sums: Sums) -> (Vec<usize>, Sums) {
    let places = segmentation::places(&sums);
    match sums.without_drift(&places) {
        Some(level) => (segmentation::places(&level), level),
        None => (places, sums),
    }
}

impl Logs {
    /// Returns the logarithms, and the changes as measured and in units of the ruler.
    fn new(points: &[TimedRun]) -> (Self, [Vec<usize>; 2]) {
        let times: Vec<f64> = points.iter().map(|p| p.median.ln()).collect();
        let deviations = upper_normal((1.0 - CONFIDENCE) / 2.0);
        let error = |p: &TimedRun| {
            p.interval
                .map_or(0.0, |[low, high]| (high / low).ln() / 2.0 / deviations)
        };
        let errors: Vec<f64> = points.iter().map(error).collect();
        let measured = || Sums::new(clean(&times), &errors);
        let (places, level) = without_drift(measured());
        let rulers: Option<Vec<f64>> = points.iter().map(|p| Some(p.ruler?.ln())).collect();
        let Some(rulers) = rulers else {
            let logs = Self {
                measured: measured(),
                measured_ruler: None,
                level,
                ruled: None,
            };
            return (logs, [places, Vec::new()]);
        };
        let ruled: Vec<f64> = times.iter().zip(&rulers).map(|(t, r)| t - r).collect();
        let (hidden, ruled) = without_drift(Sums::new(clean(&ruled), &errors));
        let ruler = || Sums::new(clean(&rulers), &vec![0.0; rulers.len()]);
        let level_ruler = ruler().without_drift(&places).unwrap_or_else(ruler);
        let logs = Self {
            measured: measured(),
            measured_ruler: Some(ruler()),
            level,
            ruled: Some([ruled, level_ruler]),
        };
        (logs, [places, hidden])
    }

    /// Returns the tests of a step as measured, in units of the ruler, and of the ruler.
    fn tests(&self, [from, place, to]: [usize; 3]) -> (ShiftTest, Option<[ShiftTest; 2]>) {
        let raw = segmentation::test(&self.level, from, place, to);
        let ruled = self.ruled.as_ref().map(|[ruled, ruler]| {
            let ruled = segmentation::test(ruled, from, place, to);
            [ruled, ruler.step(from, place, to)]
        });
        (raw, ruled)
    }

    fn cause(&self, around: [usize; 3]) -> Cause {
        match self.tests(around) {
            (raw, Some([ruled, ruler])) => Cause::of(&raw, &ruled, &ruler),
            (_, None) => Cause::NoRuler,
        }
    }
}

fn analyze(points: &[TimedRun]) -> Changes {
    let runs = points.len();
    let (logs, [raw, hidden]) = Logs::new(points);
    // A machine whose speed changes constantly hides steps of the times, but not in units of the ruler.
    let mut found: Vec<(usize, bool)> = raw.iter().map(|place| (*place, false)).collect();
    if !hidden.is_empty() {
        let far = |place: &usize| raw.iter().all(|other| place.abs_diff(*other) >= MIN_RUNS);
        let hidden = hidden.into_iter().filter(far);
        found.extend(hidden.map(|place| (place, true)));
        found.sort_unstable();
        let around = neighbourhoods(&found, runs);
        let mut causes = around.iter().map(|around| logs.cause(*around));
        found.retain(|(_, hidden)| causes.next() == Some(Cause::Driver) || !hidden);
    }
    let around = neighbourhoods(&found, runs);
    let hidden = found.iter().map(|(_, hidden)| *hidden);
    let changes = around.iter().zip(hidden);
    let changes = changes.map(|(around, hidden)| change(&logs, *around, hidden));
    let places: Vec<usize> = found.iter().map(|(place, _)| *place).collect();
    Changes {
        points: changes.collect(),
        drifts: drifts(&logs, &places),
        noise: logs.level.noise(&places),
        runs,
    }
}

/// Returns, for each change, the previous place, its own place, and the next place.
fn neighbourhoods(found: &[(usize, bool)], runs: usize) -> Vec<[usize; 3]> {
    let place = |index: usize| found.get(index).map_or(runs, |(place, _)| *place);
    let before = |index: usize| index.checked_sub(1).map_or(0, place);
    (0..found.len())
        .map(|index| [before(index), place(index), place(index + 1)])
        .collect()
}

/// Returns the change at a place; `hidden` if it was found in units of the ruler.
fn change(logs: &Logs, around: [usize; 3], hidden: bool) -> ChangePoint {
    let [from, place, to] = around;
    let (raw, ruled) = logs.tests(around);
    let (sums, test) = match (&logs.ruled, &ruled) {
        (Some([sums, _]), Some([test, _])) if hidden => (sums, test),
        _ => (&logs.level, &raw),
    };
    let [first, last] = sums.places(from, place, to);
    ChangePoint {
        index: place,
        between: [first - 1, last],
        before: logs.measured.mean(from, place).exp(),
        after: logs.measured.mean(place, to).exp(),
        ratio: ratio(&raw),
        ruled: ruled.as_ref().map(|[ruled, _]| ratio(ruled)),
        ruler: ruled.as_ref().map(|[_, ruler]| ratio(ruler)),
        p: test.p_of_any_place(),
        visible: test.visible().exp(),
        cause: logs.cause(around),
        returns: false,
    }
}

fn drifts(logs: &Logs, places: &[usize]) -> Vec<Drift> {
    let runs = logs.measured.values().len();
    let mut found = Vec::new();
    let mut from = 0;
    for to in places.iter().copied().chain([runs]) {
        if to - from >= MIN_DRIFT {
            let climb = logs.measured.climb(from, to);
            if climb.p() <= LEVEL && climb.shift.abs() >= MINIMUM.ln() {
                let ruler = logs
                    .measured_ruler
                    .as_ref()
                    .map(|ruler| ruler.climb(from, to));
                let along = |ruler: ShiftTest| {
                    let enough = BEYOND_RULER * ruler.shift.abs() > climb.shift.abs();
                    enough && ruler.shift * climb.shift > 0.0 && ruler.p() <= LEVEL
                };
                found.push(Drift {
                    from,
                    to,
                    ratio: ratio(&climb),
                    machine: ruler.is_some_and(along),
                });
            }
        }
        from = to;
    }
    found
}

/// Marks the changes between two levels to which the series keeps returning.
fn mark_returns(points: &mut [ChangePoint]) {
    let levels: Vec<f64> = points
        .first()
        .map(|first| first.before.ln())
        .into_iter()
        .collect();
    let levels: Vec<f64> = levels
        .into_iter()
        .chain(points.iter().map(|p| p.after.ln()))
        .collect();
    for (index, point) in points.iter_mut().enumerate() {
        let reach = (point.ratio.high / point.ratio.low).ln() / 2.0;
        let near = reach.max(STEP.ln());
        let times = |level: f64| levels.iter().filter(|l| (*l - level).abs() <= near).count();
        // If both levels are within reach of each other, returning means nothing.
        let apart = (levels[index + 1] - levels[index]).abs() > 2.0 * near;
        let visits = [levels[index], levels[index + 1]].map(times);
        let open = matches!(point.cause, Cause::NoRuler | Cause::Unclear);
        point.returns =
            open && apart && visits.iter().all(|n| *n > 1) && visits[0] + visits[1] >= VISITS;
    }
}
