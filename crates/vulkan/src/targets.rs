//! The formats of a pass's attachments, as pipelines and render passes ask for them.

use ash::vk;

/// The formats and sample count of a pass's attachments.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub(crate) struct Targets {
    pub(crate) color: Vec<vk::Format>,
    /// `UNDEFINED` without a depth aspect.
    pub(crate) depth: vk::Format,
    /// `UNDEFINED` without a stencil aspect.
    pub(crate) stencil: vk::Format,
    pub(crate) samples: u32,
}

impl Targets {
    /// Returns the format of the depth-stencil attachment.
    pub(crate) fn depth_stencil(&self) -> vk::Format {
        match self.depth {
            vk::Format::UNDEFINED => self.stencil,
            depth => depth,
        }
    }

    /// Returns the aspects of the depth-stencil attachment.
    pub(crate) fn aspects(&self) -> vk::ImageAspectFlags {
        crate::format::aspect_mask(self.depth_stencil())
    }
}
