//! A fragment in one world: culling, shading, tests, blending, stores.

use crate::input_mask::InputBits;
use crate::interval::Interval;
use crate::judging::Judging;
use crate::notes::Notes;
use crate::possible::Possible;
use crate::primitive::Shape;
use crate::range::Range;
use crate::rules::{
    AlphaToCoverage, DepthOrder, DepthRange, EarlyUpdates, MaskOfOne, Permission, SameDepth,
};
use crate::stencil_face::Face;
use crate::walk::{FragmentPlace, Walk};
use crate::world::{Increment, SampleContents, World, Worlds};
use etalon_frame::{
    Aspect, ChannelEncoding, CodeInterval, CounterKind, DepthTest, Effect, Rejection, Step,
    ValueRange,
};
use etalon_pipeline::shader::{FragmentInput, FragmentOutput, InputMask, List, Taps, fragment};
use etalon_pipeline::{
    Arithmetic, compare, front_facing, is_culled, stencil_passes, stencil_write,
};
use etalon_scene::{CompareFunction, EarlyTests, Shader, StencilOperation};
use smallvec::SmallVec;
use std::num::NonZeroU64;

/// A fragment that is tested before its shader runs.
struct Shaded<'a> {
    front: bool,
    /// True if the sample mask or the sample coverage removes the sample.
    masked: bool,
    incoming: Incoming,
    output: &'a FragmentOutput<Range>,
    covered: Covered,
}

impl Walk<'_> {
    /// Takes one fragment at this sample through culling, shading, tests, blending and stores.
    pub(crate) fn fragment(
        &self,
        place: &FragmentPlace<'_>,
        world: &World,
        positive_area: bool,
        result: &mut Worlds,
        notes: &mut Notes<'_>,
    ) {
        let draw = place.draw;
        if place.primitive.beyond {
            self.note_rejection(notes, place, Rejection::CullDistance, true, || {
                Step::Clipping
            });
            result.push(world.clone());
            return;
        }
        let front = front_facing(if positive_area { 1 } else { -1 }, draw.front_face);
        let polygon = matches!(
            place.primitive.shape,
            Shape::Triangle(_) | Shape::Outline(_)
        );
        if polygon && is_culled(draw.cull, front) {
            self.note_rejection(notes, place, Rejection::Culling, true, || Step::Culling {
                front,
                mode: draw.cull.name().to_owned(),
            });
            result.push(world.clone());
            return;
        }
        let outline = matches!(place.primitive.shape, Shape::Outline(_));
        let masks = self.input_masks(place);
        let mut shade = |world: &World, drawn: bool, notes: &mut Notes<'_>| {
            for mask in &masks {
                if outline && !self.rules.outlines_face_as_polygons.value() {
                    self.shade(place, world, (!front, *mask), drawn, result, notes);
                }
                self.shade(place, world, (front, *mask), drawn, result, notes);
            }
        };
        let open_texts = &self.open_texts[place.pass][place.draw_index];
        if draw.multisample.sample_coverage.is_none() && !open_texts.is_contested() {
            shade(world, true, notes);
            return;
        }
        for (world, drawn) in self.by_sample_coverage(place, world.clone(), notes) {
            for world in open_texts.by_reading(world) {
                shade(&world, drawn, notes);
            }
        }
    }

    /// Shades the fragment of a primitive that is not culled, facing front or back, with the sample mask that
    /// its shader reads; `drawn` is false if sample coverage removes the sample.
    fn shade(
        &self,
        place: &FragmentPlace<'_>,
        world: &World,
        (front, mask): (bool, InputBits),
        drawn: bool,
        result: &mut Worlds,
        notes: &mut Notes<'_>,
    ) {
        let draw = place.draw;
        let output = self.shader(place, world, (front, mask), notes);
        let own_depth = if self.goes_on(place) {
            self.own_depth(place)
        } else {
            Range::same(Interval {
                low: 0.0,
                high: 1.0,
            })
        };
        let covered = if drawn {
            self.covered_after_shading(place, &output, notes)
        } else {
            Covered {
                kept: Possible::Always,
                masked: Possible::Always,
                coverage: Possible::Never,
            }
        };
        // The shader does not have to run for a masked sample.
        let masked = !drawn || self.is_masked(place);
        if draw.early_tests == EarlyTests::Forced {
            let shaded = Shaded {
                front,
                masked,
                incoming: self.in_range(place, own_depth, DepthSource::Own),
                output: &output,
                covered,
            };
            self.test_early(place, world, &shaded, result, notes);
            let writes = output.depth.is_some() || draw.shader.writes_reference();
            if masked || !writes || self.rules.early_ignores_written.value() {
                return;
            }
            // The shader may still have run before.
        }
        // For a fragment that contributes nothing, the shader has to run only if the rules say so.
        let asks = !masked && self.counts_runs(place) && self.rules.runs_for_discarded.value();
        let survives = covered.survives();
        if !survives.must() {
            let mut lost = world.clone();
            self.run(place, &mut lost, asks);
            result.push(lost);
            if !survives.can() {
                return;
            }
        }
        let source = match output.depth {
            Some(_) => DepthSource::Written,
            None => DepthSource::Own,
        };
        let incoming = self.in_range(place, output.depth.unwrap_or(own_depth), source);
        for face in self.faces(place, front, &output, notes) {
            self.tests(
                place,
                world,
                face,
                incoming,
                notes,
                |mut outcome, passes, notes| {
                    let contributes = passes && self.contributes(place);
                    self.run(place, &mut outcome, asks || (!masked && contributes));
                    if passes {
                        self.count(place, &mut outcome, true, CounterKind::is_occlusion);
                        self.write_depth(place, &mut outcome, incoming, notes);
                        self.write_colors(place, &mut outcome, &output, notes);
                    }
                    result.push(outcome);
                },
            );
        }
    }

    /// Performs the tests that precede a fragment's shader, and what follows them.
    fn test_early(
        &self,
        place: &FragmentPlace<'_>,
        world: &World,
        shaded: &Shaded<'_>,
        result: &mut Worlds,
        notes: &mut Notes<'_>,
    ) {
        let incoming = shaded.incoming;
        let face = Face::of(place.draw, shaded.front);
        self.note_late_reference(place, shaded.front, notes);
        if !shaded.masked {
            self.tests(
                place,
                world,
                face,
                incoming,
                notes,
                |mut outcome, passes, notes| {
                    if passes {
                        let worlds = [world, &outcome];
                        let (output, covered) = (shaded.output, shaded.covered);
                        self.early_fragment(
                            place, worlds, output, incoming, covered, result, notes,
                        );
                    } else {
                        let may_run = !self.rules.skips_rejected.value();
                        // The stencil value of a fragment that the shader removes first is not updated.
                        if self.may_be_removed_first(shaded.covered) {
                            let mut untested = world.clone();
                            if may_run {
                                self.run(place, &mut untested, false);
                            }
                            result.push(untested);
                        }
                        if may_run {
                            self.run(place, &mut outcome, false);
                        }
                        result.push(outcome);
                    }
                },
            );
            return;
        }
        // The order of the sample mask and counting is open; its order relative to the tests is in the rules.
        let mask_acts_first = self.rules.mask_acts_first.value();
        let mut silent = Notes(None);
        let noted = if mask_acts_first {
            &mut silent
        } else {
            &mut *notes
        };
        let mut outcomes: SmallVec<[(World, bool); 2]> = SmallVec::new();
        self.tests(place, world, face, incoming, noted, |outcome, passes, _| {
            outcomes.push((outcome, passes));
        });
        let mut kept = world.clone();
        if outcomes.iter().any(|(_, passes)| *passes) {
            self.count(place, &mut kept, false, |_| true);
        }
        if !mask_acts_first {
            for (mut outcome, passes) in outcomes {
                if passes {
                    outcome.events.clone_from(&kept.events);
                    self.write_depth(place, &mut outcome, incoming, notes);
                }
                result.push(outcome);
            }
        }
        result.push(kept);
    }

    /// Returns true if the rules let the shader or coverage remove a sample before forced early tests.
    fn may_be_removed_first(&self, covered: Covered) -> bool {
        let rules = self.rules;
        // `Each` concerns fragments that passed the tests before they were removed.
        let may_precede =
            |updates: &Permission<EarlyUpdates>| updates.value() == EarlyUpdates::Either;
        !covered.kept.must() && may_precede(&rules.early_updates)
            || !covered.masked.must() && may_precede(&rules.early_mask)
            || !covered.coverage.must() && may_precede(&rules.early_coverage)
    }

    /// Runs the fragment shader at the sample.
    fn shader(
        &self,
        place: &FragmentPlace<'_>,
        world: &World,
        (front, mask): (bool, InputBits),
        notes: &mut Notes<'_>,
    ) -> FragmentOutput<Range> {
        let draw = place.draw;
        let bit = |number: u32| mask.bit(number);
        let mut judging = Judging::new(self.rules);
        let mut depth = if draw.shader.reads_depth() {
            let samples = self.samples_shaded(place);
            place.primitive.depth_seen(place.point, self.units, samples)
        } else {
            Range::exact(0.0)
        };
        if draw.depth_clamp {
            // It is unspecified whether the shader sees the depth before or after clamping.
            let [near, far] = draw.viewport.depth.map(f64::from);
            let held = depth.float.clamp(near.min(far), near.max(far));
            depth = Range::same(depth.float.hull(held));
        }
        // Sampling at a computed coordinate is not modelled, so it can return anything.
        let tap = |_: [Range; 2]| match draw.textures.first() {
            Some(index) => self.anything(*index),
            None => [Range::exact(0.0); 4],
        };
        let input = FragmentInput {
            color: place.primitive.flat_color().map(Range::same),
            front,
            depth,
            sample: place.at.sample,
            mask: if draw.shader.reads_mask() {
                InputMask::of(&bit)
            } else {
                InputMask::NONE
            },
            position: if draw.shader.reads_coordinates() {
                self.frag_coord(place)
            } else {
                [Range::exact(0.0); 2]
            },
            texels: [self.texel(place, world, 0), self.texel(place, world, 1)],
            neighbours: None,
            taps: if draw.shader.taps_texture() {
                Taps::of(&tap)
            } else {
                Taps::NONE
            },
            list: List::Unknown,
            reciprocal_w: self.reciprocal_w(place),
            uv: self.uv(place),
            params: &draw.params,
        };
        let output = fragment(&mut judging, draw.shader, &input);
        if draw.shader.reads_mask() {
            notes.add(
                || place.origin(),
                || Step::InputMask {
                    set: mask.set,
                    possible: mask.possible,
                },
                Some(self.rules.input_mask.citation),
            );
        }
        notes.add(
            || place.origin(),
            || {
                let texture = |(t, index): (usize, &usize)| {
                    let name = self.scene.attachments[*index].name.clone();
                    (name, input.texels[t].map(ValueRange::from))
                };
                let shader = draw.shader.has_fragment();
                Step::Shade {
                    front,
                    shader: shader.then(|| draw.shader.name().to_owned()),
                    color: output.color.map(ValueRange::from),
                    texels: draw.textures.iter().enumerate().map(texture).collect(),
                }
            },
            if draw.reads_own(&self.scene.passes[place.pass]) {
                Some(self.rules.own_pass)
            } else {
                draw.shader.reads_facing().then(|| self.facing(place))
            },
        );
        output
    }

    /// Returns the clause that decides whether a fragment's face is the front.
    fn facing(&self, place: &FragmentPlace<'_>) -> &'static str {
        match place.primitive.shape {
            Shape::Triangle(_) => self.rules.facing,
            Shape::Outline(_) => self.rules.outlines_face_as_polygons.citation,
            _ => self.rules.points_face_front.citation,
        }
    }

    /// Returns true if a fragment that passes its tests changes an attachment.
    fn contributes(&self, place: &FragmentPlace<'_>) -> bool {
        let pass = &self.scene.passes[place.pass];
        let depth = pass.depth_stencil.is_some() && place.draw.depth.is_some_and(|d| d.write);
        let mut targets = pass.color.iter().zip(&place.draw.targets);
        depth || targets.any(|(_, target)| target.write_mask != 0)
    }

    /// Returns true if a draw counts the runs of its shader.
    fn counts_runs(&self, place: &FragmentPlace<'_>) -> bool {
        let kind = |counter: &usize| self.scene.counters[*counter].kind;
        let mut counters = place.draw.counters.iter();
        counters.any(|counter| kind(counter) == CounterKind::ShaderRuns)
    }

    /// Adds a run of the shader for a fragment; `certain` if the rules demand it. If a later fragment can
    /// make earlier fragments unnecessary, their runs are no longer certain.
    fn run(&self, place: &FragmentPlace<'_>, world: &mut World, certain: bool) {
        if !self.counts_runs(place) {
            return;
        }
        if certain && !self.rules.runs_for_overwritten.value() && self.contributes(place) {
            for event in &mut world.events {
                let kind = self.scene.counters[usize::from(event.counter)].kind;
                if kind == CounterKind::ShaderRuns {
                    event.certain = false;
                }
            }
        }
        self.count(place, world, certain, |kind| {
            kind == CounterKind::ShaderRuns
        });
    }

    /// Returns whether the shader, the sample mask and alpha to coverage keep the sample.
    fn covered_after_shading(
        &self,
        place: &FragmentPlace<'_>,
        output: &FragmentOutput<Range>,
        notes: &mut Notes<'_>,
    ) -> Covered {
        let kept = match output.kept {
            None if !self.goes_on(place) => Possible::Maybe,
            None => Possible::Always,
            Some(kept) => {
                let (value, limit) = (kept.value.hull(), kept.limit.hull());
                if value.may_be_nan() || limit.may_be_nan() {
                    Possible::Maybe
                } else if kept.strict {
                    Possible::of(value.high > limit.low, value.low > limit.high)
                } else {
                    Possible::of(value.high >= limit.low, value.low >= limit.high)
                }
            }
        };
        if let (Some(condition), false) = (output.kept, kept.must()) {
            self.note_rejection(notes, place, Rejection::Discard, !kept.can(), || {
                Step::Discard {
                    value: condition.value.into(),
                    limit: condition.limit.into(),
                    strict: condition.strict,
                }
            });
        }
        let state = place.draw.multisample;
        let alpha = output.color[3];
        let masked = self.shader_mask_keeps(place, output);
        if let (Some(mask), false) = (&output.mask, masked.must()) {
            self.note_rejection(notes, place, Rejection::ShaderMask, !masked.can(), || {
                Step::ShaderMask {
                    bits: mask.bits.into(),
                }
            });
        }
        let coverage = self.sample_passes(place, alpha);
        if self.is_masked(place) {
            // The rules decide whether forced early tests come before the mask.
            let forced = place.draw.early_tests == EarlyTests::Forced;
            let certain = !forced || self.rules.mask_acts_first.value();
            self.note_rejection(notes, place, Rejection::SampleMask, certain, || {
                Step::SampleMask { mask: state.mask }
            });
        } else if !coverage.must() {
            let lost = !coverage.can();
            self.note_rejection(notes, place, Rejection::AlphaToCoverage, lost, || {
                Step::AlphaToCoverage {
                    alpha: alpha.into(),
                }
            });
        }
        Covered {
            kept,
            masked,
            coverage,
        }
    }

    /// Continues a fragment that passed forced early tests. If the shader then discards it, it may still have
    /// changed depth and stencil and have been counted.
    #[expect(
        clippy::too_many_arguments,
        reason = "a fragment with all results of its earlier stages"
    )]
    fn early_fragment(
        &self,
        place: &FragmentPlace<'_>,
        [before, tested]: [&World; 2],
        output: &FragmentOutput<Range>,
        incoming: Incoming,
        covered: Covered,
        result: &mut Worlds,
        notes: &mut Notes<'_>,
    ) {
        let mut passed = tested.clone();
        let asks = self.counts_runs(place) && self.rules.runs_for_discarded.value();
        self.run(place, &mut passed, asks);
        let survives = covered.survives();
        if survives.can() {
            let mut kept = tested.clone();
            let asks = asks || self.contributes(place);
            self.run(place, &mut kept, asks);
            self.count(place, &mut kept, true, CounterKind::is_occlusion);
            self.write_depth(place, &mut kept, incoming, notes);
            self.write_colors(place, &mut kept, output, notes);
            result.push(kept);
        }
        if survives.must() {
            return;
        }
        notes.add(
            || place.origin(),
            || Step::LostAfterEarlyTests,
            Some(self.rules.early_updates.citation),
        );
        let counted = self.rules.early_counts.value() == EarlyUpdates::Happen;
        self.count(place, &mut passed, counted, CounterKind::is_occlusion);
        let mut updated = passed.clone();
        self.write_depth(place, &mut updated, incoming, notes);
        result.push(updated);
        let losses = [
            (covered.kept, &self.rules.early_updates),
            (covered.masked, &self.rules.early_mask),
            (covered.coverage, &self.rules.early_coverage),
        ];
        let of_lost = losses.map(|(kept, rule)| (!kept.must()).then(|| rule.value()));
        let allows = |updates: EarlyUpdates| of_lost.contains(&Some(updates));
        if allows(EarlyUpdates::Either) || allows(EarlyUpdates::Each) {
            // The state before the fragment was tested, except that its counts are kept.
            let mut untouched = before.clone();
            untouched.events.clone_from(&passed.events);
            if allows(EarlyUpdates::Each) {
                let mut only_depth = untouched.clone();
                self.write_depth(place, &mut only_depth, incoming, notes);
                result.push(only_depth);
                result.push(passed);
            }
            result.push(untouched);
        }
    }

    /// Adds to the draw's counters of the given kinds.
    fn count(
        &self,
        place: &FragmentPlace<'_>,
        world: &mut World,
        certain: bool,
        kinds: impl Fn(CounterKind) -> bool,
    ) {
        for counter in &place.draw.counters {
            if kinds(self.scene.counters[*counter].kind) {
                world.events.push(Increment {
                    counter: *counter as u16,
                    fragment: (place.draw_id, place.primitive_index as u32),
                    certain,
                });
            }
        }
    }

    /// Performs the depth bounds, stencil and depth tests: calls back with every possible end and whether the
    /// fragment passes. The stencil value is updated; depth is not yet written.
    fn tests(
        &self,
        place: &FragmentPlace<'_>,
        world: &World,
        face: Option<Face>,
        incoming: Incoming,
        notes: &mut Notes<'_>,
        mut then: impl FnMut(World, bool, &mut Notes<'_>),
    ) {
        let draw = place.draw;
        let pass = &self.scene.passes[place.pass];
        let depth_stencil = pass.depth_stencil;
        // Without a depth attachment the test passes.
        let bounded = depth_stencil.filter(|i| self.scene.attachments[*i].format.has_depth());
        if let (Some(bounds), Some(index)) = (draw.depth_bounds, bounded) {
            let inside = self.depth_bounds(place, world, bounds, index, notes);
            if !inside.must() {
                then(world.clone(), false, notes);
            }
            if !inside.can() {
                return;
            }
        }
        if let (Some(face), Some(index)) = (face, depth_stencil) {
            let state = &face.state;
            let stored = world.cells[index].stencil;
            let masked = stencil_passes(state, stored);
            let unmasked = compare(state.compare, state.reference, stored & state.read_mask);
            let either = !self.rules.masks_reference.value() && masked != unmasked;
            if !masked || either {
                let new = stencil_write(state, state.fail_op, stored);
                self.note_stencil(place, &face, [stored, new], StencilOutcome::Fails, notes);
                let mut failed = world.clone();
                failed.cells[index].stencil = new;
                then(failed, false, notes);
                if !either {
                    return;
                }
            }
        }
        let outcomes = match (draw.depth, depth_stencil) {
            (Some(state), Some(index)) => {
                let encoding = self.depth_encoding(index);
                let stored = world.cells[index];
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
                let outcome = if passes {
                    StencilOutcome::Passes
                } else {
                    StencilOutcome::DepthFails
                };
                let stored = world.cells[index].stencil;
                let new = stencil_write(&face.state, outcome.operation(&face), stored);
                self.note_stencil(place, &face, [stored, new], outcome, notes);
                world.cells[index].stencil = new;
            }
            then(world, passes, notes);
        }
    }

    /// Returns the depth that is tested and stored. It is clamped to the viewport's range if the draw clamps;
    /// otherwise the rules decide about a depth outside the range. A fixed-function depth is always inside if
    /// the primitive is clipped.
    fn in_range(&self, place: &FragmentPlace<'_>, depth: Range, source: DepthSource) -> Incoming {
        let [near, far] = place.draw.viewport.depth.map(f64::from);
        let (near, far) = (near.min(far), near.max(far));
        let held = depth.float.clamp(near, far);
        let zero_to_one = Interval {
            low: 0.0,
            high: 1.0,
        };
        let unit = depth.float.clamp(0.0, 1.0);
        let slack = self.rules.float_error.value() * 4.0;
        let outside = depth.float.low < near - slack || depth.float.high > far + slack;
        let written = source == DepthSource::Written;
        // The rules can let a point beyond the near or far plane be drawn.
        let point = matches!(place.primitive.shape, Shape::Point { .. });
        let exported = written || point || place.primitive.is_biased();
        let depth = Range::same(if depth.float.may_be_nan() {
            // NaN stays NaN, or is clamped to any value of the range.
            depth.float
        } else if place.draw.depth_clamp {
            held
        } else if !(exported && outside) {
            unit
        } else {
            match self.rules.depth_range.value() {
                DepthRange::Undefined => zero_to_one,
                DepthRange::Unit => unit,
                DepthRange::ViewportIfWritten if written => held,
                DepthRange::Either | DepthRange::ViewportIfWritten => held.hull(unit),
            }
        });
        let attachment = self.scene.passes[place.pass].depth_stencil;
        let attachment = attachment.filter(|_| place.draw.depth.is_some());
        let encoded = attachment
            .map(|index| Judging::new(self.rules).encode(self.depth_encoding(index), depth));
        let keeps_depth = !written || place.draw.shader == Shader::FragCoordDepth;
        let is_float = attachment.is_some_and(|index| self.depth_encoding(index).is_float());
        let same = match self.rules.same_depth.value() {
            SameDepth::All => keeps_depth,
            SameDepth::Written => written && keeps_depth,
            SameDepth::WrittenAsFloat => written && keeps_depth && is_float,
        };
        Incoming {
            depth,
            codes: encoded.unwrap_or(CodeInterval::exact(0)),
            origin: (place.primitive.geometry).filter(|_| same && place.at.samples == 1),
        }
    }

    /// Returns whether the sample mask that the shader writes keeps the sample.
    fn shader_mask_keeps(
        &self,
        place: &FragmentPlace<'_>,
        output: &FragmentOutput<Range>,
    ) -> Possible {
        let Some(mask) = &output.mask else {
            return Possible::Always;
        };
        let bits = mask.bits.hull();
        if bits.low.to_bits() != bits.high.to_bits() {
            return Possible::Maybe;
        }
        let bits = mask.written(bits.low as u32);
        if bits & (1 << place.at.sample) != 0 {
            return Possible::Always;
        }
        let ignored = match place.at.samples {
            1 => self.rules.mask_of_one.value(),
            _ => MaskOfOne::Acts,
        };
        match ignored {
            MaskOfOne::Acts => Possible::Never,
            MaskOfOne::Ignored => Possible::Always,
            MaskOfOne::Either => Possible::Maybe,
        }
    }

    /// Returns the window depth of a covered sample. If its position is open, so is the depth.
    pub(crate) fn own_depth(&self, place: &FragmentPlace<'_>) -> Range {
        let anywhere = self.anywhere(place.at.samples);
        place.primitive.depth_at(place.point, anywhere)
    }

    /// Returns true if the fragment has a shader, or if the rules let it pass unchanged without a shader.
    fn goes_on(&self, place: &FragmentPlace<'_>) -> bool {
        place.draw.shader.has_fragment() || self.rules.goes_on_unshaded.value()
    }

    /// Returns true if the draw's sample mask, alpha to coverage and alpha to one act.
    pub(crate) fn coverage_acts(&self, place: &FragmentPlace<'_>) -> bool {
        place.at.samples > 1 || self.rules.covers_one_sample.value()
    }

    /// Returns true if the draw's sample mask leaves the sample out.
    fn is_masked(&self, place: &FragmentPlace<'_>) -> bool {
        place.draw.multisample.mask & (1 << place.at.sample) == 0 && self.coverage_acts(place)
    }

    /// Returns whether mask and alpha to coverage keep the sample.
    fn sample_passes(&self, place: &FragmentPlace<'_>, alpha: Range) -> Possible {
        if self.is_masked(place) {
            return Possible::Never;
        }
        if !place.draw.alpha_to_coverage() || !self.coverage_acts(place) {
            return Possible::Always;
        }
        let alpha = alpha.hull();
        let several = place.at.samples > 1;
        let pass = &self.scene.passes[place.pass];
        match self.rules.alpha_to_coverage_in(pass).value() {
            AlphaToCoverage::Ends => Possible::of(alpha.high > 0.0 || !several, alpha.low >= 1.0),
            AlphaToCoverage::Opaque => Possible::of(true, alpha.low >= 1.0),
            AlphaToCoverage::Any => Possible::Maybe,
        }
    }

    /// Returns whether the stored depth is within the bounds (Vulkan, Depth Bounds Test).
    fn depth_bounds(
        &self,
        place: &FragmentPlace<'_>,
        world: &World,
        [low, high]: [f32; 2],
        index: usize,
        notes: &mut Notes<'_>,
    ) -> Possible {
        let encoding = self.depth_encoding(index);
        let stored = world.cells[index].channel(0);
        let mut judging = Judging::new(self.rules);
        let exact = Interval::of_codes(encoding, stored);
        let stored = exact.hull(judging.decode(encoding, stored).hull());
        // A bound may be compared exactly or as the attachment would store it.
        let mut bound = |v: f32| {
            let v = judging.constant(v);
            let codes = judging.encode(encoding, v);
            Interval::of_codes(encoding, codes).hull(v.float)
        };
        let (low, high) = (bound(low), bound(high));
        let can = stored.high >= low.low && stored.low <= high.high;
        let must = stored.low >= low.high && stored.high <= high.low;
        let inside = Possible::of(can, must);
        let step = || Step::DepthBounds {
            stored: stored.into(),
            low: low.into(),
            high: high.into(),
        };
        match inside {
            Possible::Always => notes.add(|| place.origin(), step, None),
            _ => self.note_rejection(notes, place, Rejection::DepthBounds, !inside.can(), step),
        }
        inside
    }

    /// Notes a stencil test and the update of the stencil value.
    fn note_stencil(
        &self,
        place: &FragmentPlace<'_>,
        face: &Face,
        [before, after]: [u8; 2],
        outcome: StencilOutcome,
        notes: &mut Notes<'_>,
    ) {
        let step = || Step::StencilTest {
            reference: face.state.reference,
            exported: face.exported,
            compare: face.state.compare.name().to_owned(),
            stored: before,
            read_mask: face.state.read_mask,
            depth_fails: outcome == StencilOutcome::DepthFails,
        };
        if outcome == StencilOutcome::Fails {
            self.note_rejection(notes, place, Rejection::Stencil, true, step);
        } else {
            notes.add(|| place.origin(), step, Some(self.rules.stencil));
        }
        let Some(attachment) = self.scene.passes[place.pass].depth_stencil else {
            return;
        };
        let stored = (after != before).then_some(SampleContents {
            stencil: after,
            ..SampleContents::default()
        });
        self.note_effect(notes, place, self.rules.stencil, stored, || {
            let target = self.target(attachment, Aspect::Stencil);
            let effect = if after == before {
                Effect::Keeps(target)
            } else {
                Effect::Stores(target)
            };
            let step = Step::StencilUpdate {
                operation: outcome.operation(face).name().to_owned(),
                write_mask: face.state.write_mask,
                before,
                after,
            };
            (effect, step)
        });
    }

    /// Returns whether a depth test can pass, and whether it can fail.
    fn depth_test(
        &self,
        place: &FragmentPlace<'_>,
        function: CompareFunction,
        incoming: Incoming,
        stored: SampleContents,
        encoding: ChannelEncoding,
        notes: &mut Notes<'_>,
    ) -> [bool; 2] {
        if incoming.origin.is_some() && incoming.origin == stored.origin {
            let passes = compare(function, 0, 0);
            let citation = self.rules.same_depth.citation;
            self.note_effect(notes, place, citation, None, || {
                let effect = if passes {
                    Effect::None
                } else {
                    Effect::Rejects(Rejection::Depth)
                };
                let compare = function.name().to_owned();
                (effect, Step::DepthTest(DepthTest::Same { compare }))
            });
            return [passes, !passes];
        }
        let stored = stored.channel(0);
        let of_codes = |codes: CodeInterval| Interval::of_codes(encoding, codes);
        let compared = || {
            let both = [of_codes(incoming.codes), of_codes(stored)];
            let is_converted = match self.rules.depth_order.value() {
                DepthOrder::Either => false,
                DepthOrder::WrittenConvertedFirst => place.draw.shader.writes_depth(),
                DepthOrder::ConvertedFirst => true,
            };
            if is_converted {
                return both;
            }
            let decoded = Judging::new(self.rules).decode(encoding, stored);
            let [left, right] = both;
            [left.hull(incoming.depth.hull()), right.hull(decoded.hull())]
        };
        let outcomes = match function {
            CompareFunction::Never => [false, true],
            CompareFunction::Always => [true, false],
            _ => possible(function, compared()),
        };
        let step = || {
            let [left, right] = compared();
            Step::DepthTest(DepthTest::Compared {
                compare: function.name().to_owned(),
                incoming: left.into(),
                stored: right.into(),
            })
        };
        match outcomes {
            [true, false] => notes.add(|| place.origin(), step, None),
            [true, true] => {
                let citation = self.rules.depth_order.citation;
                self.note_effect(notes, place, citation, None, || {
                    (Effect::MayReject(Rejection::Depth), step())
                });
            }
            _ => self.note_rejection(notes, place, Rejection::Depth, true, step),
        }
        outcomes
    }
}

/// The outcome of shading for a sample: whether the shader's discard, the shader's sample mask, and the
/// draw's mask with alpha to coverage can keep the sample, and whether they must.
#[derive(Clone, Copy, Debug)]
struct Covered {
    kept: Possible,
    masked: Possible,
    coverage: Possible,
}

impl Covered {
    fn survives(self) -> Possible {
        self.kept.and(self.masked).and(self.coverage)
    }
}

/// The outcome of stencil and depth test.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum StencilOutcome {
    Fails,
    DepthFails,
    Passes,
}

impl StencilOutcome {
    /// Returns the operation that updates the stencil value.
    fn operation(self, face: &Face) -> StencilOperation {
        match self {
            Self::Fails => face.state.fail_op,
            Self::DepthFails => face.state.depth_fail_op,
            Self::Passes => face.state.pass_op,
        }
    }
}

/// The source of a depth.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum DepthSource {
    /// The fragment's interpolated depth.
    Own,
    /// The shader's output.
    Written,
}

/// A depth that is tested and stored.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Incoming {
    pub(crate) depth: Range,
    /// The depth as an attachment stores it, if the draw has a depth test.
    pub(crate) codes: CodeInterval,
    /// The geometry that the depth belongs to, if redraws of that geometry have the same depth.
    pub(crate) origin: Option<NonZeroU64>,
}

/// Returns whether a comparison of some value of `left` with some value of `right` can be true, and
/// whether it can be false.
fn possible(function: CompareFunction, [left, right]: [Interval; 2]) -> [bool; 2] {
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
