//! Twin of `shaders/expensive_depth.wgsl`. But for the cost it is `frag_coord_depth`.

pub(super) use super::frag_coord_depth::fragment;
