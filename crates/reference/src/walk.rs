//! The walk of one sample through its worlds. Samples are walked one by one, so that a story needs no walk of
//! the others.

use crate::bins::PassSetup;
use crate::notes::{Note, Notes, Skipped};
use crate::possible::Possible;
use crate::primitive::{EdgeSide, Shape, SnappedPrimitive, misses};
use crate::read_back::{converted, depth_encoding, read_path};
use crate::readings::OpenTexts;
use crate::rounding::all_codes;
use crate::rules::{Copies, Rules};
use crate::sample::{self, Sample};
use crate::setups::setups;
use crate::sides::sides;
use crate::snap::{SnapBox, units_per_texel};
use crate::states::StatePictures;
use crate::texels::Texels;
use crate::undefined::Undefined;
use crate::world::{Decision, World, Worlds, merge};
use etalon_frame::{
    Aspect, ChannelEncoding, CodeInterval, Limits, Origin, ReadPath, Rejection, Step, TexelSet,
    WorldBox,
};
use etalon_pipeline::Point;
use etalon_scene::{Attachment, Draw, Scene};
use smallvec::SmallVec;
use std::borrow::Cow;
use std::cell::{Cell, RefCell};
use std::collections::HashMap;
use std::hash::{DefaultHasher, Hash, Hasher};
use std::num::NonZeroU64;
use std::rc::Rc;
use std::sync::Arc;

/// Worlds by sample and number of passes; `None` if the sample is open.
type SampleWorlds = HashMap<(Sample, usize), Option<Rc<Worlds>>>;

/// Returns true if a texel is inside a draw's scissor rectangle.
pub(crate) fn in_scissor(draw: &Draw, at: Sample) -> bool {
    draw.scissor
        .is_none_or(|[x, y, w, h]| at.x >= x && at.y >= y && at.x - x < w && at.y - y < h)
}

pub(crate) struct Walk<'a> {
    pub(crate) scene: &'a Scene,
    pub(crate) limits: &'a Limits,
    pub(crate) rules: &'a Rules,
    /// Per pass.
    pub(crate) setups: Arc<[PassSetup]>,
    /// Per pass and draw.
    pub(crate) open_texts: Vec<Vec<OpenTexts>>,
    /// Per pass, the number of its first draw, counted over the scene from 1.
    pub(crate) draw_ids: Vec<u32>,
    pub(crate) units: i64,
    /// For each attachment, the encoding of its depth, if it has one.
    depth_encodings: Vec<ChannelEncoding>,
    /// The judged texels.
    pub(crate) texels: Texels,
    /// The results that depend on discarded contents.
    pub(crate) undefined: Undefined,
    /// Samples of other texels that a story needed, by number of passes.
    known: RefCell<SampleWorlds>,
    /// A line that the walk lets cover a sample, even if the rules leave that open.
    pub(crate) forced: Cell<Option<Forced>>,
    pub(crate) pictures: RefCell<StatePictures>,
}

/// A line, or an outline, that covers a sample.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Forced {
    pub(crate) at: Sample,
    /// The draw, counted over the scene from 1.
    pub(crate) draw: u32,
    /// The primitive's index in the draw.
    pub(crate) primitive: u32,
}

/// The coverage of a sample by a primitive.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) struct Hit {
    /// The sides of a triangle's edges on which the sample is.
    pub(crate) sides: [EdgeSide; 3],
    /// True if the sample is certainly inside the viewport.
    pub(crate) in_viewport: bool,
    /// True if the near and far planes certainly do not clip the sample.
    pub(crate) in_depth: bool,
    /// True if certainly no clip distance clips the sample.
    pub(crate) in_distances: bool,
}

impl Hit {
    /// Returns true if the fragment is certainly not clipped.
    pub(crate) fn is_certain(self) -> bool {
        self.in_viewport && self.in_depth && self.in_distances
    }
}

/// The place of a fragment: its sample, pass, draw and primitive.
#[derive(Clone, Copy)]
pub(crate) struct FragmentPlace<'a> {
    pub(crate) at: Sample,
    /// The sample's position in sub-texel units.
    pub(crate) point: Point,
    /// The sides of a triangle's edges on which the sample is.
    pub(crate) sides: [EdgeSide; 3],
    pub(crate) pass: usize,
    pub(crate) draw_index: usize,
    pub(crate) draw: &'a Draw,
    pub(crate) primitive_index: usize,
    pub(crate) primitive: &'a SnappedPrimitive,
    /// Unique over the scene.
    pub(crate) draw_id: u32,
    /// The index of the world and the number of worlds, for the story; 0 if there is only one.
    pub(crate) world: (usize, usize),
}

impl FragmentPlace<'_> {
    /// Returns the origin of the fragment's events.
    pub(crate) fn origin(&self) -> Origin {
        let (world, worlds) = self.world;
        Origin::Fragment {
            pass: self.pass,
            draw: self.draw_index,
            primitive: self.primitive_index as u32,
            world: (world > 0).then_some([world, worlds]),
        }
    }
}

impl<'a> Walk<'a> {
    pub(crate) fn new(
        scene: &'a Scene,
        limits: &'a Limits,
        rules: &'a Rules,
        texels: Texels,
    ) -> Self {
        let setups = setups(scene, limits, rules, texels, true);
        Self::over(scene, limits, rules, texels, setups.into())
    }

    /// Returns a walk over primitives that were set up before.
    pub(crate) fn over(
        scene: &'a Scene,
        limits: &'a Limits,
        rules: &'a Rules,
        texels: Texels,
        setups: Arc<[PassSetup]>,
    ) -> Self {
        let open_texts = scene.passes.iter().map(|pass| {
            let each = pass.draws.iter();
            each.map(|draw| OpenTexts::new(rules, scene, pass, draw))
                .collect()
        });
        let mut draws = 1;
        let draw_ids = scene.passes.iter().map(|pass| {
            let first = draws;
            draws += pass.draws.len() as u32;
            first
        });
        Self {
            scene,
            limits,
            rules,
            setups,
            open_texts: open_texts.collect(),
            draw_ids: draw_ids.collect(),
            units: units_per_texel(limits),
            depth_encodings: (0..scene.attachments.len())
                .map(|index| depth_encoding(scene, limits, index))
                .collect(),
            texels,
            undefined: Undefined::of(scene),
            known: RefCell::default(),
            forced: Cell::default(),
            pictures: RefCell::default(),
        }
    }

    /// Returns the worlds of another sample after the first passes; `None` if it is open. A sample of a
    /// picture is taken from there, since the picture has been painted up to the current pass.
    pub(crate) fn earlier(&self, at: Sample, passes: usize) -> Option<Rc<Worlds>> {
        let pictures = self.pictures.borrow();
        if pictures.has(at) {
            return pictures.states.worlds(pictures.state(at)).cloned();
        }
        drop(pictures);
        let key = (at, passes);
        if let Some(known) = self.known.borrow().get(&key) {
            return known.clone();
        }
        let worlds = self.worlds(at, passes, &mut Notes(None)).map(Rc::new);
        self.known.borrow_mut().insert(key, worlds.clone());
        worlds
    }

    /// Forgets the worlds of other samples.
    #[cfg(test)]
    pub(crate) fn forget(&self) {
        self.known.borrow_mut().clear();
    }

    /// Makes a line cover a sample from now on. Replaces an earlier call.
    pub(crate) fn force(&self, forced: Forced) {
        self.forced.set(Some(forced));
        self.known.borrow_mut().clear();
    }

    /// Returns the encoding in which an attachment stores its depth.
    pub(crate) fn depth_encoding(&self, attachment: usize) -> ChannelEncoding {
        self.depth_encodings[attachment]
    }

    /// Returns the encodings in which an aspect is read back, and the read path.
    pub(crate) fn read_encoding(
        &self,
        attachment: usize,
        aspect: Aspect,
    ) -> (Cow<'static, [ChannelEncoding]>, ReadPath) {
        let format = self.scene.attachments[attachment].format;
        let read = read_path(self.limits, format);
        match aspect {
            Aspect::Color => (Cow::Borrowed(format.color_channels()), read),
            Aspect::Depth => match (read, self.depth_encoding(attachment)) {
                (ReadPath::Shader, _) => (Cow::Borrowed(&[ChannelEncoding::Float32]), read),
                (ReadPath::Copy, encoding) => (Cow::Owned(vec![encoding]), read),
            },
            // Integers are exact, however they are read.
            Aspect::Stencil => (Cow::Borrowed(&[ChannelEncoding::Uint(8)]), ReadPath::Copy),
        }
    }

    pub(crate) fn sample(&self, at: Sample, notes: &mut Vec<Note>) -> TexelSet {
        let mut notes = Notes(Some(notes));
        match self.worlds(at, self.scene.passes.len(), &mut notes) {
            Some(worlds) => self.finish(&worlds, at, &mut notes),
            None => TexelSet::default(),
        }
    }

    /// Returns the worlds of a sample after the first passes; `None` if it is open.
    pub(crate) fn worlds(
        &self,
        at: Sample,
        passes: usize,
        notes: &mut Notes<'_>,
    ) -> Option<Worlds> {
        let mut worlds: Worlds = SmallVec::new();
        worlds.push(self.initial(at, notes));
        for (p, pass) in self.scene.passes[..passes].iter().enumerate() {
            let shape = (self.scene.pass_size(pass), self.scene.pass_samples(pass));
            let is_own = shape == (at.size, at.samples);
            if !is_own && !pass.draws.is_empty() {
                let (size, samples) = shape;
                notes.add(
                    || Origin::Pass(p),
                    || Step::OtherAttachments { size, samples },
                    None,
                );
            }
            if is_own {
                self.load(p, &mut worlds, notes);
            }
            for (d, draw) in pass.draws.iter().enumerate().filter(|_| is_own) {
                self.clear((p, d), at, &mut worlds, notes);
                if draw.rasterizer_discard || !in_scissor(draw, at) {
                    self.note_draw(notes, (p, d, draw));
                    continue;
                }
                let point = self.sample_point(at);
                let primitives = self.setups[p].at(d, at.x, at.y).map(|primitive| {
                    let sides = self.sides_of(primitive, at, point);
                    (primitive, self.hit((p, d), primitive, sides, point))
                });
                worlds = self.draw(at, (p, d), primitives, &worlds, notes)?;
            }
            if is_own {
                self.clear((p, pass.draws.len()), at, &mut worlds, notes);
            }
            self.end_pass(&mut worlds);
            for (source, target) in self.resolves_into(p, at) {
                let outcomes = self.resolve(source, target, at, p + 1, notes)?;
                worlds = resolved(&worlds, target, &outcomes)?;
            }
            self.resolve_depth_stencil(p, at, &mut worlds, notes)?;
            self.store(p, notes);
        }
        Some(worlds)
    }

    /// Carries worlds through the primitives of one draw, given with their coverage of the sample or the
    /// reason for missing it; `None` if the sample is open after it.
    pub(crate) fn draw<'s>(
        &self,
        at: Sample,
        (p, d): (usize, usize),
        primitives: impl Iterator<Item = (&'s SnappedPrimitive, Result<Hit, Rejection>)>,
        before: &Worlds,
        notes: &mut Notes<'_>,
    ) -> Option<Worlds> {
        let draw = &self.scene.passes[p].draws[d];
        if self.open_texts[p][d].vertices {
            return None;
        }
        let mut skipped = Skipped::new(notes);
        let mut drawn: Option<Worlds> = None;
        let point = self.sample_point(at);
        for (primitive, hit) in primitives {
            let hit = match hit {
                Ok(hit) => hit,
                Err(reason) => {
                    skipped.add(primitive.index, Some(reason));
                    continue;
                }
            };
            let place = FragmentPlace {
                at,
                point,
                sides: hit.sides,
                pass: p,
                draw_index: d,
                draw,
                primitive_index: primitive.index as usize,
                primitive,
                draw_id: self.draw_ids[p] + d as u32,
                world: (0, 1),
            };
            skipped.add(primitive.index, None);
            if !hit.is_certain() {
                self.note_clipping(notes, &place, hit);
            }
            let earlier = drawn.as_ref().unwrap_or(before);
            let mut worlds = self.primitive(&place, earlier, notes);
            // A sample that may be clipped away can also keep its contents.
            if !hit.is_certain() {
                worlds.extend(earlier.iter().cloned());
            }
            if !merge(&mut worlds) {
                notes.add(
                    || place.origin(),
                    || Step::GiveUp {
                        worlds: worlds.len(),
                    },
                    None,
                );
                return None;
            }
            drawn = Some(worlds);
        }
        self.note_skipped(notes, (p, d, draw), skipped);
        let mut worlds = drawn.unwrap_or_else(|| before.clone());
        // Later draws do not share this one's edges.
        let outlives = |(decision, _): &(Decision, bool)| decision.outlives_its_draw();
        worlds.iter_mut().for_each(|w| w.decisions.retain(outlives));
        merge(&mut worlds);
        Some(worlds)
    }

    /// Returns how a primitive covers a sample with these sides of its edges, or why it does not.
    pub(crate) fn hit(
        &self,
        (p, d): (usize, usize),
        primitive: &SnappedPrimitive,
        sides: [EdgeSide; 3],
        point: Point,
    ) -> Result<Hit, Rejection> {
        let draw = &self.scene.passes[p].draws[d];
        if let Shape::Triangle(triangle) = &primitive.shape
            && misses(triangle, sides)
        {
            return Err(Rejection::Coverage);
        }
        let spread = self.anywhere(self.scene.pass_samples(&self.scene.passes[p]));
        let clip = self.setups[p].clip(d);
        let sample = SnapBox::of_sample(point, spread);
        let in_viewport = clip.holds(primitive, sample, self.rules, self.units);
        if !in_viewport.can() {
            let reached = primitive.times(point, sample, self.units).1 > 0;
            return Err(if reached {
                Rejection::Viewport
            } else {
                Rejection::Coverage
            });
        }
        let passes =
            matches!(primitive.shape, Shape::Point { .. }) && !self.rules.clips_points.value();
        let in_depth = if draw.depth_clamp {
            Possible::Always
        } else {
            match primitive.inside_depth(point, spread) {
                Possible::Never if passes => Possible::Maybe,
                inside => inside,
            }
        };
        if !in_depth.can() {
            return Err(Rejection::NearFar);
        }
        let in_distances = primitive.inside_distances(point, spread);
        if !in_distances.can() {
            return Err(Rejection::ClipDistance);
        }
        Ok(Hit {
            sides,
            in_viewport: in_viewport.must(),
            in_depth: in_depth.must(),
            in_distances: in_distances.must(),
        })
    }

    /// Returns the units of a texel if its samples, of this number, can be anywhere in it.
    pub(crate) fn anywhere(&self, samples: u32) -> Option<i64> {
        let is_open = samples > 1 && !self.rules.covers_at_positions.value();
        is_open.then_some(self.units)
    }

    /// Forgets the decisions of a pass at its end.
    pub(crate) fn end_pass(&self, worlds: &mut Worlds) {
        worlds.iter_mut().for_each(|w| w.decisions.clear());
        merge(worlds);
    }

    /// Returns the resolves at the end of a pass into attachments of a sample's shape, as source and target.
    pub(crate) fn resolves_into(&self, pass: usize, at: Sample) -> Vec<(usize, usize)> {
        let pass = &self.scene.passes[pass];
        let both = pass.color.iter().zip(&pass.resolve);
        let both = both.filter_map(|(source, target)| Some((*source, (*target)?)));
        both.filter(|(_, target)| {
            let attachment = &self.scene.attachments[*target];
            (attachment.size, attachment.samples) == (at.size, at.samples)
        })
        .collect()
    }

    /// Returns the sides of a triangle's edges on which a sample is; unknown sides for other shapes.
    pub(crate) fn sides_of(
        &self,
        primitive: &SnappedPrimitive,
        at: Sample,
        point: Point,
    ) -> [EdgeSide; 3] {
        match &primitive.shape {
            Shape::Triangle(triangle) => sides(self.rules, triangle, at, point, self.units),
            _ => [EdgeSide::Unknown; 3],
        }
    }

    pub(crate) fn sample_point(&self, at: Sample) -> Point {
        at.point(self.limits)
    }

    /// Returns the legal set of a sample of a picture; nothing is asserted about an open sample.
    pub(crate) fn set(
        &self,
        worlds: Option<&Rc<Worlds>>,
        (size, samples): sample::SampleShape,
    ) -> TexelSet {
        let at = Sample {
            size,
            samples,
            x: 0,
            y: 0,
            sample: 0,
        };
        worlds.map_or_else(TexelSet::default, |worlds| {
            self.finish(worlds, at, &mut Notes(None))
        })
    }

    /// Returns the attachments that are read back and have the size and the samples of a sample's, with their indices.
    fn read_in(&self, at: Sample) -> impl Iterator<Item = (usize, &Attachment)> {
        let read = self.scene.read.iter();
        let all = read.map(|index| (*index, &self.scene.attachments[*index]));
        all.filter(move |(_, a)| (a.size, a.samples) == (at.size, at.samples))
    }

    /// Returns the legal set of the attachments that are read back.
    pub(crate) fn finish(&self, worlds: &[World], at: Sample, notes: &mut Notes<'_>) -> TexelSet {
        let mut set = TexelSet::default();
        for (w, world) in worlds.iter().enumerate() {
            let mut channels: SmallVec<[CodeInterval; 6]> = SmallVec::new();
            for (index, attachment) in self.read_in(at) {
                let cell = &world.cells[index];
                for aspect in attachment.format.aspects() {
                    let first = channels.len();
                    match aspect {
                        Aspect::Color => {
                            let encodings = attachment.format.color_channels();
                            let stored = cell.channels().into_iter().zip(encodings);
                            channels.extend(
                                stored.map(|(c, e)| self.read_color(attachment.samples, *e, c)),
                            );
                        }
                        Aspect::Depth => channels.push(self.read_depth(index, cell.channel(0))),
                        Aspect::Stencil => {
                            channels.push(CodeInterval::exact(i64::from(cell.stencil)));
                        }
                    }
                    self.open_undefined(index, *aspect, &mut channels[first..]);
                }
                notes.add(
                    || Origin::End {
                        world: (worlds.len() > 1).then_some([w + 1, worlds.len()]),
                    },
                    || Step::ReadBack {
                        attachment: attachment.name.clone(),
                        contents: self.all_contents(index, cell),
                        depth_by_shader: attachment.format.has_depth()
                            && read_path(self.limits, attachment.format) == ReadPath::Shader,
                    },
                    None,
                );
            }
            set.worlds.push(WorldBox { channels });
        }
        if let ([world], [values]) = (worlds, &set.worlds[..]) {
            set.operands = self.operands(world, at, values);
        }
        set
    }

    /// Returns the number of the operands that the colours of a sample come from, if they are known and the colours
    /// are read back as they are stored.
    fn operands(&self, world: &World, at: Sample, read: &WorldBox) -> Option<NonZeroU64> {
        let mut hasher = DefaultHasher::new();
        let mut has_origin = false;
        let mut read = read.channels.iter();
        for (index, attachment) in self.read_in(at) {
            let cell = &world.cells[index];
            for aspect in attachment.format.aspects() {
                if *aspect != Aspect::Color {
                    read.next();
                    continue;
                }
                let channels = attachment.format.color_channels().len();
                let as_stored = (0..channels).all(|c| read.next() == Some(&cell.channel(c)));
                if !as_stored || !cell.is_determined() {
                    return None;
                }
                has_origin |= cell.origin.is_some();
                (index, cell.codes, cell.origin).hash(&mut hasher);
            }
        }
        NonZeroU64::new(hasher.finish()).filter(|_| has_origin)
    }

    /// Returns a colour as it is read back.
    fn read_color(
        &self,
        samples: u32,
        encoding: ChannelEncoding,
        stored: CodeInterval,
    ) -> CodeInterval {
        let least = encoding.min_order();
        let stored = match encoding {
            // No API copies individual samples: a shader reads them, and it sees both codes of -1 as one
            // value.
            ChannelEncoding::Snorm(_) if samples > 1 && stored.low == least => {
                stored.hull(CodeInterval::exact(least + 1))
            }
            _ => stored,
        };
        let one_code = !encoding.is_float() && !matches!(encoding, ChannelEncoding::Snorm(_));
        if one_code || self.rules.copies.value() == Copies::Exact {
            return stored;
        }
        match encoding {
            // Both codes of -1 are possible.
            ChannelEncoding::Snorm(_) if stored.low <= encoding.min_order() + 1 => {
                CodeInterval::new(encoding.min_order(), stored.high)
            }
            _ if !encoding.is_float() => stored,
            _ => {
                let finite = CodeInterval::new(encoding.min_order(), encoding.max_order());
                if !finite.contains(stored.low) || !finite.contains(stored.high) {
                    return all_codes(encoding);
                }
                // A subnormal value may be flushed to zero.
                match encoding.least_normal_order() {
                    least if stored.low.abs() < least || stored.high.abs() < least => {
                        stored.hull(CodeInterval::exact(0))
                    }
                    _ => stored,
                }
            }
        }
    }

    /// Returns a depth as it is read back: its code, or the float that a shader reads.
    pub(crate) fn read_depth(&self, attachment: usize, stored: CodeInterval) -> CodeInterval {
        let encoding = self.depth_encoding(attachment);
        match read_path(self.limits, self.scene.attachments[attachment].format) {
            ReadPath::Shader if encoding != ChannelEncoding::Float32 => {
                converted(self.rules, (encoding, stored), ChannelEncoding::Float32)
            }
            ReadPath::Shader | ReadPath::Copy => stored,
        }
    }
}

/// Returns worlds with the outcomes of a resolve; `None` if there are too many.
pub(crate) fn resolved(
    worlds: &Worlds,
    target: usize,
    outcomes: &[[CodeInterval; 4]],
) -> Option<Worlds> {
    let each = worlds.iter().flat_map(|world| {
        outcomes.iter().map(|channels| {
            let mut world = world.clone();
            world.cells[target].set_channels(*channels);
            world
        })
    });
    let mut worlds: Worlds = each.collect();
    merge(&mut worlds).then_some(worlds)
}
