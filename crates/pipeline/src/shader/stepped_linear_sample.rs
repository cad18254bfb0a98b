//! Twin of `shaders/stepped_linear_sample.wgsl`.

pub(super) use super::stepped_perspective::fragment;
