//! Textures with their views. Views for fetches are created on first use: few scenes need them.

use std::cell::OnceCell;

/// A texture with its views.
pub(crate) struct Target {
    pub(crate) texture: wgpu::Texture,
    /// The view of all aspects, for passes.
    pub(crate) view: wgpu::TextureView,
    /// The view of colour or depth, for fetches.
    fetch: OnceCell<wgpu::TextureView>,
    /// The view of stencil, for fetches.
    stencil: OnceCell<wgpu::TextureView>,
}

impl Target {
    pub(crate) fn new(texture: wgpu::Texture) -> Self {
        Self {
            view: texture.create_view(&wgpu::TextureViewDescriptor::default()),
            texture,
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
            ..wgpu::TextureViewDescriptor::default()
        })
    }
}
