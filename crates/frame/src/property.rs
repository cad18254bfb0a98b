//! Properties of an adapter that change what its API permits.

use crate::state_enum;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

state_enum! {
    /// A promise of an adapter that narrows its API's text.
    Property: array {
        /// With forced early tests, alpha to coverage acts after samples are counted
        /// (`earlyFragmentMultisampleCoverageAfterSampleCounting` of Vulkan's maintenance5 and 1.4).
        CoverageAfterCounting = "coverage-after-counting",
        /// With forced early tests, the sample mask acts before samples are counted
        /// (`earlyFragmentSampleMaskTestBeforeSampleCounting` of Vulkan's maintenance5 and 1.4).
        MaskBeforeCounting = "mask-before-counting",
        /// A point outside of the view volume is discarded (`VK_POINT_CLIPPING_BEHAVIOR_ALL_CLIP_PLANES` of Vulkan's
        /// maintenance2 and 1.1).
        DiscardsPointsOutside = "discards-points-outside",
    }
}
