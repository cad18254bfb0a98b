//! Limits that every driver of every API has.

use super::CheckEnd;
use crate::subject::CheckedBackend;
use etalon_frame::{Api, ReadPath, Requirement, TextureFormat};

/// The required limits: Vulkan, Required Limits; OpenGL 4.6, tables 23.53 and 23.58; WebGPU, limits.
pub(crate) fn limits_are_at_least_the_required_ones(s: &CheckedBackend) -> CheckEnd {
    let limits = s.limits();
    let needs = |least: Requirement, most: Requirement| {
        assert!(
            limits.missing(&[least]).is_none() || limits.exempt.contains(&most),
            "{least}"
        );
    };
    assert!(limits.sub_pixel_bits >= 4, "sub-pixel bits");
    needs(Requirement::Size(4096), Requirement::Size(u32::MAX));
    needs(
        Requirement::ColorAttachments(4),
        Requirement::ColorAttachments(u32::MAX),
    );
    assert_eq!(limits.sample_positions[&1], [[128, 128]]);
    for positions in &limits.sample_positions {
        assert_eq!(*positions.0 as usize, positions.1.len());
    }
    Ok(())
}

pub(crate) fn formats_are_described_without_contradiction(s: &CheckedBackend) -> CheckEnd {
    for format in TextureFormat::ALL.iter().copied() {
        let Some(support) = s.limits().formats.get(&format) else {
            continue;
        };
        assert!(matches!(support.samples[..], [] | [1, ..]), "{format}");
        assert!(format.is_color() || !support.blendable, "{format}");
        assert_eq!(support.depth.is_empty(), !format.has_depth(), "{format}");
        let encodings = format.depth_encodings();
        assert!(
            support.depth.iter().all(|d| encodings.contains(d)),
            "{format}"
        );
        // OpenGL ES cannot copy depths, and programs send them as floats.
        let sends_floats = s.adapter().backend == "external";
        let shader = format.has_depth() && (s.limits().api == Api::OpenGlEs || sends_floats);
        let copied = support.read == ReadPath::Copy || shader || s.limits().api == Api::WebGpu;
        assert!(copied, "{format}");
    }
    Ok(())
}
