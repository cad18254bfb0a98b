//! The notes of a walk, from which the story of a sample is made. Each has an event and, for a store, the new
//! contents.

use crate::world::SampleContents;
use etalon_frame::{Effect, Event, Origin, Rejection, Step, Target};

/// An operation with its effect.
#[derive(Clone, Debug)]
pub(crate) struct Note {
    pub(crate) event: Event,
    /// The new contents of the attachment, for a store.
    pub(crate) stored: Option<SampleContents>,
}

impl Note {
    /// Returns the note of a store between draws: a clear or a resolve.
    pub(crate) fn store(
        origin: Origin,
        step: Step,
        target: Target,
        stored: SampleContents,
        citation: &str,
    ) -> Self {
        Self {
            event: Event {
                scene: None,
                origin,
                step,
                effect: Effect::Stores(target),
                citation: Some(citation.to_owned()),
            },
            stored: Some(stored),
        }
    }
}

/// The notes; `None` unless a story is being made.
pub(crate) struct Notes<'s>(pub(crate) Option<&'s mut Vec<Note>>);

impl Notes<'_> {
    /// Adds an operation without an effect.
    pub(crate) fn add(
        &mut self,
        origin: impl FnOnce() -> Origin,
        step: impl FnOnce() -> Step,
        citation: Option<&str>,
    ) {
        self.push(|| Note {
            event: Event {
                scene: None,
                origin: origin(),
                step: step(),
                effect: Effect::None,
                citation: citation.map(str::to_owned),
            },
            stored: None,
        });
    }

    pub(crate) fn push(&mut self, note: impl FnOnce() -> Note) {
        if let Some(notes) = &mut self.0 {
            notes.push(note());
        }
    }
}

/// The primitives of a draw without a fragment at the sample, each with the reason, or `None` if it has notes
/// of its own. Collected only if a story is being made.
pub(crate) struct Skipped(pub(crate) Option<Vec<(u32, Option<Rejection>)>>);

impl Skipped {
    pub(crate) fn new(notes: &Notes<'_>) -> Self {
        Self(notes.0.is_some().then(Vec::new))
    }

    pub(crate) fn add(&mut self, primitive: u32, reason: Option<Rejection>) {
        if let Some(notes) = &mut self.0 {
            notes.push((primitive, reason));
        }
    }
}
