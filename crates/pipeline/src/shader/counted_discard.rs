//! Twin of `shaders/counted_discard.wgsl`. What it counts is the walker's business; the rest is
//! `texel_discard`.

pub(super) use super::texel_discard::fragment;
