//! Twin of `shaders/stepped_perspective_sample.wgsl`.

pub(super) use super::stepped_perspective::fragment;
