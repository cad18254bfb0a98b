//! Twin of `shaders/uint_color.wgsl`: `uniform_color`, since integers are exact as reals.

pub(super) use super::uniform_color::fragment;
