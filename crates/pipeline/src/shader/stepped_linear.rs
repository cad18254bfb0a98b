//! Twin of `shaders/stepped_linear.wgsl`.

pub(super) use super::stepped_perspective::fragment;
