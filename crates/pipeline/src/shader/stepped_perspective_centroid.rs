//! Twin of `shaders/stepped_perspective_centroid.wgsl`.

pub(super) use super::stepped_perspective::fragment;
