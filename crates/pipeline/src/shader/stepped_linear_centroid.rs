//! Twin of `shaders/stepped_linear_centroid.wgsl`.

pub(super) use super::stepped_perspective::fragment;
