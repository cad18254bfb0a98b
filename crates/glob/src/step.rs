//! The steps of a match.

/// A step of a match. Without a jump, the next step follows.
#[derive(Clone, Debug)]
pub(crate) enum MatchStep {
    /// Takes this character.
    Char(char),
    /// Takes any character.
    Any,
    /// Takes a character inside, or if `negated` outside, of all ranges.
    Class {
        negated: bool,
        ranges: Vec<(char, char)>,
    },
    /// Takes any text.
    Star,
    /// Takes nothing, and continues at each of these later steps.
    Jump(Vec<usize>),
}

impl MatchStep {
    /// Returns true if a step for one character takes this one.
    pub(crate) fn takes(&self, c: char) -> bool {
        match self {
            Self::Char(expected) => *expected == c,
            Self::Any => true,
            Self::Class { negated, ranges } => {
                let inside = |(first, last): &(char, char)| (*first..=*last).contains(&c);
                ranges.iter().any(inside) != *negated
            }
            Self::Star | Self::Jump(_) => false,
        }
    }
}
