//! One span of texels through the fragment pipeline, all lanes at once.

use crate::depth_encoding;
use crate::surface::Surface;
use etalon_case::Scene;
use etalon_case::scene::{Draw, Pass, StencilFace};
use etalon_frame::ChannelEncoding;
use etalon_pipeline::shader::{FragmentInput, fragment};
use etalon_pipeline::{
    Arithmetic, BlendInput, Plain, blend, compare, stencil_passes, stencil_write,
};

/// Texels of a span.
pub(crate) const LANES: usize = 16;

type Real = [f32; LANES];
type Mask = [bool; LANES];

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
pub(crate) struct SpanState<'a> {
    draw: &'a Draw,
    pass: &'a Pass,
    depth: Option<ChannelEncoding>,
    encodings: Vec<[ChannelEncoding; 4]>,
    texture: [ChannelEncoding; 4],
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

impl<'a> SpanState<'a> {
    pub(crate) fn new(
        scene: &Scene,
        pass: &'a Pass,
        draw: &'a Draw,
        surfaces: &'a mut [Surface],
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
        let mut mask = span.mask;
        let face = self
            .draw
            .stencil
            .map(|s| if span.front { s.front } else { s.back });
        if let Some(face) = face {
            mask = self.stencil_test(span, &face, mask);
        }
        let passed = self.depth_test(span, depth, mask);
        if let Some(face) = face {
            self.stencil_update(span, &face, face.depth_fail_op, and_not(mask, passed));
            self.stencil_update(span, &face, face.pass_op, passed);
        }
        self.write_colors(span, &output.color, passed);
    }

    fn texel(&self, span: &Span) -> [Real; 4] {
        let Some(index) = self.draw.textures.first() else {
            return [[0.0; LANES]; 4];
        };
        let surface = &self.surfaces[*index];
        let at = span.y * surface.stride + span.x;
        let mut plain = Plain::<LANES>;
        std::array::from_fn(|c| plain.decode(self.texture[c], load(&surface.planes[c], at)))
    }

    fn stencil_test(&mut self, span: &Span, face: &StencilFace, mask: Mask) -> Mask {
        let Some(index) = self.pass.depth_stencil else {
            return mask;
        };
        let surface = &self.surfaces[index];
        let at = span.y * surface.stride + span.x;
        let passes: Mask = std::array::from_fn(|i| stencil_passes(face, surface.stencil[at + i]));
        self.stencil_update(span, face, face.fail_op, and_not(mask, passes));
        and(mask, passes)
    }

    fn stencil_update(
        &mut self,
        span: &Span,
        face: &StencilFace,
        operation: etalon_case::state::StencilOperation,
        mask: Mask,
    ) {
        let Some(index) = self.pass.depth_stencil else {
            return;
        };
        let surface = &mut self.surfaces[index];
        let at = span.y * surface.stride + span.x;
        for (i, slot) in surface.stencil[at..at + LANES].iter_mut().enumerate() {
            let new = stencil_write(face, operation, *slot);
            *slot = if mask[i] { new } else { *slot };
        }
    }

    fn depth_test(&mut self, span: &Span, depth: Real, mask: Mask) -> Mask {
        let (Some(state), Some(index), Some(encoding)) =
            (self.draw.depth, self.pass.depth_stencil, self.depth)
        else {
            return mask;
        };
        let surface = &mut self.surfaces[index];
        let at = span.y * surface.stride + span.x;
        // Codes of depths in 0..=1 are ordered as the depths are, floats among them.
        let codes = Plain::<LANES>.encode(encoding, depth.map(|v| v.clamp(0.0, 1.0)));
        let stored = load(&surface.planes[0], at);
        let passes = std::array::from_fn(|i| compare(state.compare, codes[i], stored[i]));
        let passed = and(mask, passes);
        if state.write {
            store(&mut surface.planes[0], at, codes, passed);
        }
        passed
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
                    blend(&mut plain, state, encodings, &input)
                }
            };
            for (c, plane) in surface.planes.iter_mut().enumerate() {
                if target.write_mask & (1 << c) != 0 {
                    store(plane, at, plain.encode(encodings[c], value[c]), mask);
                }
            }
        }
    }
}
