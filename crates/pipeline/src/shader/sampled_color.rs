//! Twin of `shaders/sampled_color.wgsl`. Whether the texel was fetched or sampled is the walker's
//! business: `texel_color`.

pub(super) use super::texel_color::fragment;
