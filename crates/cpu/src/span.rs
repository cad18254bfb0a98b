//! One span of texels through the fragment pipeline, all lanes at once.

use crate::depth_encoding;
use crate::steps::{Codes, Mask, Path, Real, Steps, Tests};
use crate::surface::Surface;
use etalon_case::Scene;
use etalon_case::scene::{Draw, Pass, StencilFace};
use etalon_frame::ChannelEncoding;
use etalon_pipeline::shader::{FragmentInput, fragment};
use etalon_pipeline::{Arithmetic, BlendInput, Plain};

/// Texels of a span.
pub(crate) const LANES: usize = 16;

/// Covered texels of one primitive in one row. `x` is a multiple of [`LANES`].
pub(crate) struct Span {
    pub(crate) x: usize,
    pub(crate) y: usize,
    pub(crate) mask: Mask,
    pub(crate) front: bool,
    pub(crate) color: [f32; 4],
    pub(crate) depth: Real,
}

/// A draw's state and the attachments it works on.
pub(crate) struct SpanState<'a, S> {
    draw: &'a Draw,
    pass: &'a Pass,
    depth: Option<ChannelEncoding>,
    encodings: Vec<[ChannelEncoding; 4]>,
    texture: [ChannelEncoding; 4],
    surfaces: &'a mut [Surface],
    steps: &'a S,
}

fn and(a: Mask, b: Mask) -> Mask {
    std::array::from_fn(|i| a[i] & b[i])
}

fn and_not(a: Mask, b: Mask) -> Mask {
    std::array::from_fn(|i| a[i] & !b[i])
}

fn load(plane: &[u32], at: usize) -> Codes {
    std::array::from_fn(|i| plane[at + i])
}

fn store(plane: &mut [u32], at: usize, codes: Codes, mask: Mask) {
    for (i, slot) in plane[at..at + LANES].iter_mut().enumerate() {
        *slot = if mask[i] { codes[i] } else { *slot };
    }
}

impl<'a, S: Steps> SpanState<'a, S> {
    pub(crate) fn new(
        scene: &Scene,
        pass: &'a Pass,
        draw: &'a Draw,
        surfaces: &'a mut [Surface],
        steps: &'a S,
    ) -> Self {
        let format = |index: usize| scene.attachments[index].format;
        let four = |index: usize| -> [ChannelEncoding; 4] {
            let channels = format(index).color_channels();
            std::array::from_fn(|c| channels[c.min(channels.len() - 1)])
        };
        Self {
            draw,
            pass,
            depth: pass.depth_stencil.and_then(|i| depth_encoding(format(i))),
            encodings: pass.color.iter().map(|index| four(*index)).collect(),
            texture: draw
                .textures
                .first()
                .map_or([ChannelEncoding::Float32; 4], |index| four(*index)),
            surfaces,
            steps,
        }
    }

    /// Shades, tests, blends and stores a span.
    pub(crate) fn run(&mut self, span: &Span) {
        let mut plain = Plain::<LANES>;
        let texel = self.texel(span);
        let input = FragmentInput {
            color: span.color.map(|v| [v; LANES]),
            front: span.front,
            texel,
            params: &self.draw.params,
        };
        let output = fragment(&mut plain, self.draw.shader, &input);
        let depth = output.depth.unwrap_or(span.depth);
        let mut tests = Tests {
            covered: span.mask,
            stencil: [true; LANES],
            depth: [true; LANES],
        };
        let face = self
            .draw
            .stencil
            .map(|s| if span.front { s.front } else { s.back });
        if let Some(face) = &face {
            tests.stencil = self.stencil_test(span, face);
        }
        let codes = self.depth_test(span, depth, &mut tests.depth);
        let written = self.steps.written(&tests);
        if let Some(codes) = codes {
            self.depth_write(span, codes, written.depth);
        }
        if let Some(face) = &face {
            let passed = and(tests.covered, tests.stencil);
            let failed = and_not(tests.covered, tests.stencil);
            self.stencil_update(span, face, Path::Fail, failed);
            self.stencil_update(span, face, Path::DepthFail, and_not(passed, tests.depth));
            self.stencil_update(span, face, Path::Pass, and(passed, tests.depth));
        }
        self.write_colors(span, &output.color, written.color);
    }

    fn texel(&self, span: &Span) -> [Real; 4] {
        let Some(index) = self.draw.textures.first() else {
            return [[0.0; LANES]; 4];
        };
        self.steps
            .fetch(&self.surfaces[*index], self.texture, span.x, span.y)
    }

    fn stencil_test(&self, span: &Span, face: &StencilFace) -> Mask {
        let Some(index) = self.pass.depth_stencil else {
            return [true; LANES];
        };
        let surface = &self.surfaces[index];
        let at = span.y * surface.stride + span.x;
        std::array::from_fn(|i| self.steps.stencil_passes(face, surface.stencil[at + i]))
    }

    fn stencil_update(&mut self, span: &Span, face: &StencilFace, path: Path, mask: Mask) {
        let Some(index) = self.pass.depth_stencil else {
            return;
        };
        let surface = &mut self.surfaces[index];
        let at = span.y * surface.stride + span.x;
        for (i, slot) in surface.stencil[at..at + LANES].iter_mut().enumerate() {
            let new = self.steps.stencil_write(face, path, *slot);
            *slot = if mask[i] { new } else { *slot };
        }
    }

    /// The codes to store, where the draw stores any.
    fn depth_test(&self, span: &Span, depth: Real, passes: &mut Mask) -> Option<Codes> {
        let (state, index, encoding) = (self.draw.depth?, self.pass.depth_stencil?, self.depth?);
        let surface = &self.surfaces[index];
        let codes = self.steps.depth_codes(encoding, depth);
        let stored = load(&surface.planes[0], span.y * surface.stride + span.x);
        *passes =
            std::array::from_fn(|i| self.steps.depth_passes(state.compare, codes[i], stored[i]));
        state.write.then_some(codes)
    }

    fn depth_write(&mut self, span: &Span, codes: Codes, mask: Mask) {
        if let Some(index) = self.pass.depth_stencil {
            let surface = &mut self.surfaces[index];
            let at = span.y * surface.stride + span.x;
            store(&mut surface.planes[0], at, codes, mask);
        }
    }

    fn write_colors(&mut self, span: &Span, color: &[Real; 4], mask: Mask) {
        let mut plain = Plain::<LANES>;
        for (t, index) in self.pass.color.iter().enumerate() {
            let target = &self.draw.targets[t];
            let encodings = self.encodings[t];
            let surface = &mut self.surfaces[*index];
            let at = span.y * surface.stride + span.x;
            let value = match &target.blend {
                None => *color,
                Some(state) => {
                    let dst = std::array::from_fn(|c| {
                        let plane = &surface.planes[c.min(surface.planes.len() - 1)];
                        plain.decode(encodings[c], load(plane, at))
                    });
                    let input = BlendInput {
                        src: *color,
                        dst,
                        constant: self.draw.blend_constant.map(|v| [v; LANES]),
                    };
                    self.steps.blend(state, encodings, &input)
                }
            };
            for (c, plane) in surface.planes.iter_mut().enumerate() {
                if target.write_mask & (1 << c) != 0 {
                    let codes = self.steps.color_codes(encodings[c], value[c]);
                    store(plane, at, codes, mask);
                }
            }
        }
    }
}
