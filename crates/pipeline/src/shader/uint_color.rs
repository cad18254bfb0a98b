//! Twin of `shaders/uint_color.wgsl`. Whole numbers are the same as integers and as reals:
//! `uniform_color`.

pub(super) use super::uniform_color::fragment;
