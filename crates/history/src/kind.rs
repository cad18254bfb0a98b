//! Kinds of runs.

use std::fmt;

/// The kind of a run.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Kind {
    /// `etalon run`.
    Run,
    /// `etalon bench`.
    Bench,
    /// One release of the line that `etalon bisect` searched.
    Release,
}

impl Kind {
    /// Every kind.
    pub const ALL: [Self; 3] = [Self::Run, Self::Bench, Self::Release];

    /// Returns the name in the database and in exports.
    pub fn name(self) -> &'static str {
        match self {
            Self::Run => "run",
            Self::Bench => "bench",
            Self::Release => "release",
        }
    }

    /// Returns the kind with this name.
    pub fn of(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|kind| kind.name() == name)
    }
}

impl fmt::Display for Kind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}
