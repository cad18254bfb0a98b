//! Images with their memory and views.

use crate::device::Device;
use crate::error::Check;
use crate::format;
use crate::state;
use ash::vk;
use etalon_backend::BackendError;
use etalon_frame::PathTarget;

/// The properties that interchangeable images share.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct ImageKey {
    /// The format of views.
    pub(crate) format: vk::Format,
    /// The format of the image.
    pub(crate) stored: vk::Format,
    pub(crate) size: [u32; 2],
    pub(crate) samples: u32,
    pub(crate) usage: vk::ImageUsageFlags,
    /// The level, layer or slice that is used.
    pub(crate) target: PathTarget,
    /// The layer that is read, out of three, if passes have several layers.
    pub(crate) layered: Option<u32>,
}

/// The level, layer and slice of an image that a scene uses.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct ImagePlace {
    level: u32,
    layer: u32,
    slice: u32,
    /// True if passes draw to all layers.
    layered: bool,
}

/// The number of layers of an image if passes have several.
pub(crate) const LAYERS: u32 = 3;
/// The layers that passes draw to; one of them is read.
pub(crate) const DRAWN_LAYERS: [u32; 2] = [1, 2];

/// The dimensions of an image around the part that is used.
pub(crate) struct ImageShape {
    pub(crate) kind: vk::ImageType,
    pub(crate) extent: vk::Extent3D,
    pub(crate) levels: u32,
    pub(crate) layers: u32,
    pub(crate) flags: vk::ImageCreateFlags,
    pub(crate) place: ImagePlace,
}

impl ImageKey {
    /// Returns the dimensions. The used part is never the first level, layer or slice, except for plain
    /// targets.
    pub(crate) fn shape(&self) -> ImageShape {
        let [width, height] = self.size;
        let mut shape = ImageShape {
            kind: vk::ImageType::TYPE_2D,
            extent: vk::Extent3D {
                width,
                height,
                depth: 1,
            },
            levels: 1,
            layers: 1,
            flags: vk::ImageCreateFlags::empty(),
            place: ImagePlace::default(),
        };
        if let Some(layer) = self.layered {
            shape.layers = LAYERS;
            (shape.place.layer, shape.place.layered) = (layer, true);
            return shape;
        }
        match self.target {
            PathTarget::Plain | PathTarget::Renderbuffer => {}
            PathTarget::MipLevel => {
                // Odd sizes: each level's size is rounded down.
                shape.extent.width = 2 * width + 1;
                shape.extent.height = 2 * height + 1;
                shape.levels = 2;
                shape.place.level = 1;
            }
            PathTarget::LevelOfLayer => {
                shape.extent.width = 2 * width + 1;
                shape.extent.height = 2 * height + 1;
                shape.levels = 2;
                shape.layers = 3;
                (shape.place.level, shape.place.layer) = (1, 2);
            }
            PathTarget::ArrayLayer => {
                shape.layers = 3;
                shape.place.layer = 2;
            }
            PathTarget::CubeFace => {
                shape.layers = 6;
                shape.flags = vk::ImageCreateFlags::CUBE_COMPATIBLE;
                shape.place.layer = 4;
            }
            PathTarget::Slice3d => {
                shape.kind = vk::ImageType::TYPE_3D;
                shape.extent.depth = 4;
                shape.flags = vk::ImageCreateFlags::TYPE_2D_ARRAY_COMPATIBLE;
                shape.place.slice = 3;
            }
        }
        shape
    }
}

impl ImagePlace {
    /// Returns the range for barriers: all slices of its level and layer, or all layers.
    pub(crate) fn range(self, mask: vk::ImageAspectFlags) -> vk::ImageSubresourceRange {
        vk::ImageSubresourceRange {
            aspect_mask: mask,
            base_mip_level: self.level,
            level_count: 1,
            base_array_layer: if self.layered { 0 } else { self.layer },
            layer_count: self.layer_count(),
        }
    }

    /// Returns the ranges for clears. Several layers give two ranges: the first layer, and the others.
    pub(crate) fn cleared(self, mask: vk::ImageAspectFlags) -> Vec<vk::ImageSubresourceRange> {
        let range = self.range(mask);
        if self.layered {
            let layers = |base_array_layer, layer_count| vk::ImageSubresourceRange {
                base_array_layer,
                layer_count,
                ..range
            };
            vec![layers(0, 1), layers(1, LAYERS - 1)]
        } else {
            vec![range]
        }
    }

    /// Returns the destinations of uploaded texels: one for each layer that passes draw to.
    pub(crate) fn uploaded(self) -> Vec<Self> {
        if self.layered {
            DRAWN_LAYERS
                .into_iter()
                .map(|layer| Self { layer, ..self })
                .collect()
        } else {
            vec![self]
        }
    }

    /// Returns the range for views, in which slices are layers.
    fn viewed(self, mask: vk::ImageAspectFlags) -> vk::ImageSubresourceRange {
        vk::ImageSubresourceRange {
            base_array_layer: self.layer + self.slice,
            layer_count: 1,
            ..self.range(mask)
        }
    }

    /// Returns the number of layers that passes draw to.
    pub(crate) fn layer_count(self) -> u32 {
        if self.layered { LAYERS } else { 1 }
    }

    /// Returns the layers for copies.
    pub(crate) fn layers(self, mask: vk::ImageAspectFlags) -> vk::ImageSubresourceLayers {
        vk::ImageSubresourceLayers {
            aspect_mask: mask,
            mip_level: self.level,
            base_array_layer: self.layer,
            layer_count: 1,
        }
    }

    /// Returns the offset of a texel in copies.
    pub(crate) fn offset(self, x: u32, y: u32) -> vk::Offset3D {
        vk::Offset3D {
            x: x.cast_signed(),
            y: y.cast_signed(),
            z: self.slice.cast_signed(),
        }
    }
}

/// An image with its own memory.
#[derive(Debug)]
pub(crate) struct DeviceImage {
    pub(crate) key: ImageKey,
    pub(crate) raw: vk::Image,
    memory: vk::DeviceMemory,
    pub(crate) bytes: u64,
    /// A view of all aspects, and one per aspect for depth-stencil images that shaders read.
    views: Vec<(vk::ImageAspectFlags, vk::ImageView)>,
    /// A view without sRGB conversion, for a multisampled sRGB image that shaders read.
    unconverted: Option<vk::ImageView>,
    /// A view of all layers, if passes have several.
    layers: Option<vk::ImageView>,
}

impl DeviceImage {
    pub(crate) fn new(device: &Device, key: ImageKey) -> Result<Self, BackendError> {
        let mut image = Self {
            key,
            raw: vk::Image::null(),
            memory: vk::DeviceMemory::null(),
            bytes: 0,
            views: Vec::new(),
            unconverted: None,
            layers: None,
        };
        let created = image.create(device);
        if let Err(error) = created {
            image.destroy(device);
            return Err(error);
        }
        Ok(image)
    }

    fn create(&mut self, device: &Device) -> Result<(), BackendError> {
        let key = self.key;
        let read_by_sample = key.samples > 1 && key.usage.contains(vk::ImageUsageFlags::SAMPLED);
        let unconverted = format::unconverted(key.format).filter(|_| read_by_sample);
        // The list of formats lets the driver keep the memory layout of an image with a mutable format.
        let mut formats = vec![key.stored];
        let others = [key.format, unconverted.unwrap_or(key.format)];
        formats.extend(others.into_iter().filter(|format| *format != key.stored));
        formats.dedup();
        let mut list = vk::ImageFormatListCreateInfo::default().view_formats(&formats);
        let shape = key.shape();
        let mut info = vk::ImageCreateInfo::default()
            .flags(shape.flags)
            .image_type(shape.kind)
            .format(key.stored)
            .extent(shape.extent)
            .mip_levels(shape.levels)
            .array_layers(shape.layers)
            .samples(state::samples(key.samples))
            .tiling(vk::ImageTiling::OPTIMAL)
            .usage(key.usage);
        if formats.len() > 1 {
            info = info
                .flags(shape.flags | vk::ImageCreateFlags::MUTABLE_FORMAT)
                .push_next(&mut list);
        }
        // SAFETY: the device is alive, and it supports the format.
        self.raw = unsafe { device.raw.create_image(&info, None) }.check("an image")?;
        // SAFETY: the image was just made.
        let needs = unsafe { device.raw.get_image_memory_requirements(self.raw) };
        self.bytes = needs.size;
        let preferences = [
            vk::MemoryPropertyFlags::DEVICE_LOCAL,
            vk::MemoryPropertyFlags::empty(),
        ];
        self.memory = device.allocate(needs, &preferences, "image memory")?;
        // SAFETY: image and memory are new, and the memory type allows the image.
        unsafe { device.raw.bind_image_memory(self.raw, self.memory, 0) }.check("image memory")?;

        let viewed = vk::ImageUsageFlags::COLOR_ATTACHMENT
            | vk::ImageUsageFlags::DEPTH_STENCIL_ATTACHMENT
            | vk::ImageUsageFlags::SAMPLED;
        if !key.usage.intersects(viewed) {
            return Ok(());
        }
        let aspects = format::aspect_mask(key.format);
        let mut masks = vec![aspects];
        let both = vk::ImageAspectFlags::DEPTH | vk::ImageAspectFlags::STENCIL;
        let read = vk::ImageUsageFlags::SAMPLED | vk::ImageUsageFlags::INPUT_ATTACHMENT;
        if aspects == both && key.usage.intersects(read) {
            masks.extend([vk::ImageAspectFlags::DEPTH, vk::ImageAspectFlags::STENCIL]);
        }
        let kind = vk::ImageViewType::TYPE_2D;
        for mask in masks {
            let range = self.place().viewed(mask);
            let view = self.create_view(device, key.format, kind, range)?;
            self.views.push((mask, view));
        }
        if let Some(format) = unconverted {
            let range = self.place().viewed(aspects);
            self.unconverted = Some(self.create_view(device, format, kind, range)?);
        }
        if key.layered.is_some() {
            let (kind, range) = (
                vk::ImageViewType::TYPE_2D_ARRAY,
                self.place().range(aspects),
            );
            self.layers = Some(self.create_view(device, key.format, kind, range)?);
        }
        Ok(())
    }

    fn create_view(
        &self,
        device: &Device,
        format: vk::Format,
        kind: vk::ImageViewType,
        range: vk::ImageSubresourceRange,
    ) -> Result<vk::ImageView, BackendError> {
        let info = vk::ImageViewCreateInfo::default()
            .image(self.raw)
            .view_type(kind)
            .format(format)
            .subresource_range(range);
        // SAFETY: the image is bound, lives as long as its views, and was made for this format.
        unsafe { device.raw.create_image_view(&info, None) }.check("an image view")
    }

    /// Returns the view through which a shader reads the samples of one aspect.
    pub(crate) fn sample_view(
        &self,
        mask: vk::ImageAspectFlags,
    ) -> Result<vk::ImageView, BackendError> {
        self.unconverted.map_or_else(|| self.view(mask), Ok)
    }

    /// Returns the view of exactly these aspects.
    pub(crate) fn view(&self, mask: vk::ImageAspectFlags) -> Result<vk::ImageView, BackendError> {
        let found = self.views.iter().find(|(aspects, _)| *aspects == mask);
        found
            .map(|(_, view)| *view)
            .ok_or_else(|| BackendError::internal_of("no view of the aspects", format!("{mask:?}")))
    }

    /// Returns the view of all aspects.
    pub(crate) fn whole(&self) -> Result<vk::ImageView, BackendError> {
        self.view(self.aspects())
    }

    /// Returns the view of all aspects that passes draw to, with all layers if passes have several.
    pub(crate) fn attached(&self) -> Result<vk::ImageView, BackendError> {
        self.layers.map_or_else(|| self.whole(), Ok)
    }

    /// Returns the part of the image that is used.
    pub(crate) fn place(&self) -> ImagePlace {
        self.key.shape().place
    }

    /// Returns all aspects of the image.
    pub(crate) fn aspects(&self) -> vk::ImageAspectFlags {
        format::aspect_mask(self.key.format)
    }

    pub(crate) fn destroy(&self, device: &Device) {
        // SAFETY: the device is done with the image; null handles are ignored.
        unsafe {
            let views = self.views.iter().map(|(_, view)| view);
            for view in views.chain(&self.unconverted).chain(&self.layers) {
                device.raw.destroy_image_view(*view, None);
            }
            device.raw.destroy_image(self.raw, None);
            device.raw.free_memory(self.memory, None);
        }
    }
}
