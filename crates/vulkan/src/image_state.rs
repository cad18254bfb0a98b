//! The states of images between commands, for barriers and attachments.

use ash::vk;

/// The layout of an image with the stages and accesses that use it.
#[derive(Clone, Copy)]
pub(crate) struct ImageState {
    pub(crate) layout: vk::ImageLayout,
    pub(crate) stages: vk::PipelineStageFlags2,
    pub(crate) access: vk::AccessFlags2,
}

pub(crate) const TRANSFER_DST: ImageState = ImageState {
    layout: vk::ImageLayout::TRANSFER_DST_OPTIMAL,
    stages: vk::PipelineStageFlags2::ALL_TRANSFER,
    access: vk::AccessFlags2::TRANSFER_WRITE,
};

pub(crate) const TRANSFER_SRC: ImageState = ImageState {
    layout: vk::ImageLayout::TRANSFER_SRC_OPTIMAL,
    stages: vk::PipelineStageFlags2::ALL_TRANSFER,
    access: vk::AccessFlags2::TRANSFER_READ,
};

pub(crate) const COMPUTE: ImageState = ImageState {
    layout: vk::ImageLayout::SHADER_READ_ONLY_OPTIMAL,
    stages: vk::PipelineStageFlags2::COMPUTE_SHADER,
    access: vk::AccessFlags2::SHADER_SAMPLED_READ,
};

/// Depth and stencil attachments of a read-only pass.
pub(crate) const DEPTH_STENCIL_READ_ONLY: ImageState = ImageState {
    layout: vk::ImageLayout::DEPTH_STENCIL_READ_ONLY_OPTIMAL,
    stages: DEPTH_STENCIL.stages,
    access: vk::AccessFlags2::DEPTH_STENCIL_ATTACHMENT_READ,
};

pub(crate) const DEPTH_STENCIL: ImageState = ImageState {
    layout: vk::ImageLayout::DEPTH_STENCIL_ATTACHMENT_OPTIMAL,
    stages: vk::PipelineStageFlags2::from_raw(
        vk::PipelineStageFlags2::EARLY_FRAGMENT_TESTS.as_raw()
            | vk::PipelineStageFlags2::LATE_FRAGMENT_TESTS.as_raw(),
    ),
    access: vk::AccessFlags2::from_raw(
        vk::AccessFlags2::DEPTH_STENCIL_ATTACHMENT_READ.as_raw()
            | vk::AccessFlags2::DEPTH_STENCIL_ATTACHMENT_WRITE.as_raw(),
    ),
};

/// Resolve targets of depth and stencil. The colour attachment output stage writes them (Vulkan, Render Pass
/// Multisample Resolve Operations).
pub(crate) const DEPTH_STENCIL_RESOLVE: ImageState = ImageState {
    layout: DEPTH_STENCIL.layout,
    stages: vk::PipelineStageFlags2::COLOR_ATTACHMENT_OUTPUT,
    access: vk::AccessFlags2::from_raw(
        vk::AccessFlags2::COLOR_ATTACHMENT_READ.as_raw()
            | vk::AccessFlags2::COLOR_ATTACHMENT_WRITE.as_raw(),
    ),
};

/// An image after any use; its contents are discarded.
pub(crate) const UNDEFINED: ImageState = ImageState {
    layout: vk::ImageLayout::UNDEFINED,
    stages: vk::PipelineStageFlags2::ALL_COMMANDS,
    access: vk::AccessFlags2::MEMORY_WRITE,
};

pub(crate) const COLOR: ImageState = ImageState {
    layout: vk::ImageLayout::COLOR_ATTACHMENT_OPTIMAL,
    stages: vk::PipelineStageFlags2::COLOR_ATTACHMENT_OUTPUT,
    access: vk::AccessFlags2::from_raw(
        vk::AccessFlags2::COLOR_ATTACHMENT_READ.as_raw()
            | vk::AccessFlags2::COLOR_ATTACHMENT_WRITE.as_raw(),
    ),
};

pub(crate) const FETCHED: ImageState = ImageState {
    layout: vk::ImageLayout::SHADER_READ_ONLY_OPTIMAL,
    stages: vk::PipelineStageFlags2::from_raw(
        vk::PipelineStageFlags2::VERTEX_SHADER.as_raw()
            | vk::PipelineStageFlags2::FRAGMENT_SHADER.as_raw(),
    ),
    access: vk::AccessFlags2::SHADER_SAMPLED_READ,
};
