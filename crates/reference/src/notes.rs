//! The notes of a walk, of which the story of a sample is made. Each tells the effect of its operation
//! beside the words, so that the verdict can name the operation that decided without reading prose.

use crate::clause::Rejection;
use crate::world::Cell;
use etalon_frame::{Aspect, StoryLine};

/// The effect of a noted operation on the sample.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Effect {
    /// None that the verdict asks for.
    Plain,
    /// The draw, the primitives or the fragment end here.
    Rejects(Rejection),
    /// The rules leave two outcomes open, of which one ends here.
    MayReject(Rejection),
    /// A fragment that passed leaves an aspect of an attachment as it was.
    Keeps { attachment: usize, aspect: Aspect },
    /// An aspect of an attachment gets new contents.
    Stores {
        attachment: usize,
        aspect: Aspect,
        contents: Cell,
    },
}

/// The part of the scene that a note speaks of.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Origin {
    pub(crate) pass: usize,
    pub(crate) draw: usize,
    /// In order; empty stands for all.
    pub(crate) primitives: Vec<u32>,
}

/// One operation with its effect.
#[derive(Clone, Debug)]
pub(crate) struct Note {
    pub(crate) line: StoryLine,
    /// `None` where no draw is the cause.
    pub(crate) origin: Option<Origin>,
    pub(crate) effect: Effect,
}

/// The notes, if a story is told; without one, they cost nothing.
pub(crate) struct Notes<'s>(pub(crate) Option<&'s mut Vec<Note>>);

impl Notes<'_> {
    pub(crate) fn add(
        &mut self,
        at: impl FnOnce() -> String,
        operation: &str,
        detail: impl FnOnce() -> String,
        citation: Option<&str>,
    ) {
        self.push(|| Note {
            line: StoryLine {
                at: at(),
                operation: operation.to_owned(),
                detail: detail(),
                citation: citation.map(str::to_owned),
            },
            origin: None,
            effect: Effect::Plain,
        });
    }

    /// Adds a note with an effect.
    pub(crate) fn push(&mut self, note: impl FnOnce() -> Note) {
        if let Some(notes) = &mut self.0 {
            notes.push(note());
        }
    }
}

/// The primitives of a draw that do not come to a fragment at the sample, with the reason; without a
/// reason, those that have notes of their own. Collected only where a story is told.
pub(crate) struct Skipped(pub(crate) Option<Vec<(u32, Option<Rejection>)>>);

impl Skipped {
    pub(crate) fn new(notes: &Notes<'_>) -> Self {
        Self(notes.0.is_some().then(Vec::new))
    }

    pub(crate) fn add(&mut self, primitive: u32, reason: Option<Rejection>) {
        if let Some(all) = &mut self.0 {
            all.push((primitive, reason));
        }
    }
}
