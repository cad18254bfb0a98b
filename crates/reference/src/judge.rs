//! The walk over samples and worlds.

use crate::judging::{Judging, Range};
use crate::rules::{Rules, SharedEdge};
use crate::setup::{self, DrawSetup, Primitive, Side, units_per_texel};
use crate::world::{Cell, Decision, World, merge};
use etalon_case::Scene;
use etalon_case::scene::{Contents, Draw};
use etalon_frame::{
    Aspect, ChannelEncoding, CodeInterval, LegalSet, LegalSetBuilder, Limits, ReadPath, Story,
    StoryLine, TexelSet, WorldBox,
};
use etalon_pipeline::{Arithmetic, Point, is_top_left};
use smallvec::SmallVec;
use std::borrow::Cow;

/// Both bands of one scene for one possible set of limits.
#[derive(Clone, Debug)]
pub struct Judgement {
    /// The limits that were assumed: every depth format has one encoding.
    pub limits: Limits,
    /// What the API's text allows.
    pub legal: LegalSet,
    /// What the yardstick wants.
    pub yardstick: LegalSet,
}

/// Judges a scene in both bands, once per depth encoding that the adapter may have.
pub fn judgements(scene: &Scene, limits: &Limits) -> Vec<Judgement> {
    limits
        .alternatives(&scene.formats())
        .into_iter()
        .map(|limits| Judgement {
            legal: judge(scene, &limits, &Rules::of(limits.api)),
            yardstick: judge(scene, &limits, &Rules::yardstick(&limits)),
            limits,
        })
        .collect()
}

/// What the rules allow at every sample of what the scene reads back. Of a depth format with
/// several possible encodings the first is assumed; see [`judgements`].
pub fn judge(scene: &Scene, limits: &Limits, rules: &Rules) -> LegalSet {
    let walk = Walk::new(scene, limits, rules);
    let mut builder = LegalSetBuilder::default();
    for index in &scene.read {
        let attachment = &scene.attachments[*index];
        for aspect in attachment.format.aspects() {
            let (channels, read) = walk.read_encoding(*index, *aspect);
            builder.image(
                &attachment.name,
                *aspect,
                attachment.size,
                attachment.samples,
                &channels,
                read,
            );
        }
    }
    let mut shapes: Vec<([u32; 2], u32)> = Vec::new();
    for index in &scene.read {
        let attachment = &scene.attachments[*index];
        let shape = (attachment.size, attachment.samples);
        if !shapes.contains(&shape) {
            shapes.push(shape);
        }
    }
    for (group, shape) in shapes.iter().enumerate() {
        for y in 0..shape.0[1] {
            for x in 0..shape.0[0] {
                for sample in 0..shape.1 {
                    let at = Sample {
                        size: shape.0,
                        samples: shape.1,
                        x,
                        y,
                        sample,
                    };
                    builder.sample(group, walk.sample(at, None));
                }
            }
        }
    }
    builder.build()
}

/// One sample of the attachments of one shape.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Sample {
    /// The attachments' width and height.
    pub size: [u32; 2],
    /// Their samples per texel.
    pub samples: u32,
    /// Column.
    pub x: u32,
    /// Row.
    pub y: u32,
    /// Sample within the texel.
    pub sample: u32,
}

/// The story of one sample: every operation on it with its outcome and, where a permission was
/// used, its citation.
pub fn explain(scene: &Scene, limits: &Limits, rules: &Rules, at: Sample) -> Story {
    let mut story = Story::default();
    Walk::new(scene, limits, rules).sample(at, Some(&mut story));
    story
}

pub(crate) struct Walk<'a> {
    pub(crate) scene: &'a Scene,
    limits: &'a Limits,
    pub(crate) rules: &'a Rules,
    /// Per pass and draw.
    setups: Vec<Vec<DrawSetup>>,
    units: i64,
}

/// Where in the scene a fragment comes from.
#[derive(Clone, Copy)]
pub(crate) struct Place<'a> {
    pub(crate) at: Sample,
    /// Where the sample lies relative to the primitive's edges.
    sides: [Side; 3],
    pub(crate) pass: usize,
    draw_index: usize,
    pub(crate) draw: &'a Draw,
    primitive_index: usize,
    pub(crate) primitive: &'a Primitive,
    /// Unique over the scene.
    draw_id: u32,
    /// How many worlds there are, for the story.
    world: usize,
}

/// A note taker: costs nothing while nobody listens.
pub(crate) struct Notes<'s>(Option<&'s mut Story>);

impl Notes<'_> {
    pub(crate) fn add(
        &mut self,
        at: impl FnOnce() -> String,
        operation: &str,
        detail: impl FnOnce() -> String,
        citation: Option<&str>,
    ) {
        if let Some(story) = &mut self.0 {
            story.lines.push(StoryLine {
                at: at(),
                operation: operation.to_owned(),
                detail: detail(),
                citation: citation.map(str::to_owned),
            });
        }
    }
}

impl Place<'_> {
    pub(crate) fn name(&self) -> String {
        let world = if self.world == 0 {
            String::new()
        } else {
            format!(", world {}", self.world)
        };
        format!(
            "pass {}, draw {}, primitive {}{world}",
            self.pass, self.draw_index, self.primitive_index
        )
    }
}

impl<'a> Walk<'a> {
    fn new(scene: &'a Scene, limits: &'a Limits, rules: &'a Rules) -> Self {
        let setups = scene
            .passes
            .iter()
            .map(|pass| {
                let target = pass.color.first().copied().or(pass.depth_stencil);
                let size = target.map_or([1, 1], |i| scene.attachments[i].size);
                pass.draws
                    .iter()
                    .map(|draw| setup::draw(rules, limits, draw, size))
                    .collect()
            })
            .collect();
        Self {
            scene,
            limits,
            rules,
            setups,
            units: units_per_texel(limits),
        }
    }

    /// The encoding in which an attachment stores its depth.
    pub(crate) fn depth_encoding(&self, attachment: usize) -> ChannelEncoding {
        let format = self.scene.attachments[attachment].format;
        let of = |encodings: &[ChannelEncoding]| encodings.first().copied();
        self.limits
            .formats
            .get(&format)
            .and_then(|support| of(&support.depth))
            .or_else(|| of(format.depth_encodings()))
            .unwrap_or(ChannelEncoding::Float32)
    }

    /// The encodings in which an aspect arrives, and how it is read.
    fn read_encoding(
        &self,
        attachment: usize,
        aspect: Aspect,
    ) -> (Cow<'static, [ChannelEncoding]>, ReadPath) {
        let format = self.scene.attachments[attachment].format;
        let read = self
            .limits
            .formats
            .get(&format)
            .map_or(ReadPath::Copy, |support| support.read);
        match aspect {
            Aspect::Color => (Cow::Borrowed(format.color_channels()), read),
            Aspect::Depth => match (read, self.depth_encoding(attachment)) {
                (ReadPath::Shader, _) => (Cow::Borrowed(&[ChannelEncoding::Float32]), read),
                (ReadPath::Copy, encoding) => (Cow::Owned(vec![encoding]), read),
            },
            // Integers are exact however they are read.
            Aspect::Stencil => (Cow::Borrowed(&[ChannelEncoding::Uint(8)]), ReadPath::Copy),
        }
    }

    fn sample(&self, at: Sample, story: Option<&mut Story>) -> TexelSet {
        let mut notes = Notes(story);
        let mut worlds: SmallVec<[World; 2]> = SmallVec::new();
        worlds.push(self.initial(at, &mut notes));
        let mut draw_id = 0;
        let point = self.sample_point(at);
        for (p, pass) in self.scene.passes.iter().enumerate() {
            let target = pass.color.first().copied().or(pass.depth_stencil);
            let shape = target.map(|i| {
                let a = &self.scene.attachments[i];
                (a.size, a.samples)
            });
            for (d, draw) in pass.draws.iter().enumerate() {
                draw_id += 1;
                if shape != Some((at.size, at.samples)) {
                    continue;
                }
                let setup = &self.setups[p][d];
                for i in &setup.rows[at.y as usize] {
                    let primitive = &setup.primitives[*i as usize];
                    let x = i64::from(at.x);
                    if x < primitive.bounds[0] || x >= primitive.bounds[2] {
                        continue;
                    }
                    let sides = [0, 1, 2].map(|i| primitive.side(i, point));
                    if misses(primitive, sides) {
                        continue;
                    }
                    let place = Place {
                        at,
                        sides,
                        pass: p,
                        draw_index: d,
                        draw,
                        primitive_index: *i as usize,
                        primitive,
                        draw_id,
                        world: 0,
                    };
                    worlds = self.primitive(place, worlds, &mut notes);
                    if !merge(&mut worlds) {
                        notes.add(
                            || place.name(),
                            "give up",
                            || format!("{} worlds: the sample is open", worlds.len()),
                            None,
                        );
                        return TexelSet::default();
                    }
                }
                // No later draw refers to this one's choices.
                worlds.iter_mut().for_each(|w| w.decisions.clear());
                merge(&mut worlds);
            }
        }
        self.finish(&worlds, at, &mut notes)
    }

    fn initial(&self, at: Sample, notes: &mut Notes<'_>) -> World {
        let mut judging = Judging::new(self.rules);
        let cells = self
            .scene
            .attachments
            .iter()
            .enumerate()
            .map(|(index, attachment)| {
                let encodings = attachment.format.color_channels();
                let mut cell = Cell {
                    channels: [CodeInterval::exact(0); 4],
                    stencil: 0,
                };
                match &attachment.contents {
                    Contents::Color(color) => {
                        for (c, encoding) in encodings.iter().enumerate() {
                            let value = judging.constant(color[c]);
                            cell.channels[c] = judging.encode(*encoding, value);
                        }
                    }
                    Contents::DepthStencil { depth, stencil } => {
                        let value = judging.constant(*depth);
                        cell.channels[0] = judging.encode(self.depth_encoding(index), value);
                        cell.stencil = *stencil;
                    }
                    Contents::Texels(codes) if attachment.size == at.size => {
                        let start =
                            (at.y as usize * at.size[0] as usize + at.x as usize) * encodings.len();
                        for (c, encoding) in encodings.iter().enumerate() {
                            let order = encoding.order_of_code(codes[start + c]);
                            cell.channels[c] = CodeInterval::exact(order);
                        }
                    }
                    Contents::Texels(_) => {}
                }
                let text = || self.cell_text(index, &cell);
                let how = match &attachment.contents {
                    Contents::Texels(_) => "upload",
                    _ => "clear",
                };
                let citation = match &attachment.contents {
                    Contents::Texels(_) => None,
                    _ => Some(self.rules.store.citation),
                };
                let name = || format!("attachment {}", attachment.name);
                if (attachment.size, attachment.samples) == (at.size, at.samples) {
                    notes.add(name, how, text, citation);
                }
                cell
            })
            .collect();
        World {
            cells,
            decisions: SmallVec::new(),
        }
    }

    pub(crate) fn cell_text(&self, attachment: usize, cell: &Cell) -> String {
        let format = self.scene.attachments[attachment].format;
        let mut parts = Vec::new();
        for (c, encoding) in format.color_channels().iter().enumerate() {
            parts.push(codes_text(*encoding, cell.channels[c]));
        }
        if format.has_depth() {
            let encoding = self.depth_encoding(attachment);
            parts.push(format!("depth {}", codes_text(encoding, cell.channels[0])));
        }
        if format.has_stencil() {
            parts.push(format!("stencil {}", cell.stencil));
        }
        parts.join(", ")
    }

    /// Carries worlds through one primitive.
    fn primitive(
        &self,
        place: Place<'_>,
        worlds: SmallVec<[World; 2]>,
        notes: &mut Notes<'_>,
    ) -> SmallVec<[World; 2]> {
        let (least, most) = place.primitive.area;
        let mut result = SmallVec::new();
        let several = worlds.len() > 1;
        for (w, world) in worlds.into_iter().enumerate() {
            let mut place = place;
            place.world = if several { w + 1 } else { 0 };
            for positive in [true, false] {
                let possible = if positive { most > 0 } else { least < 0 };
                if !possible {
                    continue;
                }
                self.covered(place, world.clone(), positive, &mut result, notes);
            }
            // A triangle that legal snapping can flatten may also cover nothing.
            if least <= 0 && most >= 0 {
                result.push(world);
            }
        }
        result
    }

    fn sample_point(&self, at: Sample) -> Point {
        let position = self
            .limits
            .sample_positions
            .get(&at.samples)
            .and_then(|all| all.get(at.sample as usize))
            .copied()
            .unwrap_or([128, 128]);
        let axis = |texel: u32, offset: u16| {
            i64::from(texel) * self.units + i64::from(offset) * self.units / 256
        };
        Point {
            x: axis(at.x, position[0]),
            y: axis(at.y, position[1]),
        }
    }

    /// Splits a world by the edges that may or may not hold the sample.
    fn covered(
        &self,
        place: Place<'_>,
        world: World,
        positive_area: bool,
        result: &mut SmallVec<[World; 2]>,
        notes: &mut Notes<'_>,
    ) {
        let primitive = place.primitive;
        let mut pending: SmallVec<[World; 2]> = SmallVec::new();
        pending.push(world);
        let inside = inside_of(positive_area);
        let sides = place.sides;
        if sides
            .into_iter()
            .any(|side| is_outside(side, positive_area))
        {
            result.append(&mut pending);
            return;
        }
        for (i, side) in sides.into_iter().enumerate() {
            if side == inside {
                continue;
            }
            if side == Side::On && self.rules.shared_edge.value == SharedEdge::TopLeft {
                let (p, q) = primitive.edge(i);
                let (p, q) = if positive_area { (q, p) } else { (p, q) };
                if !is_top_left(p, q) {
                    result.append(&mut pending);
                    return;
                }
                continue;
            }
            let (a, b) = (primitive.ids[i], primitive.ids[(i + 1) % 3]);
            let decision = Decision {
                draw: place.draw_id,
                ends: (a.min(b), a.max(b)),
                owner: (self.rules.shared_edge.value == SharedEdge::Independent)
                    .then_some(place.primitive_index as u32),
            };
            // The side is named by the edge's canonical direction.
            let wanted = (inside == Side::Positive) == (a < b);
            let mut inside_worlds = SmallVec::new();
            for world in pending {
                match world.decided(decision) {
                    Some(outcome) if outcome == wanted => inside_worlds.push(world),
                    Some(_) => result.push(world),
                    None => {
                        result.push(world.with(decision, !wanted));
                        inside_worlds.push(world.with(decision, wanted));
                    }
                }
            }
            pending = inside_worlds;
            notes.add(
                || place.name(),
                "coverage",
                || format!("edge {i} is too near to tell: covered and not covered both stand"),
                Some(match side {
                    Side::On => self.rules.shared_edge.citation,
                    _ => self.rules.snap.citation,
                }),
            );
        }
        for world in pending {
            self.fragment(place, world, positive_area, result, notes);
        }
    }

    /// The boxes of what is read back.
    fn finish(&self, worlds: &[World], at: Sample, notes: &mut Notes<'_>) -> TexelSet {
        let mut set = TexelSet::default();
        for world in worlds {
            let mut channels = SmallVec::new();
            for index in &self.scene.read {
                let attachment = &self.scene.attachments[*index];
                if (attachment.size, attachment.samples) != (at.size, at.samples) {
                    continue;
                }
                let cell = &world.cells[*index];
                for aspect in attachment.format.aspects() {
                    match aspect {
                        Aspect::Color => {
                            let n = attachment.format.color_channels().len();
                            channels.extend_from_slice(&cell.channels[..n]);
                        }
                        Aspect::Depth => channels.push(self.read_depth(*index, cell.channels[0])),
                        Aspect::Stencil => {
                            channels.push(CodeInterval::exact(i64::from(cell.stencil)));
                        }
                    }
                }
                let how = match self.read_encoding(*index, Aspect::Depth).1 {
                    ReadPath::Shader if attachment.format.has_depth() => {
                        ", its depth read by a shader"
                    }
                    _ => "",
                };
                notes.add(
                    || "at the end".to_owned(),
                    "read back",
                    || {
                        format!(
                            "{} holds {}{how}",
                            attachment.name,
                            self.cell_text(*index, cell)
                        )
                    },
                    None,
                );
            }
            set.worlds.push(WorldBox { channels });
        }
        set
    }

    /// A depth as it is read back: its code, or the float that a shader sees.
    fn read_depth(&self, attachment: usize, stored: CodeInterval) -> CodeInterval {
        let encoding = self.depth_encoding(attachment);
        let (read, _) = self.read_encoding(attachment, Aspect::Depth);
        if read[0] == encoding {
            return stored;
        }
        let mut judging = Judging::new(self.rules);
        let value = judging.decode(encoding, stored);
        judging.encode(read[0], Range::same(value.float))
    }
}

/// The side of a triangle's edges on which its inside lies. With y down, a triangle of positive area
/// (y up) has it where edge functions are negative.
fn inside_of(positive_area: bool) -> Side {
    if positive_area {
        Side::Negative
    } else {
        Side::Positive
    }
}

/// Whether a sample is outside a triangle whichever way it turns: nothing happens in any world.
fn misses(primitive: &Primitive, sides: [Side; 3]) -> bool {
    let (least, most) = primitive.area;
    let outside = |positive: bool| sides.into_iter().any(|side| is_outside(side, positive));
    least != 0 && most != 0 && (most < 0 || outside(true)) && (least > 0 || outside(false))
}

/// Whether a side of one edge is certainly outside a triangle.
fn is_outside(side: Side, positive_area: bool) -> bool {
    matches!(side, Side::Positive | Side::Negative) && side != inside_of(positive_area)
}

pub(crate) fn codes_text(encoding: ChannelEncoding, codes: CodeInterval) -> String {
    let text = |order: i64| match encoding {
        ChannelEncoding::Float32 => format!("{:?}", encoding.value_of_order(order) as f32),
        _ => order.to_string(),
    };
    if codes.is_exact() {
        text(codes.low)
    } else {
        format!("{}..{}", text(codes.low), text(codes.high))
    }
}

#[cfg(test)]
pub(crate) mod tests;
