//! The permissions of each specification: data with citations, one file per API, so that a reader can
//! hold each against its text.
//!
//! If a text is silent, the union of the other APIs' permissions holds: never nothing, never the
//! tightest. The yardstick is not a permission but the quality band: 32-bit float arithmetic on exact
//! inputs, one conversion within 0.6 codes at the store, the adapter's own sub-pixel bits, the top-left
//! rule.

mod invariance;
mod opengl;
mod opengl_es;
mod permission;
mod sample_shading;
mod vulkan;
mod webgpu;
mod yardstick;

pub use permission::{
    BiasUnit, BlendPrecision, DepthOrder, DepthRange, EarlyUpdates, FactorClamp, Permission,
    Resolve, Rounding, Rules, SameDepth, SamplesCounted, SharedEdge, Snap,
};
pub use sample_shading::ShadedAt;

use etalon_frame::{Api, Limits};

impl Rules {
    /// Returns the permissions of an API.
    pub fn of(api: Api) -> Self {
        match api {
            Api::Vulkan => vulkan::rules(),
            Api::OpenGl => opengl::rules(),
            Api::OpenGlEs => opengl_es::rules(),
            Api::WebGpu => webgpu::rules(),
        }
    }

    /// Returns the quality band for an adapter.
    pub fn yardstick(limits: &Limits) -> Self {
        yardstick::rules(limits.api)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_permission_has_a_citation() {
        for api in [Api::Vulkan, Api::OpenGl, Api::OpenGlEs, Api::WebGpu] {
            let rules = Rules::of(api);
            assert_eq!(rules.name, api.name());
            for citation in [
                rules.float_error.citation,
                rules.shader_error.citation,
                rules.decode_error.citation,
                rules.snap.citation,
                rules.shared_edge.citation,
                rules.store.citation,
                rules.blend.citation,
                rules.depth_order.citation,
                rules.depth_bias_unit.citation,
                rules.depth_range.citation,
                rules.factor_clamp.citation,
                rules.resolve.citation,
                rules.points_face_front.citation,
                rules.outlines_face_as_polygons.citation,
                rules.early_updates.citation,
                rules.early_counts.citation,
                rules.samples_counted.citation,
                rules.same_depth.citation,
                rules.filter_step.citation,
                rules.flushes_small_floats.citation,
                rules.shader_runs,
                rules.alpha_to_coverage,
                rules.facing,
                rules.stencil,
                rules.write_mask,
            ] {
                assert!(citation.contains(':'), "{}: {citation:?}", rules.name);
            }
        }
    }
}
