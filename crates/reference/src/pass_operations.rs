//! Load and store operations and clear commands of passes.
//!
//! A clear stores the same as the initial clear of an attachment. Discarded contents stay in the worlds. The
//! walk continues with them, and at the end everything that depends on them becomes open.

use crate::judging::Judging;
use crate::notes::{Note, Notes};
use crate::rounding::all_codes;
use crate::sample::Sample;
use crate::walk::Walk;
use crate::world::{World, Worlds, merge};
use etalon_frame::{Aspect, ChannelEncoding, CodeInterval, Origin, Step};
use etalon_pipeline::Arithmetic;
use etalon_scene::ClearTarget;

/// Returns every value that a channel can have.
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
                self.fill(worlds, &filling, notes, &Origin::Load(p));
            }
        }
        if let Some(index) = pass.depth_stencil {
            let depth = pass.operations.depth.load.clear_value();
            let stencil = pass.operations.stencil.load.clear_value();
            if depth.is_some() || stencil.is_some() {
                let filling = self.depth_stencil(index, depth, stencil.map(|v| (v, 0xff)));
                self.fill(worlds, &filling, notes, &Origin::Load(p));
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
        let origin = if draw == pass.draws.len() {
            Origin::PassEnd(p)
        } else {
            Origin::BeforeDraw { pass: p, draw }
        };
        for clear in clears {
            if !inside(clear.rect) {
                notes.add(|| origin.clone(), || Step::ClearElsewhere, None);
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
            self.fill(worlds, &filling, notes, &origin);
        }
        merge(worlds);
    }

    /// Notes the aspects that the store operations of a pass discard.
    pub(crate) fn store(&self, p: usize, notes: &mut Notes<'_>) {
        for (index, aspect) in self.scene.passes[p].discarded() {
            notes.add(
                || Origin::AfterPass(p),
                || Step::StoreDiscard(self.target(index, aspect)),
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

    fn fill(&self, worlds: &mut Worlds, filling: &Filling, notes: &mut Notes<'_>, origin: &Origin) {
        let format = self.scene.attachments[filling.attachment].format;
        for world in worlds.iter_mut() {
            let cell = &mut world.cells[filling.attachment];
            for (channel, codes) in &filling.channels {
                cell.set_channel(*channel, *codes);
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
                notes.push(|| {
                    let step =
                        Step::Clear(vec![self.contents(filling.attachment, *aspect, &contents)]);
                    let target = self.target(filling.attachment, *aspect);
                    let citation = self.rules.store.citation;
                    Note::store(origin.clone(), step, target, contents, citation)
                });
            }
        }
    }
}
