//! Signatures: everything that a draw's outcome at a sample depends on, apart from the sample's earlier
//! contents. Samples with equal signatures and equal contents have equal contents afterwards, so only one of
//! them is judged.

use crate::interval::Interval;
use crate::primitive::{EdgeSide, Shape, SnappedPrimitive};
use crate::range::Range;
use crate::sample::Sample;
use crate::walk::{FragmentPlace, Hit, Walk};
use crate::world::World;
use etalon_frame::Rejection;
use etalon_scene::{AttachmentContents, Draw, EarlyTests, InterpolationSampling, Multisample};
use rustc_hash::FxHashMap;
use smallvec::SmallVec;
use std::num::NonZeroU64;

/// The inputs of a draw's fragments that its signatures must distinguish.
#[derive(Clone, Debug)]
pub(crate) struct SignatureInputs {
    /// True if the fragment's own depth is tested, stored or both.
    depth: bool,
    /// True if the shader reads the fragment's depth.
    depth_seen: bool,
    coordinates: bool,
    /// True if the shader reads the sample mask.
    mask_seen: bool,
    /// True if the number of the sample, or its position in the texel, matters.
    sample: bool,
    /// True if the primitives themselves matter, because counters identify fragments by them.
    primitives: bool,
    textures: SmallVec<[TextureEffect; 2]>,
    /// For each primitive, the number of the set of values that are constant over it.
    kinds: Vec<u32>,
}

/// The effect of a texture that a draw reads on its signatures.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum TextureEffect {
    /// Only through the sample's contents and the coordinates.
    Known,
    /// Through the texel under the sample, as uploaded.
    Uploaded(usize),
    /// Through the value that the shader reads.
    Value(usize),
}

/// A draw's part of a signature: the words and hits from the first ones on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct SignaturePart {
    pub(crate) draw: u32,
    first_word: u32,
    first_hit: u32,
}

/// The signature of a sample over all draws of a pass that can touch it.
#[derive(Clone, Debug, Default)]
pub(crate) struct SampleKey {
    pub(crate) words: Vec<u64>,
    /// The draws that touch the sample, in order.
    pub(crate) parts: Vec<SignaturePart>,
    /// The primitives that cover the sample, by their indices in the draws' setups.
    hits: Vec<(u32, Hit)>,
    /// The sides for all primitives, even if they miss the sample.
    sides: Vec<[EdgeSide; 3]>,
    /// True if all samples in the row between this sample and another with equal signature and sides also
    /// have that signature.
    constant: bool,
    /// True if the signature leaves out inputs that vary, so that each sample must be drawn by itself.
    pub(crate) varies: bool,
}

impl SampleKey {
    /// Returns the words of one of the draws.
    pub(crate) fn words_of(&self, part: usize) -> &[u64] {
        let end = self
            .parts
            .get(part + 1)
            .map(|next| next.first_word as usize);
        &self.words[self.parts[part].first_word as usize..end.unwrap_or(self.words.len())]
    }

    /// Returns the primitives of one of the draws that cover the sample.
    pub(crate) fn hits_of(&self, part: usize) -> &[(u32, Hit)] {
        let end = self.parts.get(part + 1).map(|next| next.first_hit as usize);
        &self.hits[self.parts[part].first_hit as usize..end.unwrap_or(self.hits.len())]
    }

    /// Returns words that are equal for samples that the same primitives cover with equal signatures.
    pub(crate) fn identity(&self) -> Vec<u64> {
        let parts = self.parts.iter();
        let parts = parts.map(|part| u64::from(part.draw) << 32 | u64::from(part.first_word));
        let primitives = self.hits.iter().map(|(primitive, _)| u64::from(*primitive));
        let lengths = (self.words.len() as u64) << 32 | self.parts.len() as u64;
        let words = std::iter::once(lengths).chain(self.words.iter().copied());
        words.chain(parts).chain(primitives).collect()
    }

    /// Returns true if all samples in a row between two samples with these signatures have the same
    /// signature. The points that are certainly on one side of an edge form a half-plane, whose points in a
    /// row form an interval.
    pub(crate) fn spans(&self, other: &Self) -> bool {
        self.constant
            && other.constant
            && self.words == other.words
            && self.parts == other.parts
            && self.sides == other.sides
    }
}

fn bits(value: Interval) -> [u64; 2] {
    [value.low.to_bits(), value.high.to_bits()]
}

fn range_bits(value: Range) -> [[u64; 2]; 3] {
    [value.float, value.codes, value.fixed].map(bits)
}

impl Walk<'_> {
    /// Returns the inputs of a draw.
    pub(crate) fn inputs(&self, pass: usize, index: usize) -> SignatureInputs {
        let draw = &self.scene.passes[pass].draws[index];
        let tests_depth = self.scene.passes[pass].depth_stencil.is_some() && draw.depth.is_some();
        let forced = draw.early_tests == EarlyTests::Forced;
        let state = &draw.multisample;
        let samples = self.scene.pass_samples(&self.scene.passes[pass]);
        let full_mask = (1_u64 << samples) - 1;
        let plain = Multisample {
            mask: state.mask,
            ..Multisample::default()
        };
        let masked = u64::from(state.mask) & full_mask != full_mask;
        let mut inputs = SignatureInputs {
            depth: tests_depth && (forced || !draw.shader.writes_depth()),
            depth_seen: draw.shader.reads_depth(),
            coordinates: draw.shader.reads_coordinates(),
            mask_seen: draw.shader.reads_mask(),
            sample: masked
                || *state != plain
                || draw.shader.runs_per_sample()
                || draw.shader.writes_mask()
                || draw.shader.reads_mask()
                || draw.shader.interpolation_sampling() != InterpolationSampling::Center,
            primitives: !draw.counters.is_empty(),
            textures: draw
                .textures
                .iter()
                .map(|i| self.texture(pass, draw, *i))
                .collect(),
            kinds: Vec::new(),
        };
        let mut known = FxHashMap::default();
        let primitives = self.setups[pass].primitives_of(index);
        // Neighbours often have the same values.
        let mut latest = (SmallVec::new(), 0);
        inputs.kinds = primitives
            .iter()
            .map(|primitive| {
                let kind = inputs.kind(primitive);
                if kind != latest.0 {
                    let next = known.len() as u32;
                    latest = (kind.clone(), *known.entry(kind).or_insert(next));
                }
                latest.1
            })
            .collect();
        inputs
    }

    fn texture(&self, pass: usize, draw: &Draw, index: usize) -> TextureEffect {
        let attachment = &self.scene.attachments[index];
        let drawn = self.is_drawn_before(index, pass);
        let reading_pass = &self.scene.passes[pass];
        if reading_pass.attaches(index) {
            // The sample's state has it.
            return TextureEffect::Known;
        }
        let same_size = attachment.size == self.scene.pass_size(reading_pass);
        let same_shape = same_size && attachment.samples == self.scene.pass_samples(reading_pass);
        match (draw.sampler.filter(|_| draw.shader.uses_uv()), drawn) {
            // The coordinates select the texels, which are the same for all samples.
            (Some(_), false) => TextureEffect::Known,
            (Some(_), true) => TextureEffect::Value(index),
            (None, true) if same_shape || !same_size => TextureEffect::Known,
            (None, true) => TextureEffect::Value(index),
            (None, false) => match &attachment.contents {
                AttachmentContents::Texels(_) => TextureEffect::Uploaded(index),
                _ => TextureEffect::Known,
            },
        }
    }

    /// Returns the signature of a sample. `members` are the primitives of the pass that can touch it, each as
    /// draw and index in the draw's setup, in drawing order. The signature contains inputs that vary over a
    /// primitive only if `names_inputs` returns true for the draw.
    pub(crate) fn sign(
        &self,
        pass: usize,
        inputs: &[SignatureInputs],
        at: Sample,
        members: impl Iterator<Item = (u32, u32)>,
        names_inputs: impl Fn(u32) -> bool,
        signature: &mut SampleKey,
    ) {
        signature.words.clear();
        signature.parts.clear();
        signature.hits.clear();
        signature.sides.clear();
        signature.constant = true;
        signature.varies = false;
        let point = self.sample_point(at);
        let setup = &self.setups[pass];
        for (d, i) in members {
            let draw = &self.scene.passes[pass].draws[d as usize];
            let primitive = &setup.primitives_of(d as usize)[i as usize];
            let inputs = &inputs[d as usize];
            let sides = self.sides_of(primitive, at, point);
            signature.sides.push(sides);
            let hit = match self.hit((pass, d as usize), primitive, sides, point) {
                Ok(hit) => hit,
                Err(reason) => {
                    // A primitive that is clipped at both ends of a run of texels can still reach between
                    // them, and a line that misses both ends can cross the row there.
                    let triangle = matches!(primitive.shape, Shape::Triangle(_));
                    signature.constant &= triangle && reason == Rejection::Coverage;
                    continue;
                }
            };
            if signature.parts.last().is_none_or(|part| part.draw != d) {
                signature.parts.push(SignaturePart {
                    draw: d,
                    first_word: signature.words.len() as u32,
                    first_hit: signature.hits.len() as u32,
                });
                self.sign_draw(inputs, at, signature);
            }
            signature.hits.push((i, hit));
            let place = FragmentPlace {
                at,
                point,
                sides: hit.sides,
                pass,
                draw_index: d as usize,
                draw,
                primitive_index: primitive.index as usize,
                primitive,
                draw_id: self.draw_ids[pass] + d,
                world: (0, 1),
            };
            self.sign_primitive(&place, hit, inputs.kinds[i as usize], inputs, signature);
            if inputs.vary(primitive) {
                if names_inputs(d) {
                    signature.constant = false;
                    self.sign_inputs(&place, inputs, signature);
                } else {
                    signature.varies = true;
                }
            }
        }
    }

    /// Adds the words that all primitives of a draw share.
    fn sign_draw(&self, inputs: &SignatureInputs, at: Sample, signature: &mut SampleKey) {
        if inputs.sample {
            signature.words.push(u64::from(at.sample));
        }
        for texture in &inputs.textures {
            let TextureEffect::Uploaded(index) = texture else {
                continue;
            };
            signature.constant = false;
            let attachment = &self.scene.attachments[*index];
            if let AttachmentContents::Texels(codes) = &attachment.contents {
                let channels = attachment.format.color_channels().len();
                let start =
                    (at.y as usize * attachment.size[0] as usize + at.x as usize) * channels;
                let texel = codes.get(start..start + channels).unwrap_or_default();
                signature
                    .words
                    .extend(texel.iter().map(|code| u64::from(*code)));
            }
        }
    }

    fn sign_primitive(
        &self,
        place: &FragmentPlace<'_>,
        hit: Hit,
        kind: u32,
        inputs: &SignatureInputs,
        signature: &mut SampleKey,
    ) {
        let primitive = place.primitive;
        let flags = u64::from(hit.in_viewport)
            | u64::from(hit.in_depth) << 1
            | u64::from(hit.in_distances) << 2;
        let mut word = u64::from(kind) | flags << 32;
        let mut names_itself = inputs.primitives;
        signature.constant &= hit.is_certain();
        if let Shape::Triangle(triangle) = &primitive.shape {
            for (i, side) in hit.sides.into_iter().enumerate() {
                word |= (side as u64) << (35 + 2 * i);
            }
            let (least, most) = triangle.area;
            let certain = |side: EdgeSide| matches!(side, EdgeSide::Positive | EdgeSide::Negative);
            let certain = (least > 0 || most < 0) && hit.sides.into_iter().all(certain);
            names_itself |= !certain;
            signature.constant &= certain;
        } else {
            let (least, most) = self.times(place);
            word |= u64::from(least) << 35 | u64::from(most) << 37;
            signature.constant = false;
        }
        signature.words.push(word);
        if names_itself {
            signature.words.push(u64::from(primitive.index));
        }
    }

    /// Adds the values of inputs that vary over a primitive.
    fn sign_inputs(
        &self,
        place: &FragmentPlace<'_>,
        inputs: &SignatureInputs,
        signature: &mut SampleKey,
    ) {
        let primitive = place.primitive;
        if inputs.depth && !primitive.window_depth.is_flat() {
            let depth = self.own_depth(place);
            signature.words.extend(bits(depth.float));
        }
        if inputs.depth_seen && !primitive.window_depth.is_flat() {
            let samples = self.samples_shaded(place);
            let depth = primitive.depth_seen(place.point, self.units, samples);
            signature.words.extend(bits(depth.float));
        }
        if primitive.w_varies() {
            signature.words.extend(bits(self.reciprocal_w(place).float));
        }
        if primitive.uv_varies() {
            for axis in self.uv(place) {
                signature.words.extend(bits(axis.float));
            }
        }
        if inputs.coordinates {
            for axis in self.frag_coord(place) {
                signature.words.extend(bits(axis.float));
            }
        }
        if inputs.mask_seen {
            for mask in self.input_masks(place) {
                let words = [mask.set, mask.possible].map(u64::from);
                signature.words.extend(words);
            }
        }
        for (t, texture) in inputs.textures.iter().enumerate() {
            if let TextureEffect::Value(_) = texture {
                let nowhere = World::default();
                for channel in self.texel(place, &nowhere, t) {
                    signature.words.extend(range_bits(channel).as_flattened());
                }
            }
        }
    }
}

impl SignatureInputs {
    /// Returns true if signatures have values that earlier passes drew.
    pub(crate) fn reads_earlier_passes(&self) -> bool {
        let drawn = |texture: &TextureEffect| matches!(texture, TextureEffect::Value(_));
        self.textures.iter().any(drawn)
    }

    /// Returns true if inputs of a primitive's fragments vary over it.
    fn vary(&self, primitive: &SnappedPrimitive) -> bool {
        (self.depth || self.depth_seen) && !primitive.window_depth.is_flat()
            || primitive.w_varies()
            || primitive.uv_varies()
            || self.coordinates
            || self.mask_seen
            || self.reads_earlier_passes()
    }

    /// Returns the values that are constant over a primitive.
    fn kind(&self, primitive: &SnappedPrimitive) -> SmallVec<[u64; 24]> {
        let mut words: SmallVec<[u64; 24]> = SmallVec::new();
        words.push(match &primitive.shape {
            Shape::Point { .. } => 0,
            Shape::Line(_) => 1,
            Shape::Triangle(triangle) => 2 + facings(triangle.area),
            Shape::Outline(triangle) => 6 + facings(triangle.area),
        });
        for channel in primitive.flat_color() {
            words.extend(bits(channel));
        }
        words.extend(bits(primitive.bias));
        words.push(u64::from(primitive.geometry.is_some()) | u64::from(primitive.beyond) << 1);
        words.extend(primitive.geometry.map(NonZeroU64::get));
        if (self.depth || self.depth_seen) && primitive.window_depth.is_flat() {
            words.extend(bits(primitive.window_depth.hull));
        }
        let uv = primitive.uv.iter().flat_map(|uv| uv.iter());
        let varyings = uv.chain(primitive.reciprocal_w.as_deref());
        for flat in varyings.filter(|varying| varying.is_flat()) {
            words.extend(bits(flat.hull()));
        }
        words
    }
}

/// Returns the facings that a triangle with areas in this range can have, as a number below 4.
fn facings((least, most): (i64, i64)) -> u64 {
    u64::from(least < 0) | u64::from(most > 0) << 1
}
