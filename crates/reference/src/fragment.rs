//! What happens to one fragment in one world: culling, shading, tests, blending, stores.

use crate::interval::Interval;
use crate::judge::{Notes, Place, Sample, Walk, codes_text};
use crate::judging::{Judging, Range};
use crate::rules::{DepthOrder, DepthRange};
use crate::setup::Shape;
use crate::world::World;
use etalon_case::scene::{Contents, Draw, StencilFace};
use etalon_case::state::CompareFunction;
use etalon_frame::{ChannelEncoding, CodeInterval};
use etalon_pipeline::shader::{FragmentInput, FragmentOutput, fragment};
use etalon_pipeline::{
    Arithmetic, BlendInput, blend, front_facing, is_culled, stencil_passes, stencil_write,
    takes_logic,
};
use smallvec::SmallVec;

impl Walk<'_> {
    /// One fragment at this sample: culling, shading, tests, blending, stores.
    pub(crate) fn fragment(
        &self,
        place: Place<'_>,
        world: World,
        positive_area: bool,
        result: &mut SmallVec<[World; 2]>,
        notes: &mut Notes<'_>,
    ) {
        let draw = place.draw;
        let front = front_facing(if positive_area { 1 } else { -1 }, draw.front_face);
        let polygon = matches!(
            place.primitive.shape,
            Shape::Triangle(_) | Shape::Outline(_)
        );
        if polygon && is_culled(draw.cull, front) {
            notes.add(
                || place.name(),
                "cull",
                || {
                    let face = if front { "front" } else { "back" };
                    format!("a {face} face, culled by {}", draw.cull.name())
                },
                Some(self.rules.facing),
            );
            result.push(world);
            return;
        }
        let outline = matches!(place.primitive.shape, Shape::Outline(_));
        if outline && !self.rules.outlines_face_as_polygons.value {
            self.shade(place, world.clone(), !front, result, notes);
        }
        self.shade(place, world, front, result, notes);
    }

    /// The fragment of a primitive that is not culled, facing front or back.
    fn shade(
        &self,
        place: Place<'_>,
        world: World,
        front: bool,
        result: &mut SmallVec<[World; 2]>,
        notes: &mut Notes<'_>,
    ) {
        let draw = place.draw;
        let mut judging = Judging::new(self.rules);
        let own_depth = place.primitive.depth_at(place.point);
        let texel = |t: usize| self.texel(draw, t, place.at);
        let input = FragmentInput {
            color: place.primitive.color,
            front,
            depth: place
                .primitive
                .depth_seen(place.point, self.units, place.at.samples),
            sample: place.at.sample,
            texels: [texel(0), texel(1)],
            params: &draw.params,
        };
        let output = fragment(&mut judging, draw.shader, &input);
        notes.add(
            || place.name(),
            "shade",
            || {
                let color = output.color.map(|c| c.hull().to_string()).join(", ");
                let face = if front { "front" } else { "back" };
                format!("{face} face, {} gives ({color})", draw.shader.name())
            },
            None,
        );
        let (can, must) = self.sample_passes(place, output.color[3]);
        if !must {
            notes.add(
                || place.name(),
                "coverage",
                || {
                    let word = if can { "may or may not" } else { "does not" };
                    let sample = place.at.sample;
                    format!("sample {sample} {word} pass mask and alpha to coverage")
                },
                Some(self.rules.alpha_to_coverage),
            );
            result.push(world.clone());
            if !can {
                return;
            }
        }
        let pass = &self.scene.passes[place.pass];
        let depth_stencil = pass.depth_stencil;
        let mut world = world;
        // Without a depth attachment the test passes.
        let bounded = depth_stencil.filter(|i| self.scene.attachments[*i].format.has_depth());
        if let (Some(bounds), Some(index)) = (draw.depth_bounds, bounded) {
            let (can, must) = self.depth_bounds(place, &world, bounds, index, notes);
            if !must {
                result.push(world.clone());
            }
            if !can {
                return;
            }
        }
        let face = draw
            .stencil
            .as_ref()
            .map(|s| if front { s.front } else { s.back });
        if let (Some(face), Some(index)) = (face, depth_stencil) {
            let stored = world.cells[index].stencil;
            if !stencil_passes(&face, stored) {
                let new = stencil_write(&face, face.fail_op, stored);
                self.note_stencil(
                    place,
                    &face,
                    stored,
                    "fails",
                    face.fail_op.name(),
                    new,
                    notes,
                );
                world.cells[index].stencil = new;
                result.push(world);
                return;
            }
        }
        let exported = output.depth.is_some() || place.primitive.is_biased();
        let incoming = self.in_range(place, output.depth.unwrap_or(own_depth), exported);
        let outcomes = match (draw.depth, depth_stencil) {
            (Some(state), Some(index)) => {
                let encoding = self.depth_encoding(index);
                let stored = world.cells[index].channels[0];
                self.depth_test(place, state.compare, incoming, stored, encoding, notes)
            }
            _ => [true, false],
        };
        for passes in [true, false] {
            if !outcomes[usize::from(!passes)] {
                continue;
            }
            let mut world = world.clone();
            if let (Some(face), Some(index)) = (face, depth_stencil) {
                let (operation, word) = if passes {
                    (face.pass_op, "passes")
                } else {
                    (face.depth_fail_op, "passes, depth fails")
                };
                let stored = world.cells[index].stencil;
                let new = stencil_write(&face, operation, stored);
                self.note_stencil(place, &face, stored, word, operation.name(), new, notes);
                world.cells[index].stencil = new;
            }
            if passes {
                self.write(place, &mut world, &output, incoming, notes);
            }
            result.push(world);
        }
    }

    /// The depth that is tested and stored: held to the viewport's range where the draw clamps;
    /// where it does not, what lies outside of the range is treated as the rules say. The clipped
    /// fixed-function depth alone lies inside.
    fn in_range(&self, place: Place<'_>, depth: Range, exported: bool) -> Range {
        let [near, far] = place.draw.viewport.depth.map(f64::from);
        let (near, far) = (near.min(far), near.max(far));
        let held = depth.float.clamp(near, far);
        let whole = Interval {
            low: 0.0,
            high: 1.0,
        };
        let unit = depth.float.clamp(0.0, 1.0);
        let slack = self.rules.float_error.value * 4.0;
        let outside = depth.float.low < near - slack || depth.float.high > far + slack;
        Range::same(match self.rules.depth_range.value {
            _ if place.draw.depth_clamp => held,
            _ if !(exported && outside) => unit,
            DepthRange::Undefined => whole,
            DepthRange::Viewport => held,
            DepthRange::Either => held.hull(unit),
        })
    }

    /// Whether mask and alpha to coverage can and whether they must let the sample through.
    fn sample_passes(&self, place: Place<'_>, alpha: Range) -> (bool, bool) {
        let state = place.draw.multisample;
        if state.mask & (1 << place.at.sample) == 0 {
            return (false, false);
        }
        if !state.alpha_to_coverage {
            return (true, true);
        }
        let alpha = alpha.hull();
        let several = place.at.samples > 1;
        (alpha.high > 0.0 || !several, alpha.low >= 1.0)
    }

    /// Whether the stored depth can and whether it must lie within the bounds (Vulkan, Depth Bounds
    /// Test).
    fn depth_bounds(
        &self,
        place: Place<'_>,
        world: &World,
        [low, high]: [f32; 2],
        index: usize,
        notes: &mut Notes<'_>,
    ) -> (bool, bool) {
        let encoding = self.depth_encoding(index);
        let stored = world.cells[index].channels[0];
        let mut judging = Judging::new(self.rules);
        let exact = Interval {
            low: encoding.value_of_order(stored.low),
            high: encoding.value_of_order(stored.high),
        };
        let stored = exact.hull(judging.decode(encoding, stored).hull());
        // A bound may be compared as it is or as the attachment would hold it.
        let mut bound = |v: f32| {
            let v = judging.constant(v);
            let codes = judging.encode(encoding, v);
            Interval {
                low: encoding.value_of_order(codes.low).min(v.float.low),
                high: encoding.value_of_order(codes.high).max(v.float.high),
            }
        };
        let (low, high) = (bound(low), bound(high));
        let can = stored.high >= low.low && stored.low <= high.high;
        let must = stored.low >= low.high && stored.high <= high.low;
        notes.add(
            || place.name(),
            "depth bounds",
            || {
                let word = match (can, must) {
                    (_, true) => "inside",
                    (true, false) => "perhaps inside",
                    (false, _) => "outside",
                };
                format!("stored {stored} is {word} {low} to {high}")
            },
            Some(self.rules.depth_order.citation),
        );
        (can, must)
    }

    /// The texel of a texture under the sample.
    fn texel(&self, draw: &Draw, t: usize, at: Sample) -> [Range; 4] {
        let mut judging = Judging::new(self.rules);
        let mut texel = [Range::exact(0.0); 4];
        if let Some(index) = draw.textures.get(t) {
            let attachment = &self.scene.attachments[*index];
            if let Contents::Texels(codes) = &attachment.contents {
                let encodings = attachment.format.color_channels();
                let start = (at.y as usize * at.size[0] as usize + at.x as usize) * encodings.len();
                for (c, encoding) in encodings.iter().enumerate() {
                    let order = encoding.order_of_code(codes[start + c]);
                    texel[c] = judging.decode(*encoding, CodeInterval::exact(order));
                }
                // A format without alpha is fetched with alpha 1.
                if encodings.len() < 4 {
                    texel[3] = Range::exact(1.0);
                }
            }
        }
        texel
    }

    #[expect(
        clippy::too_many_arguments,
        reason = "one line of the story, all of it"
    )]
    fn note_stencil(
        &self,
        place: Place<'_>,
        face: &StencilFace,
        stored: u8,
        outcome: &str,
        operation: &str,
        new: u8,
        notes: &mut Notes<'_>,
    ) {
        notes.add(
            || place.name(),
            "stencil",
            || {
                format!(
                    "reference {} {} stored {stored} under read mask {:#04x} {outcome}; {operation} \
                     under write mask {:#04x} leaves {new}",
                    face.reference,
                    face.compare.name(),
                    face.read_mask,
                    face.write_mask
                )
            },
            Some(self.rules.stencil),
        );
    }

    /// Which outcomes of a depth test are possible: passing, failing.
    fn depth_test(
        &self,
        place: Place<'_>,
        function: CompareFunction,
        incoming: Range,
        stored: CodeInterval,
        encoding: ChannelEncoding,
        notes: &mut Notes<'_>,
    ) -> [bool; 2] {
        let mut judging = Judging::new(self.rules);
        let codes = judging.encode(encoding, incoming);
        let of_codes = |codes: CodeInterval| Interval {
            low: encoding.value_of_order(codes.low),
            high: encoding.value_of_order(codes.high),
        };
        let (left, right) = match self.rules.depth_order.value {
            DepthOrder::Either => (
                of_codes(codes).hull(incoming.hull()),
                of_codes(stored).hull(judging.decode(encoding, stored).hull()),
            ),
            DepthOrder::ConvertedFirst => (of_codes(codes), of_codes(stored)),
        };
        let outcomes = possible(function, left, right);
        notes.add(
            || place.name(),
            "depth test",
            || {
                let word = match outcomes {
                    [true, true] => "may be either",
                    [true, false] => "is true",
                    _ => "is false",
                };
                format!("{left} {} stored {right} {word}", function.name())
            },
            Some(self.rules.depth_order.citation),
        );
        outcomes
    }

    /// Stores depth and colours of a fragment that passed all tests.
    fn write(
        &self,
        place: Place<'_>,
        world: &mut World,
        output: &FragmentOutput<Range>,
        depth: Range,
        notes: &mut Notes<'_>,
    ) {
        let mut judging = Judging::new(self.rules);
        let pass = &self.scene.passes[place.pass];
        if let (Some(state), Some(index)) = (place.draw.depth, pass.depth_stencil)
            && state.write
        {
            let encoding = self.depth_encoding(index);
            let codes = judging.encode(encoding, depth);
            world.cells[index].channels[0] = codes;
            notes.add(
                || place.name(),
                "store depth",
                || format!("{} as {}", depth.hull(), codes_text(encoding, codes)),
                Some(self.rules.store.citation),
            );
        }
        let mut color = output.color;
        let mut second = output.second.unwrap_or([Range::exact(0.0); 4]);
        if place.draw.multisample.alpha_to_one {
            color[3] = Range::exact(1.0);
            second[3] = Range::exact(1.0);
        }
        for (target, index) in place.draw.targets.iter().zip(&pass.color) {
            let attachment = &self.scene.attachments[*index];
            let encodings = attachment.format.color_channels();
            let all: [ChannelEncoding; 4] =
                std::array::from_fn(|c| encodings[c.min(encodings.len() - 1)]);
            let missing = missing_channels(encodings.len());
            let cell = &mut world.cells[*index];
            let value = match &target.blend {
                None => color,
                Some(state) => {
                    let dst = std::array::from_fn(|c| match missing[c] {
                        Some(value) => Range::exact(value),
                        None => judging.decode(all[c], cell.channels[c]),
                    });
                    let constant = place.draw.blend_constant.map(|v| judging.constant(v));
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
                                    ["red", "green", "blue", "alpha"][c],
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
            for (c, encoding) in encodings.iter().enumerate() {
                if target.write_mask & (1 << c) != 0 {
                    let codes = judging.encode(*encoding, value[c]);
                    cell.channels[c] = match place.draw.logic {
                        Some(operation) if takes_logic(attachment.format) => {
                            judging.logic(*encoding, operation, codes, cell.channels[c])
                        }
                        _ => codes,
                    };
                }
            }
            let cell = *cell;
            let masked = target.write_mask != 0xf;
            notes.add(
                || place.name(),
                "store color",
                || {
                    format!(
                        "{} holds {}",
                        attachment.name,
                        self.cell_text(*index, &cell)
                    )
                },
                Some(if masked {
                    self.rules.write_mask
                } else {
                    self.rules.store.citation
                }),
            );
        }
    }
}

/// What a destination's missing channels count as in blending: colours 0, alpha 1 (Vulkan, Blending;
/// OpenGL 4.6, 17.3.6).
fn missing_channels(channels: usize) -> [Option<f64>; 4] {
    std::array::from_fn(|c| {
        let value = if c == 3 { 1.0 } else { 0.0 };
        (c >= channels).then_some(value)
    })
}

/// Whether a comparison of some value of `left` with some value of `right` can be true, and whether
/// it can be false.
fn possible(function: CompareFunction, left: Interval, right: Interval) -> [bool; 2] {
    let can_be_less = left.low < right.high;
    let can_be_greater = left.high > right.low;
    let can_be_equal = left.low <= right.high && right.low <= left.high;
    match function {
        CompareFunction::Never => [false, true],
        CompareFunction::Always => [true, false],
        CompareFunction::Less => [can_be_less, can_be_greater || can_be_equal],
        CompareFunction::LessEqual => [can_be_less || can_be_equal, can_be_greater],
        CompareFunction::Greater => [can_be_greater, can_be_less || can_be_equal],
        CompareFunction::GreaterEqual => [can_be_greater || can_be_equal, can_be_less],
        CompareFunction::Equal => [can_be_equal, can_be_less || can_be_greater],
        CompareFunction::NotEqual => [can_be_less || can_be_greater, can_be_equal],
    }
}
