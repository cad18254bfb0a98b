//! Twin of `shaders/sampled_discard.wgsl`: `texel_discard`. The caller samples instead of fetching.

pub(super) use super::texel_discard::fragment;
