//! Twin of `shaders/counted_depth.wgsl`. What it counts is the walker's business; the rest is
//! `flat_color_depth`.

pub(super) use super::flat_color_depth::fragment;
