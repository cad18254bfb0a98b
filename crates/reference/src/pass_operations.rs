//! Load and store operations and clear commands of passes.
//!
//! A clear stores what the first clear of an attachment stores. What is discarded stays in the worlds: the
//! walk goes on with it, and at the end everything that depends on it is opened.

use crate::judging::{Judging, all_codes};
use crate::notes::{Effect, Note, Notes};
use crate::sample::Sample;
use crate::walk::{Walk, codes_text};
use crate::world::{Cell, World, Worlds, merge};
use etalon_frame::{Aspect, ChannelEncoding, CodeInterval, StoryLine};
use etalon_pipeline::Arithmetic;
use etalon_scene::ClearTarget;

/// Returns every value that a channel can hold.
fn everything(encoding: ChannelEncoding) -> CodeInterval {
    if encoding.is_float() {
        all_codes(encoding)
    } else {
        CodeInterval::new(encoding.min_order(), encoding.max_order())
    }
}

/// New contents of an aspect.
struct Filling {
    attachment: usize,
    /// The written colour channels, or depth, with their codes.
    channels: Vec<(usize, CodeInterval)>,
    /// The value and the written bits of stencil.
    stencil: Option<(u8, u8)>,
}

impl Walk<'_> {
    /// Executes the load operations of a pass at a sample of its attachments.
    pub(crate) fn load(&self, p: usize, worlds: &mut Worlds, notes: &mut Notes<'_>) {
        let pass = &self.scene.passes[p];
        for (location, index) in pass.color.iter().enumerate() {
            if let Some(value) = pass.color_operations(location).load.clear_value() {
                let filling = self.color(*index, value, 0b1111);
                self.fill(worlds, &filling, notes, || load_text(p));
            }
        }
        if let Some(index) = pass.depth_stencil {
            let depth = pass.operations.depth.load.clear_value();
            let stencil = pass.operations.stencil.load.clear_value();
            if depth.is_some() || stencil.is_some() {
                let filling = self.depth_stencil(index, depth, stencil.map(|v| (v, 0xff)));
                self.fill(worlds, &filling, notes, || load_text(p));
            }
        }
        merge(worlds);
    }

    /// Executes the clear commands before a draw, or at the end of the pass, at a sample of its attachments.
    pub(crate) fn clear(
        &self,
        (p, draw): (usize, usize),
        at: Sample,
        worlds: &mut Worlds,
        notes: &mut Notes<'_>,
    ) {
        let pass = &self.scene.passes[p];
        let clears = pass.clears_before(draw);
        if clears.is_empty() {
            return;
        }
        let inside = |rect: Option<[u32; 4]>| {
            rect.is_none_or(|[x, y, w, h]| at.x >= x && at.y >= y && at.x - x < w && at.y - y < h)
        };
        let when = match draw == pass.draws.len() {
            true => format!("pass {p}, at the end"),
            false => format!("pass {p}, before draw {draw}"),
        };
        for clear in clears {
            if !inside(clear.rect) {
                let detail = || "the texel lies outside its rectangle".to_owned();
                notes.add(|| when.clone(), "clear", detail, None);
                continue;
            }
            let filling = match clear.target {
                ClearTarget::Color {
                    location,
                    value,
                    write_mask,
                } => self.color(pass.color[location], value, write_mask),
                ClearTarget::DepthStencil {
                    depth,
                    stencil,
                    depth_write,
                    stencil_write_mask,
                } => {
                    let Some(index) = pass.depth_stencil else {
                        continue;
                    };
                    let depth = depth.filter(|_| depth_write);
                    self.depth_stencil(index, depth, stencil.map(|v| (v, stencil_write_mask)))
                }
            };
            self.fill(worlds, &filling, notes, || when.clone());
        }
        merge(worlds);
    }

    /// Tells what the store operations of a pass discard.
    pub(crate) fn store(&self, p: usize, notes: &mut Notes<'_>) {
        for (index, aspect) in self.scene.passes[p].discarded() {
            let name = &self.scene.attachments[index].name;
            notes.add(
                || format!("after pass {p}"),
                "discard",
                || format!("{aspect} of {name} is undefined until all of it is cleared"),
                None,
            );
        }
    }

    /// Opens the channels of an aspect as it is read back, if it is undefined.
    pub(crate) fn open_undefined(
        &self,
        attachment: usize,
        aspect: Aspect,
        channels: &mut [CodeInterval],
    ) {
        if self.undefined.aspect(attachment, aspect) {
            let (encodings, _) = self.read_encoding(attachment, aspect);
            for (channel, encoding) in channels.iter_mut().zip(encodings.iter()) {
                *channel = everything(*encoding);
            }
        }
    }

    fn color(&self, attachment: usize, value: [f32; 4], mask: u8) -> Filling {
        let mut judging = Judging::new(self.rules);
        let encodings = self.scene.attachments[attachment].format.color_channels();
        let each = encodings.iter().enumerate();
        let each = each.filter(|(c, _)| mask & (1 << c) != 0);
        let mut code = |value, encoding| {
            let value = judging.constant(value);
            judging.encode(encoding, value)
        };
        Filling {
            attachment,
            channels: each.map(|(c, e)| (c, code(value[c], *e))).collect(),
            stencil: None,
        }
    }

    fn depth_stencil(
        &self,
        attachment: usize,
        depth: Option<f32>,
        stencil: Option<(u8, u8)>,
    ) -> Filling {
        let mut judging = Judging::new(self.rules);
        let mut code = |value| {
            let value = judging.constant(value);
            judging.encode(self.depth_encoding(attachment), value)
        };
        Filling {
            attachment,
            channels: depth.map(|value| (0, code(value))).into_iter().collect(),
            stencil,
        }
    }

    fn fill(
        &self,
        worlds: &mut Worlds,
        filling: &Filling,
        notes: &mut Notes<'_>,
        when: impl Fn() -> String,
    ) {
        let format = self.scene.attachments[filling.attachment].format;
        for world in worlds.iter_mut() {
            let cell = &mut world.cells[filling.attachment];
            for (channel, codes) in &filling.channels {
                cell.channels[*channel] = *codes;
            }
            if !filling.channels.is_empty() {
                cell.origin = None;
            }
            if let Some((value, mask)) = filling.stencil {
                cell.stencil = cell.stencil & !mask | value & mask;
            }
        }
        let Some(World { cells, .. }) = worlds.first() else {
            return;
        };
        let contents = cells[filling.attachment];
        for aspect in format.aspects() {
            let stores = match aspect {
                Aspect::Color | Aspect::Depth => !filling.channels.is_empty(),
                Aspect::Stencil => filling.stencil.is_some_and(|(_, mask)| mask != 0),
            };
            if stores {
                self.note_clear(notes, filling.attachment, *aspect, contents, &when);
            }
        }
    }

    fn note_clear(
        &self,
        notes: &mut Notes<'_>,
        attachment: usize,
        aspect: Aspect,
        contents: Cell,
        when: impl Fn() -> String,
    ) {
        notes.push(|| {
            let Cell {
                channels, stencil, ..
            } = contents;
            let of = &self.scene.attachments[attachment];
            let text = match aspect {
                Aspect::Color => {
                    let each = of.format.color_channels().iter().zip(channels);
                    let each: Vec<String> = each.map(|(e, c)| codes_text(*e, c)).collect();
                    each.join(", ")
                }
                Aspect::Depth => codes_text(self.depth_encoding(attachment), channels[0]),
                Aspect::Stencil => stencil.to_string(),
            };
            let name = &of.name;
            Note {
                line: StoryLine {
                    at: when(),
                    operation: "clear".to_owned(),
                    detail: format!("{name} holds {aspect} {text}"),
                    citation: Some(self.rules.store.citation.to_owned()),
                },
                origin: None,
                effect: Effect::Stores {
                    attachment,
                    aspect,
                    contents,
                },
            }
        });
    }
}

fn load_text(p: usize) -> String {
    format!("pass {p}, load operation")
}
