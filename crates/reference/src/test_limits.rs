//! Limits for tests.

use etalon_frame::{Api, Feature, FormatSupport, Limits, ReadPath, TextureFormat};

/// Returns the limits of an adapter that has every feature, reads everything back by a copy, and has 8
/// sub-pixel bits.
pub(crate) fn limits(api: Api) -> Limits {
    let formats = TextureFormat::ALL
        .into_iter()
        .map(|format| {
            let support = FormatSupport {
                samples: vec![1],
                blendable: true,
                depth: format.depth_encodings().iter().copied().take(1).collect(),
                read: ReadPath::Copy,
            };
            (format, support)
        })
        .collect();
    Limits {
        sub_pixel_bits: 8,
        viewport_bits: Some(8),
        max_size: 4096,
        max_color_attachments: 8,
        formats,
        features: Feature::ALL.into_iter().collect(),
        sample_positions: [(1, vec![[128, 128]])].into_iter().collect(),
        ..Limits::nothing(api)
    }
}
