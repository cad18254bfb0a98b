//! Buffers and images, reused from bounded pools.

use crate::device::Device;
use crate::error::{Check, internal};
use crate::format;
use crate::state;
use ash::vk;
use etalon_backend::BackendError;

/// The most objects and bytes that a pool keeps.
const KEPT_OBJECTS: usize = 64;
const KEPT_BYTES: u64 = 256 << 20;
/// The smallest buffer. Sizes are powers of two, so that buffers fit later scenes.
const SMALLEST_BUFFER: u64 = 64 << 10;

/// The use of a buffer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum BufferUse {
    /// Written by the host: vertices, indices, parameters, uploads.
    Input,
    /// Read by the host: attachments that are read back.
    Output,
    /// Incremented by shaders, then read by the host: a few words.
    Counts,
}

/// A persistently mapped buffer in coherent memory.
#[derive(Debug)]
pub(crate) struct Buffer {
    pub(crate) raw: vk::Buffer,
    memory: vk::DeviceMemory,
    pointer: *mut u8,
    size: u64,
    usage: BufferUse,
}

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
    bytes: u64,
    /// A view of all aspects, and one per aspect for depth-stencil images that shaders read.
    views: Vec<(vk::ImageAspectFlags, vk::ImageView)>,
    /// A view without sRGB conversion, for a multisampled sRGB image that shaders read.
    unconverted: Option<vk::ImageView>,
}

/// Unused objects, oldest first.
#[derive(Debug, Default)]
pub(crate) struct Pool {
    buffers: Vec<Buffer>,
    images: Vec<Image>,
}

impl Buffer {
    /// Passes a buffer of null handles to `create`, so that a failure leaks nothing.
    fn new(device: &Device, usage: BufferUse, size: u64) -> Result<Self, BackendError> {
        let size = size.max(SMALLEST_BUFFER).checked_next_power_of_two();
        let mut buffer = Self {
            raw: vk::Buffer::null(),
            memory: vk::DeviceMemory::null(),
            pointer: std::ptr::null_mut(),
            size: size.unwrap_or(u64::MAX),
            usage,
        };
        let created = buffer.create(device);
        if let Err(error) = created {
            buffer.destroy(device);
            return Err(error);
        }
        Ok(buffer)
    }

    fn create(&mut self, device: &Device) -> Result<(), BackendError> {
        let coherent =
            vk::MemoryPropertyFlags::HOST_VISIBLE | vk::MemoryPropertyFlags::HOST_COHERENT;
        let (flags, preferred) = match self.usage {
            BufferUse::Input => (
                vk::BufferUsageFlags::VERTEX_BUFFER
                    | vk::BufferUsageFlags::INDEX_BUFFER
                    | vk::BufferUsageFlags::UNIFORM_BUFFER
                    | vk::BufferUsageFlags::TRANSFER_SRC,
                vk::MemoryPropertyFlags::DEVICE_LOCAL,
            ),
            BufferUse::Output => (
                vk::BufferUsageFlags::STORAGE_BUFFER | vk::BufferUsageFlags::TRANSFER_DST,
                vk::MemoryPropertyFlags::HOST_CACHED,
            ),
            BufferUse::Counts => (
                vk::BufferUsageFlags::STORAGE_BUFFER | vk::BufferUsageFlags::TRANSFER_DST,
                vk::MemoryPropertyFlags::DEVICE_LOCAL,
            ),
        };
        let info = vk::BufferCreateInfo::default().size(self.size).usage(flags);
        // SAFETY: the device lives, and `info` is complete.
        self.raw = unsafe { device.raw.create_buffer(&info, None) }.check("a buffer")?;
        // SAFETY: the buffer was just made.
        let needs = unsafe { device.raw.get_buffer_memory_requirements(self.raw) };
        self.memory = device.allocate(needs, &[coherent | preferred, coherent], "buffer memory")?;
        // SAFETY: buffer and memory are new, the memory type allows the buffer, and it is mapped
        // once, whole.
        unsafe {
            device
                .raw
                .bind_buffer_memory(self.raw, self.memory, 0)
                .check("buffer memory")?;
            let range = vk::WHOLE_SIZE;
            let mapped = device
                .raw
                .map_memory(self.memory, 0, range, vk::MemoryMapFlags::empty());
            self.pointer = mapped.check("mapped memory")?.cast();
        }
        Ok(())
    }

    /// Writes bytes at an offset. Fails if they do not fit.
    pub(crate) fn write(&mut self, offset: u64, bytes: &[u8]) -> Result<(), BackendError> {
        let at = self.range(offset, bytes.len())?;
        // SAFETY: `range` checked that the mapping holds all of it, the device does not use the
        // buffer while its scene is being prepared, and `bytes` cannot overlap mapped memory.
        unsafe { std::ptr::copy_nonoverlapping(bytes.as_ptr(), self.pointer.add(at), bytes.len()) };
        Ok(())
    }

    /// Copies bytes out, after the device is done with the buffer.
    pub(crate) fn read(&self, offset: u64, length: usize) -> Result<Vec<u8>, BackendError> {
        let at = self.range(offset, length)?;
        let mut bytes = vec![0; length];
        // SAFETY: as in `write`; a fence signalled that the device is done.
        unsafe {
            std::ptr::copy_nonoverlapping(self.pointer.add(at), bytes.as_mut_ptr(), length);
        }
        Ok(bytes)
    }

    fn range(&self, offset: u64, length: usize) -> Result<usize, BackendError> {
        let end = offset.checked_add(length as u64);
        if end.is_some_and(|end| end <= self.size)
            && let Ok(at) = usize::try_from(offset)
        {
            return Ok(at);
        }
        Err(internal(format!(
            "{length} bytes at {offset} leave a buffer of {}",
            self.size
        )))
    }

    fn destroy(&self, device: &Device) {
        // SAFETY: the device is done with the buffer; null handles are ignored, and freeing memory
        // unmaps it.
        unsafe {
            device.raw.destroy_buffer(self.raw, None);
            device.raw.free_memory(self.memory, None);
        }
    }
}

impl Image {
    fn new(device: &Device, key: ImageKey) -> Result<Self, BackendError> {
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

    fn destroy(&self, device: &Device) {
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

impl Pool {
    /// Returns a buffer of at least this size.
    pub(crate) fn buffer(
        &mut self,
        device: &Device,
        usage: BufferUse,
        size: u64,
    ) -> Result<Buffer, BackendError> {
        let fits = |b: &Buffer| b.usage == usage && b.size >= size;
        match self.buffers.iter().rposition(fits) {
            Some(index) => Ok(self.buffers.remove(index)),
            None => Buffer::new(device, usage, size),
        }
    }

    /// Returns an image with undefined contents.
    pub(crate) fn image(&mut self, device: &Device, key: ImageKey) -> Result<Image, BackendError> {
        match self.images.iter().rposition(|i| i.key == key) {
            Some(index) => Ok(self.images.remove(index)),
            None => Image::new(device, key),
        }
    }

    /// Returns objects to the pool once the device is done with them.
    pub(crate) fn give_back(
        &mut self,
        device: &Device,
        buffers: impl IntoIterator<Item = Buffer>,
        images: impl IntoIterator<Item = Image>,
    ) {
        self.buffers.extend(buffers);
        self.images.extend(images);
        let excess = excess(self.buffers.iter().map(|b| b.size));
        self.buffers.drain(..excess).for_each(|b| b.destroy(device));
        let excess = self::excess(self.images.iter().map(|i| i.bytes));
        self.images.drain(..excess).for_each(|i| i.destroy(device));
    }

    /// Destroys everything, before the device is destroyed.
    pub(crate) fn destroy(&mut self, device: &Device) {
        self.buffers.drain(..).for_each(|b| b.destroy(device));
        self.images.drain(..).for_each(|i| i.destroy(device));
    }
}

/// Returns the number of oldest objects to destroy to keep the rest within the bounds.
fn excess(sizes: impl DoubleEndedIterator<Item = u64> + ExactSizeIterator) -> usize {
    let count = sizes.len();
    let mut bytes = 0_u64;
    let kept = sizes
        .rev()
        .take(KEPT_OBJECTS)
        .take_while(|size| {
            bytes = bytes.saturating_add(*size);
            bytes <= KEPT_BYTES
        })
        .count();
    count - kept
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pools_keep_the_newest_within_their_bounds() {
        assert_eq!(excess([1_u64; 10].into_iter()), 0);
        assert_eq!(excess([1_u64; KEPT_OBJECTS + 3].into_iter()), 3);
        assert_eq!(excess([KEPT_BYTES, 1, 1].into_iter()), 1);
        assert_eq!(excess([KEPT_BYTES + 1].into_iter()), 1);
    }
}
