//! Limits that an adapter reports and does not have.

use etalon_frame::Limits;
use serde::{Deserialize, Serialize};

/// A wrong limit.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum LimitFault {
    /// Another number of sub-pixel bits: `sub-pixel-bits-64`.
    SubPixelBits(u8),
    /// A sample two texels to the right of its own: `sample-outside`.
    SampleOutside,
    /// No format with several samples: `one-sample`.
    OneSample,
}

impl LimitFault {
    /// Changes what an adapter reports.
    pub fn apply(self, limits: &mut Limits) {
        match self {
            Self::SubPixelBits(bits) => limits.sub_pixel_bits = bits,
            Self::SampleOutside => {
                for position in limits.sample_positions.values_mut().flatten() {
                    position[0] = position[0].saturating_add(512);
                }
            }
            Self::OneSample => {
                for support in limits.formats.values_mut() {
                    support.samples.retain(|n| *n == 1);
                }
            }
        }
    }
}
