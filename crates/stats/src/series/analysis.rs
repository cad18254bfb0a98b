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
    /// The steps between levels, by their run.
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
    // Needs the levels of the whole series, which `analyze` might not see.
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
    /// That is the change before the last one that a whole window of runs has followed.
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
        let settled_points = self.points.iter().take_while(|point| point.index <= start);
        let mut points: Vec<ChangePoint> = settled_points.copied().collect();
        points.append(&mut tail.points);
        mark_returns(&mut points);
        let settled_drifts = self.drifts.iter().take_while(|drift| drift.to <= start);
        let mut drifts: Vec<Drift> = settled_drifts.copied().collect();
        drifts.append(&mut tail.drifts);
        Ok(Self {
            points,
            drifts,
            noise: tail.noise,
            runs: runs.len(),
        })
    }
}

/// The logarithms of a series.
struct Logs {
    /// The times as measured.
    measured: Sums,
    /// The times without a drift over the whole series.
    level: Sums,
    /// The ruler's, if every run has a ruler.
    ruler: Option<RulerLogs>,
}

/// The logarithms that need a ruler.
struct RulerLogs {
    /// The ruler's times as measured.
    measured: Sums,
    /// The ruler's times without a drift over the whole series.
    level: Sums,
    /// The times in units of the ruler, without a drift over the whole series.
    ruled: Sums,
}

/// The places at which a series changes.
struct ChangePlaces {
    /// As measured.
    measured: Vec<usize>,
    /// In units of the ruler; empty without a ruler.
    ruled: Vec<usize>,
}

/// A place at which a series can change.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct ChangeCandidate {
    place: usize,
    /// True if the change shows in units of the ruler only.
    is_hidden: bool,
}

/// Returns the places at which a series changes, and the series without its drift. If the series looks like
/// stairs with the same drift in each step, the places are found again without that drift.
fn places_and_level(sums: Sums) -> (Vec<usize>, Sums) {
    let places = segmentation::places(&sums);
    match sums.without_drift(&places) {
        Some(level) => (segmentation::places(&level), level),
        None => (places, sums),
    }
}

impl Logs {
    fn new(points: &[TimedRun]) -> (Self, ChangePlaces) {
        let times: Vec<f64> = points.iter().map(|p| p.median.ln()).collect();
        let quantile = upper_normal((1.0 - CONFIDENCE) / 2.0);
        let error = |p: &TimedRun| {
            p.interval
                .map_or(0.0, |[low, high]| (high / low).ln() / 2.0 / quantile)
        };
        let errors: Vec<f64> = points.iter().map(error).collect();
        let measured = || Sums::new(clean(&times), &errors);
        let (places, level) = places_and_level(measured());
        let rulers: Option<Vec<f64>> = points.iter().map(|p| Some(p.ruler?.ln())).collect();
        let mut ruled_places = Vec::new();
        let ruler = rulers.map(|rulers| {
            let ruled: Vec<f64> = times.iter().zip(&rulers).map(|(t, r)| t - r).collect();
            let ruled = Sums::new(clean(&ruled), &errors);
            let (places_in_ruler, ruled) = places_and_level(ruled);
            ruled_places = places_in_ruler;
            let measured = || Sums::new(clean(&rulers), &vec![0.0; rulers.len()]);
            RulerLogs {
                level: measured().without_drift(&places).unwrap_or_else(measured),
                measured: measured(),
                ruled,
            }
        });
        let logs = Self {
            measured: measured(),
            level,
            ruler,
        };
        let places = ChangePlaces {
            measured: places,
            ruled: ruled_places,
        };
        (logs, places)
    }

    /// Returns the tests of a step as measured, in units of the ruler, and of the ruler.
    fn tests(&self, [from, place, to]: [usize; 3]) -> (ShiftTest, Option<[ShiftTest; 2]>) {
        let measured = segmentation::test(&self.level, from, place, to);
        let ruler = self.ruler.as_ref().map(|ruler| {
            let ruled = segmentation::test(&ruler.ruled, from, place, to);
            [ruled, ruler.level.step(from, place, to)]
        });
        (measured, ruler)
    }

    fn cause(&self, around: [usize; 3]) -> Cause {
        match self.tests(around) {
            (measured, Some([ruled, ruler])) => Cause::of(&measured, &ruled, &ruler),
            (_, None) => Cause::NoRuler,
        }
    }
}

fn analyze(points: &[TimedRun]) -> Changes {
    let runs = points.len();
    let (logs, places) = Logs::new(points);
    let candidates = candidates(&logs, places, runs);
    let around = neighbourhoods(&candidates, runs).into_iter();
    let points = around
        .zip(&candidates)
        .map(|(around, candidate)| change(&logs, around, candidate.is_hidden));
    let places: Vec<usize> = candidates.iter().map(|candidate| candidate.place).collect();
    Changes {
        points: points.collect(),
        drifts: drifts(&logs, &places),
        noise: logs.level.noise(&places),
        runs,
    }
}

/// Returns the changes as measured, and the driver's changes that the machine hid: a machine whose speed changes
/// constantly hides steps of the times, but not in units of the ruler.
fn candidates(logs: &Logs, places: ChangePlaces, runs: usize) -> Vec<ChangeCandidate> {
    let ChangePlaces { measured, ruled } = places;
    let is_far = |place: &usize| {
        let mut others = measured.iter();
        others.all(|other| place.abs_diff(*other) >= MIN_RUNS)
    };
    let candidate = |is_hidden| move |place| ChangeCandidate { place, is_hidden };
    let hidden = ruled.into_iter().filter(is_far).map(candidate(true));
    let mut candidates: Vec<ChangeCandidate> = hidden.collect();
    candidates.extend(measured.into_iter().map(candidate(false)));
    candidates.sort_unstable();
    let around = neighbourhoods(&candidates, runs);
    let is_kept = |(candidate, around): &(ChangeCandidate, [usize; 3])| {
        !candidate.is_hidden || logs.cause(*around) == Cause::Driver
    };
    let pairs = candidates.into_iter().zip(around);
    pairs
        .filter(is_kept)
        .map(|(candidate, _)| candidate)
        .collect()
}

/// Returns, for each change, the previous place, its own place, and the next place.
fn neighbourhoods(candidates: &[ChangeCandidate], runs: usize) -> Vec<[usize; 3]> {
    let place = |index: usize| candidates.get(index).map_or(runs, |c| c.place);
    let before = |index: usize| index.checked_sub(1).map_or(0, place);
    (0..candidates.len())
        .map(|index| [before(index), place(index), place(index + 1)])
        .collect()
}

/// Returns the change at a place. `is_hidden` is true if it shows in units of the ruler only.
fn change(logs: &Logs, around: [usize; 3], is_hidden: bool) -> ChangePoint {
    let [from, place, to] = around;
    let (measured, ruled) = logs.tests(around);
    let (sums, test) = match (&logs.ruler, &ruled) {
        (Some(ruler), Some([test, _])) if is_hidden => (&ruler.ruled, test),
        _ => (&logs.level, &measured),
    };
    let [first, last] = sums.places(from, place, to);
    ChangePoint {
        index: place,
        between: [first - 1, last],
        before: logs.measured.mean(from, place).exp(),
        after: logs.measured.mean(place, to).exp(),
        ratio: ratio(&measured),
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
    let mut drifts = Vec::new();
    let mut from = 0;
    for to in places.iter().copied().chain([runs]) {
        if to - from >= MIN_DRIFT {
            let climb = logs.measured.climb(from, to);
            if climb.p() <= LEVEL && climb.shift.abs() >= MINIMUM.ln() {
                let ruler = logs.ruler.as_ref();
                let ruler = ruler.map(|ruler| ruler.measured.climb(from, to));
                let along = |ruler: ShiftTest| {
                    let enough = BEYOND_RULER * ruler.shift.abs() > climb.shift.abs();
                    enough && ruler.shift * climb.shift > 0.0 && ruler.p() <= LEVEL
                };
                drifts.push(Drift {
                    from,
                    to,
                    ratio: ratio(&climb),
                    machine: ruler.is_some_and(along),
                });
            }
        }
        from = to;
    }
    drifts
}

/// Marks the changes between two levels to which the series keeps returning.
fn mark_returns(points: &mut [ChangePoint]) {
    let Some(first) = points.first() else {
        return;
    };
    let after = points.iter().map(|point| point.after);
    let levels: Vec<f64> = [first.before]
        .into_iter()
        .chain(after)
        .map(f64::ln)
        .collect();
    for (index, point) in points.iter_mut().enumerate() {
        let reach = (point.ratio.high / point.ratio.low).ln() / 2.0;
        let tolerance = reach.max(STEP.ln());
        let times = |level: f64| {
            let levels = levels.iter();
            levels.filter(|l| (*l - level).abs() <= tolerance).count()
        };
        // If both levels are within reach of each other, returning means nothing.
        let apart = (levels[index + 1] - levels[index]).abs() > 2.0 * tolerance;
        let visits = [levels[index], levels[index + 1]].map(times);
        let unexplained = matches!(point.cause, Cause::NoRuler | Cause::Unclear);
        point.returns = unexplained
            && apart
            && visits.iter().all(|n| *n > 1)
            && visits[0] + visits[1] >= VISITS;
    }
}
