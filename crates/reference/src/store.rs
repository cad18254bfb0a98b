//! Stores: depth and colours of a fragment that passed, with masks, blending and logic operations.

use crate::fragment::Incoming;
use crate::judging::{Judging, Range};
use crate::notes::{Effect, Notes};
use crate::rules::{SignedClamp, SrgbLogic};
use crate::walk::{Place, Walk, codes_text};
use crate::world::World;
use etalon_frame::{Aspect, ChannelEncoding, CodeInterval, TextureFormat};
use etalon_pipeline::shader::FragmentOutput;
use etalon_pipeline::{Arithmetic, BlendInput, advanced_blend, blend, takes_logic};
use etalon_scene::AdvancedBlend;

impl Walk<'_> {
    /// Stores the depth of a fragment that passed all tests.
    pub(crate) fn write_depth(
        &self,
        place: Place<'_>,
        world: &mut World,
        incoming: Incoming,
        notes: &mut Notes<'_>,
    ) {
        let mut judging = Judging::new(self.rules);
        let pass = &self.scene.passes[place.pass];
        if let (Some(state), Some(index)) = (place.draw.depth, pass.depth_stencil)
            && state.write
        {
            let encoding = self.depth_encoding(index);
            let codes = judging.encode(encoding, incoming.depth);
            world.cells[index].channels[0] = codes;
            world.cells[index].origin = incoming.origin;
            let effect = Effect::Stores {
                attachment: index,
                aspect: Aspect::Depth,
                contents: world.cells[index],
            };
            let detail = || {
                let depth = incoming.depth.hull();
                format!("{depth} as {}", codes_text(encoding, codes))
            };
            let citation = || self.rules.store.citation.to_owned();
            self.note_effect(notes, place, effect, "store depth", [&detail, &citation]);
        } else if let Some(attachment) = pass.depth_stencil
            && self.scene.attachments[attachment].format.has_depth()
        {
            let aspect = Aspect::Depth;
            let effect = Effect::Keeps { attachment, aspect };
            let detail = || match place.draw.depth {
                Some(_) => "depth writes are off".to_owned(),
                None => "without a depth test, nothing is written".to_owned(),
            };
            let citation = || self.rules.write_mask.to_owned();
            self.note_effect(notes, place, effect, "keep depth", [&detail, &citation]);
        }
    }

    /// Returns the codes of a colour that a shader or a blend stores.
    fn store_color(
        &self,
        judging: &mut Judging<'_>,
        encoding: ChannelEncoding,
        value: Range,
    ) -> CodeInterval {
        let whole = judging.encode(encoding, value);
        if !matches!(encoding, ChannelEncoding::Snorm(_)) {
            return whole;
        }
        let clamped = Range {
            float: value.float.clamp(0.0, 1.0),
            coarse: value.coarse.clamp(0.0, 1.0),
        };
        match self.rules.signed_result.value() {
            SignedClamp::Signed => whole,
            SignedClamp::Unit => judging.encode(encoding, clamped),
            SignedClamp::Either => whole.hull(judging.encode(encoding, clamped)),
        }
    }

    /// Returns whether logic operations apply to a format.
    fn logic_on(&self, format: TextureFormat) -> SrgbLogic {
        match format {
            _ if takes_logic(format) => SrgbLogic::Applies,
            TextureFormat::Rgba8UnormSrgb => self.rules.srgb_logic.value(),
            _ => SrgbLogic::PassesThrough,
        }
    }

    /// Returns the colour of an advanced blend of source and destination.
    fn advanced(
        &self,
        place: Place<'_>,
        mode: AdvancedBlend,
        encodings: [ChannelEncoding; 4],
        [src, dst]: [[Range; 4]; 2],
        notes: &mut Notes<'_>,
    ) -> [Range; 4] {
        let mut judging = Judging::of_advanced_blends(self.rules);
        let value = advanced_blend(&mut judging, mode, encodings, src, dst);
        notes.add(
            || place.name(),
            "advanced blend",
            || {
                let text = |color: [Range; 4]| color.map(|v| v.hull().to_string()).join(", ");
                format!(
                    "{} of [{}] onto [{}] = [{}]",
                    mode.name(),
                    text(src),
                    text(dst),
                    text(value)
                )
            },
            Some(self.rules.advanced_blend.citation),
        );
        value
    }

    /// Stores the colours of a fragment that passed all tests.
    pub(crate) fn write_colors(
        &self,
        place: Place<'_>,
        world: &mut World,
        output: &FragmentOutput<Range>,
        notes: &mut Notes<'_>,
    ) {
        let mut judging = Judging::new(self.rules);
        let pass = &self.scene.passes[place.pass];
        let mut second = output.second.unwrap_or([Range::exact(0.0); 4]);
        if place.draw.alpha_to_one() {
            second[3] = Range::exact(1.0);
        }
        for (location, index) in pass.color.iter().enumerate() {
            let Some(target) = place.draw.targets.get(location) else {
                continue;
            };
            let mut color = output.at_location(location);
            if place.draw.alpha_to_one() {
                color[3] = Range::exact(1.0);
            }
            let attachment = &self.scene.attachments[*index];
            let encodings = attachment.format.color_channels();
            let all: [ChannelEncoding; 4] =
                std::array::from_fn(|c| encodings[c.min(encodings.len() - 1)]);
            let missing = missing_channels(encodings.len());
            let cell = &mut world.cells[*index];
            let mut dst = || {
                std::array::from_fn(|c| match missing[c] {
                    Some(value) => Range::exact(value),
                    None => judging.decode(all[c], cell.channels[c]),
                })
            };
            let value = match (&target.blend, target.advanced) {
                (None, None) => color,
                (None, Some(mode)) => self.advanced(place, mode, all, [color, dst()], notes),
                (Some(state), _) => {
                    let dst = dst();
                    let constant = place.draw.blend_constant.map(|v| {
                        let plain = judging.constant(v);
                        let clamped = v.clamp(0.0, 1.0);
                        match clamped != v && self.rules.clamps_constant.value() {
                            true => plain.joined(judging.constant(clamped)),
                            false => plain,
                        }
                    });
                    let input = BlendInput {
                        src: color,
                        src1: second,
                        dst,
                        constant,
                    };
                    let value = blend(&mut judging, state, all, &input);
                    notes.add(
                        || place.name(),
                        "blend",
                        || {
                            let side = |c: usize| {
                                let part = if c == 3 { state.alpha } else { state.color };
                                format!(
                                    "{}: {} × {} {} {} × {} = {}",
                                    Aspect::Color.channel(c),
                                    color[c].hull(),
                                    part.src_factor.name(),
                                    part.operation.name(),
                                    dst[c].hull(),
                                    part.dst_factor.name(),
                                    value[c].hull()
                                )
                            };
                            [0, 1, 2, 3].map(side).join("; ")
                        },
                        Some(self.rules.blend.citation),
                    );
                    value
                }
            };
            let works = self.logic_on(attachment.format) != SrgbLogic::PassesThrough;
            if let Some(operation) = place.draw.logic.filter(|_| works) {
                let before = *cell;
                notes.add(
                    || place.name(),
                    "logic operation",
                    || {
                        let stored = self.cell_text(*index, &before);
                        format!("{} onto {stored}", operation.name())
                    },
                    None,
                );
            }
            for (c, encoding) in encodings.iter().enumerate() {
                if target.write_mask & (1 << c) != 0 {
                    let codes = self.store_color(&mut judging, *encoding, value[c]);
                    let (stored, logic) = (cell.channels[c], place.draw.logic);
                    // On sRGB attachments the operation works on the codes, which are those of 8 bits.
                    let bits = match encoding {
                        ChannelEncoding::Srgb8 => ChannelEncoding::Unorm(8),
                        other => *other,
                    };
                    let mut worked = |operation| judging.logic(bits, operation, codes, stored);
                    cell.channels[c] = match (logic, self.logic_on(attachment.format)) {
                        (Some(operation), SrgbLogic::Applies) => worked(operation),
                        (Some(operation), SrgbLogic::Either) => codes.hull(worked(operation)),
                        _ => codes,
                    };
                }
            }
            let cell = *cell;
            let contents = || self.cell_text(*index, &cell);
            let (attachment_index, aspect) = (*index, Aspect::Color);
            let name = &attachment.name;
            let written = target.write_mask & ((1 << encodings.len()) - 1);
            if written == 0 {
                let effect = Effect::Keeps {
                    attachment: attachment_index,
                    aspect,
                };
                let detail = || {
                    let mask = target.write_mask;
                    format!("write mask {mask:#x}: {name} still holds {}", contents())
                };
                let citation = || self.rules.write_mask.to_owned();
                self.note_effect(notes, place, effect, "keep color", [&detail, &citation]);
                continue;
            }
            let effect = Effect::Stores {
                attachment: attachment_index,
                aspect,
                contents: cell,
            };
            let masked = written.count_ones() != encodings.len() as u32;
            let detail = || {
                let of = match masked {
                    true => format!(" (write mask {:#x})", target.write_mask),
                    false => String::new(),
                };
                format!("{name} holds {}{of}", contents())
            };
            let citation = || match masked {
                true => self.rules.write_mask.to_owned(),
                false => self.rules.store.citation.to_owned(),
            };
            self.note_effect(notes, place, effect, "store color", [&detail, &citation]);
        }
    }
}

/// The value of a destination's missing channel in blending: colours 0, alpha 1 (Vulkan, Blending;
/// OpenGL 4.6, 17.3.6).
fn missing_channels(channels: usize) -> [Option<f64>; 4] {
    std::array::from_fn(|c| {
        let value = if c == 3 { 1.0 } else { 0.0 };
        (c >= channels).then_some(value)
    })
}
