//! Parsing.

use crate::step::MatchStep;
use std::iter::Peekable;
use std::str::Chars;
use thiserror::Error;

/// The reason why a text is not a glob.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
pub enum GlobError {
    /// A `[` without its `]`.
    #[error("`[` without `]`; `[[]` matches the character")]
    OpenClass,
    /// A range that contains nothing.
    #[error("the range `{0}-{1}` is reversed")]
    ReversedRange(char, char),
    /// A `{` without its `}`.
    #[error("`{{` without `}}`; `[{{]` matches the character")]
    OpenBrace,
    /// A `}` without its `{`.
    #[error("`}}` without `{{`; `[}}]` matches the character")]
    ClosedBrace,
    /// A backslash at the end.
    #[error("nothing follows the last `\\`")]
    Backslash,
}

/// A list in braces that is not closed yet.
struct OpenBraces {
    /// The number of the step that jumps to all alternatives.
    fork: usize,
    /// The numbers of their first steps.
    starts: Vec<usize>,
    /// The numbers of the steps that jump to the end of the list.
    ends: Vec<usize>,
    /// True if the list is at the start of a part of a path.
    begins: bool,
}

/// Returns the steps of a glob.
pub(crate) fn steps(glob: &str) -> Result<Vec<MatchStep>, GlobError> {
    let mut steps = Vec::new();
    let mut lists: Vec<OpenBraces> = Vec::new();
    let mut chars = glob.chars().peekable();
    // True at the start of a part of a path.
    let mut begins = true;
    while let Some(c) = chars.next() {
        let began = std::mem::take(&mut begins);
        match c {
            '*' => {
                let mut stars = 1;
                while chars.next_if_eq(&'*').is_some() {
                    stars += 1;
                }
                if began && stars == 2 && chars.next_if_eq(&'/').is_some() {
                    let fork = steps.len();
                    let targets = vec![fork + 1, fork + 3];
                    steps.extend([
                        MatchStep::Jump(targets),
                        MatchStep::Star,
                        MatchStep::Char('/'),
                    ]);
                    begins = true;
                } else {
                    steps.push(MatchStep::Star);
                }
            }
            '?' => steps.push(MatchStep::Any),
            '[' => steps.push(class(&mut chars)?),
            '\\' => steps.push(MatchStep::Char(chars.next().ok_or(GlobError::Backslash)?)),
            '{' => {
                lists.push(OpenBraces {
                    fork: steps.len(),
                    starts: vec![steps.len() + 1],
                    ends: Vec::new(),
                    begins: began,
                });
                steps.push(MatchStep::Jump(Vec::new()));
                begins = began;
            }
            ',' if let Some(list) = lists.last_mut() => {
                list.ends.push(steps.len());
                steps.push(MatchStep::Jump(Vec::new()));
                list.starts.push(steps.len());
                begins = list.begins;
            }
            '}' => {
                let list = lists.pop().ok_or(GlobError::ClosedBrace)?;
                let end = steps.len();
                for jump in list.ends {
                    steps[jump] = MatchStep::Jump(vec![end]);
                }
                steps[list.fork] = MatchStep::Jump(list.starts);
            }
            c => {
                begins = c == '/';
                steps.push(MatchStep::Char(c));
            }
        }
    }
    if lists.is_empty() {
        Ok(steps)
    } else {
        Err(GlobError::OpenBrace)
    }
}

/// Parses a class after its `[`. A `]` that comes first, and a `-` at either end, are members of the class.
fn class(chars: &mut Peekable<Chars<'_>>) -> Result<MatchStep, GlobError> {
    let negated = chars.next_if(|c| matches!(c, '!' | '^')).is_some();
    let mut ranges = Vec::new();
    loop {
        let first = chars.next().ok_or(GlobError::OpenClass)?;
        if first == ']' && !ranges.is_empty() {
            return Ok(MatchStep::Class { negated, ranges });
        }
        let mut last = first;
        let mut ahead = chars.clone();
        if ahead.next() == Some('-')
            && let Some(end) = ahead.next().filter(|c| *c != ']')
        {
            last = end;
            *chars = ahead;
        }
        if last < first {
            return Err(GlobError::ReversedRange(first, last));
        }
        ranges.push((first, last));
    }
}
