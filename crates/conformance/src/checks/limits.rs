//! Limits that every driver of every API has.

use super::CheckEnd;
use crate::subject::CheckedBackend;
use etalon_frame::{Api, ReadPath, TextureFormat};

/// The required limits: Vulkan, Required Limits; OpenGL 4.6, tables 23.53 and 23.58; WebGPU, limits.
pub(crate) fn limits_are_at_least_the_required_ones(s: &CheckedBackend) -> CheckEnd {
    let limits = s.limits();
    assert!(limits.sub_pixel_bits >= 4);
    assert!(limits.max_size >= 4096);
    assert!(limits.max_color_attachments >= 4);
    assert_eq!(limits.sample_positions[&1], [[128, 128]]);
    for positions in &limits.sample_positions {
        assert_eq!(*positions.0 as usize, positions.1.len());
    }
    Ok(())
}

pub(crate) fn formats_are_described_without_contradiction(s: &CheckedBackend) -> CheckEnd {
    for format in TextureFormat::ALL.iter().copied() {
        let Some(support) = s.limits().formats.get(&format) else {
            println!("{format}: not offered");
            continue;
        };
        println!("{format}: {support:?}");
        assert!(matches!(support.samples[..], [] | [1, ..]), "{format}");
        assert!(format.is_color() || !support.blendable, "{format}");
        assert_eq!(support.depth.is_empty(), !format.has_depth(), "{format}");
        let encodings = format.depth_encodings();
        assert!(
            support.depth.iter().all(|d| encodings.contains(d)),
            "{format}"
        );
        // OpenGL ES cannot copy depths.
        let shader = s.limits().api == Api::OpenGlEs && format.has_depth();
        assert!(support.read == ReadPath::Copy || shader || s.limits().api == Api::WebGpu);
    }
    Ok(())
}
