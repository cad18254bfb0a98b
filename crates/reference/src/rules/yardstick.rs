//! The quality band, in the spirit of the Direct3D 11.3 functional specification.

use super::permission::{
    AlphaToCoverage, BiasUnit, BlendPrecision, DepthOrder, DepthRange, DepthTerms, EarlyUpdates,
    FactorClamp, FlushedFloats, Resolve, Rounding, Rules, SameDepth, SamplesCounted, SharedEdge,
    Snap, permit,
};
use etalon_frame::{Api, Limits};

/// The name of the band's rules.
const YARDSTICK: &str = "yardstick";

impl Rules {
    /// Returns true if these rules demand quality rather than legality.
    pub fn is_yardstick(&self) -> bool {
        self.name == YARDSTICK
    }
}

/// Returns the band for an adapter. `text` has the permissions of the adapter's API. If Direct3D demands
/// something else, the band forbids nothing that they allow. One entry per permission.
pub(super) fn rules(limits: &Limits, text: &Rules) -> Rules {
    let api = limits.api;
    // WebGPU does not report the sub-pixel grid, so nothing tighter than the API's rule can be demanded.
    let snap = match api {
        Api::WebGpu => Snap::EitherSide,
        _ => Snap::Nearest,
    };
    Rules {
        name: YARDSTICK,
        text: "the yardstick",
        // Two units in the last place of a 32-bit float: one rounding each for operand and result.
        float_error: permit(
            f64::from(f32::EPSILON),
            "Direct3D 11.3: 3.1 Floating Point Rules: 1 ULP",
        ),
        shader_error: permit(
            3.0 * f64::from(f32::EPSILON),
            "Yardstick: 32-bit floats, as Vulkan and WGSL have them: quotients within 2.5 ULP",
        ),
        decode_error: permit(
            f64::from(f32::EPSILON),
            "Direct3D 11.3: 3.2.3.5 UNORM to FLOAT: 1 ULP",
        ),
        restarts_before_base_vertex: permit(
            text.restarts_before_base_vertex.value,
            "Yardstick: as the API's text says",
        ),
        sub_pixel_bits: permit(
            limits.sub_pixel_bits,
            "Yardstick: the grid that the adapter reports",
        ),
        viewport_step: permit(0.0, "Yardstick: bounds are exact"),
        snap: permit(snap, "Direct3D 11.3: 3.4.1 Coordinate Snapping: nearest"),
        shared_edge: permit(SharedEdge::TopLeft, "Direct3D 11.3: 3.4.2.1 Top-Left Rule"),
        covers_at_positions: permit(true, "Yardstick: at the positions that are told"),
        store: permit(
            Rounding::Within(0.6),
            "Direct3D 11.3: 3.2.3.6 FLOAT to UNORM: 0.6 ULP",
        ),
        float32_blend_error: permit(
            f64::from(f32::EPSILON),
            "Direct3D 11.3: 3.1 Floating Point Rules: 1 ULP",
        ),
        weights_by_channel: permit(true, "Yardstick: in 32-bit floats"),
        blends_in_order: permit(true, "Yardstick: as the equation is written"),
        advanced_blend: permit(BlendPrecision::Float32, "Yardstick: in 32-bit floats"),
        blend: permit(
            BlendPrecision::Float32,
            "Direct3D 11.3: 17.5 Blending Precision, held to 32-bit float",
        ),
        signed_clamp: permit(text.signed_clamp.value, "Yardstick: as the API's text says"),
        signed_result: permit(
            text.signed_result.value,
            "Yardstick: as the API's text says",
        ),
        constant_clamp: permit(
            text.constant_clamp.value,
            "Yardstick: as the API's text says",
        ),
        one_is_first_output: permit(
            text.one_is_first_output.value,
            "Yardstick: as the API's text says",
        ),
        quotients_beyond_one: permit(
            text.quotients_beyond_one.value,
            "Yardstick: as the API's text says",
        ),
        negative_alpha: permit(
            text.negative_alpha.value,
            "Yardstick: as the API's text says",
        ),
        masks_reference: permit(true, "Yardstick: as Direct3D 11.3 has it (17.12)"),
        copies: permit(text.copies.value, "Yardstick: as the API's text says"),
        srgb_logic: permit(text.srgb_logic.value, "Yardstick: as the API's text says"),
        depth_order: permit(
            DepthOrder::ConvertedFirst,
            "Direct3D 11.3: 17.11 Depth Comparison: convert, then compare",
        ),
        depth_bias_unit: permit(
            BiasUnit {
                unorm16: &[(0.999, 1.001)],
                unorm: &[(0.999, 1.001)],
                float: &[(0.999, 1.001)],
                assumed: None,
            },
            "Direct3D 11.3: 15.10 Depth Bias: 1/2^n, for floats 2^(e-23)",
        ),
        slope_root: permit(text.slope_root.value, "Yardstick: as the API's text says"),
        bias_clamps_fragments: permit(
            true,
            "Yardstick: clamped behind the bias, as Direct3D 11.3 has it (15.10)",
        ),
        depth_terms: permit(
            DepthTerms::NearPlane,
            "Direct3D 11.3: 15.6 Viewport: depth from 0 to 1",
        ),
        depth_range: permit(
            DepthRange::Either,
            "Direct3D 11.3: 16.9 Depth Clamp: held to the viewport; OpenGL: to 0 and 1",
        ),
        factor_clamp: permit(
            match api {
                Api::WebGpu => FactorClamp::Either,
                _ => FactorClamp::Clamped,
            },
            "Direct3D 11.3: 17.6 Blending: as the API says",
        ),
        resolve: permit(Resolve::Average, "Direct3D 11.3: 19.2 Resolve: the average"),
        clips_points: permit(
            true,
            "Yardstick: nothing outside of the clip volume is drawn",
        ),
        clips_points_at_sides: permit(
            true,
            "Yardstick: nothing outside of the clip volume is drawn",
        ),
        clips_lines_at_sides: permit(
            true,
            "Yardstick: nothing outside of the clip volume is drawn",
        ),
        clips_lines_by_depth: permit(
            true,
            "Yardstick: nothing outside of the clip volume is drawn",
        ),
        keeps_lines_that_end_behind: permit(
            true,
            "Yardstick: all that is inside of the clip volume is drawn",
        ),
        clips_lines_by_distance: permit(
            true,
            "Yardstick: nothing outside of the clip volume is drawn",
        ),
        lines_cover_texels: permit(true, "Yardstick: no gap in a line"),
        lines_cover_their_shape: permit(
            false,
            "Direct3D 11.3: 3.4.3 aliased lines: the diamond-exit rule",
        ),
        lines_lack: permit(Some(0), "Yardstick: no gap in a line"),
        biases_lines: permit(
            false,
            "Direct3D 11.3: 15.10: points and lines are not biased",
        ),
        points_face_front: permit(
            api != Api::WebGpu,
            "Direct3D 11.3: 15.10: points and lines are front-facing",
        ),
        outlines_face_as_polygons: permit(true, "Direct3D 11.3: 15.10 Facing: of the triangle"),
        early_updates: permit(
            EarlyUpdates::Happen,
            "Yardstick: forced early tests come first, as Direct3D 11.3 has them (17.3)",
        ),
        early_coverage: permit(
            EarlyUpdates::Happen,
            "Yardstick: forced early tests come first, as Direct3D 11.3 has them (17.3)",
        ),
        early_mask: permit(
            EarlyUpdates::Happen,
            "Yardstick: forced early tests come first, as Direct3D 11.3 has them (17.3)",
        ),
        early_ignores_written: permit(
            text.early_ignores_written.value,
            "Yardstick: as the API's text says",
        ),
        covers_one_sample: permit(
            text.covers_one_sample.value,
            "Yardstick: as the API's text says",
        ),
        mask_of_one: permit(text.mask_of_one.value, "Yardstick: as the API's text says"),
        goes_on_unshaded: permit(true, "Yardstick: without a shader, as it was rasterized"),
        input_mask: permit(text.input_mask.value, "Yardstick: as the API's text says"),
        input_mask_lacks_masked: permit(
            text.input_mask_lacks_masked.value,
            "Yardstick: as the API's text says",
        ),
        mask_acts_first: permit(true, "Yardstick: the sample mask comes before all tests"),
        early_counts: permit(
            EarlyUpdates::Happen,
            "Yardstick: forced early tests come first, and counting with them",
        ),
        samples_counted: permit(
            SamplesCounted::Passing,
            "Yardstick: samples that pass, one by one",
        ),
        clears_count_nothing: permit(true, "Yardstick: samples of draws"),
        operations_count_nothing: permit(true, "Yardstick: samples of draws"),
        same_depth: permit(
            SameDepth::All,
            "Yardstick: the fragment's own depth is the same, written or not (Direct3D 11.3)",
        ),
        filter_step: permit(
            text.filter_step.value.min(1.0 / 256.0),
            "Yardstick: 8 bits of fraction (Direct3D 11.3, 7.18.7 and 7.18.8)",
        ),
        filters_to_codes: permit(false, "Yardstick: in floats"),
        half_overflows: permit(true, "Yardstick: the largest finite value or infinity"),
        flushes_small_floats: permit(
            FlushedFloats::None,
            "Yardstick: representable values are kept",
        ),
        small_floats: permit(text.small_floats.value, "Yardstick: as the API's text says"),
        runs_for_discarded: permit(true, "Yardstick: one run for every fragment"),
        runs_for_overwritten: permit(true, "Yardstick: one run for every fragment"),
        skips_rejected: permit(true, "Yardstick: one run for every fragment"),
        runs_once: permit(text.runs_once.value, "Yardstick: as the API's text says"),
        samples_as_told: permit(true, "Yardstick: as many as are told"),
        runs_by_share: permit(
            text.runs_by_share.value,
            "Yardstick: as the API's text says",
        ),
        alpha_to_coverage: permit(
            AlphaToCoverage::Ends,
            "Direct3D 11.3: 17.15 Alpha to Coverage: dither allowed",
        ),
        colorless_alpha_to_coverage: permit(
            AlphaToCoverage::Ends,
            "Direct3D 11.3: 17.15 Alpha to Coverage: dither allowed",
        ),
        sample_coverage: permit(AlphaToCoverage::Ends, "Yardstick: as alpha to coverage"),
        frag_coord: permit(text.frag_coord.value, "Yardstick: as the API's text says"),
        inputs_at_samples: permit(
            text.inputs_at_samples.value,
            "Yardstick: as the API's text says",
        ),
        facing: "Direct3D 11.3: 15.10 Facing: after snapping, zero area is back",
        own_pass: "Direct3D 11.3: Rasterizer Ordered Views: reads follow the writes of earlier primitives",
        stencil: "Direct3D 11.3: 17.12 Stencil: integer operations",
        write_mask: "Direct3D 11.3: 17.8 Write Masks",
    }
}
