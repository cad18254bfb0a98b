//! Notes on fragments, and the contents of attachments as stories hold them.

use crate::clause::clause;
use crate::notes::{Note, Notes};
use crate::sample::Sample;
use crate::walk::{Place, Walk};
use crate::world::Cell;
use etalon_frame::{
    Aspect, ChannelEncoding, CodeInterval, Codes, Contents, Effect, Event, Rejection, Step, Target,
};

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
        ChannelEncoding::Uint(8),
        CodeInterval::exact(i64::from(value)),
    )
}
