//! The notes of a walk, of which the story of a sample is made. Each holds an event, and the contents that a store
//! leaves.

use crate::clause::clause;
use crate::sample::Sample;
use crate::walk::{Place, Walk};
use crate::world::Cell;
use etalon_frame::{
    Aspect, CodeInterval, Codes, Contents, Effect, Event, Origin, Rejection, Step, Target,
};

/// One operation with its effect.
#[derive(Clone, Debug)]
pub(crate) struct Note {
    pub(crate) event: Event,
    /// The new contents of the attachment, of a store.
    pub(crate) stored: Option<Cell>,
}

impl Note {
    /// Returns the note of a store between draws: a clear or a resolve.
    pub(crate) fn store(
        origin: Origin,
        step: Step,
        target: Target,
        stored: Cell,
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

/// The notes, if a story is made; without one, they cost nothing.
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

/// The primitives of a draw that do not come to a fragment at the sample, with the reason; without a
/// reason, those that have notes of their own. Collected only if a story is made.
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

impl Walk<'_> {
    /// Notes an operation on a fragment that has an effect; a store gives the new contents of its attachment.
    pub(crate) fn note_effect(
        &self,
        notes: &mut Notes<'_>,
        place: Place<'_>,
        citation: &str,
        stored: Option<Cell>,
        operation: impl FnOnce() -> (Effect, Step),
    ) {
        notes.push(|| {
            let (effect, step) = operation();
            Note {
                event: Event {
                    scene: None,
                    origin: place.origin(),
                    step,
                    effect,
                    citation: Some(citation.to_owned()),
                },
                stored,
            }
        });
    }

    /// Notes that a fragment ends by an operation, or may end.
    pub(crate) fn note_rejection(
        &self,
        notes: &mut Notes<'_>,
        place: Place<'_>,
        rejection: Rejection,
        certain: bool,
        step: impl FnOnce() -> Step,
    ) {
        notes.push(|| Note {
            event: Event {
                scene: None,
                origin: place.origin(),
                step: step(),
                effect: if certain {
                    Effect::Rejects(rejection)
                } else {
                    Effect::MayReject(rejection)
                },
                citation: Some(clause(
                    rejection,
                    self.rules,
                    self.limits,
                    place.draw.topology,
                )),
            },
            stored: None,
        });
    }

    /// Returns an aspect of an attachment by its name.
    pub(crate) fn target(&self, attachment: usize, aspect: Aspect) -> Target {
        Target {
            attachment: self.scene.attachments[attachment].name.clone(),
            aspect,
        }
    }

    /// Returns the contents of an aspect of an attachment as they are stored.
    pub(crate) fn contents(&self, attachment: usize, aspect: Aspect, cell: &Cell) -> Contents {
        let Target {
            attachment: name, ..
        } = self.target(attachment, aspect);
        let format = self.scene.attachments[attachment].format;
        let codes = match aspect {
            Aspect::Color => Codes::of_channels(format.color_channels(), cell.channels),
            Aspect::Depth => vec![Codes::new(
                self.depth_encoding(attachment),
                cell.channels[0],
            )],
            Aspect::Stencil => vec![stencil_codes(cell.stencil)],
        };
        Contents {
            attachment: name,
            aspect,
            codes,
        }
    }

    /// Returns the contents of all aspects of an attachment as they are stored.
    pub(crate) fn all_contents(&self, attachment: usize, cell: &Cell) -> Vec<Contents> {
        let aspects = self.scene.attachments[attachment].format.aspects().iter();
        aspects
            .map(|aspect| self.contents(attachment, *aspect, cell))
            .collect()
    }

    /// True if an attachment has the size and the samples of a sample's attachments.
    pub(crate) fn has_shape(&self, attachment: usize, at: Sample) -> bool {
        let attachment = &self.scene.attachments[attachment];
        (attachment.size, attachment.samples) == (at.size, at.samples)
    }
}

/// Returns the codes of a stencil value.
pub(crate) fn stencil_codes(value: u8) -> Codes {
    Codes::new(
        etalon_frame::ChannelEncoding::Uint(8),
        CodeInterval::exact(i64::from(value)),
    )
}
