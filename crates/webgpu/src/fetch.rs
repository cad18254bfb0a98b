//! Pipelines that render an attachment into a texture that can be copied.

use crate::binding::texture;
use crate::calls::{LayoutEntry, SampleType};
use crate::format::GpuFormat;
use crate::pipeline_state::{
    DepthBiasState, DepthStencil, PipelineState, PipelineTarget, Primitive,
};
use crate::tables::Lowering;
use etalon_frame::{Requirement, TextureFormat};
use etalon_scene::{
    CompareFunction, CullMode, FrontFace, PrimitiveTopology, StencilFace, StencilOperation,
    StencilState,
};

/// The WGSL of all fetches.
const WGSL: &str = include_str!("fetch.wgsl");

/// The source and target of a fetch.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum FetchKey {
    /// Depth as the bits of a float, into `r32uint`.
    Depth,
    /// A colour as the bits of floats, into `rgba32uint`.
    Texel,
    /// An integer colour, into `rgba32uint`.
    IntegerTexel,
    /// One sample of colour or depth as the bits of floats, into `rgba32uint`.
    Sample,
    /// One sample of stencil, into the red channel of `rgba32uint`.
    StencilSample,
    /// One bit of stencil as 0 or 1, into one channel of `rgba8unorm`. Bits 0 to 3, or 4 to 7, go to red,
    /// green, blue and alpha.
    StencilBit {
        /// The attachment's format.
        format: TextureFormat,
        /// The index of the bit.
        bit: u8,
    },
}

impl FetchKey {
    /// Returns the format that it renders to.
    pub(crate) fn target(self) -> Result<GpuFormat, Requirement> {
        match self {
            Self::Depth => Ok(GpuFormat::R32Uint),
            Self::StencilBit { .. } => GpuFormat::of(TextureFormat::Rgba8Unorm),
            Self::Texel | Self::IntegerTexel | Self::Sample | Self::StencilSample => {
                Ok(GpuFormat::Rgba32Uint)
            }
        }
    }

    /// Returns the binding of the texture that it reads.
    pub(crate) fn entries(self) -> Vec<LayoutEntry> {
        let (sample_type, multisampled) = match self {
            Self::Depth | Self::Texel => (SampleType::UnfilterableFloat, false),
            Self::IntegerTexel => (SampleType::Uint, false),
            Self::Sample => (SampleType::UnfilterableFloat, true),
            Self::StencilSample => (SampleType::Uint, true),
            Self::StencilBit { .. } => return Vec::new(),
        };
        vec![LayoutEntry {
            binding: 1,
            resource: texture(sample_type, multisampled),
        }]
    }

    /// Returns the names of the vertex and the fragment entry point.
    fn entry_points(self) -> [&'static str; 2] {
        match self {
            Self::Depth => ["everywhere", "depth"],
            Self::Texel => ["everywhere", "texel"],
            Self::IntegerTexel => ["everywhere", "integer_texel"],
            Self::Sample => ["sampled", "floats"],
            Self::StencilSample => ["sampled", "integers"],
            Self::StencilBit { .. } => ["everywhere", "one"],
        }
    }
}

/// Returns the pipeline of a fetch.
pub(crate) fn pipeline(lowering: &mut Lowering<'_>, key: FetchKey) -> Result<usize, Requirement> {
    let shader = lowering.shader("fetch", WGSL.into());
    let entries = key.entries();
    let layout = (!entries.is_empty()).then(|| lowering.layout(entries));
    let (write_mask, depth_stencil) = match key {
        FetchKey::StencilBit { format, bit } => (1 << (bit % 4), Some(stencil_bit(format, bit)?)),
        _ => (0xf, None),
    };
    let [vertex, fragment] = key.entry_points();
    let state = PipelineState {
        label: "fetch".into(),
        vertex: vertex.into(),
        fragment: Some(fragment.into()),
        buffers: Vec::new(),
        primitive: Primitive {
            topology: PrimitiveTopology::TriangleList,
            strip_index: None,
            front_face: FrontFace::Ccw,
            cull: CullMode::None,
            unclipped_depth: false,
        },
        depth_stencil,
        samples: 1,
        mask: u32::MAX,
        alpha_to_coverage: false,
        targets: vec![Some(PipelineTarget {
            format: key.target()?,
            blend: None,
            write_mask,
        })],
    };
    Ok(lowering.pipeline(shader, layout, state))
}

/// Returns a stencil test that passes if the bit is set, and writes nothing. The pass sets the reference to
/// 0xff.
fn stencil_bit(format: TextureFormat, bit: u8) -> Result<DepthStencil, Requirement> {
    let face = StencilFace {
        compare: CompareFunction::Equal,
        fail_op: StencilOperation::Keep,
        depth_fail_op: StencilOperation::Keep,
        pass_op: StencilOperation::Keep,
        reference: 0,
        read_mask: 1 << bit,
        write_mask: 0,
    };
    Ok(DepthStencil {
        format: GpuFormat::of(format)?,
        depth_write: format.has_depth().then_some(false),
        depth_compare: CompareFunction::Always,
        stencil: Some(StencilState {
            front: face,
            back: face,
        }),
        bias: DepthBiasState::default(),
    })
}
