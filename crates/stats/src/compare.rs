//! Comparison of two benches.

use crate::rank::{MIN_ROUNDS, Shift, shift};
use crate::samples::Samples;

/// The maximum probability that two benches of the same thing are called different: the level of the
/// two-sided test behind [`compare`], for one comparison.
pub const LEVEL: f64 = 0.001;

/// The least change, as a ratio, that is worth reporting. Smaller changes come from where a program's code
/// and data happen to be in memory, and say nothing about a driver. It is part of the hypothesis: a change is
/// reported if a change of up to this size is rejected at [`LEVEL`], not if the estimate exceeds it.
pub const MINIMUM: f64 = 1.01;

/// The factor by which times must have moved farther than the ruler, in logarithms, to count as changed.
pub const BEYOND_RULER: f64 = 2.0;

/// A ratio of times, after over before, with its interval of confidence 1 - [`LEVEL`]; from 0 to infinity if
/// there are too few rounds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ratio {
    /// The estimate: the median over all pairs of rounds.
    pub estimate: f64,
    /// The lower end of the interval.
    pub low: f64,
    /// The upper end of the interval.
    pub high: f64,
}

impl From<Shift> for Ratio {
    fn from(logs: Shift) -> Self {
        Self {
            estimate: logs.estimate.exp(),
            low: logs.low.exp(),
            high: logs.high.exp(),
        }
    }
}

/// The comparison of two benches.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BenchComparison {
    /// The ratio of the times as measured.
    pub ratio: Ratio,
    /// The ratio of the times in units of the ruler, if both benches have one.
    pub ruled: Option<Ratio>,
    /// The conclusion from both ratios.
    pub outcome: Conclusion,
}

/// The conclusion that two benches allow.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Conclusion {
    /// The second bench takes less time.
    Faster,
    /// The second bench takes more time.
    Slower,
    /// The samples show neither faster nor slower.
    CannotTell(Why),
}

impl Conclusion {
    /// Returns the word for reports.
    pub fn name(self) -> &'static str {
        match self {
            Self::Faster => "faster",
            Self::Slower => "slower",
            Self::CannotTell(_) => "cannot tell",
        }
    }
}

/// The reason why neither faster nor slower is shown.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Why {
    /// One bench has fewer than [`MIN_ROUNDS`] rounds.
    TooFewRounds,
    /// If there is a change, it is smaller than [`MINIMUM`]: as close to "the same" as a comparison gets.
    Small,
    /// The times differ, but not in units of the ruler, which has moved as well: the machine itself has
    /// changed its speed.
    Drift,
    /// The times differ, but the ruler is so unsteady that the machine may have changed its speed.
    Ruler,
    /// Both no change and a change above [`MINIMUM`] are possible.
    Noise,
}

impl Why {
    /// Returns the reason in words.
    pub fn text(self) -> &'static str {
        match self {
            Self::TooFewRounds => "too few rounds: each bench needs at least 7",
            Self::Small => "any change is below 1 %",
            Self::Drift => "the machine drifted: the ruler moved along",
            Self::Ruler => "the ruler is too unsteady to rule out that the machine drifted",
            Self::Noise => "too much noise for a change of this size",
        }
    }
}

/// Compares two benches of the same case and adapter.
///
/// A change counts if the whole interval is beyond [`MINIMUM`], for the times as measured *and* for the times
/// in units of the ruler. Each test alone has the level [`LEVEL`] for two benches whose rounds are
/// exchangeable; both together can only have a smaller one. A machine that slows down moves the first and not
/// the second; a disturbed ruler moves the second and not the first.
///
/// No ruler feels a machine's speed exactly as drawing does: how much a neighbour on the same core takes away
/// depends on the work. A change must therefore also be [`BEYOND_RULER`] times as large, in logarithms, as
/// the ruler's own movement.
pub fn compare(before: &Samples, after: &Samples) -> BenchComparison {
    let raw = shift(before.logs(), after.logs(), LEVEL);
    let ruled = before.ruled().zip(after.ruled());
    let ruled = ruled.map(|(b, a)| shift(b, a, LEVEL));
    let least = MINIMUM.ln();
    let side = |s: Shift| match s {
        s if s.low > least => IntervalSide::Slower,
        s if s.high < -least => IntervalSide::Faster,
        s if s.low >= -least && s.high <= least => IntervalSide::Small,
        _ => IntervalSide::Open,
    };
    // Without a ruler, nothing confirms the times as measured.
    let guard = ruled.map_or(side(raw), side);
    let drifted = drift(before, after).is_some_and(|s| raw.estimate.abs() < BEYOND_RULER * s.abs());
    let outcome = match (side(raw), guard) {
        _ if before.rounds().min(after.rounds()) < MIN_ROUNDS => {
            Conclusion::CannotTell(Why::TooFewRounds)
        }
        (IntervalSide::Slower, IntervalSide::Slower)
        | (IntervalSide::Faster, IntervalSide::Faster)
            if drifted =>
        {
            Conclusion::CannotTell(Why::Drift)
        }
        (IntervalSide::Slower, IntervalSide::Slower) => Conclusion::Slower,
        (IntervalSide::Faster, IntervalSide::Faster) => Conclusion::Faster,
        (IntervalSide::Small, IntervalSide::Small) => Conclusion::CannotTell(Why::Small),
        (IntervalSide::Slower | IntervalSide::Faster, _) => {
            Conclusion::CannotTell(moved(before, after))
        }
        _ => Conclusion::CannotTell(Why::Noise),
    };
    BenchComparison {
        ratio: raw.into(),
        ruled: ruled.map(Ratio::from),
        outcome,
    }
}

/// Returns how much the ruler has moved, as a logarithm, if both benches have one.
fn drift(before: &Samples, after: &Samples) -> Option<f64> {
    before.ruled().zip(after.ruled())?;
    Some(shift(&before.rulers(), &after.rulers(), LEVEL).estimate)
}

/// Returns the reason why times that differ do not differ in units of the ruler.
fn moved(before: &Samples, after: &Samples) -> Why {
    let (before, after) = (before.rulers(), after.rulers());
    match shift(&before, &after, LEVEL) {
        s if s.low > 0.0 || s.high < 0.0 => Why::Drift,
        _ => Why::Ruler,
    }
}

/// The position of an interval relative to [`MINIMUM`].
enum IntervalSide {
    Slower,
    Faster,
    Small,
    Open,
}
