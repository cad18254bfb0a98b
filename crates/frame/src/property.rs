//! Properties of an adapter that change what its API permits.

use crate::state_enum;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

state_enum! {
    /// A promise of an adapter that narrows what its API's specification permits.
    Property: array {
        /// With forced early tests, alpha to coverage acts after samples are counted
        /// (`earlyFragmentMultisampleCoverageAfterSampleCounting` of Vulkan's maintenance5 and 1.4).
        CoverageAfterCounting = "coverage-after-counting",
        /// With forced early tests, the sample mask acts before samples are counted
        /// (`earlyFragmentSampleMaskTestBeforeSampleCounting` of Vulkan's maintenance5 and 1.4).
        MaskBeforeCounting = "mask-before-counting",
        /// A point outside the view volume is discarded (`VK_POINT_CLIPPING_BEHAVIOR_ALL_CLIP_PLANES` of
        /// Vulkan's maintenance2 and 1.1).
        DiscardsPointsOutside = "discards-points-outside",
        /// With forced early tests, shading and multisample coverage come after samples are counted, because
        /// the version of the specification says so (Vulkan up to 1.3.216).
        ShadesAfterCounting = "shades-after-counting",
        /// Lines one texel wide are rectangles or parallelograms (`strictLines` of Vulkan, or
        /// `nonStrictSinglePixelWideLinesUseParallelogram` of its maintenance5 and 1.4).
        LinesAreParallelograms = "lines-are-parallelograms",
        /// Clip-space depth ranges from 0 to 1, so the viewport's terms are those of its near plane
        /// (`glClipControl` of OpenGL 4.5, `EXT_clip_control` of OpenGL ES).
        DepthFromZero = "depth-from-zero",
    }
}
