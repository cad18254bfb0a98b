//! Order between uses of storage buffers: zeros before shaders, and the writes of a pass before the reads of
//! the next.

use crate::device::Device;
use ash::vk;

/// Records a fill of the first bytes of a storage buffer with zeros, visible to fragment shaders after it.
pub(crate) fn zero(
    device: &Device,
    commands: vk::CommandBuffer,
    buffer: vk::Buffer,
    bytes: vk::DeviceSize,
) {
    // SAFETY: `commands` is being recorded, outside a render pass; no other work uses the buffer, which has
    // at least this size.
    unsafe {
        device.raw.cmd_fill_buffer(commands, buffer, 0, bytes, 0);
    }
    let (written, stage) = (
        vk::AccessFlags2::TRANSFER_WRITE,
        vk::PipelineStageFlags2::ALL_TRANSFER,
    );
    before_use(device, commands, stage, written);
}

/// Makes writes visible to the storage reads and writes of fragment shaders.
pub(crate) fn before_use(
    device: &Device,
    commands: vk::CommandBuffer,
    stage: vk::PipelineStageFlags2,
    written: vk::AccessFlags2,
) {
    let barriers = [vk::MemoryBarrier2::default()
        .src_stage_mask(stage)
        .src_access_mask(written)
        .dst_stage_mask(vk::PipelineStageFlags2::FRAGMENT_SHADER)
        .dst_access_mask(
            vk::AccessFlags2::SHADER_STORAGE_READ | vk::AccessFlags2::SHADER_STORAGE_WRITE,
        )];
    let info = vk::DependencyInfo::default().memory_barriers(&barriers);
    // SAFETY: `commands` is being recorded, outside a render pass.
    unsafe { device.raw.cmd_pipeline_barrier2(commands, &info) };
}
