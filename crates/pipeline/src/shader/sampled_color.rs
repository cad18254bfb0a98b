//! Twin of `shaders/sampled_color.wgsl`: `texel_color`. The caller samples instead of fetching.

pub(super) use super::texel_color::fragment;
