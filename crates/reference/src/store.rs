//! Stores: depth and colours of a fragment that passed, with masks, blending and logic operations.

use crate::fragment::Incoming;
use crate::interval::Interval;
use crate::judging::Judging;
use crate::notes::Notes;
use crate::range::Range;
use crate::rules::{ConstantClamp, NegativeAlpha, SignedClamp, SrgbLogic};
use crate::walk::{FragmentPlace, Walk};
use crate::world::{Contested, Decision, SampleContents, World};
use etalon_frame::{
    Aspect, ChannelEncoding, CodeInterval, Codes, Effect, Step, TextureFormat, ValueRange,
};
use etalon_pipeline::shader::FragmentOutput;
use etalon_pipeline::{Arithmetic, BlendInput, advanced_blend, blend, takes_logic};
use etalon_scene::AdvancedBlend;
use std::hash::{DefaultHasher, Hash, Hasher};
use std::num::NonZeroU64;

impl Walk<'_> {
    /// Stores the depth of a fragment that passed all tests.
    pub(crate) fn write_depth(
        &self,
        place: &FragmentPlace<'_>,
        world: &mut World,
        incoming: Incoming,
        notes: &mut Notes<'_>,
    ) {
        let pass = &self.scene.passes[place.pass];
        if let (Some(state), Some(index)) = (place.draw.depth, pass.depth_stencil)
            && state.write
        {
            world.cells[index].set_channel(0, incoming.codes);
            world.cells[index].origin = incoming.origin;
            let cell = world.cells[index];
            self.note_effect(notes, place, self.rules.store.citation, Some(cell), || {
                let step = Step::StoreDepth {
                    depth: incoming.depth.hull().into(),
                    codes: Codes::new(self.depth_encoding(index), incoming.codes),
                };
                (Effect::Stores(self.target(index, Aspect::Depth)), step)
            });
        } else if let Some(attachment) = pass.depth_stencil
            && self.scene.attachments[attachment].format.has_depth()
        {
            self.note_effect(notes, place, self.rules.write_mask, None, || {
                let tested = place.draw.depth.is_some();
                let target = self.target(attachment, Aspect::Depth);
                (Effect::Keeps(target), Step::KeepDepth { tested })
            });
        }
    }

    /// Returns the codes of a colour that a shader or a blend stores.
    fn store_color(
        &self,
        judging: &mut Judging<'_>,
        encoding: ChannelEncoding,
        value: Range,
        world: &World,
    ) -> CodeInterval {
        let reading = world.decided(Decision::Reading(Contested::SignedResults));
        let is_signed = !matches!(encoding, ChannelEncoding::Snorm(_))
            || reading.unwrap_or_else(|| self.rules.signed_result.value() != SignedClamp::Unit);
        let value = if is_signed {
            value
        } else {
            value.map(|v| v.clamp_number(0.0, 1.0))
        };
        judging.encode(encoding, value)
    }

    /// Returns true if logic operations apply to a format.
    fn has_logic(&self, format: TextureFormat, world: &World) -> bool {
        takes_logic(format)
            || format == TextureFormat::Rgba8UnormSrgb
                && world
                    .decided(Decision::Reading(Contested::SrgbLogic))
                    .unwrap_or_else(|| self.rules.srgb_logic.value() == SrgbLogic::Applies)
    }

    /// Returns the blend constant of a draw.
    fn blend_constant(
        &self,
        place: &FragmentPlace<'_>,
        world: &World,
        judging: &mut Judging<'_>,
    ) -> [Range; 4] {
        place.draw.blend_constant.map(|v| {
            let clamped = v.clamp(0.0, 1.0);
            let is_clamped = clamped != v
                && world
                    .decided(Decision::Reading(Contested::ClampedConstant))
                    .unwrap_or_else(|| self.rules.constant_clamp.value() == ConstantClamp::Always);
            judging.constant(if is_clamped { clamped } else { v })
        })
    }

    /// Returns the colour of an advanced blend of source and destination.
    fn advanced(
        &self,
        place: &FragmentPlace<'_>,
        mode: AdvancedBlend,
        encodings: [ChannelEncoding; 4],
        [src, dst]: [[Range; 4]; 2],
        notes: &mut Notes<'_>,
    ) -> [Range; 4] {
        let mut judging = Judging::of_advanced_blends(self.rules);
        let mut value = advanced_blend(&mut judging, mode, encodings, src, dst);
        let is_negative = |color: [Range; 4]| color[3].hull().low < 0.0;
        let is_normalized = encodings.iter().all(|encoding| !encoding.is_float());
        let is_defined = match self.rules.negative_alpha.value() {
            NegativeAlpha::Defined => true,
            NegativeAlpha::IfNormalized => is_normalized,
            NegativeAlpha::Undefined => false,
        };
        if !is_defined && [src, dst, value].into_iter().any(is_negative) {
            value = [Range::same(Interval::EVERYTHING); 4];
        }
        // Equal codes are equal up to the error of their conversion.
        let exceeds_alpha = |color: [Range; 4]| {
            let alpha = color[3].hull().low + 4.0 * self.rules.decode_error.value();
            color[..3].iter().any(|channel| channel.hull().high > alpha)
        };
        if is_normalized
            && [src, dst].into_iter().any(exceeds_alpha)
            && !self.rules.quotients_beyond_one.value()
        {
            value[..3].fill(Range::same(Interval::EVERYTHING));
        }
        notes.add(
            || place.origin(),
            || Step::AdvancedBlend {
                operation: mode.name().to_owned(),
                src: src.map(ValueRange::from),
                dst: dst.map(ValueRange::from),
                result: value.map(ValueRange::from),
            },
            Some(self.rules.advanced_blend.citation),
        );
        value
    }

    /// Stores the colours of a fragment that passed all tests.
    pub(crate) fn write_colors(
        &self,
        place: &FragmentPlace<'_>,
        world: &mut World,
        output: &FragmentOutput<Range>,
        notes: &mut Notes<'_>,
    ) {
        let reading = |text: Contested| world.decided(Decision::Reading(text));
        let mut judging = Judging::new(self.rules);
        judging.signed_operands = reading(Contested::SignedOperands);
        let one_for_all = reading(Contested::OneForAll).unwrap_or(true);
        let pass = &self.scene.passes[place.pass];
        let mut second = output.second.unwrap_or([Range::exact(0.0); 4]);
        let to_one = place.draw.alpha_to_one() && self.coverage_acts(place);
        if to_one && one_for_all {
            second[3] = Range::exact(1.0);
        }
        let constant = self.blend_constant(place, world, &mut judging);
        for (location, index) in pass.color.iter().enumerate() {
            let Some(target) = place.draw.targets.get(location) else {
                continue;
            };
            let mut color = output.at_location(location);
            if to_one && (location == 0 || one_for_all) {
                color[3] = Range::exact(1.0);
            }
            let attachment = &self.scene.attachments[*index];
            let encodings = attachment.format.color_channels();
            let per_channel: [ChannelEncoding; 4] =
                std::array::from_fn(|c| encodings[c.min(encodings.len() - 1)]);
            let missing = missing_channels(encodings.len());
            let stored = world.cells[*index].channels();
            let mut dst = || {
                std::array::from_fn(|c| match missing[c] {
                    Some(value) => Range::exact(value),
                    None => judging.decode(per_channel[c], stored[c]),
                })
            };
            let mut in_steps: Vec<[Range; 4]> = Vec::new();
            let blending = place.draw.blend_of(target);
            let value = match (&blending, target.advanced) {
                (None, None) => color,
                (None, Some(mode)) => {
                    self.advanced(place, mode, per_channel, [color, dst()], notes)
                }
                (Some(state), _) => {
                    let input = BlendInput {
                        src: color,
                        src1: second,
                        dst: dst(),
                        constant,
                    };
                    let value = blend(&mut judging, state, per_channel, &input);
                    self.note_blend(place, state, &input, value, notes);
                    for further in judging.uniform_steps(encodings) {
                        let mut judging = judging;
                        judging.further_steps = Some(further);
                        let value = blend(&mut judging, state, per_channel, &input);
                        in_steps.push(value.map(|v| Range::same(v.fixed)));
                    }
                    value
                }
            };
            let has_logic = self.has_logic(attachment.format, world);
            let logic = place.draw.logic.filter(|_| has_logic);
            let before = world.cells[*index];
            if let Some(operation) = logic {
                notes.add(
                    || place.origin(),
                    || Step::Logic {
                        operation: operation.name().to_owned(),
                        stored: self.contents(*index, Aspect::Color, &before),
                    },
                    None,
                );
            }
            for (c, encoding) in encodings.iter().enumerate() {
                if target.write_mask & (1 << c) != 0 {
                    let ways = std::iter::once(&value).chain(&in_steps);
                    let codes =
                        ways.map(|v| self.store_color(&mut judging, *encoding, v[c], world));
                    let codes = codes.reduce(CodeInterval::hull).unwrap_or(stored[c]);
                    // On sRGB attachments the operation works on the 8-bit codes.
                    let bits = match encoding {
                        ChannelEncoding::Srgb8 => ChannelEncoding::Unorm(8),
                        other => *other,
                    };
                    let codes = match logic {
                        Some(operation) => judging.logic(bits, operation, codes, stored[c]),
                        None => codes,
                    };
                    world.cells[*index].set_channel(c, codes);
                }
            }
            if !world.cells[*index].is_exact() {
                let keeps = (0..encodings.len()).any(|c| target.write_mask & (1 << c) == 0);
                let blends = blending.is_some() || target.advanced.is_some();
                let read = (keeps || blends || logic.is_some()).then_some(before);
                // Coverage that is still to be decided leaves the origin unknown, so that no two worlds differ in it
                // alone.
                world.cells[*index].origin = if world.decisions.is_empty() {
                    color_origin((place.draw_id, location), [color, second], read)
                } else {
                    None
                };
            }
            let cell = world.cells[*index];
            self.note_store(place, *index, target.write_mask, cell, notes);
        }
    }
}

/// Returns the origin of the colours that a draw stores at an output location: the operands of its arithmetic, if all
/// of them are known exactly. `read` is the destination, if it is one of them.
fn color_origin(
    output: (u32, usize),
    sources: [[Range; 4]; 2],
    read: Option<SampleContents>,
) -> Option<NonZeroU64> {
    let sources = sources.as_flattened().iter();
    let is_exact = |value: &Range| value.is_same() && value.float.low == value.float.high;
    if !sources.clone().all(is_exact) || read.is_some_and(|cell| !cell.is_determined()) {
        return None;
    }
    let mut hasher = DefaultHasher::new();
    output.hash(&mut hasher);
    sources.for_each(|value| value.float.low.to_bits().hash(&mut hasher));
    read.map(|cell| (cell.codes, cell.origin)).hash(&mut hasher);
    NonZeroU64::new(hasher.finish())
}

/// Returns the values of a destination's missing channels in blending: colours 0, alpha 1 (Vulkan, Blending;
/// OpenGL 4.6, 17.3.6).
fn missing_channels(channels: usize) -> [Option<f64>; 4] {
    std::array::from_fn(|c| {
        let value = if c == 3 { 1.0 } else { 0.0 };
        (c >= channels).then_some(value)
    })
}
