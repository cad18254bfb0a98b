//! The attachments of a planned pass, with what happens to them before and after it.

use crate::clear::Ends;
use ash::vk;

/// A colour attachment of a pass.
pub(crate) struct ColorPlan {
    /// Null where no attachment is.
    pub(crate) view: vk::ImageView,
    pub(crate) ends: Ends,
    /// The view and mode of the resolve, if the pass resolves it.
    pub(crate) resolve: Option<(vk::ImageView, vk::ResolveModeFlags)>,
}

/// The depth-stencil attachment of a pass.
pub(crate) struct DepthStencilPlan {
    pub(crate) view: vk::ImageView,
    /// The operations of depth, if the format has it.
    pub(crate) depth: Option<Ends>,
    /// The operations of stencil, if the format has it.
    pub(crate) stencil: Option<Ends>,
    pub(crate) read_only: bool,
    /// The view of the resolve with the modes of depth and stencil, if the pass resolves them.
    pub(crate) resolve: Option<(vk::ImageView, [vk::ResolveModeFlags; 2])>,
}
