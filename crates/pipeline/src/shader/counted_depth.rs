//! Twin of `shaders/counted_depth.wgsl`: `flat_color_depth`. The caller counts its runs.

pub(super) use super::flat_color_depth::fragment;
