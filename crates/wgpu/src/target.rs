//! Textures with their views. Views for fetches are created on first use: few scenes need them.

use crate::path::Shape;
use std::cell::OnceCell;

/// A texture with its views.
pub(crate) struct Target {
    pub(crate) texture: wgpu::Texture,
    /// The part of the texture that is meant.
    shape: Shape,
    /// The view of all aspects, for passes.
    pub(crate) view: wgpu::TextureView,
    /// The view of colour or depth, for fetches.
    fetch: OnceCell<wgpu::TextureView>,
    /// The view of stencil, for fetches.
    stencil: OnceCell<wgpu::TextureView>,
}

impl Target {
    pub(crate) fn new(texture: wgpu::Texture, shape: Shape) -> Self {
        Self {
            view: texture.create_view(&part(shape)),
            texture,
            shape,
            fetch: OnceCell::new(),
            stencil: OnceCell::new(),
        }
    }

    /// Returns the view of colour or depth, for fetches.
    pub(crate) fn fetch(&self) -> &wgpu::TextureView {
        self.fetch.get_or_init(|| {
            let depth = self.texture.format().has_depth_aspect();
            self.seen(if depth {
                wgpu::TextureAspect::DepthOnly
            } else {
                wgpu::TextureAspect::All
            })
        })
    }

    /// Returns the view of stencil, for fetches.
    pub(crate) fn stencil(&self) -> &wgpu::TextureView {
        let aspect = wgpu::TextureAspect::StencilOnly;
        self.stencil.get_or_init(|| self.seen(aspect))
    }

    fn seen(&self, aspect: wgpu::TextureAspect) -> wgpu::TextureView {
        // The samples of an sRGB texture are fetched without conversion, as codes.
        let format = self.texture.format();
        let cast = self.texture.sample_count() > 1 && format.is_srgb();
        self.texture.create_view(&wgpu::TextureViewDescriptor {
            aspect,
            format: cast.then(|| format.remove_srgb_suffix()),
            ..part(self.shape)
        })
    }

    /// Returns the slice of a three-dimensional texture that passes draw to.
    pub(crate) fn slice(&self) -> Option<u32> {
        self.shape.slice()
    }

    /// Returns the part for copies, from texels on.
    pub(crate) fn copied(
        &self,
        aspect: wgpu::TextureAspect,
        [x, y]: [u32; 2],
    ) -> wgpu::TexelCopyTextureInfo<'_> {
        wgpu::TexelCopyTextureInfo {
            texture: &self.texture,
            mip_level: self.shape.level,
            origin: wgpu::Origin3d {
                x,
                y,
                z: self.shape.layer,
            },
            aspect,
        }
    }
}

/// Returns the view of a part: of three dimensions there is none but the whole.
fn part(shape: Shape) -> wgpu::TextureViewDescriptor<'static> {
    match shape.dimension {
        wgpu::TextureDimension::D2 => wgpu::TextureViewDescriptor {
            dimension: Some(wgpu::TextureViewDimension::D2),
            base_mip_level: shape.level,
            mip_level_count: Some(1),
            base_array_layer: shape.layer,
            array_layer_count: Some(1),
            ..wgpu::TextureViewDescriptor::default()
        },
        _ => wgpu::TextureViewDescriptor::default(),
    }
}
