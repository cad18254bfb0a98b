//! Notes on fragments, and the contents of attachments as stories show them.

use crate::clause::clause;
use crate::notes::{Note, Notes};
use crate::range::Range;
use crate::sample::Sample;
use crate::walk::{FragmentPlace, Walk};
use crate::world::SampleContents;
use etalon_frame::{
    Aspect, BlendedChannel, ChannelEncoding, CodeInterval, Codes, Contents, Effect, Event,
    Rejection, Step, Target,
};
use etalon_pipeline::BlendInput;
use etalon_scene::BlendState;

impl Walk<'_> {
    /// Notes an operation on a fragment that has an effect; a store gives the new contents of its attachment.
    pub(crate) fn note_effect(
        &self,
        notes: &mut Notes<'_>,
        place: &FragmentPlace<'_>,
        citation: &str,
        stored: Option<SampleContents>,
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

    /// Notes that an operation ends, or can end, a fragment.
    pub(crate) fn note_rejection(
        &self,
        notes: &mut Notes<'_>,
        place: &FragmentPlace<'_>,
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
                    (&self.scene.passes[place.pass], place.draw.topology),
                )),
            },
            stored: None,
        });
    }

    /// Notes the operands and the result of a blend.
    pub(crate) fn note_blend(
        &self,
        place: &FragmentPlace<'_>,
        state: &BlendState,
        input: &BlendInput<Range>,
        value: [Range; 4],
        notes: &mut Notes<'_>,
    ) {
        let channel = |c: usize| {
            let part = if c == 3 { state.alpha } else { state.color };
            BlendedChannel {
                src: input.src[c].into(),
                src_factor: part.src_factor.name().to_owned(),
                operation: part.operation.name().to_owned(),
                dst: input.dst[c].into(),
                dst_factor: part.dst_factor.name().to_owned(),
                result: value[c].into(),
            }
        };
        notes.add(
            || place.origin(),
            || Step::Blend(Box::new([0, 1, 2, 3].map(channel))),
            Some(self.rules.blend.citation),
        );
    }

    /// Notes the contents of a colour attachment after a fragment: a stored colour, or the old one that its
    /// write mask keeps.
    pub(crate) fn note_store(
        &self,
        place: &FragmentPlace<'_>,
        attachment: usize,
        write_mask: u8,
        cell: SampleContents,
        notes: &mut Notes<'_>,
    ) {
        let channels = self.scene.attachments[attachment].format.color_channels();
        let target = || self.target(attachment, Aspect::Color);
        let contents = || self.contents(attachment, Aspect::Color, &cell);
        let written = write_mask & ((1 << channels.len()) - 1);
        if written == 0 {
            self.note_effect(notes, place, self.rules.write_mask, None, || {
                let contents = contents();
                let step = Step::KeepColor {
                    contents,
                    write_mask,
                };
                (Effect::Keeps(target()), step)
            });
            return;
        }
        let masked = written.count_ones() != channels.len() as u32;
        let citation = if masked {
            self.rules.write_mask
        } else {
            self.rules.store.citation
        };
        self.note_effect(notes, place, citation, Some(cell), || {
            let step = Step::StoreColor {
                contents: contents(),
                write_mask: masked.then_some(write_mask),
            };
            (Effect::Stores(target()), step)
        });
    }

    /// Returns an aspect of an attachment, by the attachment's name.
    pub(crate) fn target(&self, attachment: usize, aspect: Aspect) -> Target {
        Target {
            attachment: self.scene.attachments[attachment].name.clone(),
            aspect,
        }
    }

    /// Returns the contents of an aspect of an attachment as they are stored.
    pub(crate) fn contents(
        &self,
        attachment: usize,
        aspect: Aspect,
        cell: &SampleContents,
    ) -> Contents {
        let Target {
            attachment: name, ..
        } = self.target(attachment, aspect);
        let format = self.scene.attachments[attachment].format;
        let codes = match aspect {
            Aspect::Color => Codes::of_channels(format.color_channels(), cell.channels()),
            Aspect::Depth => vec![Codes::new(self.depth_encoding(attachment), cell.channel(0))],
            Aspect::Stencil => vec![stencil_codes(cell.stencil)],
        };
        Contents {
            attachment: name,
            aspect,
            codes,
        }
    }

    /// Returns the contents of all aspects of an attachment as they are stored.
    pub(crate) fn all_contents(&self, attachment: usize, cell: &SampleContents) -> Vec<Contents> {
        let aspects = self.scene.attachments[attachment].format.aspects().iter();
        aspects
            .map(|aspect| self.contents(attachment, *aspect, cell))
            .collect()
    }

    /// Returns true if an attachment has the size and sample count of a sample's attachments.
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
