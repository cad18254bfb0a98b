//! The permissions of each specification: data with citations, one file per API, so that a reader can compare
//! each with the specification.
//!
//! If a specification is silent, the union of the other APIs' permissions applies. The yardstick is not a
//! permission but the quality band: 32-bit float arithmetic on exact inputs, one conversion within 0.6 codes
//! at the store, the adapter's own sub-pixel bits, the top-left rule.

mod invariance;
mod opengl;
mod opengl_es;
mod permission;
pub mod required;
mod vulkan;
mod webgpu;
mod yardstick;

pub use permission::{
    AlphaToCoverage, BiasUnit, BlendPrecision, ConstantClamp, Copies, DepthOrder, DepthRange,
    DepthTerms, EarlyUpdates, FactorClamp, FlushedFloats, FragCoord, InputMaskRule, MaskOfOne,
    NegativeAlpha, Permission, Resolve, Rounding, Rules, SameDepth, SamplesCounted, SharedEdge,
    SignedClamp, SmallFloats, Snap, SrgbLogic,
};

use etalon_frame::{Api, Limits};

impl Rules {
    /// Returns the permissions of the specification that binds an adapter, by all evidence; see
    /// [`Rules::bound_by`].
    pub fn of(limits: &Limits) -> Self {
        match limits.api {
            Api::Vulkan => vulkan::rules(limits),
            Api::OpenGl => opengl::rules(limits),
            Api::OpenGlEs => opengl_es::rules(limits),
            Api::WebGpu => webgpu::rules(limits),
        }
    }

    /// Returns the quality band for an adapter.
    pub fn yardstick(limits: &Limits) -> Self {
        yardstick::rules(limits, &Self::of(limits))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::test_limits;
    use etalon_frame::{ApiVersion, Grade, Property};

    /// Returns limits for every version of a specification that was read.
    fn all_limits() -> Vec<Limits> {
        let versions = [
            (Api::Vulkan, [(1, 0), (1, 3), (1, 4)]),
            (Api::OpenGl, [(3, 3), (4, 5), (4, 6)]),
            (Api::OpenGlEs, [(3, 0), (3, 1), (3, 2)]),
            (Api::WebGpu, [(0, 0), (0, 0), (0, 0)]),
        ];
        let mut result = Vec::new();
        for (api, versions) in versions {
            for (major, minor) in versions {
                let mut limits = test_limits::limits(api);
                limits.version = ApiVersion::new(major, minor);
                result.push(limits.clone());
                limits.properties = Property::ALL.into_iter().collect();
                result.push(limits);
            }
        }
        result
    }

    #[test]
    fn every_permission_cites_its_own_specification() {
        for limits in all_limits() {
            let rules = Rules::of(&limits);
            assert_eq!(rules.name, limits.api.name());
            for (name, citation, _) in rules.permissions() {
                assert!(citation.contains(':'), "{name}: {citation:?}");
                // If a version lacks a feature, its rule cites the first version that has the feature. If an
                // API is silent, its rule names the other APIs.
                let title = rules.text.split(" (").next().expect("a name");
                let family = title.split(' ').next().expect("a word");
                assert!(
                    citation.contains(family) || citation.starts_with("WGSL"),
                    "{title}, {name}: {citation}"
                );
            }
        }
    }

    #[test]
    fn a_version_cites_its_own_sections() {
        let cited = |api, major, minor| {
            let mut limits = test_limits::limits(api);
            limits.version = ApiVersion::new(major, minor);
            let rules = Rules::of(&limits);
            (rules.text, rules.stencil)
        };
        assert_eq!(
            cited(Api::OpenGl, 3, 3),
            (
                "OpenGL 3.3 (core profile)",
                "OpenGL 3.3: 4.1.4 Stencil Test: integer operations"
            )
        );
        assert_eq!(
            cited(Api::OpenGl, 4, 6),
            (
                "OpenGL 4.6 (core profile)",
                "OpenGL 4.6: 17.3.3 Stencil Test: integer operations"
            )
        );
        assert_eq!(
            cited(Api::OpenGlEs, 3, 0),
            (
                "OpenGL ES 3.0",
                "OpenGL ES 3.0: 4.1.4 Stencil Test: integer operations"
            )
        );
    }

    #[test]
    fn leaving_out_weak_evidence_only_narrows_the_rules() {
        for limits in all_limits() {
            let rules = Rules::of(&limits);
            assert_eq!(rules.bound_by(Grade::Disputed), rules);
            let proven = rules.bound_by(Grade::Proven);
            let narrowed = rules
                .permissions()
                .iter()
                .any(|(_, _, grade)| *grade < Grade::Proven);
            assert_eq!(proven != rules, narrowed, "{}", rules.text);
        }
    }

    #[test]
    fn the_citations_of_two_versions_differ() {
        let rules_of = |major, minor| {
            let mut limits = test_limits::limits(Api::OpenGl);
            limits.version = ApiVersion::new(major, minor);
            Rules::of(&limits)
        };
        let (old, new) = (rules_of(3, 3), rules_of(4, 5));
        assert_eq!(old.signed_clamp.value, SignedClamp::Unit);
        assert_eq!(new.signed_clamp.value, SignedClamp::Signed);
        assert_eq!(old.srgb_logic.value, SrgbLogic::Applies);
        assert_eq!(new.srgb_logic.value, SrgbLogic::PassesThrough);
        // Version 3.3 was corrected later, so neither reading is proven wrong.
        let proven = old.bound_by(Grade::Proven);
        assert_eq!(proven.signed_clamp.value, SignedClamp::Either);
        assert_eq!(proven.srgb_logic.value, SrgbLogic::Either);
    }

    #[test]
    fn promised_properties_narrow_the_rules_of_vulkan() {
        let mut limits = test_limits::limits(Api::Vulkan);
        let open = Rules::of(&limits);
        assert_eq!(open.early_coverage.value, EarlyUpdates::Either);
        assert_eq!(open.early_updates.grade, Grade::RequiredByCts);
        assert!(!open.mask_acts_first.value && !open.clips_points_at_sides.value);
        limits.properties = Property::ALL.into_iter().collect();
        let pinned = Rules::of(&limits);
        assert_eq!(pinned.early_coverage.value, EarlyUpdates::Happen);
        assert_eq!(pinned.early_updates.grade, Grade::Proven);
        assert!(pinned.mask_acts_first.value && pinned.clips_points_at_sides.value);
    }
}
