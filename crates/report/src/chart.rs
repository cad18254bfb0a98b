//! Charts as SVG.

pub(crate) mod kit;
