//! Claims of the literature about methods, as data: the quantities that are compared, the cases that are
//! compared, and the condition under which a claim holds.
//!
//! Claims are defined in the modules of the methods that they name. Code that checks them needs no
//! knowledge of the methods. Every comparison except [`Test::Halves`] compares two methods at the same
//! parameters of the same scene on the same adapter.

/// A claim of a publication.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Claim {
    /// The claim.
    pub title: &'static str,
    /// The publication.
    pub source: &'static str,
    /// The question whose cases decide it.
    pub question: &'static str,
    /// The families of cases, by the last part of the case file's name; all families of the question if
    /// empty.
    pub families: &'static [&'static str],
    /// The values of the parameter that count.
    pub values: ClaimedValues,
    /// The quantities that are compared.
    pub test: Test,
    /// Two methods; the claim is decided only on adapters on which the first method runs fewer fragment
    /// shaders than the second. Other adapters count fragments before the depth test, so their counts say
    /// nothing about the claim.
    pub fewer: Option<[&'static str; 2]>,
    /// A sentence about what else the measured quantities include; empty if there is nothing to add.
    pub note: &'static str,
}

/// The values of a scene's parameter that count.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ClaimedValues {
    /// All values.
    All,
    /// Values between two bounds, inclusive.
    Between(f64, f64),
}

/// A comparison and its condition.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Test {
    /// The quantity of one method.
    Value {
        /// The measured quantity.
        quantity: Quantity,
        /// The method.
        of: &'static str,
        /// The condition under which the claim is true.
        holds: FigureCondition,
    },
    /// A sum of one quantity over several methods, divided by another such sum; each term is a method and
    /// its factor.
    Ratio {
        /// The measured quantity.
        quantity: Quantity,
        /// The numerator.
        of: &'static [(&'static str, f64)],
        /// The denominator.
        over: &'static [(&'static str, f64)],
        /// The condition under which the claim is true.
        holds: FigureCondition,
    },
    /// Two methods with the same error.
    Same {
        /// The methods.
        methods: [&'static str; 2],
    },
    /// The quantity at the largest value of the parameter, divided by the quantity at the smallest.
    Trend {
        /// The measured quantity.
        quantity: Quantity,
        /// The method.
        of: &'static str,
        /// The condition under which the claim is true.
        holds: FigureCondition,
    },
    /// A method that is within 1 % RMSE at every value, compared with one that exceeds it at some value.
    Unlike {
        /// The method that stays within 1 %.
        right: &'static str,
        /// The method that exceeds 1 % at some value.
        wrong: &'static str,
    },
    /// A method at half the value of the parameter compared with another at the full value: at most one and
    /// a half times the error, in at most half the passes plus two.
    Halves {
        /// The method with half the value.
        of: &'static str,
        /// The method with the full value.
        over: &'static str,
    },
    /// The smallest value of the parameter above which a method always stays within 1 % RMSE, divided by
    /// that of another.
    Narrowest {
        /// The method.
        of: &'static str,
        /// The method that it is compared with.
        over: &'static str,
        /// The condition under which the claim is true.
        holds: FigureCondition,
    },
    /// A method with `samples + 1` levels of its parameter, from 0 to 1: within 0.5 % RMSE on the levels,
    /// and at least four times as far off halfway between them.
    Levels {
        /// The method.
        of: &'static str,
        /// The number of samples.
        samples: u32,
    },
    /// The largest error multiplied by the parameter, in units of half an 8-bit code.
    HalfCodes {
        /// The method.
        of: &'static str,
        /// The condition under which the claim is true.
        holds: FigureCondition,
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

/// The condition that a figure meets. A figure with an interval meets it if the whole interval does, and
/// fails it if no part of the interval does.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum FigureCondition {
    /// Less than this.
    Below(f64),
    /// More than this.
    Above(f64),
    /// At most this.
    AtMost(f64),
    /// Between these two, inclusive.
    Between(f64, f64),
}

impl FigureCondition {
    /// Returns true if a figure meets the condition.
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
    /// Returns the name for use in a sentence.
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
    /// Creates a claim that all families of the question decide, at all values.
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
            values: ClaimedValues::All,
            test,
            fewer: None,
            note: "",
        }
    }

    /// Restricts the claim to these families.
    pub(crate) const fn of(self, families: &'static [&'static str]) -> Self {
        Self { families, ..self }
    }

    /// Restricts the claim to these values.
    pub(crate) const fn between(self, low: f64, high: f64) -> Self {
        let values = ClaimedValues::Between(low, high);
        Self { values, ..self }
    }

    /// Adds a note about what is measured.
    pub(crate) const fn noting(self, note: &'static str) -> Self {
        Self { note, ..self }
    }

    /// Restricts the claim to adapters on which a depth test lowers the fragment count.
    pub(crate) const fn where_fewer(self, fewer: [&'static str; 2]) -> Self {
        let fewer = Some(fewer);
        Self { fewer, ..self }
    }
}

/// A sum with a single method.
macro_rules! one {
    ($method:literal) => {
        &[($method, 1.0)]
    };
}
pub(crate) use one;
