//! The limits of an adapter, and the requirements that are compared with them.

use crate::api::Api;
use crate::encoding::ChannelEncoding;
use crate::feature::Feature;
use crate::format::TextureFormat;
use crate::image::ReadPath;
use crate::path::PathValue;
use crate::property::Property;
use crate::version::ApiVersion;
use serde::{Deserialize, Serialize};
use std::collections::{BTreeMap, BTreeSet};
use std::fmt;

/// One thing that a scene needs from an adapter.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Requirement {
    /// A capability.
    Feature(Feature),
    /// Textures of this format that can be uploaded or cleared, fetched from and read back.
    Format(TextureFormat),
    /// Attachments of this format that can be drawn to.
    Drawing(TextureFormat),
    /// Blending into attachments of this format.
    Blending(TextureFormat),
    /// At least this many colour attachments in one pass.
    ColorAttachments(u32),
    /// This many samples per texel in this format.
    Samples(TextureFormat, u32),
    /// Attachments of at least this width and height.
    Size(u32),
    /// A storage buffer of this many bytes, which is more than every API supports.
    Storage(u64),
    /// A way to the driver other than the default.
    Path(PathValue),
}

impl fmt::Display for Requirement {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Feature(feature) => write!(f, "feature {}", feature.name()),
            Self::Format(format) => write!(f, "format {format}"),
            Self::Drawing(format) => write!(f, "drawing to {format}"),
            Self::Blending(format) => write!(f, "blending into {format}"),
            Self::ColorAttachments(n) => write!(f, "{n} colour attachments"),
            Self::Samples(format, n) => write!(f, "{n} samples of {format}"),
            Self::Size(size) => write!(f, "attachments of {size} texels a side"),
            Self::Storage(bytes) => write!(f, "a storage buffer of {bytes} bytes"),
            Self::Path(value) => write!(f, "path {value}"),
        }
    }
}

/// The support of one format by an adapter.
#[derive(Clone, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct FormatSupport {
    /// Sample counts of attachments that can be drawn to and read back; empty if the format can only be
    /// uploaded and fetched from.
    pub samples: Vec<u32>,
    /// True if attachments of the format can be blended into.
    pub blendable: bool,
    /// The actual encoding of the depth aspect; empty for formats without depth. There are several if the API
    /// does not reveal it: then all of a frame has the same one of them.
    pub depth: Vec<ChannelEncoding>,
    /// The way to read back the depth aspect, or the colour aspect of a format without depth.
    pub read: ReadPath,
}

/// The limits of an adapter that matter to the suite.
#[derive(Clone, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Limits {
    /// The API whose rules bind the adapter.
    pub api: Api,
    /// The version of the specification that binds the adapter; 0.0 if the API has none, or in older records.
    #[serde(default)]
    pub version: ApiVersion,
    /// The promises that narrow what the specification permits.
    #[serde(default)]
    pub properties: BTreeSet<Property>,
    /// Bits of sub-pixel precision in vertex positions; the API's minimum if the adapter does not report
    /// them.
    pub sub_pixel_bits: u8,
    /// Bits of sub-pixel precision in the bounds of viewports; `None` if the adapter does not report them, and in
    /// older records.
    #[serde(default)]
    pub viewport_bits: Option<u8>,
    /// Bits of sub-texel precision in filtering, likewise.
    #[serde(default)]
    pub texel_bits: Option<u8>,
    /// The largest width and height of an attachment.
    pub max_size: u32,
    /// The largest storage buffer in bytes; `None` if the adapter does not report it, and in older records.
    #[serde(default)]
    pub max_storage: Option<u64>,
    /// The maximum number of colour attachments in one pass.
    pub max_color_attachments: u32,
    /// The formats that attachments can have, with what can be done with each.
    pub formats: BTreeMap<TextureFormat, FormatSupport>,
    /// The optional features that scenes can use.
    pub features: BTreeSet<Feature>,
    /// The supported ways to the driver other than the defaults; empty in older records.
    #[serde(default)]
    pub paths: BTreeSet<PathValue>,
    /// Requirements that are unmet although the driver does not deny them: the backend does not use what the
    /// driver offers, or the driver claims less than the API.
    #[serde(default)]
    pub exempt: BTreeSet<Requirement>,
    /// Sample positions in units of 1/256 texel from the top left corner, per sample count.
    pub sample_positions: BTreeMap<u32, Vec<[u16; 2]>>,
}

impl Limits {
    /// Returns the limits of an adapter that can do nothing and says nothing.
    pub fn nothing(api: Api) -> Self {
        Self {
            api,
            version: ApiVersion::UNKNOWN,
            properties: BTreeSet::new(),
            sub_pixel_bits: 0,
            viewport_bits: None,
            texel_bits: None,
            max_size: 0,
            max_storage: None,
            max_color_attachments: 0,
            formats: BTreeMap::new(),
            features: BTreeSet::new(),
            paths: BTreeSet::new(),
            exempt: BTreeSet::new(),
            sample_positions: BTreeMap::new(),
        }
    }

    /// Returns the first requirement that is not met.
    pub fn missing(&self, requirements: &[Requirement]) -> Option<Requirement> {
        requirements.iter().copied().find(|r| !self.meets(*r))
    }

    fn meets(&self, requirement: Requirement) -> bool {
        match requirement {
            Requirement::Feature(feature) => self.features.contains(&feature),
            Requirement::Format(format) => self.formats.contains_key(&format),
            Requirement::Drawing(format) => self
                .formats
                .get(&format)
                .is_some_and(|support| !support.samples.is_empty()),
            Requirement::Blending(format) => self
                .formats
                .get(&format)
                .is_some_and(|support| support.blendable),
            Requirement::ColorAttachments(n) => n <= self.max_color_attachments,
            Requirement::Samples(format, n) => self
                .formats
                .get(&format)
                .is_some_and(|support| support.samples.contains(&n)),
            Requirement::Size(size) => size <= self.max_size,
            Requirement::Storage(bytes) => self.max_storage.is_some_and(|most| bytes <= most),
            Requirement::Path(value) => value.is_default() || self.paths.contains(&value),
        }
    }

    /// Returns these limits once per possible depth encoding of the given formats, each with only that
    /// encoding: a format with an unknown encoding has the same one for a whole frame, never one per texel.
    /// Two formats can differ in their choice.
    pub fn alternatives(&self, formats: &[TextureFormat]) -> Vec<Self> {
        let mut variants = vec![self.clone()];
        for format in formats {
            let Some(support) = self.formats.get(format) else {
                continue;
            };
            if support.depth.len() < 2 {
                continue;
            }
            variants = variants
                .iter()
                .flat_map(|limits| {
                    support.depth.iter().map(|encoding| {
                        let mut variant = limits.clone();
                        if let Some(entry) = variant.formats.get_mut(format) {
                            entry.depth = vec![*encoding];
                        }
                        variant
                    })
                })
                .collect();
        }
        variants
    }
}
