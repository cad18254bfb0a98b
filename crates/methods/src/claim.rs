//! Claims of the literature about methods, as data: what is compared, over which cases, and the condition under
//! which a claim holds.
//!
//! A claim stands beside the methods that it names, and whoever reads records checks it without knowing one of
//! them. Every comparison but [`Test::Halves`] holds two methods against each other at the same parameters of the
//! same scene on the same adapter.

/// A claim of a publication.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Claim {
    /// The claim.
    pub title: &'static str,
    /// The publication.
    pub source: &'static str,
    /// The question whose cases decide it.
    pub question: &'static str,
    /// The families of cases, by the last part of the case file's name; all of the question where there are none.
    pub families: &'static [&'static str],
    /// The values of the parameter that count.
    pub values: Values,
    /// The quantities that are compared.
    pub test: Test,
    /// Two methods of which the first must run fewer fragment shaders than the second. Adapters where it does not
    /// count fragments before the depth test, and their counts say nothing about it.
    pub fewer: Option<[&'static str; 2]>,
    /// What else the measured quantities hold, in a sentence; empty where there is nothing to say.
    pub note: &'static str,
}

/// The values of a scene's parameter that count.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Values {
    /// All of them.
    All,
    /// Those between two values, both included.
    Between(f64, f64),
}

/// A comparison and its condition.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Test {
    /// The quantity of a method.
    Value {
        /// The quantity.
        quantity: Quantity,
        /// The method.
        of: &'static str,
        /// The condition.
        holds: Condition,
    },
    /// A sum of one quantity over several methods over another such sum; each term is a method and its sign.
    Ratio {
        /// The quantity.
        quantity: Quantity,
        /// The numerator.
        of: &'static [(&'static str, f64)],
        /// The denominator.
        over: &'static [(&'static str, f64)],
        /// The condition.
        holds: Condition,
    },
    /// Two methods with the same error.
    Same {
        /// The methods.
        methods: [&'static str; 2],
    },
    /// The quantity at the largest value of the parameter over that at the smallest.
    Trend {
        /// The quantity.
        quantity: Quantity,
        /// The method.
        of: &'static str,
        /// The condition.
        holds: Condition,
    },
    /// A method that is within 1 % RMSE at every value, where another is not at some.
    Unlike {
        /// The method that is right.
        right: &'static str,
        /// The method that is wrong somewhere.
        wrong: &'static str,
    },
    /// A method that leaves at most one and a half times the error of another in half of its passes and at most two
    /// more, at half the value of the parameter.
    Halves {
        /// The method with half the value.
        of: &'static str,
        /// The method that it is held against.
        over: &'static str,
    },
    /// The smallest value of the parameter from which on a method stays within 1 % RMSE, over that of another.
    Narrowest {
        /// The method.
        of: &'static str,
        /// The method that it is held against.
        over: &'static str,
        /// The condition.
        holds: Condition,
    },
    /// A method that knows one more level of its parameter, from 0 to 1, than it has samples: within 0.5 % RMSE on
    /// levels, and at least four times as far off halfway between them.
    Levels {
        /// The method.
        of: &'static str,
        /// The number of samples.
        samples: u32,
    },
    /// The largest error times the parameter, in halves of a code of 8 bits.
    HalfCodes {
        /// The method.
        of: &'static str,
        /// The condition.
        holds: Condition,
    },
}

/// A measured quantity.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Quantity {
    /// RMSE.
    Rmse,
    /// The largest error.
    Largest,
    /// Passes.
    Passes,
    /// Draws.
    Draws,
    /// Fragment shader invocations.
    Fragments,
    /// Frame time, with its interval.
    Time,
}

/// The condition that a figure meets. A figure with an interval meets it where all of the interval does, and misses
/// it where none of it does.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Condition {
    /// Less than this, and not as much.
    Below(f64),
    /// More than this, and not as much.
    Above(f64),
    /// This or less.
    AtMost(f64),
    /// Between these two, both included.
    Between(f64, f64),
}

impl Condition {
    /// True if a figure meets it.
    pub fn met(self, figure: f64) -> bool {
        match self {
            Self::Below(limit) => figure < limit,
            Self::Above(limit) => figure > limit,
            Self::AtMost(limit) => figure <= limit,
            Self::Between(low, high) => (low..=high).contains(&figure),
        }
    }
}

impl Quantity {
    /// The name in a sentence.
    pub fn name(self) -> &'static str {
        match self {
            Self::Rmse => "RMSE",
            Self::Largest => "largest error",
            Self::Passes => "passes",
            Self::Draws => "draws",
            Self::Fragments => "fragments shaded",
            Self::Time => "frame time",
        }
    }
}

impl Claim {
    /// A claim of a question that all of its families decide, at all values.
    pub(crate) const fn new(
        question: &'static str,
        title: &'static str,
        source: &'static str,
        test: Test,
    ) -> Self {
        Self {
            title,
            source,
            question,
            families: &[],
            values: Values::All,
            test,
            fewer: None,
            note: "",
        }
    }

    /// The claim, decided by these families alone.
    pub(crate) const fn of(self, families: &'static [&'static str]) -> Self {
        Self { families, ..self }
    }

    /// The claim, at these values alone.
    pub(crate) const fn between(self, low: f64, high: f64) -> Self {
        let values = Values::Between(low, high);
        Self { values, ..self }
    }

    /// The claim with a note on what is measured.
    pub(crate) const fn noting(self, note: &'static str) -> Self {
        Self { note, ..self }
    }

    /// The claim, on adapters whose counts the depth test lowers.
    pub(crate) const fn where_fewer(self, fewer: [&'static str; 2]) -> Self {
        let fewer = Some(fewer);
        Self { fewer, ..self }
    }
}

/// The sum of one method alone.
macro_rules! one {
    ($method:literal) => {
        &[($method, 1.0)]
    };
}
pub(crate) use one;
