//! Innocents: the rasterizer with what some specification permits, alone or as a family of hardware combines it.

use crate::changes;
use crate::mutant::Mutant;
use crate::permission::{UsedPermission, under};
use etalon_backend::Backend;
use etalon_cpu::CpuBackend;
use etalon_frame::{Api, ApiVersion, Feature, Grade, Limits, Property};
use etalon_reference::Rules;
use etalon_reference::rules::{ConstantClamp, DepthRange, MaskOfOne, SignedClamp, SrgbLogic};
use std::collections::BTreeSet;
use std::sync::LazyLock;

/// The rasterizer with legal changes. No specification that permits all of them may fail it.
#[derive(Clone, Debug)]
pub struct Innocent {
    /// The stable name: that of the change, or `profile/` and that of the hardware.
    pub name: String,
    /// The behaviour, in one sentence.
    pub about: String,
    /// The hardware or driver that behaves so.
    pub source: &'static str,
    /// The names of the changes that a profile combines.
    pub parts: &'static [&'static str],
    /// The permissions that the rasterizer uses unchanged.
    own: Vec<UsedPermission>,
    pub(super) changes: Vec<&'static Mutant>,
}

impl Innocent {
    /// Returns true if it is the rasterizer itself.
    pub fn is_itself(&self) -> bool {
        self.changes.is_empty()
    }

    /// Returns the names of the permissions that it uses, which are fields of [`Rules`].
    pub fn permissions(&self) -> BTreeSet<&'static str> {
        let used = self.changes.iter().flat_map(|change| &change.permissions);
        self.own.iter().chain(used).map(|used| used.name).collect()
    }

    /// Returns the changes that count under a specification: of a profile, the permitted ones.
    fn changes_under(&self, specification: &Limits) -> Vec<&'static Mutant> {
        let is_permitted = |change: &&Mutant| {
            let limits = change.reported(specification.clone());
            change.forbidden_by(&Rules::of(&limits)).is_none()
        };
        let changes = self.changes.iter().copied();
        changes
            .filter(|change| self.parts.is_empty() || is_permitted(change))
            .collect()
    }

    /// Returns the name of its backend under a specification, for [`MutantBackend::new`](crate::MutantBackend::new).
    pub fn backend(&self, specification: &Limits) -> String {
        let changes = self.changes_under(specification);
        let names: Vec<&str> = changes.iter().map(|change| change.name.as_str()).collect();
        names.join("+")
    }

    /// Returns the limits that an adapter that behaves so reports under a specification.
    pub fn limits(&self, specification: &Limits) -> Limits {
        let changes = self.changes_under(specification).into_iter();
        changes.fold(specification.clone(), |limits, change| {
            change.reported(limits)
        })
    }

    /// Returns the strongest evidence by which a specification forbids the behaviour; `None` if it permits it.
    pub fn forbidden_by(&self, specification: &Limits) -> Option<Grade> {
        let rules = Rules::of(&self.limits(specification));
        let own = self.own.iter().filter_map(|used| used.forbidden_by(&rules));
        let changes = self.changes_under(specification).into_iter();
        let each = changes.filter_map(|change| change.forbidden_by(&rules));
        own.chain(each).max()
    }
}

/// Hardware families: what one combines, as names of changes. Where a specification forbids a part, it is left out.
const PROFILES: &[(&str, &str, &[&str])] = &[
    (
        "tiler",
        "A tile-based GPU of phones: blends and resolves in codes, coarse positions and filters.",
        &[
            "blend/in-8-bits-times-plus-one",
            "freedom/resolve-halves-truncated",
            "freedom/vertices-floored",
            "freedom/subnormal-halves-flushed",
            "freedom/filter-in-16-steps",
            "samples/alpha-to-coverage-from-the-last",
            "sample-shading/rounded-up-to-a-power-of-two",
        ],
    ),
    (
        "direct3d-12",
        "A GPU behind Direct3D 12: fused float blends, unclamped signed factors, late conversion of depth, fine filters.",
        &[
            "freedom/float-blends-fused",
            "format/snorm8-inverse-factors-out-of-range",
            "freedom/own-depth-compared-unconverted",
            "freedom/filter-in-256-steps",
        ],
    ),
    (
        "half-exports",
        "A GPU that exports colours as 16-bit floats, doubles the bias of float depth and averages codes of sRGB.",
        &[
            "freedom/exported-as-halves",
            "bias/float-step-doubled",
            "freedom/slope-root",
            "depth/d16-truncated",
            "sample-shading/all-samples",
            "resolve/srgb-encoded",
        ],
    ),
    (
        "apple",
        "An integrated GPU: whole viewports, inputs at covered samples, blends in 16-bit floats, another fill rule.",
        &[
            "freedom/whole-viewports",
            "freedom/inputs-at-a-covered-sample",
            "freedom/blends-in-halves",
            "freedom/bottom-right-rule",
            "format/float16-truncated",
            "clear/color-rounded-down",
        ],
    ),
];

/// Returns all innocents: the rasterizer itself, each change that some permission is for, and the profiles.
pub fn innocents() -> &'static [Innocent] {
    static ALL: LazyLock<Vec<Innocent>> = LazyLock::new(|| {
        let itself = Innocent {
            name: "itself".to_owned(),
            about: "The rasterizer, unchanged.".to_owned(),
            source: "the rasterizer",
            parts: &[],
            // OpenGL's shader masks do nothing to a single sample, and 3.3 clamps and applies more than later versions.
            own: vec![
                under!(depth_range: DepthRange::Undefined | DepthRange::Either | DepthRange::ViewportIfWritten),
                under!(mask_of_one: MaskOfOne::Acts | MaskOfOne::Either),
                under!(covers_one_sample: true),
                under!(lines_cover_their_shape: false),
                under!(signed_clamp: SignedClamp::Signed | SignedClamp::Either),
                under!(constant_clamp: ConstantClamp::Never | ConstantClamp::Either),
                under!(srgb_logic: SrgbLogic::PassesThrough | SrgbLogic::Either),
            ],
            changes: Vec::new(),
        };
        let permitted = changes()
            .iter()
            .filter(|change| !change.permissions.is_empty());
        let single = permitted.map(|change| Innocent {
            name: change.name.clone(),
            about: change.about.clone(),
            source: change.source,
            parts: &[],
            own: Vec::new(),
            changes: vec![change],
        });
        let profiles = PROFILES.iter().map(|(name, about, parts)| Innocent {
            name: format!("profile/{name}"),
            about: (*about).to_owned(),
            source: "a family of hardware",
            parts,
            own: Vec::new(),
            changes: changes()
                .iter()
                .filter(|change| parts.contains(&change.name.as_str()))
                .collect(),
        });
        std::iter::once(itself)
            .chain(single)
            .chain(profiles)
            .collect()
    });
    &ALL
}

/// Returns the limits of the rasterizer under each specification that differs from others.
pub fn specifications() -> Vec<Limits> {
    let own = CpuBackend::spans("cpu").limits().clone();
    let none: &[Property] = &[];
    [
        (Api::Vulkan, (1, 1), none),
        (Api::Vulkan, (1, 4), &Property::ALL),
        (Api::OpenGl, (3, 3), none),
        (Api::OpenGl, (4, 6), &[Property::DepthFromZero]),
        (Api::OpenGlEs, (3, 0), none),
        (Api::OpenGlEs, (3, 2), none),
        (Api::WebGpu, (0, 0), none),
    ]
    .into_iter()
    .map(|(api, (major, minor), properties)| {
        let mut features = own.features.clone();
        if api == Api::WebGpu {
            // WebGPU has none, so that its text does not say what they do.
            features.remove(&Feature::ForcedEarlyTests);
            features.remove(&Feature::ForcedEarlyTestsWithDepth);
        }
        Limits {
            api,
            version: ApiVersion::new(major, minor),
            properties: properties.iter().copied().collect(),
            features,
            ..own.clone()
        }
    })
    .collect()
}
