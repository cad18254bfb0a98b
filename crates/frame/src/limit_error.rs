//! The bounds of what an adapter can report about itself.

use crate::encoding::ChannelEncoding;
use crate::format::TextureFormat;
use crate::limits::Limits;
use thiserror::Error;

/// The finest grid of vertices that is judged, in bits. Products of two coordinates fit into 63 bits, up to
/// 2¹⁸ texels from the origin.
pub const MAX_SUB_PIXEL_BITS: u8 = 12;
/// The finest grid of viewport bounds and of filtering that is judged, in bits.
const MAX_FRACTION_BITS: u8 = 16;
/// The largest sample count that an API names.
const MAX_SAMPLES: u32 = 64;
/// The width of a texel in the units of sample positions.
const TEXEL: u16 = 256;

/// A limit that no specification permits, and with which nothing can be judged.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
pub enum LimitError {
    /// A number of samples that no API has.
    #[error("{0} samples per texel, which no API has")]
    Samples(u32),
    /// Too few or too many sample positions.
    #[error("{positions} sample positions for {samples} samples")]
    Positions {
        /// The sample count.
        samples: u32,
        /// The number of its positions.
        positions: usize,
    },
    /// A sample outside its texel.
    #[error(
        "sample {sample} of {samples} at {}/256, {}/256, which is outside the texel",
        position[0],
        position[1]
    )]
    Outside {
        /// The sample count.
        samples: u32,
        /// The sample.
        sample: usize,
        /// Its position in units of 1/256 texel.
        position: [u16; 2],
    },
    /// A depth encoding that the format cannot have, or none.
    #[error("{} as the depth of {format}", encoding.map_or_else(|| "nothing".to_owned(), |e| e.to_string()))]
    Depth {
        /// The format.
        format: TextureFormat,
        /// The encoding.
        encoding: Option<ChannelEncoding>,
    },
}

impl Limits {
    /// Returns the limits with a grid of vertices that can be judged. A grid that is finer than
    /// [`MAX_SUB_PIXEL_BITS`] is replaced by that one: a vertex can be snapped to either side on any grid, so a
    /// coarser grid permits everything that a finer one permits.
    ///
    /// # Errors
    /// If an adapter reports something that no specification permits.
    pub fn checked(mut self) -> Result<Self, LimitError> {
        self.sub_pixel_bits = self.sub_pixel_bits.min(MAX_SUB_PIXEL_BITS);
        // Rounding to a coarser grid permits more.
        let coarsened = |bits: u8| bits.min(MAX_FRACTION_BITS);
        self.viewport_bits = self.viewport_bits.map(coarsened);
        self.texel_bits = self.texel_bits.map(coarsened);
        let counts = self.formats.values().flat_map(|f| f.samples.iter());
        for count in counts.chain(self.sample_positions.keys()) {
            if !count.is_power_of_two() || *count > MAX_SAMPLES {
                return Err(LimitError::Samples(*count));
            }
        }
        for (&samples, positions) in &self.sample_positions {
            if positions.len() != samples as usize {
                return Err(LimitError::Positions {
                    samples,
                    positions: positions.len(),
                });
            }
            for (sample, &position) in positions.iter().enumerate() {
                if position.iter().any(|axis| *axis > TEXEL) {
                    return Err(LimitError::Outside {
                        samples,
                        sample,
                        position,
                    });
                }
            }
        }
        for (&format, support) in &self.formats {
            let known = format.depth_encodings();
            let unknown = support.depth.iter().find(|e| !known.contains(e));
            if unknown.is_some() || support.depth.is_empty() && !known.is_empty() {
                return Err(LimitError::Depth {
                    format,
                    encoding: unknown.copied(),
                });
            }
        }
        Ok(self)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::api::Api;
    use crate::image::ReadPath;
    use crate::limits::FormatSupport;
    use crate::samples::standard_sample_positions;

    fn limits() -> Limits {
        let format = |format: TextureFormat| FormatSupport {
            samples: vec![1, 4],
            blendable: false,
            depth: format.depth_encodings().to_vec(),
            read: ReadPath::Copy,
        };
        let formats = [TextureFormat::Rgba8Unorm, TextureFormat::Depth24Plus];
        Limits {
            sub_pixel_bits: 8,
            max_size: u32::MAX,
            max_color_attachments: u32::MAX,
            formats: formats.into_iter().map(|f| (f, format(f))).collect(),
            sample_positions: [1, 4].map(|n| (n, standard_sample_positions(n))).into(),
            ..Limits::nothing(Api::Vulkan)
        }
    }

    #[test]
    fn a_grid_that_is_too_fine_becomes_the_finest_that_can_be_judged() {
        for bits in 0..=u8::MAX {
            let mut reported = limits();
            reported.sub_pixel_bits = bits;
            let checked = reported.checked().map(|l| l.sub_pixel_bits);
            assert_eq!(checked, Ok(bits.min(MAX_SUB_PIXEL_BITS)));
        }
    }

    #[test]
    fn limits_that_no_specification_permits_are_named() {
        let refused = |spoil: &dyn Fn(&mut Limits)| {
            let mut limits = limits();
            spoil(&mut limits);
            limits.checked().map_err(|e| e.to_string()).unwrap_err()
        };
        for count in [0, 3, 128, u32::MAX] {
            let text = refused(&|l| {
                let format = l.formats.get_mut(&TextureFormat::Rgba8Unorm).unwrap();
                format.samples.push(count);
            });
            assert!(text.starts_with(&format!("{count} samples")), "{text}");
            let text = refused(&|l| {
                l.sample_positions.insert(count, Vec::new());
            });
            assert!(text.starts_with(&format!("{count} samples")), "{text}");
        }
        let text = refused(&|l| {
            l.sample_positions.insert(4, vec![[128, 128]]);
        });
        assert_eq!(text, "1 sample positions for 4 samples");
        let text = refused(&|l| {
            l.sample_positions.insert(1, vec![[128, 257]]);
        });
        assert_eq!(
            text,
            "sample 0 of 1 at 128/256, 257/256, which is outside the texel"
        );
        let depth = |encodings: Vec<ChannelEncoding>| {
            refused(&|l| {
                let format = l.formats.get_mut(&TextureFormat::Depth24Plus).unwrap();
                format.depth.clone_from(&encodings);
            })
        };
        assert_eq!(depth(Vec::new()), "nothing as the depth of depth24plus");
        let text = depth(vec![ChannelEncoding::Unorm(200)]);
        assert!(text.ends_with(" as the depth of depth24plus"), "{text}");
    }
}
