//! A page's description of its device, as an adapter.

use crate::device::{Abilities, Device};
use crate::message::Hello;
use crate::offer::{DeviceLimits, Level, Offer, standard_formats};
use etalon_frame::{AdapterInfo, DeviceOffer, Feature};
use std::collections::BTreeSet;

/// Words in the names of software rasterizers.
const SOFTWARE: [&str; 4] = ["swiftshader", "llvmpipe", "warp", "basic render"];

/// The largest alignment of an offset in a buffer that a device can need.
const MAX_ALIGNMENT: u32 = 256;

/// Returns the adapter of a page.
pub fn info(name: &str, hello: &Hello) -> AdapterInfo {
    let adapter = &hello.adapter;
    let parts = [&adapter.description, &adapter.vendor, &adapter.architecture];
    let words = parts.map(|part| part.to_lowercase()).join(" ");
    let software = adapter.fallback || SOFTWARE.iter().any(|word| words.contains(word));
    let named = [&adapter.vendor, &adapter.architecture, &adapter.device];
    let named: Vec<&str> = named
        .into_iter()
        .map(String::as_str)
        .filter(|part| !part.is_empty())
        .collect();
    let device = match (adapter.description.as_str(), named.join(" ").as_str()) {
        ("", "") if software => "a software rasterizer without a name".to_owned(),
        ("", "") => "a device without a name".to_owned(),
        ("", named) => named.to_owned(),
        (description, _) => description.to_owned(),
    };
    AdapterInfo {
        name: name.to_owned(),
        backend: "webgpu".to_owned(),
        device,
        driver: hello.browser.name.clone(),
        driver_version: hello.browser.version.clone(),
        driver_id: std::iter::once("WebGPU")
            .chain(named)
            .collect::<Vec<_>>()
            .join(", "),
        api_version: if hello.offer.compatibility {
            "WebGPU, compatibility mode".to_owned()
        } else {
            "WebGPU".to_owned()
        },
        software,
        offer: Some(hello.offer.clone()),
    }
}

/// Returns the facts about a device that lowering uses, or the reason if a limit is missing or
/// impossible.
pub fn device(offer: &DeviceOffer) -> Result<Device, String> {
    let has = |name: &str| offer.features.iter().any(|feature| feature == name);
    let limit = |name: &str| {
        let value = offer.limits.get(name);
        let value = value.and_then(|value| u32::try_from(*value).ok());
        value.ok_or_else(|| format!("the device does not report the limit {name}"))
    };
    // WebGPU: Limits. An alignment is a power of two, and the largest is the default.
    let alignment = |name: &str| match limit(name)? {
        value if value.is_power_of_two() && value <= MAX_ALIGNMENT => Ok(value),
        value => Err(format!(
            "the device reports {value} as the limit {name}, which must be a power of two up to {MAX_ALIGNMENT}"
        )),
    };
    let storage = limit("maxStorageBuffersInFragmentStage")
        .or_else(|_| limit("maxStorageBuffersPerShaderStage"))?;
    let core = !offer.compatibility;
    let level = if core {
        Level::Core
    } else {
        Level::Compatibility
    };
    Ok(Device::new(Offer {
        formats: standard_formats(level, has),
        abilities: Abilities {
            copies: true,
            casts: core,
            layers: core,
        },
        features: features(core, has, storage > 0),
        indirect: true,
        indirect_first_instance: has("indirect-first-instance"),
        level,
        limits: DeviceLimits {
            texture_2d: limit("maxTextureDimension2D")?,
            texture_3d: limit("maxTextureDimension3D")?,
            color_attachments: limit("maxColorAttachments")?,
            color_bytes_per_sample: limit("maxColorAttachmentBytesPerSample")?,
            uniform_alignment: alignment("minUniformBufferOffsetAlignment")?,
            storage_alignment: alignment("minStorageBufferOffsetAlignment")?,
        },
    }))
}

/// Returns the features that a device has, beyond the ones that every device has.
fn features(core: bool, has: impl Fn(&str) -> bool, storage: bool) -> BTreeSet<Feature> {
    let found = [
        (Feature::BaseVertex, true),
        (Feature::ClipDistances, has("clip-distances")),
        (Feature::DepthBiasClamp, core),
        (Feature::DepthClamp, has("depth-clip-control")),
        (Feature::DualSourceBlending, has("dual-source-blending")),
        (Feature::FragmentStorage, storage),
        (Feature::IndependentBlend, core),
        (Feature::SampleInterpolation, core),
        (Feature::SampleShading, core),
        (Feature::StorageCounters, storage),
    ];
    let found = found.into_iter().filter(|(_, has)| *has);
    found.map(|(feature, _)| feature).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn offer(alignment: u64) -> DeviceOffer {
        let limits = [
            ("maxStorageBuffersPerShaderStage", 8),
            ("maxTextureDimension2D", u64::from(u32::MAX)),
            ("maxTextureDimension3D", 2048),
            ("maxColorAttachments", 8),
            ("maxColorAttachmentBytesPerSample", 32),
            ("minUniformBufferOffsetAlignment", alignment),
            ("minStorageBufferOffsetAlignment", 256),
        ];
        DeviceOffer {
            compatibility: false,
            features: Vec::new(),
            limits: limits.map(|(name, value)| (name.to_owned(), value)).into(),
        }
    }

    #[test]
    fn an_impossible_alignment_is_an_error_that_names_it() {
        for alignment in [1, 32, 256] {
            assert!(device(&offer(alignment)).is_ok(), "{alignment}");
        }
        for alignment in [0, 3, 512, 1 << 31] {
            let error = device(&offer(alignment)).err().unwrap_or_default();
            let words = format!("reports {alignment} as the limit minUniformBufferOffsetAlignment");
            assert!(error.contains(&words), "{error}");
        }
    }
}
