//! Host-visible buffers, mapped as long as they exist: inputs are written and results read in place,
//! without staging copies.

use crate::device::Device;
use crate::error::Check;
use crate::recording;
use ash::vk;
use etalon_backend::BackendError;

/// The smallest buffer. Sizes are powers of two, so that buffers fit later scenes.
const SMALLEST_BUFFER: u64 = 64 << 10;

/// The use of a buffer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum BufferUse {
    /// Written by the host: vertices, indices, parameters, uploads.
    Input,
    /// Read by the host: attachments that are read back.
    Output,
    /// Written by shaders: the counts, which the host reads, and the pool.
    Storage,
}

/// A persistently mapped buffer in coherent memory.
#[derive(Debug)]
pub(crate) struct MappedBuffer {
    pub(crate) raw: vk::Buffer,
    memory: vk::DeviceMemory,
    pointer: *mut u8,
    pub(crate) size: u64,
    pub(crate) usage: BufferUse,
}

impl MappedBuffer {
    /// Creates a buffer. If a step fails, it destroys what was made, so nothing leaks.
    pub(crate) fn new(device: &Device, usage: BufferUse, size: u64) -> Result<Self, BackendError> {
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
                    | vk::BufferUsageFlags::INDIRECT_BUFFER
                    | vk::BufferUsageFlags::UNIFORM_BUFFER
                    | vk::BufferUsageFlags::TRANSFER_SRC,
                vk::MemoryPropertyFlags::DEVICE_LOCAL,
            ),
            BufferUse::Output => (
                vk::BufferUsageFlags::STORAGE_BUFFER | vk::BufferUsageFlags::TRANSFER_DST,
                vk::MemoryPropertyFlags::HOST_CACHED,
            ),
            BufferUse::Storage => (
                vk::BufferUsageFlags::STORAGE_BUFFER | vk::BufferUsageFlags::TRANSFER_DST,
                vk::MemoryPropertyFlags::DEVICE_LOCAL,
            ),
        };
        let info = vk::BufferCreateInfo::default().size(self.size).usage(flags);
        // SAFETY: the device is alive, and `info` is complete.
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
        let start = self.range(offset, bytes.len())?;
        // SAFETY: `range` checked that the bytes fit the mapping, the device does not use the buffer while
        // its scene is being prepared, and `bytes` cannot overlap mapped memory.
        unsafe {
            std::ptr::copy_nonoverlapping(bytes.as_ptr(), self.pointer.add(start), bytes.len())
        };
        recording::written(self.pointer, offset, bytes);
        Ok(())
    }

    /// Copies bytes out. The device must be done with the buffer.
    pub(crate) fn read(&self, offset: u64, length: usize) -> Result<Vec<u8>, BackendError> {
        let start = self.range(offset, length)?;
        let mut bytes = vec![0; length];
        // SAFETY: as in `write`; the fence was signalled, so the device is done.
        unsafe {
            std::ptr::copy_nonoverlapping(self.pointer.add(start), bytes.as_mut_ptr(), length);
        }
        recording::read(self.pointer, offset, length);
        Ok(bytes)
    }

    fn range(&self, offset: u64, length: usize) -> Result<usize, BackendError> {
        let end = offset.checked_add(length as u64);
        if end.is_some_and(|end| end <= self.size)
            && let Ok(start) = usize::try_from(offset)
        {
            return Ok(start);
        }
        Err(BackendError::internal_of(
            "a range leaves its buffer",
            format!("{length} bytes at {offset} of {}", self.size),
        ))
    }

    pub(crate) fn destroy(&self, device: &Device) {
        // SAFETY: the device is done with the buffer; null handles are ignored, and freeing memory
        // unmaps it.
        unsafe {
            device.raw.destroy_buffer(self.raw, None);
            device.raw.free_memory(self.memory, None);
        }
    }
}
