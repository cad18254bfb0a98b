//! Tests of a place between two stretches of a series, from running sums.

use super::clean::FLOOR;
use crate::compare::LEVEL;
use crate::rank::upper_normal;
use crate::student::{least, quantile, two_sided};
use crate::visible::POWER;

/// The minimum number of runs on each side of a change. Three in a row are a disturbance.
pub const MIN_RUNS: usize = 4;

/// The minimum step, as a ratio, that is reported as a change of a series. Over many runs, smaller steps can
/// be distinguished from noise, but mean as little as changes below [`crate::MINIMUM`] between two benches.
/// It is half of that, so that a step of 1 % is usually found.
pub const STEP: f64 = 1.005;

/// The number of runs for which [`LEVEL`] is the probability of a false change.
pub(super) const PER_RUNS: f64 = 100.0;

/// The largest correlation of neighbours that is corrected for.
const MOST_CORRELATION: f64 = 0.9;

/// Running sums of logarithms, for the moments of any stretch.
pub(super) struct Sums {
    value: Vec<f64>,
    square: Vec<f64>,
    /// Products of values with their index.
    by_index: Vec<f64>,
    /// Products of a value and the next one.
    by_next: Vec<f64>,
    /// Squares of the standard errors within runs.
    error: Vec<f64>,
    values: Vec<f64>,
    errors: Vec<f64>,
}

/// The moments of a stretch, about its mean.
#[derive(Clone, Copy)]
struct Moments {
    runs: f64,
    mean: f64,
    /// The mean index.
    middle: f64,
    squares: f64,
    /// The sum of products of value and index, and the sum of squares of the index.
    by_index: f64,
    index_squares: f64,
    /// The sum of products of neighbours.
    by_next: f64,
    error: f64,
}

/// A shift with its test.
#[derive(Clone, Copy, Debug)]
pub(super) struct ShiftTest {
    /// The step of the logarithm.
    pub(super) shift: f64,
    /// The standard error of the shift.
    pub(super) error: f64,
    /// Degrees of freedom of the error.
    pub(super) freedom: f64,
    /// The number of runs among which the place was chosen.
    runs: f64,
}

impl ShiftTest {
    /// Returns the probability of an equally clear shift at a place given in advance: Student's test.
    pub(super) fn p(&self) -> f64 {
        two_sided(self.shift.abs() / self.error, self.freedom)
    }

    /// Returns that probability for any place of [`PER_RUNS`] runs.
    pub(super) fn p_of_any_place(&self) -> f64 {
        of_any_place(self.p(), self.runs)
    }

    /// Returns half the length of the interval of the shift with a confidence of 1 - [`LEVEL`].
    pub(super) fn reach(&self) -> f64 {
        quantile(LEVEL, self.freedom) * self.error
    }

    /// Returns the test of a step with these numbers of runs before and after, given the noise.
    pub(super) fn of_noise(noise: f64, before: usize, after: usize) -> Self {
        let (m, n) = (before as f64, after as f64);
        Self {
            shift: 0.0,
            error: noise * (1.0 / m + 1.0 / n).sqrt(),
            freedom: m + n - 2.0,
            runs: m + n,
        }
    }

    /// Returns the size of a step that is found with probability [`POWER`] in noise like this.
    pub(super) fn visible(&self) -> f64 {
        let found = |t: f64| of_any_place(two_sided(t, self.freedom), self.runs) <= LEVEL;
        // As for two benches, the deviation estimated from a few runs is increased to be safe.
        let error = self.error * (1.0 + 1.0 / (2.0 * self.freedom).sqrt());
        let bound = (least(found) * error).max(STEP.ln());
        bound + upper_normal(1.0 - POWER) * error
    }
}

/// Returns the probability that the clearest place among `runs` has a test with a probability of at most `p`,
/// given one such stretch in every [`PER_RUNS`] runs.
///
/// The tests of neighbouring places depend on each other; over all places they behave like an
/// Ornstein–Uhlenbeck process over the logarithm of the odds of the place. The probability that this exceeds
/// a bound is given by Csörgő and Horváth (1997, 1.3.26).
fn of_any_place(p: f64, runs: f64) -> f64 {
    if p < 1e-290 {
        return 0.0;
    }
    let least = MIN_RUNS as f64;
    let span = 2.0 * ((runs - least) / least).ln().max(0.0);
    let z = upper_normal(p.min(1.0) / 2.0);
    let places = ((z * z - 1.0) * span + 4.0) / 2.0;
    let stretches = PER_RUNS / runs;
    (p * places.max(1.0) * stretches.max(1.0)).min(1.0)
}

impl Sums {
    /// Returns the sums of logarithms, with the standard error of each within its run.
    pub(super) fn new(values: Vec<f64>, errors: &[f64]) -> Self {
        let sums = |each: &dyn Fn(usize) -> f64| {
            let mut sum = 0.0;
            let mut sums = vec![0.0];
            sums.extend((0..values.len()).map(|i| {
                sum += each(i);
                sum
            }));
            sums
        };
        let next = |i: usize| values.get(i + 1).map_or(0.0, |next| values[i] * next);
        Self {
            value: sums(&|i| values[i]),
            square: sums(&|i| values[i] * values[i]),
            by_index: sums(&|i| values[i] * i as f64),
            by_next: sums(&next),
            error: sums(&|i| errors[i] * errors[i]),
            values,
            errors: errors.to_vec(),
        }
    }

    /// Returns the sums without the slope that all stretches between places share, if there is one.
    pub(super) fn without_drift(&self, places: &[usize]) -> Option<Self> {
        let mut from = 0;
        let (mut by_index, mut index_squares, mut squares, mut by_next, mut error) =
            (0.0, 0.0, 0.0, 0.0, 0.0);
        for to in places.iter().copied().chain([self.values.len()]) {
            if to > from {
                let part = self.moments(from, to);
                by_index += part.by_index;
                index_squares += part.index_squares;
                squares += part.squares;
                by_next += part.by_next;
                error += part.error;
            }
            from = to;
        }
        let runs = self.values.len() as f64;
        let freedom = runs - places.len() as f64 - 2.0;
        if freedom < 1.0 || index_squares <= 0.0 {
            return None;
        }
        let slope = by_index / index_squares;
        let explained = slope * by_index;
        let left = (squares - explained).max(0.0);
        let variance = variance(left, by_next - explained, error, runs, freedom);
        let drifts = two_sided(slope.abs() / (variance / index_squares).sqrt(), freedom) <= LEVEL;
        drifts.then(|| {
            let values = self.values.iter().enumerate();
            let level = values.map(|(i, value)| value - slope * i as f64);
            Self::new(level.collect(), &self.errors)
        })
    }

    /// Returns all values.
    pub(super) fn values(&self) -> &[f64] {
        &self.values
    }

    /// Returns the mean of a stretch.
    pub(super) fn mean(&self, from: usize, to: usize) -> f64 {
        (self.value[to] - self.value[from]) / (to - from) as f64
    }

    fn moments(&self, from: usize, to: usize) -> Moments {
        let between = |sums: &[f64]| sums[to] - sums[from];
        let runs = (to - from) as f64;
        let sum = between(&self.value);
        let mean = sum / runs;
        let middle = (from + to - 1) as f64 / 2.0;
        let (first, last) = (self.values[from], self.values[to - 1]);
        let neighbours = self.by_next[to - 1] - self.by_next[from];
        Moments {
            runs,
            mean,
            middle,
            squares: (between(&self.square) - sum * mean).max(0.0),
            by_index: between(&self.by_index) - middle * sum,
            index_squares: runs * (runs * runs - 1.0) / 12.0,
            by_next: neighbours - mean * (2.0 * sum - first - last) + (runs - 1.0) * mean * mean,
            error: between(&self.error),
        }
    }

    /// Returns the sum of the squares of a stretch around its mean.
    pub(super) fn squares(&self, from: usize, to: usize) -> f64 {
        self.moments(from, to).squares
    }

    /// Returns the deviation of a run's value, in stretches between places.
    pub(super) fn noise(&self, places: &[usize]) -> f64 {
        let runs = self.values.len();
        let mut sums = [0.0; 3];
        let mut from = 0;
        for to in places.iter().copied().chain([runs]).filter(|to| *to > 0) {
            let part = self.moments(from, to);
            sums[0] += part.squares;
            sums[1] += part.by_next;
            sums[2] += part.error;
            from = to;
        }
        let freedom = runs.saturating_sub(places.len() + 1).max(1);
        variance(
            sums[0],
            sums[1],
            sums[2],
            runs.max(1) as f64,
            freedom as f64,
        )
        .sqrt()
    }

    /// Returns the step at a place between two levels, for independent runs.
    pub(super) fn plain_step(&self, from: usize, place: usize, to: usize) -> ShiftTest {
        self.step_with(from, place, to, 0.0)
    }

    /// Returns the step at a place between two levels.
    pub(super) fn step(&self, from: usize, place: usize, to: usize) -> ShiftTest {
        self.step_with(from, place, to, 1.0)
    }

    /// Returns the step at a place; `dependence` is the share of the neighbours' correlation that is
    /// corrected for.
    fn step_with(&self, from: usize, place: usize, to: usize, dependence: f64) -> ShiftTest {
        let (a, b) = (self.moments(from, place), self.moments(place, to));
        let runs = a.runs + b.runs;
        let freedom = runs - 2.0;
        let variance = variance(
            a.squares + b.squares,
            dependence * (a.by_next + b.by_next),
            a.error + b.error,
            runs,
            freedom,
        );
        ShiftTest {
            shift: b.mean - a.mean,
            error: (variance * (1.0 / a.runs + 1.0 / b.runs)).sqrt(),
            freedom,
            runs,
        }
    }

    /// Returns the step at a place of a line.
    pub(super) fn step_of_line(&self, from: usize, place: usize, to: usize) -> ShiftTest {
        let (a, b) = (self.moments(from, place), self.moments(place, to));
        let runs = a.runs + b.runs;
        let freedom = runs - 3.0;
        let index_squares = a.index_squares + b.index_squares;
        let by_index = a.by_index + b.by_index;
        let slope = by_index / index_squares;
        let explained = slope * by_index;
        let variance = variance(
            (a.squares + b.squares - explained).max(0.0),
            a.by_next + b.by_next - explained,
            a.error + b.error,
            runs,
            freedom,
        );
        let apart = b.middle - a.middle;
        let parts = 1.0 / a.runs + 1.0 / b.runs + apart * apart / index_squares;
        ShiftTest {
            shift: b.mean - a.mean - slope * apart,
            error: (variance * parts).sqrt(),
            freedom,
            runs,
        }
    }

    /// Returns true if a line through all runs fits better than two levels with a step between them.
    pub(super) fn is_rather_a_line(&self, from: usize, place: usize, to: usize) -> bool {
        let levels = self.squares(from, place) + self.squares(place, to);
        let moments = self.moments(from, to);
        moments.squares - moments.by_index * moments.by_index / moments.index_squares < levels
    }

    /// Returns the test of the slope of a stretch: its rise from the first run to the last.
    pub(super) fn climb(&self, from: usize, to: usize) -> ShiftTest {
        let moments = self.moments(from, to);
        let slope = moments.by_index / moments.index_squares;
        let explained = slope * moments.by_index;
        let freedom = moments.runs - 2.0;
        let left = (moments.squares - explained).max(0.0);
        let next = moments.by_next - explained;
        let variance = variance(left, next, moments.error, moments.runs, freedom);
        let length = moments.runs - 1.0;
        ShiftTest {
            shift: slope * length,
            error: (variance / moments.index_squares).sqrt() * length,
            freedom,
            runs: moments.runs,
        }
    }

    /// Returns the first and the last place that a step between two neighbours could also have, with a
    /// confidence of 99 %: the places whose likelihood ratio to the best is not above Yao's (1987)
    /// distribution of it.
    pub(super) fn places(&self, from: usize, place: usize, to: usize) -> [usize; 2] {
        let left = |p: usize| self.squares(from, p) + self.squares(p, to);
        let best = left(place);
        let variance = (best / (to - from - 2) as f64).max(FLOOR * FLOOR);
        // P(ratio <= x) = (1 - exp(-x / 2))^2.
        let most = -2.0 * (1.0 - crate::CONFIDENCE.sqrt()).ln();
        let mut open = (from + 1..to).filter(|p| (left(*p) - best) / variance <= most);
        let first = open.next().unwrap_or(place).min(place);
        [first, open.next_back().unwrap_or(place).max(place)]
    }

    /// Returns the place between two neighbours that leaves the smallest sum of squares.
    pub(super) fn best_place(&self, from: usize, place: usize, to: usize) -> usize {
        let left = |p: usize| self.squares(from, p) + self.squares(p, to);
        let mut best = (left(place), place);
        for other in from + MIN_RUNS..=to - MIN_RUNS {
            // Rounding errors of the sums must not move a place.
            let squares = left(other);
            if squares < best.0 - 1e-12 {
                best = (squares, other);
            }
        }
        best.1
    }
}

/// Returns the variance of a run's value, enlarged if neighbours correlate, since each then says less.
///
/// It is never below what the intervals within runs imply, so that a few runs that happen to agree do not
/// count as exact.
fn variance(squares: f64, by_next: f64, error: f64, runs: f64, freedom: f64) -> f64 {
    let measured = squares / freedom;
    let correlation = if squares > 0.0 {
        by_next / squares
    } else {
        0.0
    };
    // For independent runs, the correlation is almost always this small.
    let correlation = if correlation > 2.0 / runs.sqrt() {
        correlation.min(MOST_CORRELATION)
    } else {
        0.0
    };
    let enlarged = measured * (1.0 + correlation) / (1.0 - correlation);
    enlarged.max(error / runs).max(FLOOR * FLOOR)
}

#[cfg(test)]
mod tests {
    use super::*;
    use oorandom::Rand64;

    fn normal(random: &mut Rand64) -> f64 {
        let radius = (-2.0 * (1.0 - random.rand_float()).ln()).sqrt();
        radius * (std::f64::consts::TAU * random.rand_float()).cos()
    }

    fn sums(values: &[f64]) -> Sums {
        Sums::new(values.to_vec(), &vec![0.0; values.len()])
    }

    #[test]
    fn student_s_test_gives_the_textbook_value() {
        // Means 3 and 6, variances 2.5 each: t = -3 / sqrt(2.5 * (2 / 5)) = -3, p = 0.0171 at 8 degrees.
        let test = sums(&[1.0, 2.0, 5.0, 3.0, 4.0, 8.0, 4.0, 6.0, 7.0, 5.0]).step(0, 5, 10);
        assert!((test.shift - 3.0).abs() < 1e-12);
        assert!((test.error - 1.0).abs() < 1e-12);
        assert!((test.p() - 0.0171).abs() < 1e-4, "{}", test.p());
        assert!(test.p_of_any_place() > test.p());
    }

    #[test]
    fn a_line_has_no_step_and_a_step_on_a_line_keeps_its_size() {
        let mut random = Rand64::new(3);
        let mut series = |step: f64| -> Vec<f64> {
            (0..60)
                .map(|i| {
                    0.01 * f64::from(i)
                        + if i < 30 { 0.0 } else { step }
                        + 0.01 * normal(&mut random)
                })
                .collect()
        };
        let line = sums(&series(0.0));
        assert!(line.is_rather_a_line(0, 30, 60));
        assert!(line.step_of_line(0, 30, 60).p() > 0.01);
        assert!((line.climb(0, 60).shift - 0.59).abs() < 0.02);
        let both = sums(&series(0.1)).step_of_line(0, 30, 60);
        assert!((both.shift - 0.1).abs() < both.reach(), "{both:?}");
        assert!(both.p_of_any_place() < LEVEL);
        let step: Vec<f64> = series(0.0)
            .iter()
            .enumerate()
            .map(|(i, v)| v - 0.01 * i as f64 + if i < 20 { 0.0 } else { 0.1 })
            .collect();
        assert!(!sums(&step).is_rather_a_line(0, 20, 60));
        let [first, last] = sums(&step).places(0, 20, 60);
        assert!(
            first <= 20 && 20 <= last && last - first <= 3,
            "{first} {last}"
        );
        assert_eq!(sums(&step).best_place(0, 23, 60), 20);
    }

    #[test]
    fn noise_has_a_clear_place_as_rarely_as_the_level_says() {
        // The approximation can have fewer false changes, but not many more.
        let (mut found, trials) = (0.0, 4000);
        let runs = 100;
        let mut random = Rand64::new(9);
        for _ in 0..trials {
            let values: Vec<f64> = (0..runs).map(|_| normal(&mut random)).collect();
            let sums = sums(&values);
            let places = MIN_RUNS..=runs - MIN_RUNS;
            let least = places
                .map(|p| sums.step(0, p, runs).p())
                .fold(1.0, f64::min);
            found += if of_any_place(least, runs as f64) <= 0.05 {
                1.0
            } else {
                0.0
            };
        }
        let share = found / f64::from(trials);
        assert!((0.015..=0.06).contains(&share), "{share}");
    }

    #[test]
    fn neighbours_that_resemble_each_other_count_less() {
        let mut random = Rand64::new(4);
        let mut value = 0.0;
        let kept: Vec<f64> = (0..200)
            .map(|_| {
                value = 0.8 * value + 0.6 * normal(&mut random);
                value
            })
            .collect();
        let fresh: Vec<f64> = (0..200).map(|_| normal(&mut random)).collect();
        let error_of = |values: &[f64]| sums(values).step(0, 100, 200).error;
        assert!(
            error_of(&kept) > 2.0 * error_of(&fresh),
            "{} {}",
            error_of(&kept),
            error_of(&fresh)
        );
    }
}
