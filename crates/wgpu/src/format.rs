//! WebGPU's texture formats.

use etalon_backend::BackendError;
use etalon_frame::{Requirement, TextureFormat};
use etalon_webgpu::GpuFormat;

/// Returns WebGPU's format, if it has one.
pub(crate) fn texture(format: TextureFormat) -> Option<wgpu::TextureFormat> {
    Some(match format {
        TextureFormat::R8Unorm => wgpu::TextureFormat::R8Unorm,
        TextureFormat::Rg8Unorm => wgpu::TextureFormat::Rg8Unorm,
        TextureFormat::Rgba8Unorm => wgpu::TextureFormat::Rgba8Unorm,
        TextureFormat::Rgba8UnormSrgb => wgpu::TextureFormat::Rgba8UnormSrgb,
        TextureFormat::Bgra8Unorm => wgpu::TextureFormat::Bgra8Unorm,
        TextureFormat::Rgba8Snorm => wgpu::TextureFormat::Rgba8Snorm,
        TextureFormat::Rgb10a2Unorm => wgpu::TextureFormat::Rgb10a2Unorm,
        TextureFormat::B5g6r5Unorm | TextureFormat::Bgr5a1Unorm | TextureFormat::Bgra4Unorm => {
            return None;
        }
        TextureFormat::Rg11b10Ufloat => wgpu::TextureFormat::Rg11b10Ufloat,
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
        GpuFormat::Bgra8UnormSrgb => Ok(wgpu::TextureFormat::Bgra8UnormSrgb),
        GpuFormat::Attachment(format) => {
            texture(format).ok_or(BackendError::NotSupported(Requirement::Format(format)))
        }
    }
}
