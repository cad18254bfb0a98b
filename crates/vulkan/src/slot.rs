//! Reusable slots: the commands, fence, queries and descriptors of one scene in flight.

use crate::device::Device;
use crate::error::{Check, internal};
use crate::queries::TypedQueries;
use ash::vk;
use etalon_backend::BackendError;
use std::time::{Duration, Instant};

/// The largest number of unused slots kept.
const KEPT_SLOTS: usize = 16;
const FEWEST_SETS: u32 = 8;

/// The commands, queries and descriptors of one scene.
#[derive(Debug, Default)]
pub(crate) struct Slot {
    pool: vk::CommandPool,
    /// Primary command buffers. The first `recorded` of them are submitted.
    primaries: Vec<vk::CommandBuffer>,
    /// The number of primary command buffers that are recorded, the current one included.
    recorded: usize,
    secondaries: Vec<vk::CommandBuffer>,
    /// The number of secondary command buffers that are recorded.
    executed: usize,
    fence: vk::Fence,
    /// Empty if the queue has no timestamps.
    timestamps: TypedQueries,
    pub(crate) occlusion: TypedQueries,
    pub(crate) statistics: TypedQueries,
    descriptors: vk::DescriptorPool,
    /// The capacity of the descriptor pool in sets.
    sets: u32,
    /// The average number of images per set that the descriptor pool has room for.
    images: u32,
    /// True if the device might still be executing the commands.
    pub(crate) in_flight: bool,
}

/// The capacity that a scene needs.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Needs {
    /// Descriptor sets.
    pub(crate) sets: u32,
    /// The largest number of images of a set.
    pub(crate) images: u32,
    /// Occlusion queries.
    pub(crate) occlusion: u32,
    /// Pipeline statistics queries.
    pub(crate) statistics: u32,
}

/// Unused slots.
#[derive(Debug, Default)]
pub(crate) struct Slots {
    free: Vec<Slot>,
}

impl Slots {
    /// Returns a slot with this capacity.
    pub(crate) fn take(&mut self, device: &Device, needs: Needs) -> Result<Slot, BackendError> {
        let mut slot = self.free.pop().unwrap_or_default();
        let ready = slot.create(device, needs);
        if let Err(error) = ready {
            slot.destroy(device);
            return Err(error);
        }
        Ok(slot)
    }

    /// Returns a slot to the pool. If the slot is in flight, waits for the device and destroys the slot.
    pub(crate) fn give_back(&mut self, device: &Device, slot: Slot) {
        if slot.in_flight {
            // SAFETY: waiting has no requirements; on a lost device it fails, and nothing runs there.
            let _ = unsafe { device.raw.device_wait_idle() };
        }
        if slot.in_flight || self.free.len() >= KEPT_SLOTS {
            slot.destroy(device);
        } else {
            self.free.push(slot);
        }
    }

    /// Destroys everything. The device must still exist.
    pub(crate) fn destroy(&mut self, device: &Device) {
        self.free.drain(..).for_each(|s| s.destroy(device));
    }
}

impl Slot {
    /// Creates what is missing and frees all descriptor sets.
    fn create(&mut self, device: &Device, needs: Needs) -> Result<(), BackendError> {
        let (sets, images) = (needs.sets.max(1), needs.images.max(1));
        let api = &device.raw;
        if self.pool == vk::CommandPool::null() {
            let info = vk::CommandPoolCreateInfo::default()
                .flags(vk::CommandPoolCreateFlags::TRANSIENT)
                .queue_family_index(device.queue_family);
            // SAFETY: the device was created with this family.
            self.pool = unsafe { api.create_command_pool(&info, None) }.check("a command pool")?;
            let info = vk::FenceCreateInfo::default();
            // SAFETY: the device is alive.
            self.fence = unsafe { api.create_fence(&info, None) }.check("a fence")?;
            if device.timestamp_bits > 0 {
                self.timestamps
                    .make_room(device, vk::QueryType::TIMESTAMP, 2)?;
            }
        }
        self.occlusion
            .make_room(device, vk::QueryType::OCCLUSION, needs.occlusion)?;
        self.statistics
            .make_room(device, vk::QueryType::PIPELINE_STATISTICS, needs.statistics)?;
        if self.sets < sets || self.images < images {
            self.sets = sets.next_power_of_two().max(FEWEST_SETS);
            self.images = images.max(self.images);
            // SAFETY: no set of this pool is in use; a null pool is ignored.
            unsafe { api.destroy_descriptor_pool(self.descriptors, None) };
            self.descriptors = vk::DescriptorPool::null();
            let size = |ty, descriptor_count| vk::DescriptorPoolSize {
                ty,
                descriptor_count,
            };
            let sizes = [
                size(vk::DescriptorType::UNIFORM_BUFFER_DYNAMIC, self.sets),
                size(
                    vk::DescriptorType::SAMPLED_IMAGE,
                    self.sets.saturating_mul(self.images),
                ),
                size(
                    vk::DescriptorType::INPUT_ATTACHMENT,
                    self.sets.saturating_mul(self.images),
                ),
                size(vk::DescriptorType::STORAGE_BUFFER, self.sets),
                size(vk::DescriptorType::SAMPLER, self.sets),
            ];
            let info = vk::DescriptorPoolCreateInfo::default()
                .max_sets(self.sets)
                .pool_sizes(&sizes);
            // SAFETY: `info` is complete.
            self.descriptors =
                unsafe { api.create_descriptor_pool(&info, None) }.check("a descriptor pool")?;
        } else {
            let flags = vk::DescriptorPoolResetFlags::empty();
            // SAFETY: no set of this pool is in use.
            unsafe { api.reset_descriptor_pool(self.descriptors, flags) }
                .check("a descriptor pool")?;
        }
        Ok(())
    }

    /// Allocates a descriptor set, which is valid while the scene holds the slot.
    pub(crate) fn descriptor_set(
        &self,
        device: &Device,
        layout: vk::DescriptorSetLayout,
    ) -> Result<vk::DescriptorSet, BackendError> {
        let layouts = [layout];
        let info = vk::DescriptorSetAllocateInfo::default()
            .descriptor_pool(self.descriptors)
            .set_layouts(&layouts);
        // SAFETY: pool and layout live.
        let sets = unsafe { device.raw.allocate_descriptor_sets(&info) };
        let sets = sets.check("a descriptor set")?;
        sets.first()
            .copied()
            .ok_or_else(|| internal("no descriptor set came back"))
    }

    /// Begins recording.
    pub(crate) fn begin(&mut self, device: &Device) -> Result<vk::CommandBuffer, BackendError> {
        // SAFETY: `submit` waited, so the device is done with the commands.
        unsafe {
            device
                .raw
                .reset_command_pool(self.pool, vk::CommandPoolResetFlags::empty())
                .check("command memory")?;
        }
        (self.recorded, self.executed) = (0, 0);
        self.next_primary(device)
    }

    /// Ends the primary command buffer, and begins another that is submitted after it.
    pub(crate) fn next_primary(
        &mut self,
        device: &Device,
    ) -> Result<vk::CommandBuffer, BackendError> {
        if self.recorded > 0 {
            // SAFETY: the commands are being recorded, outside a render pass.
            unsafe { device.raw.end_command_buffer(self.commands()) }.check("command memory")?;
        }
        let level = vk::CommandBufferLevel::PRIMARY;
        let commands = nth(device, self.pool, level, &mut self.primaries, self.recorded)?;
        self.recorded += 1;
        let info = vk::CommandBufferBeginInfo::default()
            .flags(vk::CommandBufferUsageFlags::ONE_TIME_SUBMIT);
        // SAFETY: the pool was reset, and the buffer has not been recorded since.
        unsafe { device.raw.begin_command_buffer(commands, &info) }.check("command memory")?;
        Ok(commands)
    }

    /// Begins a secondary command buffer inside a pass.
    pub(crate) fn secondary(
        &mut self,
        device: &Device,
        inheritance: &vk::CommandBufferInheritanceInfo<'_>,
    ) -> Result<vk::CommandBuffer, BackendError> {
        let level = vk::CommandBufferLevel::SECONDARY;
        let commands = nth(
            device,
            self.pool,
            level,
            &mut self.secondaries,
            self.executed,
        )?;
        self.executed += 1;
        let info = vk::CommandBufferBeginInfo::default()
            .flags(
                vk::CommandBufferUsageFlags::ONE_TIME_SUBMIT
                    | vk::CommandBufferUsageFlags::RENDER_PASS_CONTINUE,
            )
            .inheritance_info(inheritance);
        // SAFETY: as above.
        unsafe { device.raw.begin_command_buffer(commands, &info) }.check("command memory")?;
        Ok(commands)
    }

    /// Returns the primary command buffer that is being recorded.
    pub(crate) fn commands(&self) -> vk::CommandBuffer {
        let last = self.recorded.saturating_sub(1);
        self.primaries.get(last).copied().unwrap_or_default()
    }

    /// Records the reset of the timestamps.
    pub(crate) fn reset_timestamps(&self, device: &Device) {
        self.timestamps.reset(device, self.commands(), 2);
    }

    /// Records a timestamp: 0 before and 1 after the timed commands.
    pub(crate) fn timestamp(&self, device: &Device, index: u32) {
        if self.timestamps.raw != vk::QueryPool::null() {
            let stage = vk::PipelineStageFlags2::ALL_COMMANDS;
            // SAFETY: the commands are being recorded; the pool has two queries.
            unsafe {
                device
                    .raw
                    .cmd_write_timestamp2(self.commands(), stage, self.timestamps.raw, index);
            }
        }
    }

    /// Ends recording, submits, and waits. Returns the time from `start` until the submission returned, and
    /// until the device was done.
    pub(crate) fn submit(
        &mut self,
        device: &Device,
        start: Instant,
    ) -> Result<(Duration, Duration), BackendError> {
        let fences = [self.fence];
        let commands: Vec<_> = self.primaries[..self.recorded]
            .iter()
            .map(|c| vk::CommandBufferSubmitInfo::default().command_buffer(*c))
            .collect();
        let info = [vk::SubmitInfo2::default().command_buffer_infos(&commands)];
        let api = &device.raw;
        // SAFETY: the commands are complete, everything that they use lives in the scene, and one thread uses
        // the queue.
        unsafe {
            api.end_command_buffer(self.commands())
                .check("command memory")?;
            api.reset_fences(&fences).check("a fence")?;
            // Set before the submission: after an error, the device might have begun.
            self.in_flight = true;
            api.queue_submit2(device.queue, &info, self.fence)
                .check("submitted work")?;
        }
        let submitted = start.elapsed();
        // SAFETY: the fence was submitted.
        unsafe { api.wait_for_fences(&fences, true, u64::MAX) }.check("submitted work")?;
        let done = start.elapsed();
        self.in_flight = false;
        Ok((submitted, done))
    }

    /// Returns the time between the two timestamps. The work must have finished.
    pub(crate) fn gpu_time(&self, device: &Device) -> Result<Option<Duration>, BackendError> {
        if self.timestamps.raw == vk::QueryPool::null() {
            return Ok(None);
        }
        let ticks = self.timestamps.results(device, 2)?;
        let mask = u64::MAX >> (64 - device.timestamp_bits.clamp(1, 64));
        let difference = ticks[1].wrapping_sub(ticks[0]) & mask;
        let nanoseconds = difference as f64 * f64::from(device.limits.timestamp_period);
        Ok(Some(Duration::from_nanos(nanoseconds as u64)))
    }

    fn destroy(&self, device: &Device) {
        // SAFETY: the device is done with the slot; null handles are ignored, and the pool frees its command
        // buffers.
        unsafe {
            device.raw.destroy_descriptor_pool(self.descriptors, None);
            device.raw.destroy_fence(self.fence, None);
            device.raw.destroy_command_pool(self.pool, None);
        }
        for queries in [&self.timestamps, &self.occlusion, &self.statistics] {
            queries.destroy(device);
        }
    }
}

/// Returns the command buffer with this index, created on first use.
fn nth(
    device: &Device,
    pool: vk::CommandPool,
    level: vk::CommandBufferLevel,
    buffers: &mut Vec<vk::CommandBuffer>,
    number: usize,
) -> Result<vk::CommandBuffer, BackendError> {
    if buffers.len() <= number {
        let info = vk::CommandBufferAllocateInfo::default()
            .command_pool(pool)
            .level(level)
            .command_buffer_count(1);
        // SAFETY: the pool is alive.
        let made = unsafe { device.raw.allocate_command_buffers(&info) };
        buffers.extend(made.check("a command buffer")?);
    }
    buffers
        .get(number)
        .copied()
        .ok_or_else(|| internal("no command buffer came back"))
}
