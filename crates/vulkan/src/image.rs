//! Images with their memory and views.

use crate::device::Device;
use crate::error::{Check, internal};
use crate::format;
use crate::state;
use ash::vk;
use etalon_backend::BackendError;

/// The properties that interchangeable images share.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct ImageKey {
    pub(crate) format: vk::Format,
    pub(crate) size: [u32; 2],
    pub(crate) samples: u32,
    pub(crate) usage: vk::ImageUsageFlags,
}

/// An image with its own memory.
#[derive(Debug)]
pub(crate) struct Image {
    pub(crate) key: ImageKey,
    pub(crate) raw: vk::Image,
    memory: vk::DeviceMemory,
    pub(crate) bytes: u64,
    /// A view of all aspects, and one per aspect for depth-stencil images that shaders read.
    views: Vec<(vk::ImageAspectFlags, vk::ImageView)>,
    /// A view without sRGB conversion, for a multisampled sRGB image that shaders read.
    unconverted: Option<vk::ImageView>,
}

impl Image {
    pub(crate) fn new(device: &Device, key: ImageKey) -> Result<Self, BackendError> {
        let mut image = Self {
            key,
            raw: vk::Image::null(),
            memory: vk::DeviceMemory::null(),
            bytes: 0,
            views: Vec::new(),
            unconverted: None,
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
        // The list of both formats keeps a mutable format from changing the image's memory layout.
        let both_formats = [key.format, unconverted.unwrap_or(key.format)];
        let mut list = vk::ImageFormatListCreateInfo::default().view_formats(&both_formats);
        let mut info = vk::ImageCreateInfo::default()
            .image_type(vk::ImageType::TYPE_2D)
            .format(key.format)
            .extent(vk::Extent3D {
                width: key.size[0],
                height: key.size[1],
                depth: 1,
            })
            .mip_levels(1)
            .array_layers(1)
            .samples(state::samples(key.samples))
            .tiling(vk::ImageTiling::OPTIMAL)
            .usage(key.usage);
        if unconverted.is_some() {
            info = info
                .flags(vk::ImageCreateFlags::MUTABLE_FORMAT)
                .push_next(&mut list);
        }
        // SAFETY: the device lives, and it supports the format.
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
        let all = format::aspect_mask(key.format);
        let mut masks = vec![all];
        let both = vk::ImageAspectFlags::DEPTH | vk::ImageAspectFlags::STENCIL;
        if all == both && key.usage.contains(vk::ImageUsageFlags::SAMPLED) {
            masks.extend([vk::ImageAspectFlags::DEPTH, vk::ImageAspectFlags::STENCIL]);
        }
        for mask in masks {
            let view = self.create_view(device, key.format, mask)?;
            self.views.push((mask, view));
        }
        if let Some(format) = unconverted {
            self.unconverted = Some(self.create_view(device, format, all)?);
        }
        Ok(())
    }

    fn create_view(
        &self,
        device: &Device,
        format: vk::Format,
        mask: vk::ImageAspectFlags,
    ) -> Result<vk::ImageView, BackendError> {
        let info = vk::ImageViewCreateInfo::default()
            .image(self.raw)
            .view_type(vk::ImageViewType::TYPE_2D)
            .format(format)
            .subresource_range(range(mask));
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
            .ok_or_else(|| internal(format!("no view of the aspects {mask:?}")))
    }

    /// Returns the view of all aspects.
    pub(crate) fn whole(&self) -> Result<vk::ImageView, BackendError> {
        self.view(self.aspects())
    }

    /// Returns all aspects of the image.
    pub(crate) fn aspects(&self) -> vk::ImageAspectFlags {
        format::aspect_mask(self.key.format)
    }

    pub(crate) fn destroy(&self, device: &Device) {
        // SAFETY: the device is done with the image; null handles are ignored.
        unsafe {
            let views = self.views.iter().map(|(_, view)| view);
            for view in views.chain(&self.unconverted) {
                device.raw.destroy_image_view(*view, None);
            }
            device.raw.destroy_image(self.raw, None);
            device.raw.free_memory(self.memory, None);
        }
    }
}

/// The only mip level and array layer of an image.
pub(crate) fn range(mask: vk::ImageAspectFlags) -> vk::ImageSubresourceRange {
    vk::ImageSubresourceRange {
        aspect_mask: mask,
        base_mip_level: 0,
        level_count: 1,
        base_array_layer: 0,
        layer_count: 1,
    }
}
