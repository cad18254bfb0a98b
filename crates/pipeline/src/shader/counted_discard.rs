//! Twin of `shaders/counted_discard.wgsl`: `texel_discard`. The caller counts its runs.

pub(super) use super::texel_discard::fragment;
