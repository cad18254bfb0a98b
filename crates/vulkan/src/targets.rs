//! The formats of a pass's attachments, as pipelines and render passes need them.

use crate::image::{DRAWN_LAYERS, LAYERS};
use ash::vk;
use etalon_frame::{PathLayers, PathReads};

/// The formats and sample count of a pass's attachments.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub(crate) struct Targets {
    /// The colour formats; `UNDEFINED` if the location has no attachment.
    pub(crate) color: Vec<vk::Format>,
    /// The format with the depth aspect, or `UNDEFINED`.
    pub(crate) depth: vk::Format,
    /// The format with the stencil aspect, or `UNDEFINED`.
    pub(crate) stencil: vk::Format,
    pub(crate) samples: u32,
    /// The layers of the pass.
    pub(crate) layers: PathLayers,
    /// The way in which draws read attachments of the pass; `None` if no draw does.
    pub(crate) reads: Option<PathReads>,
}

impl Targets {
    /// Returns the mask of the layers that are views, or 0 without multiview.
    pub(crate) fn views(&self) -> u32 {
        match self.layers {
            PathLayers::One | PathLayers::Written => 0,
            PathLayers::Multiview => DRAWN_LAYERS.iter().fold(0, |mask, layer| mask | 1 << layer),
        }
    }

    /// Returns the number of layers that shaders select from: 1 with multiview.
    pub(crate) fn layer_count(&self) -> u32 {
        match self.layers {
            PathLayers::One | PathLayers::Multiview => 1,
            PathLayers::Written => LAYERS,
        }
    }

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
