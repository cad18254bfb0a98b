//! Twin of `shaders/sampled_discard.wgsl`. Whether the texel was fetched or sampled is the walker's
//! business: `texel_discard`.

pub(super) use super::texel_discard::fragment;
