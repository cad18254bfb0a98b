//! The tiles that drivers work in.

/// Their sides, in texels.
pub(super) const TILES: [u32; 4] = [8, 16, 32, 64];
