//! Twin of `shaders/expensive_depth.wgsl`: `frag_coord_depth` without the cost.

pub(super) use super::frag_coord_depth::fragment;
