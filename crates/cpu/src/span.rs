//! The fragment pipeline for one span of texels, all lanes at once.

use crate::lanes::{LANES, LaneCodes, Mask, Real};
use crate::linear::{CENTER, LinearVarying, UNITS};
use crate::lists::TexelLists;
use crate::memory::{CountedKind, Memory};
use crate::steps::{ComparedDepths, ExportedReference, InputBit, Steps, TestOutcome, Tests};
use crate::surface::{CpuSurface, depth_encoding};
use etalon_frame::{Aspect, ChannelEncoding, CounterKind};
use etalon_pipeline::shader::{
    FragmentInput, FragmentOutput, InputMask, List, Taps, cost, fragment,
};
use etalon_pipeline::{Arithmetic, BlendInput, Plain, Point, takes_logic};
use etalon_scene::{Draw, EarlyTests, InterpolationSampling, Pass, Scene, Shader, StencilFace};

/// The covered texels of one primitive in one row. `x` is a multiple of [`LANES`].
pub(crate) struct Span<'a> {
    pub(crate) x: usize,
    pub(crate) y: usize,
    /// The coverage, one mask per sample.
    pub(crate) masks: &'a [Mask],
    pub(crate) front: bool,
    pub(crate) color: [f32; 4],
    /// Returns the window depths at one sample.
    pub(crate) depth: &'a dyn Fn(usize) -> Real,
    /// Texture coordinates, if the shader reads them.
    pub(crate) uv: Option<[LinearVarying; 2]>,
    /// 1 over w, if the shader reads it.
    pub(crate) reciprocal_w: Option<LinearVarying>,
}

/// The state of a draw and the attachments it draws to.
pub(crate) struct SpanState<'a, S> {
    draw: &'a Draw,
    pass: &'a Pass,
    /// The positions of a texel's samples.
    samples: &'a [Point],
    depth: Option<ChannelEncoding>,
    encodings: Vec<[ChannelEncoding; 4]>,
    /// True for each target to which logic operations apply.
    logic: Vec<bool>,
    size: [u32; 2],
    /// True if the fragment tests run before the shader, because they are forced to or the result is the
    /// same.
    early: bool,
    /// True if a test or the shader uses the fragment's depth.
    asks_depth: bool,
    surfaces: &'a mut [CpuSurface],
    counters: &'a mut [CountedKind],
    lists: &'a mut TexelLists,
    steps: &'a S,
}

/// The stencil state of a span's face, and the references that a shader wrote.
struct SpanFace {
    face: StencilFace,
    front: bool,
    written: Option<WrittenReferences>,
}

/// The references that a shader wrote, and the amount that it added to them for the sample.
type WrittenReferences = ([i32; LANES], i32);

impl SpanFace {
    /// Returns the state of one texel: for the stencil test, or, with an outcome, for the update.
    #[inline(always)]
    fn of<S: Steps>(
        &self,
        steps: &S,
        outcome: Option<TestOutcome>,
        lane: usize,
        sample: usize,
    ) -> StencilFace {
        let Some((written, plus)) = self.written else {
            return self.face;
        };
        let reference = steps.exported(&ExportedReference {
            face: self.face,
            front: self.front,
            outcome,
            written,
            plus,
            lane,
            sample,
        });
        StencilFace {
            reference,
            ..self.face
        }
    }
}

/// The number of texels for which an expensive shader's loop runs together.
const TOGETHER: usize = 4;

fn and(a: Mask, b: Mask) -> Mask {
    std::array::from_fn(|i| a[i] & b[i])
}

fn or(a: Mask, b: Mask) -> Mask {
    std::array::from_fn(|i| a[i] | b[i])
}

fn and_not(a: Mask, b: Mask) -> Mask {
    std::array::from_fn(|i| a[i] & !b[i])
}

fn load(plane: &[u32], offset: usize) -> LaneCodes {
    std::array::from_fn(|i| plane[offset + i])
}

fn store(plane: &mut [u32], offset: usize, codes: LaneCodes, mask: Mask) {
    for (i, slot) in plane[offset..offset + LANES].iter_mut().enumerate() {
        *slot = if mask[i] { codes[i] } else { *slot };
    }
}

fn four(channels: &[ChannelEncoding]) -> [ChannelEncoding; 4] {
    std::array::from_fn(|c| {
        let last = channels.len().saturating_sub(1);
        channels
            .get(c.min(last))
            .copied()
            .unwrap_or(ChannelEncoding::Float32)
    })
}

/// Returns true if a draw's fragment tests run before its shader, because they are forced to or the result is
/// the same.
fn tests_early(draw: &Draw) -> bool {
    let shader = draw.shader;
    let same = !(shader.discards()
        || shader.writes_depth()
        || shader.counts_runs()
        || shader.adds_to_pool()
        || shader.writes_mask()
        || shader.writes_reference()
        || draw.alpha_to_coverage());
    same || draw.early_tests == EarlyTests::Forced
}

/// Returns the window coordinates of one point of each texel of a span.
fn window_position(span: &Span<'_>, point: Point) -> [Real; 2] {
    let within = |v: i64| v as f32 / UNITS as f32;
    [
        std::array::from_fn(|lane| (span.x + lane) as f32 + within(point.x)),
        [span.y as f32 + within(point.y); LANES],
    ]
}

fn is_expensive(shader: Shader) -> bool {
    matches!(
        shader,
        Shader::ExpensiveColor | Shader::ExpensiveDepth | Shader::ExpensiveDiscard
    )
}

impl<'a, S: Steps> SpanState<'a, S> {
    pub(crate) fn new(
        scene: &Scene,
        pass: &'a Pass,
        draw: &'a Draw,
        samples: &'a [Point],
        memory: &'a mut Memory<'_>,
        steps: &'a S,
    ) -> Self {
        let format = |index: usize| scene.attachments[index].format;
        Self {
            draw,
            pass,
            samples,
            depth: pass.depth_stencil.and_then(|i| depth_encoding(format(i))),
            encodings: pass
                .color
                .iter()
                .map(|index| four(format(*index).color_channels()))
                .collect(),
            logic: pass
                .color
                .iter()
                .map(|index| takes_logic(format(*index)))
                .collect(),
            size: scene.pass_size(pass),
            early: tests_early(draw),
            asks_depth: draw.depth.is_some()
                || draw.depth_bounds.is_some()
                || draw.shader.reads_depth(),
            surfaces: memory.surfaces,
            counters: memory.counters,
            lists: memory.lists,
            steps,
        }
    }

    /// Returns the encoding of the pass's depth attachment, if it has one.
    pub(crate) fn depth_encoding(&self) -> Option<ChannelEncoding> {
        self.depth
    }

    /// Shades, tests, blends and stores a span.
    pub(crate) fn run(&mut self, span: &Span<'_>) {
        let samples = span.masks.len();
        let state = &self.draw.multisample;
        let runs = self.steps.shader_runs(self.draw.shader, state, samples);
        let mut shaded: Option<FragmentOutput<Real>> = None;
        // A shader that runs for several samples gets the depth of the first covered sample.
        let mut seen: Option<Real> = None;
        let mut ran = [false; LANES];
        let mut passed = [false; LANES];
        let mut run = 0;
        for sample in 0..samples {
            if std::mem::replace(&mut run, sample * runs / samples) != sample * runs / samples {
                self.count(|kind| !kind.is_occlusion(), ran);
                (shaded, seen, ran) = (None, None, [false; LANES]);
            }
            let mut mask = self
                .steps
                .covered(span.x, span.y, self.size, span.masks[sample]);
            let is_drawn = self.steps.sample_drawn(state, sample, samples);
            let is_masked_late =
                self.draw.early_tests == EarlyTests::Forced && self.steps.tests_before_mask();
            if !(is_drawn || is_masked_late) || !mask.contains(&true) {
                continue;
            }
            let own_depth = if self.asks_depth {
                (span.depth)(self.steps.depth_sample(sample, samples))
            } else {
                [0.0; LANES]
            };
            let first_depth = *seen.get_or_insert(own_depth);
            if self.early {
                mask = self.test_and_store(span, sample, own_depth, None, mask);
                passed = or(passed, mask);
                self.count_passed(mask);
                if !is_drawn || !mask.contains(&true) {
                    continue;
                }
            }
            let new = and_not(mask, ran);
            ran = or(ran, mask);
            // Each sample has its own depth unless the shader writes one.
            let mut output = match shaded {
                Some(output) => output,
                None => self.shade(span, sample, first_depth),
            };
            self.run_expensive_loop(span, new, &mut output);
            shaded = Some(output);
            if let Some(node) = &output.node {
                let pool_use = self.draw.shader.pool_use();
                self.lists.add([span.x, span.y], pool_use, node, new);
            }
            if let Some(kept) = &output.kept {
                mask = and(mask, self.steps.kept(kept));
            }
            if let Some(written) = &output.mask {
                mask = and(mask, self.steps.mask_keeps(written, sample, samples));
            }
            if self.draw.alpha_to_coverage() {
                let covers = self.steps.alpha_covers(output.color[3], sample, samples);
                mask = and(mask, covers);
            }
            if !self.early {
                let depth = output.depth.unwrap_or(own_depth);
                let references = output.reference.map(|reference| {
                    let written = reference.number.map(|number| reference.written(number));
                    (written, reference.plus)
                });
                mask = self.test_and_store(span, sample, depth, references, mask);
                passed = or(passed, mask);
                self.count_passed(mask);
            }
            if mask.contains(&true) {
                self.write_colors(span, sample, &output, mask);
            }
        }
        self.count(|kind| !kind.is_occlusion(), ran);
        if self.steps.counts_all_samples() {
            (0..samples).for_each(|_| self.count(CounterKind::is_occlusion, passed));
        }
    }

    /// Runs the fragment shader, except the loop of an expensive shader.
    fn shade(&self, span: &Span<'_>, sample: usize, depth: Real) -> FragmentOutput<Real> {
        let state = &self.draw.multisample;
        let point = match self.steps.shaded_at(state, sample, self.samples.len()) {
            Some(sample) => self.samples[sample],
            None => CENTER,
        };
        let tap = |[u, v]: [Real; 2]| match (self.draw.textures.first(), self.draw.sampler) {
            (Some(index), Some(sampler)) => {
                self.steps.sample(&self.surfaces[*index], sampler, u, v)
            }
            _ => [[0.0; LANES]; 4],
        };
        let mask = |bit: u32| self.input_bit(span, sample, bit as usize);
        let list = if self.draw.shader.reads_pool() {
            self.lists.of([span.x, span.y], self.draw.shader.pool_use())
        } else {
            Vec::new()
        };
        let input = FragmentInput {
            color: span.color.map(|v| [v; LANES]),
            front: span.front,
            depth,
            sample: sample as u32,
            mask: if self.draw.shader.reads_mask() {
                InputMask::of(&mask)
            } else {
                InputMask::NONE
            },
            position: window_position(span, point),
            texels: [self.texel(span, sample, 0), self.texel(span, sample, 1)],
            neighbours: self.neighbours(span, point),
            taps: if self.draw.shader.taps_texture() {
                Taps::of(&tap)
            } else {
                Taps::NONE
            },
            list: List::Known(&list),
            reciprocal_w: match &span.reciprocal_w {
                Some(plane) => plane.at(span.x, span.y, &[point; LANES]),
                None => [0.0; LANES],
            },
            uv: self.uv(span, sample, point),
            params: &self.draw.params,
        };
        fragment(&mut Plain::<LANES>, self.draw.shader, &input)
    }

    /// Returns texture 0 at the other column and at the other row of each texel's block of two by two texels, if
    /// the shader reads how it changes.
    fn neighbours(&self, span: &Span<'_>, point: Point) -> Option<[[Real; 4]; 2]> {
        let planes = span
            .uv
            .as_ref()
            .filter(|_| self.draw.shader.reads_derivatives())?;
        let (texture, sampler) = (self.draw.textures.first()?, self.draw.sampler?);
        let other = |place: usize| {
            if place.is_multiple_of(2) {
                UNITS
            } else {
                -UNITS
            }
        };
        let beside = std::array::from_fn(|lane| Point {
            x: point.x + other(span.x + lane),
            ..point
        });
        let below = [Point {
            y: point.y + other(span.y),
            ..point
        }; LANES];
        Some([beside, below].map(|points| {
            let [u, v] = planes
                .each_ref()
                .map(|plane| plane.at(span.x, span.y, &points));
            self.steps.sample(&self.surfaces[*texture], sampler, u, v)
        }))
    }

    /// Returns, for each texel, a bit of the sample mask that the run for a sample reads.
    fn input_bit(&self, span: &Span<'_>, sample: usize, bit: usize) -> Real {
        let (state, samples) = (&self.draw.multisample, span.masks.len());
        let runs = self.steps.shader_runs(self.draw.shader, state, samples);
        let exists = bit < samples;
        let covered = match span.masks.get(bit) {
            Some(mask) => self.steps.covered(span.x, span.y, self.size, *mask),
            None => [false; LANES],
        };
        covered.map(|covered| {
            let set = self.steps.input_bit(&InputBit {
                bit,
                sample,
                samples,
                covered,
                drawn: exists && self.steps.sample_drawn(state, bit, samples),
                shaded: bit * runs / samples == sample * runs / samples,
            });
            f32::from(u8::from(set))
        })
    }

    /// Runs the loop of an expensive shader for the texels that it shades, so that the time depends on their
    /// number.
    fn run_expensive_loop(&self, span: &Span<'_>, mask: Mask, output: &mut FragmentOutput<Real>) {
        let steps = self.draw.params.back_color[0];
        if !is_expensive(self.draw.shader) {
            return;
        }
        let lanes = mask.iter().enumerate().filter(|(_, set)| **set);
        let columns: Vec<u32> = lanes.map(|(lane, _)| (span.x + lane) as u32).collect();
        for some in columns.chunks(TOGETHER) {
            // The remaining lanes repeat the last texel, at no extra cost.
            let padded: [u32; TOGETHER] = std::array::from_fn(|i| some[i.min(some.len() - 1)]);
            let zeros = cost(padded, span.y as u32, steps);
            for (x, zero) in some.iter().zip(zeros) {
                let lane = *x as usize - span.x;
                output.color.iter_mut().for_each(|c| c[lane] += zero);
            }
        }
    }

    fn count_passed(&mut self, passed: Mask) {
        if self.steps.counts_all_samples() {
            return;
        }
        self.count(CounterKind::is_occlusion, passed);
    }

    /// Adds the lanes of a mask to the draw's counters of these kinds.
    fn count(&mut self, kinds: impl Fn(CounterKind) -> bool, mask: Mask) {
        for index in &self.draw.counters {
            let (kind, count) = &mut self.counters[*index];
            if kinds(*kind) {
                *count += self.steps.counted(*kind, mask);
            }
        }
    }

    fn at(&self, index: usize, span: &Span<'_>) -> usize {
        span.y * self.surfaces[index].stride + span.x
    }

    /// Returns the texture coordinates at one point of each texel of a span. `sample` is the sample that is
    /// shaded, and `point` is where inputs without a sampling qualifier are interpolated.
    fn uv(&self, span: &Span<'_>, sample: usize, point: Point) -> [Real; 2] {
        let Some(planes) = &span.uv else {
            return [[0.0; LANES]; 2];
        };
        let points = match self
            .steps
            .interpolation(self.draw.shader, &self.draw.multisample)
            .1
        {
            InterpolationSampling::Center => [point; LANES],
            InterpolationSampling::Sample => [self.samples[sample]; LANES],
            // The first covered sample is inside the primitive.
            InterpolationSampling::Centroid => std::array::from_fn(|lane| {
                let covered = span.masks.iter().position(|mask| mask[lane]);
                covered.map_or(point, |sample| self.samples[sample])
            }),
        };
        planes
            .each_ref()
            .map(|plane| plane.at(span.x, span.y, &points))
    }

    fn texel(&self, span: &Span<'_>, sample: usize, t: usize) -> [Real; 4] {
        let Some(index) = self.draw.textures.get(t) else {
            return [[0.0; LANES]; 4];
        };
        let surface = &self.surfaces[*index];
        if self.draw.shader.reads_stencil() {
            let offset = span.y * surface.stride + span.x;
            let stored = &surface.stencil[sample][offset..];
            let red = std::array::from_fn(|lane| f32::from(stored[lane]));
            return [red, [0.0; LANES], [0.0; LANES], [1.0; LANES]];
        }
        if self.pass.attaches(*index) {
            return self.steps.fetch_own(surface, span.x, span.y, sample);
        }
        match (self.draw.sampler, &span.uv) {
            (Some(sampler), Some(planes)) => {
                let [u, v] = planes
                    .each_ref()
                    .map(|plane| plane.at(span.x, span.y, &[CENTER; LANES]));
                self.steps.sample(surface, sampler, u, v)
            }
            _ => self.steps.fetch(surface, span.x, span.y),
        }
    }

    /// Runs the depth bounds, stencil and depth tests, and stores depth and stencil. `references` are the
    /// stencil references that the shader wrote, if it writes them. Returns where colour is written.
    fn test_and_store(
        &mut self,
        span: &Span<'_>,
        sample: usize,
        depth: Real,
        references: Option<WrittenReferences>,
        mask: Mask,
    ) -> Mask {
        let bounded = self.depth_bounds(span, sample, depth, mask);
        let mut tests = Tests {
            covered: bounded,
            stencil: [true; LANES],
            depth: [true; LANES],
        };
        let face = self
            .draw
            .stencil
            .map(|s| if span.front { s.front } else { s.back })
            .map(|face| SpanFace {
                face,
                front: span.front,
                written: references,
            });
        if let Some(face) = &face {
            tests.stencil = self.stencil_test(span, sample, face);
        }
        let codes = self.depth_test(span, sample, depth, &mut tests.depth);
        if self.steps.bounds_fail_as_depth() {
            tests.covered = mask;
            tests.depth = and(tests.depth, bounded);
        }
        let written = self.steps.written(&tests);
        if let Some(codes) = codes {
            self.depth_write(span, sample, codes, written.depth);
        }
        if let Some(face) = &face {
            let passed = and(tests.covered, tests.stencil);
            let failed = and_not(tests.covered, tests.stencil);
            let depth_failed = and_not(passed, tests.depth);
            self.stencil_update(span, sample, face, TestOutcome::Fail, failed);
            self.stencil_update(span, sample, face, TestOutcome::DepthFail, depth_failed);
            self.stencil_update(
                span,
                sample,
                face,
                TestOutcome::Pass,
                and(passed, tests.depth),
            );
        }
        written.color
    }

    fn depth_bounds(&self, span: &Span<'_>, sample: usize, incoming: Real, mask: Mask) -> Mask {
        let (Some(bounds), Some(index), Some(encoding)) =
            (self.draw.depth_bounds, self.pass.depth_stencil, self.depth)
        else {
            return mask;
        };
        let offset = self.at(index, span);
        let stored = load(self.surfaces[index].plane(0, sample), offset);
        let stored = Plain::<LANES>.decode(encoding, stored);
        let inside = std::array::from_fn(|i| self.steps.in_bounds(bounds, stored[i], incoming[i]));
        and(mask, inside)
    }

    /// Returns the attachment that has stencil. Without one, the test passes.
    fn stencil(&self) -> Option<usize> {
        let index = self.pass.depth_stencil?;
        (!self.surfaces[index].stencil.is_empty()).then_some(index)
    }

    fn stencil_test(&self, span: &Span<'_>, sample: usize, face: &SpanFace) -> Mask {
        let Some(index) = self.stencil() else {
            return [true; LANES];
        };
        let offset = self.at(index, span);
        let seen = self.steps.stored_sample(Aspect::Stencil, sample);
        let stored = &self.surfaces[index].stencil[seen];
        std::array::from_fn(|i| {
            let face = face.of(self.steps, None, i, sample);
            self.steps.stencil_passes(&face, stored[offset + i])
        })
    }

    fn stencil_update(
        &mut self,
        span: &Span<'_>,
        sample: usize,
        face: &SpanFace,
        outcome: TestOutcome,
        mask: Mask,
    ) {
        let Some(index) = self.stencil() else {
            return;
        };
        let offset = self.at(index, span);
        let stored = &mut self.surfaces[index].stencil[sample][offset..offset + LANES];
        for (i, slot) in stored.iter_mut().enumerate() {
            let face = face.of(self.steps, Some(outcome), i, sample);
            let new = self.steps.stencil_write(&face, outcome, *slot);
            *slot = if mask[i] { new } else { *slot };
        }
    }

    /// Returns the depth codes to write, and sets where the depth test passes. `None` if the draw does not
    /// test or write depth.
    fn depth_test(
        &self,
        span: &Span<'_>,
        sample: usize,
        depth: Real,
        passes: &mut Mask,
    ) -> Option<LaneCodes> {
        let (state, index, encoding) = (self.draw.depth?, self.pass.depth_stencil?, self.depth?);
        // Depths are clamped to the viewport's range after a shader wrote them or a bias was added.
        let range = self.draw.viewport.depth;
        let depth = depth.map(|v| self.steps.held_to_range(v, range, self.draw.depth_clamp));
        let codes = self.steps.depth_codes(encoding, depth);
        let seen = self.steps.stored_sample(Aspect::Depth, sample);
        let stored = load(self.surfaces[index].plane(0, seen), self.at(index, span));
        *passes = std::array::from_fn(|i| {
            let depths = ComparedDepths {
                encoding,
                depth: depth[i],
                incoming: codes[i],
                stored: stored[i],
                written: self.draw.shader.writes_depth(),
            };
            self.steps.depth_passes(state.compare, &depths)
        });
        state.write.then_some(codes)
    }

    fn depth_write(&mut self, span: &Span<'_>, sample: usize, codes: LaneCodes, mask: Mask) {
        if let Some(index) = self.pass.depth_stencil {
            let offset = self.at(index, span);
            store(
                self.surfaces[index].plane_mut(0, sample),
                offset,
                codes,
                mask,
            );
        }
    }

    fn write_colors(
        &mut self,
        span: &Span<'_>,
        sample: usize,
        output: &FragmentOutput<Real>,
        mask: Mask,
    ) {
        let second = output.second.unwrap_or([[0.0; LANES]; 4]);
        let second = self.steps.second_source(&self.draw.multisample, second);
        let seen = self.steps.stored_sample(Aspect::Color, sample);
        for (t, index) in self.pass.color.iter().enumerate() {
            let target = &self.draw.targets[t];
            let mut color = output.at_location(t);
            if self.draw.alpha_to_one() {
                color[3] = [1.0; LANES];
            }
            let encodings = self.encodings[t];
            let offset = self.at(*index, span);
            let surface = &mut self.surfaces[*index];
            let channels = surface.encodings.len();
            // Missing colour channels of the destination are 0, and a missing alpha is 1.
            let dst = |alpha: f32| {
                std::array::from_fn(|c| match c {
                    _ if c < channels => {
                        let stored = load(surface.plane(c, seen), offset);
                        self.steps.color_value(encodings[c], stored)
                    }
                    3 => [alpha; LANES],
                    _ => [0.0; LANES],
                })
            };
            let value = match (&self.draw.blend_of(target), target.advanced) {
                (None, None) => color,
                (None, Some(mode)) => self.steps.advanced_blend(mode, encodings, color, dst(1.0)),
                (Some(state), _) => {
                    let dst = dst(self.steps.missing_alpha(state));
                    let input = BlendInput {
                        src: color,
                        src1: second,
                        dst,
                        constant: self.draw.blend_constant.map(|v| [v; LANES]),
                    };
                    self.steps.blend(state, encodings, &input)
                }
            };
            for c in 0..channels {
                if target.write_mask & (1 << c) == 0 {
                    continue;
                }
                let plane = surface.plane_mut(c, sample);
                let mut codes = self.steps.color_codes(encodings[c], value[c]);
                if let Some(operation) = self.draw.logic {
                    let stored = load(plane, offset);
                    let obeys = self.logic[t];
                    codes = self
                        .steps
                        .logic(obeys, encodings[c], operation, codes, stored);
                }
                store(plane, offset, codes, mask);
            }
        }
    }
}
