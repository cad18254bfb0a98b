//! Change points and drifts.

use crate::compare::{BEYOND_RULER, Ratio};
use crate::series::stretch::ShiftTest;

/// A run from which on a series stays at another level.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ChangePoint {
    /// The first run at the new level, from 0.
    pub index: usize,
    /// The last run that is certainly before the change and the first that is certainly after it, with a
    /// confidence of 99 % if the noise is normal: the cause came after the first of the two and not after the
    /// second.
    pub between: [usize; 2],
    /// The level before, back to the previous change: the geometric mean, with outliers clamped.
    pub before: f64,
    /// The level after, up to the next change.
    pub after: f64,
    /// The step as a ratio, after over before. On a line that drifts before and after, it is only the step.
    pub ratio: Ratio,
    /// The same ratio in units of the ruler; `None` without a ruler.
    pub ruled: Option<Ratio>,
    /// The ruler's own step at that run.
    pub ruler: Option<Ratio>,
    /// The probability that noise alone has as clear a step at any place of 100 runs.
    pub p: f64,
    /// The smallest step, as a ratio above 1, that is found with probability [`crate::POWER`] with as many
    /// runs before and after as here, and with their noise.
    pub visible: f64,
    /// The cause, by comparison with the step of the ruler.
    pub cause: Cause,
    /// True if the series alternates between the two levels at least four times: a machine with two speeds
    /// that the ruler does not feel, or a change that repeatedly came and went. Never true if the ruler
    /// identifies the cause.
    pub returns: bool,
}

impl ChangePoint {
    /// Returns true if a person should look: the machine is not the cause, and the series does not alternate.
    pub fn is_alarm(&self) -> bool {
        self.cause != Cause::Machine && !self.returns
    }
}

/// The cause of a change, according to the ruler.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Cause {
    /// The driver or the suite: the timed frames stepped, and the ruler did not.
    Driver,
    /// The machine: the ruler stepped the same way, by more than half as much.
    Machine,
    /// Driver or machine: the ruler is too unsteady to decide.
    Unclear,
    /// Driver or machine: some run has no ruler.
    NoRuler,
}

impl Cause {
    /// Returns the words for reports.
    pub fn text(self) -> &'static str {
        match self {
            Self::Driver => "the ruler stayed where it was",
            Self::Machine => "the machine's: the ruler stepped along",
            Self::Unclear => "the ruler is too unsteady to rule out the machine",
            Self::NoRuler => "no ruler was timed",
        }
    }

    /// Returns the cause of a step from its tests as measured, in units of the ruler, and of the ruler
    /// itself.
    pub(super) fn of(raw: &ShiftTest, ruled: &ShiftTest, ruler: &ShiftTest) -> Self {
        let clear = |test: &ShiftTest| test.shift.abs() > test.reach();
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

/// A stretch without a step whose times slowly rise or fall.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Drift {
    /// The first run of the stretch, from 0.
    pub from: usize,
    /// The run after the last.
    pub to: usize,
    /// The change from the first run to the last as a ratio, along a line.
    pub ratio: Ratio,
    /// True if the ruler drifts the same way, by more than half as much.
    pub machine: bool,
}

/// Returns the ratio of a shift of logarithms.
pub(super) fn ratio(test: &ShiftTest) -> Ratio {
    let reach = test.reach();
    Ratio {
        estimate: test.shift.exp(),
        low: (test.shift - reach).exp(),
        high: (test.shift + reach).exp(),
    }
}
