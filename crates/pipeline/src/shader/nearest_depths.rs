//! Twin of `shaders/nearest_depths.wgsl`: `list_append`. The caller keeps the nearest nodes.

pub(super) use super::list_append::fragment;
