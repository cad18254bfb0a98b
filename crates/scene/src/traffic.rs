//! The bytes that a scene moves and the operations that it computes, counted from its states.
//!
//! The count is of the states, not of an implementation: every covered sample passes its tests, and nothing stays in
//! a cache or a register between two fragments.

use crate::attachment::Attachment;
use crate::blend::{BlendComponent, BlendFactor, BlendOperation, ColorTarget};
use crate::depth_stencil::{CompareFunction, StencilFace, StencilOperation};
use crate::draw::Draw;
use crate::pass::Pass;
use etalon_frame::{Aspect, TextureFormat};
use std::iter::Sum;
use std::ops::{Add, Mul};

/// Bytes read and written, and arithmetic operations: products, sums, comparisons, and conversions between codes
/// and values, each of one channel.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Traffic {
    pub(crate) bytes: u64,
    pub(crate) operations: u64,
}

impl Add for Traffic {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        Self {
            bytes: self.bytes + other.bytes,
            operations: self.operations + other.operations,
        }
    }
}

impl Sum for Traffic {
    fn sum<I: Iterator<Item = Self>>(iter: I) -> Self {
        iter.fold(Self::default(), Add::add)
    }
}

impl Mul<u64> for Traffic {
    type Output = Self;

    fn mul(self, count: u64) -> Self {
        Self {
            bytes: self.bytes * count,
            operations: self.operations * count,
        }
    }
}

/// Returns the traffic of one texel that a draw covers. Shaders count only for the texels that they fetch.
pub(crate) fn covered(attachments: &[Attachment], pass: &Pass, draw: &Draw) -> Traffic {
    let format = |index: usize| attachments[index].format;
    let fetched = draw.textures.iter().map(|index| Traffic {
        bytes: u64::from(format(*index).texel_bytes()),
        operations: 0,
    });
    let colors = pass.color.iter().zip(&draw.targets);
    let colors = colors.map(|(index, target)| color(format(*index), target, draw.logic.is_some()));
    let tests = pass
        .depth_stencil
        .map(|index| tests(format(index), draw))
        .into_iter();
    let drawn = pass.color.first().copied().or(pass.depth_stencil);
    let samples = drawn.map_or(1, |index| u64::from(attachments[index].samples));
    colors.chain(tests).sum::<Traffic>() * samples + fetched.sum()
}

/// Returns the traffic of clearing an aspect of one texel.
pub(crate) fn cleared(attachment: &Attachment, aspect: Aspect) -> Traffic {
    Traffic {
        bytes: aspect_bytes(attachment.format, aspect) * u64::from(attachment.samples),
        operations: 0,
    }
}

/// Returns the traffic of resolving one texel: its samples are converted, added and scaled.
pub(crate) fn resolved(format: TextureFormat, samples: u64) -> Traffic {
    let channels = format.color_channels().len().max(1) as u64;
    Traffic {
        bytes: u64::from(format.texel_bytes()) * (samples + 1),
        operations: channels * (2 * samples + 1),
    }
}

/// Returns the traffic of reading one texel back: it is copied.
pub(crate) fn read_back(attachment: &Attachment) -> Traffic {
    let bytes = attachment.format.texel_bytes() * attachment.samples;
    Traffic {
        bytes: 2 * u64::from(bytes),
        operations: 0,
    }
}

/// Returns the bytes of one aspect of a texel.
fn aspect_bytes(format: TextureFormat, aspect: Aspect) -> u64 {
    match aspect {
        Aspect::Color => u64::from(format.texel_bytes()),
        Aspect::Depth if format == TextureFormat::Depth16Unorm => 2,
        Aspect::Depth => 4,
        Aspect::Stencil => 1,
    }
}

/// Returns the traffic of storing one sample of a colour attachment.
fn color(format: TextureFormat, target: &ColorTarget, logic: bool) -> Traffic {
    let channels = format.color_channels().len();
    let written = |c: &usize| target.write_mask & (1 << c) != 0;
    let count = (0..channels).filter(written).count();
    if count == 0 {
        return Traffic::default();
    }
    let reads = logic || target.blends() || count < channels;
    let blended = |c: usize| match target.blend.filter(|_| !logic) {
        Some(blend) => 1 + products_and_sums(if c == 3 { blend.alpha } else { blend.color }),
        None => u64::from(logic),
    };
    Traffic {
        bytes: u64::from(format.texel_bytes()) * if reads { 2 } else { 1 },
        operations: (0..channels).filter(written).map(|c| 1 + blended(c)).sum(),
    }
}

/// Returns the operations of a blend equation in one channel.
fn products_and_sums(part: BlendComponent) -> u64 {
    if matches!(part.operation, BlendOperation::Min | BlendOperation::Max) {
        return 1;
    }
    let multiplies = |f: &BlendFactor| !matches!(f, BlendFactor::Zero | BlendFactor::One);
    let factors = [part.src_factor, part.dst_factor];
    1 + factors.iter().filter(|f| multiplies(f)).count() as u64
}

/// Returns the traffic of the depth and stencil tests of one sample.
fn tests(format: TextureFormat, draw: &Draw) -> Traffic {
    let depth = draw.depth.filter(|_| format.has_depth()).map(|state| {
        let compares = !matches!(
            state.compare,
            CompareFunction::Always | CompareFunction::Never
        );
        let accesses = u64::from(compares) + u64::from(state.write);
        Traffic {
            bytes: accesses * aspect_bytes(format, Aspect::Depth),
            operations: 1 + u64::from(compares),
        }
    });
    let stencil = draw.stencil.filter(|_| format.has_stencil()).map(|state| {
        let keeps = |face: &StencilFace| {
            [face.fail_op, face.depth_fail_op, face.pass_op] == [StencilOperation::Keep; 3]
        };
        let writes = u64::from(!(keeps(&state.front) && keeps(&state.back)));
        Traffic {
            bytes: 1 + writes,
            operations: 1 + writes,
        }
    });
    depth.into_iter().chain(stencil).sum()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::blend::BlendState;
    use crate::depth_stencil::DepthState;
    use crate::mesh_source::{MeshSource, Splat};
    use crate::rasterization::Viewport;
    use crate::shader::Shader;

    #[test]
    fn a_blend_reads_what_it_writes() {
        let part = BlendComponent {
            operation: BlendOperation::Add,
            src_factor: BlendFactor::SrcAlpha,
            dst_factor: BlendFactor::One,
        };
        let blend = Some(BlendState {
            color: part,
            alpha: part,
        });
        let plain = ColorTarget::default();
        let format = TextureFormat::Rgba8Unorm;
        let traffic = |bytes, operations| Traffic { bytes, operations };
        assert_eq!(color(format, &plain, false), traffic(4, 4));
        // A conversion each way, a product and a sum in each channel.
        let over = ColorTarget { blend, ..plain };
        assert_eq!(color(format, &over, false), traffic(8, 16));
        assert_eq!(color(format, &plain, true), traffic(8, 8));
        let masked = ColorTarget {
            write_mask: 0b0001,
            ..plain
        };
        assert_eq!(color(format, &masked, false), traffic(8, 1));
        let nothing = ColorTarget {
            write_mask: 0,
            ..plain
        };
        assert_eq!(color(format, &nothing, false), Traffic::default());
    }

    #[test]
    fn a_depth_test_reads_and_may_write() {
        let size = [4, 4];
        let mesh = MeshSource::Stack {
            z: vec![0.5],
            values: vec![Splat::default()],
        };
        let mesh = mesh.expand(size).expect("it expands");
        let mut draw = Draw::new(Shader::FlatColor, mesh, Viewport::whole(size));
        let traffic = |bytes, operations| Traffic { bytes, operations };
        for (compare, write, expected) in [
            (CompareFunction::Less, false, traffic(4, 2)),
            (CompareFunction::Less, true, traffic(8, 2)),
            (CompareFunction::Always, true, traffic(4, 1)),
        ] {
            draw.depth = Some(DepthState { compare, write });
            assert_eq!(tests(TextureFormat::Depth32Float, &draw), expected);
        }
    }
}
