//! Twin of `shaders/flat_either.wgsl`.

pub(super) use super::flat_color::fragment;
