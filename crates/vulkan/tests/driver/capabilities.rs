//! Limits, formats and adapters, as Vulkan requires them and as lavapipe has them.

use crate::drivers::{backend, is_lavapipe};
use etalon_backend::Backend;
use etalon_frame::{Api, Feature, ReadPath, TextureFormat};
use etalon_vulkan::{VulkanOptions, enumerate, open};

#[test]
fn limits_are_those_of_the_device() {
    let backend = backend(false);
    let limits = backend.limits();
    assert_eq!(limits.api, Api::Vulkan);
    for (format, support) in &limits.formats {
        assert!(!is_lavapipe() || support.samples.first() == Some(&1));
        let four = !is_lavapipe() || !format.is_color() || support.samples == [1, 4];
        assert!(four, "{format}");
        assert_eq!(support.read, ReadPath::Copy);
        assert_eq!(support.depth.len(), usize::from(format.has_depth()));
    }
    // Features of all Vulkan devices; lavapipe's description has its own.
    for feature in [
        Feature::ReversedDepthRange,
        Feature::TriangleFans,
        Feature::RasterizerDiscard,
    ] {
        assert!(limits.features.contains(&feature), "{}", feature.name());
    }
}

/// Vulkan, Mandatory Format Support.
#[test]
fn required_formats_are_blendable() {
    let backend = backend(false);
    for format in [
        TextureFormat::R8Unorm,
        TextureFormat::Rg8Unorm,
        TextureFormat::Rgba8Unorm,
        TextureFormat::Rgba8UnormSrgb,
        TextureFormat::Bgra8Unorm,
        TextureFormat::Rgb10a2Unorm,
        TextureFormat::Bgr5a1Unorm,
        TextureFormat::Rgba16Float,
    ] {
        let support = backend.limits().formats.get(&format);
        assert!(support.is_some_and(|s| s.blendable), "{format}");
    }
}

#[test]
fn adapters_are_named_by_their_drivers() {
    let adapters = enumerate().expect("these tests need a Vulkan driver");
    for adapter in &adapters {
        assert!(adapter.name.len() > "vulkan:".len() && adapter.name.starts_with("vulkan:"));
        assert_eq!(adapter.backend, "vulkan");
        assert!(!adapter.driver_id.is_empty());
    }
}

#[test]
fn a_missing_device_is_unavailable() {
    let options = VulkanOptions {
        device: 1000,
        validate: false,
        fault: None,
        record: false,
    };
    let error = open("vulkan:none", &options).map(|_| ()).unwrap_err();
    assert!(error.reason.contains("1000"), "{error}");
}
