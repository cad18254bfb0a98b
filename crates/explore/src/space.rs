//! The space of scenes: the features of the adapters that will draw them.
//!
//! Scenes that no adapter draws find nothing, so features that all adapters lack are never chosen. Missing
//! combinations, such as a format with several samples, are left to the check of each scene.

use etalon_frame::{Feature, Limits, PathValue, TextureFormat};
use std::collections::{BTreeMap, BTreeSet};

/// The formats, features and paths that scenes may use.
#[derive(Clone, Debug, Default)]
pub struct Space {
    pub(crate) color: Vec<TextureFormat>,
    pub(crate) depth_stencil: Vec<TextureFormat>,
    /// The sample counts above 1 of each format.
    pub(crate) samples: BTreeMap<TextureFormat, BTreeSet<u32>>,
    pub(crate) blendable: BTreeSet<TextureFormat>,
    pub(crate) features: BTreeSet<Feature>,
    pub(crate) paths: Vec<PathValue>,
    pub(crate) most_color: u32,
}

impl Space {
    /// Returns the space of adapters: everything that any of them supports.
    pub fn of<'l>(limits: impl IntoIterator<Item = &'l Limits>) -> Self {
        let mut space = Self::default();
        let mut drawn = BTreeSet::new();
        let mut paths: BTreeSet<PathValue> = BTreeSet::new();
        for limits in limits {
            for (format, support) in &limits.formats {
                if support.samples.is_empty() {
                    continue;
                }
                drawn.insert(*format);
                let several = support.samples.iter().copied().filter(|n| *n > 1);
                space.samples.entry(*format).or_default().extend(several);
                if support.blendable {
                    space.blendable.insert(*format);
                }
            }
            space.features.extend(&limits.features);
            paths.extend(&limits.paths);
            space.most_color = space.most_color.max(limits.max_color_attachments);
        }
        let (color, depth_stencil) = drawn.into_iter().partition(|f| f.is_color());
        space.color = color;
        space.depth_stencil = depth_stencil;
        space.paths = paths.into_iter().filter(|p| !p.is_default()).collect();
        space
    }

    /// Returns true if any adapter has a feature.
    pub(crate) fn has(&self, feature: Feature) -> bool {
        self.features.contains(&feature)
    }
}
