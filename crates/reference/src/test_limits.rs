//! Limits for tests.

use etalon_frame::{Api, ApiVersion, Feature, FormatSupport, Limits, ReadPath, TextureFormat};

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
        api,
        version: ApiVersion::UNKNOWN,
        properties: Default::default(),
        exempt: Default::default(),
        sub_pixel_bits: 8,
        viewport_bits: Some(8),
        texel_bits: None,
        max_size: 4096,
        max_color_attachments: 8,
        formats,
        features: Feature::ALL.into_iter().collect(),
        paths: Default::default(),
        sample_positions: [(1, vec![[128, 128]])].into_iter().collect(),
    }
}
