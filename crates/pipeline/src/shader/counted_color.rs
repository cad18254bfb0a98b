//! Twin of `shaders/counted_color.wgsl`: `uniform_color`. The caller counts its runs.

pub(super) use super::uniform_color::fragment;
