//! Twin of `shaders/counted_color.wgsl`. What it counts is the walker's business; the rest is
//! `uniform_color`.

pub(super) use super::uniform_color::fragment;
