//! Steps of the arithmetic with one of them replaced.

use super::plant::Plant;
use crate::span::LANES;
use crate::steps::{Codes, Faithful, Mask, Path, Real, Steps, Tests, Written};
use crate::surface::Surface;
use etalon_case::scene::StencilFace;
use etalon_case::state::{BlendState, CompareFunction};
use etalon_frame::ChannelEncoding;
use etalon_pipeline::{Arithmetic, BlendInput, Plain, blend};

type Hook<F> = Option<Box<F>>;
type BlendBug =
    dyn Fn(&BlendState, [ChannelEncoding; 4], &BlendInput<[f32; 1]>) -> [f32; 4] + Send + Sync;
type FetchBug = dyn Fn([u32; 2], [u32; 2]) -> [u32; 2] + Send + Sync;
type PassBug = dyn Fn(&StencilFace, u8) -> bool + Send + Sync;
type WriteBug = dyn Fn(&StencilFace, Path, u8) -> u8 + Send + Sync;
type CodeBug = dyn Fn(ChannelEncoding, f32) -> u32 + Send + Sync;

/// Replacements of single steps, one texel at a time: planted bugs need not be fast.
#[derive(Default)]
pub(super) struct Hooks {
    covered: Hook<dyn Fn([u32; 2], [u32; 2]) -> bool + Send + Sync>,
    fetch: Hook<FetchBug>,
    stencil_passes: Hook<PassBug>,
    stencil_write: Hook<WriteBug>,
    depth_code: Hook<CodeBug>,
    depth_passes: Hook<dyn Fn(CompareFunction, u32, u32) -> bool + Send + Sync>,
    written: Hook<dyn Fn([bool; 3]) -> [bool; 2] + Send + Sync>,
    blend: Hook<BlendBug>,
    color_code: Hook<CodeBug>,
    clear_code: Hook<CodeBug>,
}

fn plant(hooks: Hooks) -> Plant {
    Plant::Steps(Box::new(hooks))
}

/// Only texels are covered of which `bug([x, y], [width, height])` says so too.
pub(super) fn covered(bug: impl Fn([u32; 2], [u32; 2]) -> bool + Send + Sync + 'static) -> Plant {
    plant(Hooks {
        covered: Some(Box::new(bug)),
        ..Hooks::default()
    })
}

/// Texels are fetched from `bug([x, y], [width, height])`.
pub(super) fn fetch(bug: impl Fn([u32; 2], [u32; 2]) -> [u32; 2] + Send + Sync + 'static) -> Plant {
    plant(Hooks {
        fetch: Some(Box::new(bug)),
        ..Hooks::default()
    })
}

/// The stencil test.
pub(super) fn stencil_passes(
    bug: impl Fn(&StencilFace, u8) -> bool + Send + Sync + 'static,
) -> Plant {
    plant(Hooks {
        stencil_passes: Some(Box::new(bug)),
        ..Hooks::default()
    })
}

/// The stencil update, write mask and all.
pub(super) fn stencil_write(
    bug: impl Fn(&StencilFace, Path, u8) -> u8 + Send + Sync + 'static,
) -> Plant {
    plant(Hooks {
        stencil_write: Some(Box::new(bug)),
        ..Hooks::default()
    })
}

/// The conversion of depths between 0 and 1.
pub(super) fn depth_code(
    bug: impl Fn(ChannelEncoding, f32) -> u32 + Send + Sync + 'static,
) -> Plant {
    plant(Hooks {
        depth_code: Some(Box::new(bug)),
        ..Hooks::default()
    })
}

/// The depth comparison of codes, incoming first.
pub(super) fn depth_passes(
    bug: impl Fn(CompareFunction, u32, u32) -> bool + Send + Sync + 'static,
) -> Plant {
    plant(Hooks {
        depth_passes: Some(Box::new(bug)),
        ..Hooks::default()
    })
}

/// Whether colour and depth are written, of whether a texel is covered and passes the stencil and
/// the depth test.
pub(super) fn written(bug: impl Fn([bool; 3]) -> [bool; 2] + Send + Sync + 'static) -> Plant {
    plant(Hooks {
        written: Some(Box::new(bug)),
        ..Hooks::default()
    })
}

/// Blending.
pub(super) fn blending(
    bug: impl Fn(&BlendState, [ChannelEncoding; 4], &BlendInput<[f32; 1]>) -> [f32; 4]
    + Send
    + Sync
    + 'static,
) -> Plant {
    plant(Hooks {
        blend: Some(Box::new(bug)),
        ..Hooks::default()
    })
}

/// The conversion of colours at the store.
pub(super) fn color_code(
    bug: impl Fn(ChannelEncoding, f32) -> u32 + Send + Sync + 'static,
) -> Plant {
    plant(Hooks {
        color_code: Some(Box::new(bug)),
        ..Hooks::default()
    })
}

/// The conversion of clear values, colour and depth.
pub(super) fn clear_code(
    bug: impl Fn(ChannelEncoding, f32) -> u32 + Send + Sync + 'static,
) -> Plant {
    plant(Hooks {
        clear_code: Some(Box::new(bug)),
        ..Hooks::default()
    })
}

/// The code that a value is rightly stored as.
pub(super) fn code(encoding: ChannelEncoding, value: f32) -> u32 {
    let [code] = Plain::<1>.encode(encoding, [value]);
    code
}

/// Blending as it should be.
pub(super) fn faithful_blend(
    state: &BlendState,
    encodings: [ChannelEncoding; 4],
    input: &BlendInput<[f32; 1]>,
) -> [f32; 4] {
    blend(&mut Plain::<1>, state, encodings, input).map(|[v]| v)
}

impl Steps for &Hooks {
    fn covered(&self, x: usize, y: usize, size: [u32; 2], mask: Mask) -> Mask {
        match &self.covered {
            None => mask,
            Some(bug) => std::array::from_fn(|i| mask[i] && bug([(x + i) as u32, y as u32], size)),
        }
    }

    fn fetch(&self, surface: &Surface, x: usize, y: usize) -> [Real; 4] {
        let Some(bug) = &self.fetch else {
            return Faithful.fetch(surface, x, y);
        };
        let size = [surface.width as u32, surface.height as u32];
        let from: [usize; LANES] = std::array::from_fn(|i| {
            let [x, y] = bug([(x + i) as u32, y as u32], size);
            let (x, y) = (x.min(size[0] - 1), y.min(size[1] - 1));
            y as usize * surface.stride + x as usize
        });
        std::array::from_fn(|c| match surface.encodings.get(c) {
            Some(encoding) => {
                let plane = surface.plane(c, 0);
                Plain::<LANES>.decode(*encoding, from.map(|at| plane[at]))
            }
            None => [if c == 3 { 1.0 } else { 0.0 }; LANES],
        })
    }

    fn stencil_passes(&self, face: &StencilFace, stored: u8) -> bool {
        match &self.stencil_passes {
            None => Faithful.stencil_passes(face, stored),
            Some(bug) => bug(face, stored),
        }
    }

    fn stencil_write(&self, face: &StencilFace, path: Path, stored: u8) -> u8 {
        match &self.stencil_write {
            None => Faithful.stencil_write(face, path, stored),
            Some(bug) => bug(face, path, stored),
        }
    }

    fn depth_codes(&self, encoding: ChannelEncoding, depth: Real) -> Codes {
        match &self.depth_code {
            None => Faithful.depth_codes(encoding, depth),
            Some(bug) => depth.map(|v| bug(encoding, v.clamp(0.0, 1.0))),
        }
    }

    fn depth_passes(&self, function: CompareFunction, incoming: u32, stored: u32) -> bool {
        match &self.depth_passes {
            None => Faithful.depth_passes(function, incoming, stored),
            Some(bug) => bug(function, incoming, stored),
        }
    }

    fn written(&self, tests: &Tests) -> Written {
        let Some(bug) = &self.written else {
            return Faithful.written(tests);
        };
        let both: [[bool; 2]; LANES] =
            std::array::from_fn(|i| bug([tests.covered[i], tests.stencil[i], tests.depth[i]]));
        Written {
            color: both.map(|[color, _]| color),
            depth: both.map(|[_, depth]| depth),
        }
    }

    fn blend(
        &self,
        state: &BlendState,
        encodings: [ChannelEncoding; 4],
        input: &BlendInput<Real>,
    ) -> [Real; 4] {
        let Some(bug) = &self.blend else {
            return Faithful.blend(state, encodings, input);
        };
        let mut result = [[0.0; LANES]; 4];
        for lane in 0..LANES {
            let one = BlendInput {
                src: input.src.map(|v| [v[lane]]),
                src1: input.src1.map(|v| [v[lane]]),
                dst: input.dst.map(|v| [v[lane]]),
                constant: input.constant.map(|v| [v[lane]]),
            };
            for (c, value) in bug(state, encodings, &one).into_iter().enumerate() {
                result[c][lane] = value;
            }
        }
        result
    }

    fn color_codes(&self, encoding: ChannelEncoding, value: Real) -> Codes {
        match &self.color_code {
            None => Faithful.color_codes(encoding, value),
            Some(bug) => value.map(|v| bug(encoding, v)),
        }
    }

    fn clear_code(&self, encoding: ChannelEncoding, value: f32) -> u32 {
        match &self.clear_code {
            None => Faithful.clear_code(encoding, value),
            Some(bug) => bug(encoding, value),
        }
    }
}
