//! WebGPU's texture formats.

use etalon_backend::BackendError;
use etalon_frame::{Requirement, TextureFormat};
use etalon_webgpu::GpuFormat;

/// Returns WebGPU's format, if it has one.
pub(crate) fn texture(format: TextureFormat) -> Option<wgpu::TextureFormat> {
    Some(match format {
        TextureFormat::R8Unorm => wgpu::TextureFormat::R8Unorm,
        TextureFormat::Rg8Unorm => wgpu::TextureFormat::Rg8Unorm,
        TextureFormat::R16Unorm => wgpu::TextureFormat::R16Unorm,
        TextureFormat::Rg16Unorm => wgpu::TextureFormat::Rg16Unorm,
        TextureFormat::Rgba16Unorm => wgpu::TextureFormat::Rgba16Unorm,
        TextureFormat::Rgba8Unorm => wgpu::TextureFormat::Rgba8Unorm,
        TextureFormat::Rgba8UnormSrgb => wgpu::TextureFormat::Rgba8UnormSrgb,
        TextureFormat::Bgra8Unorm => wgpu::TextureFormat::Bgra8Unorm,
        TextureFormat::Bgra8UnormSrgb => wgpu::TextureFormat::Bgra8UnormSrgb,
        TextureFormat::R8Snorm => wgpu::TextureFormat::R8Snorm,
        TextureFormat::Rg8Snorm => wgpu::TextureFormat::Rg8Snorm,
        TextureFormat::Rgba8Snorm => wgpu::TextureFormat::Rgba8Snorm,
        TextureFormat::Rgb10a2Unorm => wgpu::TextureFormat::Rgb10a2Unorm,
        TextureFormat::B5g6r5Unorm | TextureFormat::Bgr5a1Unorm | TextureFormat::Bgra4Unorm => {
            return None;
        }
        TextureFormat::Rg11b10Ufloat => wgpu::TextureFormat::Rg11b10Ufloat,
        TextureFormat::R8Uint => wgpu::TextureFormat::R8Uint,
        TextureFormat::Rgb10a2Uint => wgpu::TextureFormat::Rgb10a2Uint,
        TextureFormat::R16Uint => wgpu::TextureFormat::R16Uint,
        TextureFormat::Rg16Uint => wgpu::TextureFormat::Rg16Uint,
        TextureFormat::Rgba16Uint => wgpu::TextureFormat::Rgba16Uint,
        TextureFormat::R16Float => wgpu::TextureFormat::R16Float,
        TextureFormat::Rg16Float => wgpu::TextureFormat::Rg16Float,
        TextureFormat::R32Float => wgpu::TextureFormat::R32Float,
        TextureFormat::Rg32Float => wgpu::TextureFormat::Rg32Float,
        TextureFormat::Rgba8Uint => wgpu::TextureFormat::Rgba8Uint,
        TextureFormat::Rgba16Float => wgpu::TextureFormat::Rgba16Float,
        TextureFormat::Rgba32Float => wgpu::TextureFormat::Rgba32Float,
        TextureFormat::Depth16Unorm => wgpu::TextureFormat::Depth16Unorm,
        TextureFormat::Depth24Plus => wgpu::TextureFormat::Depth24Plus,
        TextureFormat::Depth24PlusStencil8 => wgpu::TextureFormat::Depth24PlusStencil8,
        TextureFormat::Depth32Float => wgpu::TextureFormat::Depth32Float,
        TextureFormat::Depth32FloatStencil8 => wgpu::TextureFormat::Depth32FloatStencil8,
        TextureFormat::Stencil8 => wgpu::TextureFormat::Stencil8,
    })
}

/// Returns the format of a texture.
pub(crate) fn known(format: GpuFormat) -> Result<wgpu::TextureFormat, BackendError> {
    match format {
        GpuFormat::R32Uint => Ok(wgpu::TextureFormat::R32Uint),
        GpuFormat::Rgba32Uint => Ok(wgpu::TextureFormat::Rgba32Uint),
        GpuFormat::Attachment(format) => {
            texture(format).ok_or(BackendError::NotSupported(Requirement::Format(format)))
        }
    }
}
