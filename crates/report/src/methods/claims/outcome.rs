//! The figures for and against a claim, and their conclusion.

use crate::numbers::{digits, share};

/// The figure of one case.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct CaseFigure {
    /// The family of cases.
    pub(super) scene: String,
    /// The setting; empty if the figure is of a whole curve.
    pub(super) setting: String,
    /// The adapter.
    pub(super) adapter: String,
    /// The kind of the figure's number.
    pub(super) unit: Unit,
    /// The number and the ends of its interval, which equal the number if it is exact.
    pub(super) value: f64,
    pub(super) interval: [f64; 2],
    pub(super) holds: Holds,
}

/// The unit of a figure.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Unit {
    /// A ratio of two measurements: `×0.52`.
    Factor,
    /// A fraction of full brightness.
    Share,
    /// A count of these things.
    Count(&'static str),
    /// A text in place of a number.
    Text(String),
}

/// True, false, or undecided because the figure's interval crosses the limit.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) enum Holds {
    Yes,
    No,
    Unclear,
}

impl Holds {
    /// Returns the outcome for an interval inside, outside or across a condition.
    pub(super) fn of(met: impl Fn(f64) -> bool, value: f64, [low, high]: [f64; 2]) -> Self {
        let values = [low, value, high];
        match values.iter().filter(|v| met(**v)).count() {
            3 => Self::Yes,
            0 => Self::No,
            _ => Self::Unclear,
        }
    }

    pub(super) fn sign(self) -> Option<&'static str> {
        match self {
            Self::Yes => None,
            Self::No => Some("✗"),
            Self::Unclear => Some("?"),
        }
    }
}

impl From<bool> for Holds {
    fn from(holds: bool) -> Self {
        if holds { Self::Yes } else { Self::No }
    }
}

impl CaseFigure {
    /// Returns the text of a figure without a number. Figures with equal texts can be reported together.
    pub(super) fn text(&self) -> Option<&str> {
        match &self.unit {
            Unit::Text(text) => Some(text),
            _ => None,
        }
    }

    /// Returns some figures as a range, with the interval around all of them if it is wider.
    pub(super) fn range(figures: &[&Self]) -> String {
        let Some(first) = figures.first() else {
            return String::new();
        };
        let text = |v: f64| match &first.unit {
            Unit::Factor => format!("×{}", digits(v, 3)),
            Unit::Share => share(v),
            Unit::Count(_) => digits(v, 4),
            Unit::Text(text) => text.clone(),
        };
        let ends_of = |low: fn(&Self) -> f64, high: fn(&Self) -> f64| {
            let lows = figures.iter().map(|f| low(f));
            let highs = figures.iter().map(|f| high(f));
            [
                text(lows.fold(f64::INFINITY, f64::min)),
                text(highs.fold(f64::NEG_INFINITY, f64::max)),
            ]
        };
        let ends = ends_of(|f| f.value, |f| f.value);
        let outer = ends_of(|f| f.interval[0], |f| f.interval[1]);
        let mut range = match &ends {
            [a, b] if a == b => a.clone(),
            [a, b] => format!("{a} to {b}"),
        };
        if outer != ends {
            range += &format!(" (interval {} to {})", outer[0], outer[1]);
        }
        if let Unit::Count(what) = first.unit {
            range.push(' ');
            range.push_str(what);
        }
        range
    }
}

/// The degree to which a claim was reproduced.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Reproduction {
    /// Reproduced in all cases.
    Reproduced,
    /// Reproduced in some cases: their number, and the number of all cases.
    Partly(usize, usize),
    /// Reproduced in no case, and refuted in some.
    NotReproduced,
    /// No case decides the claim.
    Undecided,
    /// No case is about the claim.
    NotMeasured,
}

impl Reproduction {
    pub(super) fn of(figures: &[CaseFigure]) -> Self {
        let count = |holds| figures.iter().filter(|f| f.holds == holds).count();
        match (count(Holds::Yes), count(Holds::No), figures.len()) {
            (_, _, 0) => Self::NotMeasured,
            (held, _, total) if held == total => Self::Reproduced,
            (0, 0, _) => Self::Undecided,
            (0, _, _) => Self::NotReproduced,
            (held, _, total) => Self::Partly(held, total),
        }
    }

    pub(super) fn text(self) -> String {
        match self {
            Self::Reproduced => "✓ reproduced".to_owned(),
            Self::Partly(held, total) => format!("≈ reproduced in {held} of {total} cases"),
            Self::NotReproduced => "✗ not reproduced".to_owned(),
            Self::Undecided => "? too close to tell".to_owned(),
            Self::NotMeasured => "– not measured".to_owned(),
        }
    }

    pub(super) fn class(self) -> &'static str {
        match self {
            Self::Reproduced => "p",
            Self::Partly(..) | Self::Undecided => "i",
            Self::NotReproduced => "o",
            Self::NotMeasured => "u",
        }
    }
}
