//! A claim, and the figures for and against it.

use crate::methods::data::Methods;

/// A claim and how it is checked.
pub(super) struct Claim {
    /// The claim.
    pub(super) title: &'static str,
    /// The publication.
    pub(super) source: &'static str,
    /// The measurement that tests it, and the condition under which it holds.
    pub(super) formula: &'static str,
    /// The measured figures; none where the records have none.
    pub(super) check: fn(&Methods<'_>) -> Vec<Figure>,
}

/// One figure that speaks for or against a claim.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Figure {
    /// The scene it was found in; empty for all together.
    pub(super) scene: String,
    /// The adapter; empty where adapters have no part in it.
    pub(super) adapter: String,
    /// The figure in words.
    pub(super) text: String,
    /// True if the claim holds there.
    pub(super) holds: bool,
}

impl Figure {
    pub(super) fn new(place: Place<'_>, text: impl Into<String>, holds: bool) -> Self {
        Self {
            scene: place.0.to_owned(),
            adapter: place.1.to_owned(),
            text: text.into(),
            holds,
        }
    }
}

/// A scene and an adapter.
pub(super) type Place<'p> = (&'p str, &'p str);

/// The degree to which a claim was reproduced.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Reproduction {
    Reproduced,
    /// In so many of so many places.
    Partly(usize, usize),
    NotReproduced,
    NotMeasured,
}

impl Reproduction {
    pub(super) fn of(figures: &[Figure]) -> Self {
        let held = figures.iter().filter(|f| f.holds).count();
        match (held, figures.len()) {
            (_, 0) => Self::NotMeasured,
            (0, _) => Self::NotReproduced,
            (held, all) if held == all => Self::Reproduced,
            (held, all) => Self::Partly(held, all),
        }
    }

    pub(super) fn text(self) -> String {
        match self {
            Self::Reproduced => "✓ reproduced".to_owned(),
            Self::Partly(held, all) => format!("≈ reproduced in {held} of {all} places"),
            Self::NotReproduced => "✗ not reproduced".to_owned(),
            Self::NotMeasured => "– not measured".to_owned(),
        }
    }

    pub(super) fn class(self) -> &'static str {
        match self {
            Self::Reproduced => "p",
            Self::Partly(..) => "i",
            Self::NotReproduced => "o",
            Self::NotMeasured => "u",
        }
    }
}
