//! Change points and drifts.

use crate::compare::{BEYOND_RULER, Ratio};
use crate::series::stretch::Test;

/// A run from which on a series stays at another level.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ChangePoint {
    /// The first run at the new level, from 0.
    pub index: usize,
    /// The last run that is before the change and the first that is after it, with a confidence of 99 % where
    /// the noise is normal: what changed came after the first of the two and not after the second.
    pub between: [usize; 2],
    /// The level before, back to the change before: the geometric mean, single runs that stand out clamped.
    pub before: f64,
    /// The level after, up to the next change.
    pub after: f64,
    /// The step as a ratio, after over before. On a line, which drifts before and after, it is the step alone.
    pub ratio: Ratio,
    /// The same in units of the ruler.
    pub ruled: Option<Ratio>,
    /// The ruler's own step there.
    pub ruler: Option<Ratio>,
    /// The probability with which noise alone has as clear a step at any place of 100 runs.
    pub p: f64,
    /// The smallest step, as a ratio above 1, that is found with probability [`crate::POWER`] between as many runs
    /// as lie before and after this one, in the noise that they have.
    pub visible: f64,
    /// The cause.
    pub cause: Cause,
    /// True if the series goes back and forth between the two levels, four times or more: a machine with two paces that
    /// the ruler does not feel, or a change that came and went again and again. Never where the ruler tells which.
    pub returns: bool,
}

impl ChangePoint {
    /// True if somebody should look: the change is not the machine's, and the series does not go back and forth.
    pub fn is_alarm(&self) -> bool {
        self.cause != Cause::Machine && !self.returns
    }
}

/// The cause of a change, as far as the ruler tells it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Cause {
    /// The timed frames stepped, and not the ruler: the driver, or the suite.
    Driver,
    /// The machine: the ruler steps the same way, and by more than half as much.
    Machine,
    /// Either: the ruler is too unsteady to tell.
    Unclear,
    /// Either: some run has no ruler.
    NoRuler,
}

impl Cause {
    /// The words in reports.
    pub fn text(self) -> &'static str {
        match self {
            Self::Driver => "the ruler stayed where it was",
            Self::Machine => "the machine's: the ruler stepped along",
            Self::Unclear => "the ruler is too unsteady to rule out the machine",
            Self::NoRuler => "no ruler was timed",
        }
    }

    /// The cause of a step as measured, in units of the ruler, and of the ruler itself.
    pub(super) fn of(raw: &Test, ruled: &Test, ruler: &Test) -> Self {
        let clear = |test: &Test| test.shift.abs() > test.reach();
        let beyond = raw.shift.abs() >= BEYOND_RULER * ruler.shift.abs();
        let (of_whom, cause) = if beyond {
            (ruled, Self::Driver)
        } else {
            (ruler, Self::Machine)
        };
        if clear(of_whom) && of_whom.shift * raw.shift > 0.0 {
            cause
        } else {
            Self::Unclear
        }
    }
}

/// A stretch without a step whose times climb or fall slowly.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Drift {
    /// The first run.
    pub from: usize,
    /// The run after the last.
    pub to: usize,
    /// The change from the first run to the last as a ratio, along a line.
    pub ratio: Ratio,
    /// True if the ruler drifts the same way, and by more than half as much.
    pub machine: bool,
}

/// The ratio of a shift of logarithms.
pub(super) fn ratio(test: &Test) -> Ratio {
    let reach = test.reach();
    Ratio {
        estimate: test.shift.exp(),
        low: (test.shift - reach).exp(),
        high: (test.shift + reach).exp(),
    }
}
