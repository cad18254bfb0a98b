//! One span of texels through the fragment pipeline, all lanes at once.

use crate::depth_encoding;
use crate::surface::Surface;
use etalon_case::Scene;
use etalon_case::scene::{Draw, Pass, StencilFace};
use etalon_case::state::StencilOperation;
use etalon_frame::ChannelEncoding;
use etalon_pipeline::shader::{FragmentInput, FragmentOutput, fragment};
use etalon_pipeline::{
    Arithmetic, BlendInput, Plain, blend, compare, stencil_passes, stencil_write,
};

/// Texels of a span.
pub(crate) const LANES: usize = 16;

type Real = [f32; LANES];
/// One flag per texel of a span.
pub(crate) type Mask = [bool; LANES];

/// Covered texels of one primitive in one row. `x` is a multiple of [`LANES`].
pub(crate) struct Span<'a> {
    pub(crate) x: usize,
    pub(crate) y: usize,
    /// Coverage, sample by sample.
    pub(crate) masks: &'a [Mask],
    pub(crate) front: bool,
    pub(crate) color: [f32; 4],
    /// Window depths at one sample.
    pub(crate) depth: &'a dyn Fn(usize) -> Real,
}

/// A draw's state and the attachments it works on.
pub(crate) struct SpanState<'a> {
    draw: &'a Draw,
    pass: &'a Pass,
    depth: Option<ChannelEncoding>,
    encodings: Vec<[ChannelEncoding; 4]>,
    surfaces: &'a mut [Surface],
}

fn and(a: Mask, b: Mask) -> Mask {
    std::array::from_fn(|i| a[i] & b[i])
}

fn and_not(a: Mask, b: Mask) -> Mask {
    std::array::from_fn(|i| a[i] & !b[i])
}

fn load(plane: &[u32], at: usize) -> [u32; LANES] {
    std::array::from_fn(|i| plane[at + i])
}

fn store(plane: &mut [u32], at: usize, codes: [u32; LANES], mask: Mask) {
    for (i, slot) in plane[at..at + LANES].iter_mut().enumerate() {
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

impl<'a> SpanState<'a> {
    pub(crate) fn new(
        scene: &Scene,
        pass: &'a Pass,
        draw: &'a Draw,
        surfaces: &'a mut [Surface],
    ) -> Self {
        let format = |index: usize| scene.attachments[index].format;
        Self {
            draw,
            pass,
            depth: pass.depth_stencil.and_then(|i| depth_encoding(format(i))),
            encodings: pass
                .color
                .iter()
                .map(|index| four(format(*index).color_channels()))
                .collect(),
            surfaces,
        }
    }

    /// How the pass stores depth, if it does.
    pub(crate) fn depth_encoding(&self) -> Option<ChannelEncoding> {
        self.depth
    }

    /// Shades, tests, blends and stores a span.
    pub(crate) fn run(&mut self, span: &Span<'_>) {
        let texels = [self.texel(span, 0), self.texel(span, 1)];
        let per_sample = self.draw.shader.runs_per_sample();
        let mut shaded: Option<FragmentOutput<Real>> = None;
        for sample in 0..span.masks.len() {
            let mut mask = span.masks[sample];
            if self.draw.multisample.mask & (1 << sample) == 0 || !mask.contains(&true) {
                continue;
            }
            let own_depth = (span.depth)(sample);
            // A shader that does not ask for the sample runs once; its depth is a sample's own only
            // where it writes none.
            let output = match shaded {
                Some(output) if !per_sample => output,
                _ => {
                    let input = FragmentInput {
                        color: span.color.map(|v| [v; LANES]),
                        front: span.front,
                        depth: own_depth,
                        sample: sample as u32,
                        texels,
                        params: &self.draw.params,
                    };
                    fragment(&mut Plain::<LANES>, self.draw.shader, &input)
                }
            };
            shaded = Some(output);
            if self.draw.multisample.alpha_to_coverage {
                mask = and(mask, covers(output.color[3], sample, span.masks.len()));
            }
            let depth = output.depth.unwrap_or(own_depth);
            let mask = self.tests(span, sample, depth, mask);
            self.write_colors(span, sample, &output, mask);
        }
    }

    fn at(&self, index: usize, span: &Span<'_>) -> usize {
        span.y * self.surfaces[index].stride + span.x
    }

    fn texel(&self, span: &Span<'_>, t: usize) -> [Real; 4] {
        let Some(index) = self.draw.textures.get(t) else {
            return [[0.0; LANES]; 4];
        };
        let surface = &self.surfaces[*index];
        let at = self.at(*index, span);
        let mut plain = Plain::<LANES>;
        std::array::from_fn(|c| match surface.encodings.get(c) {
            Some(encoding) => plain.decode(*encoding, load(surface.plane(c, 0), at)),
            None => [if c == 3 { 1.0 } else { 0.0 }; LANES],
        })
    }

    /// Depth bounds, stencil and depth; the texels that pass all of them.
    fn tests(&mut self, span: &Span<'_>, sample: usize, depth: Real, mask: Mask) -> Mask {
        let mut mask = self.depth_bounds(span, sample, mask);
        let face = self
            .draw
            .stencil
            .map(|s| if span.front { s.front } else { s.back });
        if let Some(face) = face {
            mask = self.stencil_test(span, sample, &face, mask);
        }
        let passed = self.depth_test(span, sample, depth, mask);
        if let Some(face) = face {
            let failed = and_not(mask, passed);
            self.stencil_update(span, sample, &face, face.depth_fail_op, failed);
            self.stencil_update(span, sample, &face, face.pass_op, passed);
        }
        passed
    }

    fn depth_bounds(&self, span: &Span<'_>, sample: usize, mask: Mask) -> Mask {
        let (Some([low, high]), Some(index), Some(encoding)) =
            (self.draw.depth_bounds, self.pass.depth_stencil, self.depth)
        else {
            return mask;
        };
        let at = self.at(index, span);
        let stored = load(self.surfaces[index].plane(0, sample), at);
        let stored = Plain::<LANES>.decode(encoding, stored);
        and(mask, stored.map(|v| low <= v && v <= high))
    }

    fn stencil_test(
        &mut self,
        span: &Span<'_>,
        sample: usize,
        face: &StencilFace,
        mask: Mask,
    ) -> Mask {
        let Some(index) = self.pass.depth_stencil else {
            return mask;
        };
        let at = self.at(index, span);
        let stored = &self.surfaces[index].stencil[sample];
        let passes: Mask = std::array::from_fn(|i| stencil_passes(face, stored[at + i]));
        self.stencil_update(span, sample, face, face.fail_op, and_not(mask, passes));
        and(mask, passes)
    }

    fn stencil_update(
        &mut self,
        span: &Span<'_>,
        sample: usize,
        face: &StencilFace,
        operation: StencilOperation,
        mask: Mask,
    ) {
        let Some(index) = self.pass.depth_stencil else {
            return;
        };
        let at = self.at(index, span);
        let stored = &mut self.surfaces[index].stencil[sample][at..at + LANES];
        for (i, slot) in stored.iter_mut().enumerate() {
            let new = stencil_write(face, operation, *slot);
            *slot = if mask[i] { new } else { *slot };
        }
    }

    fn depth_test(&mut self, span: &Span<'_>, sample: usize, depth: Real, mask: Mask) -> Mask {
        let (Some(state), Some(index), Some(encoding)) =
            (self.draw.depth, self.pass.depth_stencil, self.depth)
        else {
            return mask;
        };
        let at = self.at(index, span);
        let plane = self.surfaces[index].plane_mut(0, sample);
        // Codes of depths in 0..=1 are ordered as the depths are, floats among them. Adding 0 takes
        // the sign off a negative zero.
        let codes = Plain::<LANES>.encode(encoding, depth.map(|v| v.clamp(0.0, 1.0) + 0.0));
        let stored = load(plane, at);
        let passes = std::array::from_fn(|i| compare(state.compare, codes[i], stored[i]));
        let passed = and(mask, passes);
        if state.write {
            store(plane, at, codes, passed);
        }
        passed
    }

    fn write_colors(
        &mut self,
        span: &Span<'_>,
        sample: usize,
        output: &FragmentOutput<Real>,
        mask: Mask,
    ) {
        let mut plain = Plain::<LANES>;
        let mut color = output.color;
        let mut second = output.second.unwrap_or([[0.0; LANES]; 4]);
        if self.draw.multisample.alpha_to_one {
            color[3] = [1.0; LANES];
            second[3] = [1.0; LANES];
        }
        for (t, index) in self.pass.color.iter().enumerate() {
            let target = &self.draw.targets[t];
            let encodings = self.encodings[t];
            let at = self.at(*index, span);
            let surface = &mut self.surfaces[*index];
            let channels = surface.encodings.len();
            let value = match &target.blend {
                None => color,
                Some(state) => {
                    // A destination's missing colours count as 0, its missing alpha as 1.
                    let dst = std::array::from_fn(|c| match c {
                        _ if c < channels => {
                            plain.decode(encodings[c], load(surface.plane(c, sample), at))
                        }
                        3 => [1.0; LANES],
                        _ => [0.0; LANES],
                    });
                    let input = BlendInput {
                        src: color,
                        src1: second,
                        dst,
                        constant: self.draw.blend_constant.map(|v| [v; LANES]),
                    };
                    blend(&mut plain, state, encodings, &input)
                }
            };
            for c in 0..channels {
                if target.write_mask & (1 << c) == 0 {
                    continue;
                }
                let plane = surface.plane_mut(c, sample);
                let mut codes = plain.encode(encodings[c], value[c]);
                if let Some(operation) = self.draw.logic {
                    codes = plain.logic(encodings[c], operation, codes, load(plane, at));
                }
                store(plane, at, codes, mask);
            }
        }
    }
}

/// Alpha to coverage: the first samples, as many as alpha's share.
fn covers(alpha: Real, sample: usize, samples: usize) -> Mask {
    let count = samples as f32;
    alpha.map(|a| (sample as f32) < (a.clamp(0.0, 1.0) * count).round())
}
