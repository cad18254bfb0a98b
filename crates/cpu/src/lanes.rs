//! Lanes: the texels of a span as arrays.

/// The number of texels of a span.
pub const LANES: usize = 16;

/// A number per lane.
pub type Real = [f32; LANES];

/// A code per lane.
pub type LaneCodes = [u32; LANES];

/// A truth value per lane.
pub type Mask = [bool; LANES];
