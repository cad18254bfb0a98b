//! The attachments of a planned pass, with their load and store operations and resolves.

use crate::clear::Ends;
use ash::vk;

/// A colour attachment of a pass.
pub(crate) struct ColorPlan {
    /// The view; null if the location has no attachment.
    pub(crate) view: vk::ImageView,
    pub(crate) layout: vk::ImageLayout,
    pub(crate) ends: Ends,
    /// The view and mode of the resolve, if the pass resolves it.
    pub(crate) resolve: Option<(vk::ImageView, vk::ResolveModeFlags)>,
}

/// The depth-stencil attachment of a pass.
pub(crate) struct DepthStencilPlan {
    pub(crate) view: vk::ImageView,
    pub(crate) layout: vk::ImageLayout,
    /// The load and store operation of depth, if the format has depth.
    pub(crate) depth: Option<Ends>,
    /// The load and store operation of stencil, if the format has stencil.
    pub(crate) stencil: Option<Ends>,
    pub(crate) read_only: bool,
    /// The view of the resolve and the modes of depth and stencil, if the pass resolves them.
    pub(crate) resolve: Option<(vk::ImageView, [vk::ResolveModeFlags; 2])>,
}
