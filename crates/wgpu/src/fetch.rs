//! Pipelines that render an attachment into a texture that can be copied.

use crate::error::Errors;
use crate::layout::Layouts;
use crate::state;
use etalon_backend::BackendError;
use etalon_frame::TextureFormat;

/// The WGSL of all fetches.
pub(crate) const WGSL: &str = include_str!("fetch.wgsl");

/// The source and target of a fetch.
#[derive(Clone, Copy, PartialEq, Eq, Hash)]
pub(crate) enum FetchKey {
    /// Depth, as the bits of a float, into `r32uint`.
    Depth,
    /// A colour, as the bits of floats, into `rgba32uint`.
    Texel,
    /// A colour of integers into `rgba32uint`.
    IntegerTexel,
    /// One sample of colour or depth, as the bits of floats, into `rgba32uint`.
    Sample,
    /// One sample of stencil into the red channel of `rgba32uint`.
    StencilSample,
    /// One bit of stencil, as 0 or 1, into one channel of `rgba8unorm`: bits 0 to 3, or 4 to 7,
    /// into red to alpha.
    StencilBit {
        /// The attachment's format.
        format: TextureFormat,
        /// The index of the bit.
        bit: u8,
    },
}

pub(crate) fn pipeline(
    device: &wgpu::Device,
    errors: &Errors,
    layouts: &Layouts,
    module: &wgpu::ShaderModule,
    key: FetchKey,
) -> Result<wgpu::RenderPipeline, BackendError> {
    let writes = wgpu::ColorWrites::ALL;
    let (layout, vertex, entry, color, write_mask, depth_stencil) = match key {
        FetchKey::Depth => {
            let color = wgpu::TextureFormat::R32Uint;
            (&layouts.texture, "everywhere", "depth", color, writes, None)
        }
        FetchKey::Texel => {
            let color = wgpu::TextureFormat::Rgba32Uint;
            (&layouts.texture, "everywhere", "texel", color, writes, None)
        }
        FetchKey::IntegerTexel => {
            let (layout, color) = (&layouts.integer_texture, wgpu::TextureFormat::Rgba32Uint);
            (layout, "everywhere", "integer_texel", color, writes, None)
        }
        FetchKey::Sample => {
            let color = wgpu::TextureFormat::Rgba32Uint;
            (&layouts.samples, "sampled", "floats", color, writes, None)
        }
        FetchKey::StencilSample => {
            let color = wgpu::TextureFormat::Rgba32Uint;
            (
                &layouts.integers,
                "sampled",
                "integers",
                color,
                writes,
                None,
            )
        }
        FetchKey::StencilBit { format, bit } => (
            &layouts.none,
            "everywhere",
            "one",
            wgpu::TextureFormat::Rgba8Unorm,
            wgpu::ColorWrites::from_bits_truncate(1 << (bit % 4)),
            Some(stencil_bit(format, bit)?),
        ),
    };
    let pipeline = device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: Some(entry),
        layout: Some(&layout.pipeline),
        vertex: wgpu::VertexState {
            module,
            entry_point: Some(vertex),
            compilation_options: wgpu::PipelineCompilationOptions::default(),
            buffers: &[],
        },
        primitive: wgpu::PrimitiveState::default(),
        depth_stencil,
        multisample: wgpu::MultisampleState::default(),
        fragment: Some(wgpu::FragmentState {
            module,
            entry_point: Some(entry),
            compilation_options: wgpu::PipelineCompilationOptions::default(),
            targets: &[Some(wgpu::ColorTargetState {
                format: color,
                blend: None,
                write_mask,
            })],
        }),
        multiview_mask: None,
        cache: None,
    });
    errors.check_pipeline("fetch")?;
    Ok(pipeline)
}

/// Returns a stencil test that passes if a bit is set and writes nothing.
fn stencil_bit(format: TextureFormat, bit: u8) -> Result<wgpu::DepthStencilState, BackendError> {
    let face = wgpu::StencilFaceState {
        compare: wgpu::CompareFunction::Equal,
        ..wgpu::StencilFaceState::default()
    };
    let bias = wgpu::DepthBiasState::default();
    Ok(wgpu::DepthStencilState {
        stencil: wgpu::StencilState {
            front: face,
            back: face,
            read_mask: 1 << bit,
            write_mask: 0,
        },
        ..state::depth_stencil(format, None, None, bias)?
    })
}
