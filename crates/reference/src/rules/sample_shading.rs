//! The point of a texel that a fragment shader's inputs belong to, and the samples that sample coverage
//! draws.
//!
//! Functions of the API, not fields of [`Rules`]: what they permit depends on the draw's state.

use super::permission::{Permission, Rules, permit};
use etalon_frame::{Api, ApiVersion, Limits};
use etalon_scene::Multisample;

/// The point of a texel at which an input of a fragment shader is evaluated.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ShadedAt {
    /// The centre.
    Center,
    /// The position of the sample itself.
    Sample,
    /// The position of any sample.
    AnySample,
    /// Any point of the texel.
    Texel,
}

impl Rules {
    /// Returns where the fragment's coordinates lie that a shader reads, in a texel of several samples.
    pub fn frag_coord(api: Api, state: &Multisample, samples: u32) -> Permission<ShadedAt> {
        let own = state.least_runs(samples) == samples;
        match (api, state.min_sample_shading) {
            (Api::Vulkan, None) => permit(
                ShadedAt::Center,
                "Vulkan: FragCoord: without sample shading, the centre of the fragment",
            ),
            // As many runs as samples, each with a sample at least: each sample has its own.
            (Api::Vulkan, Some(_)) if own => permit(
                ShadedAt::Sample,
                "Vulkan: FragCoord, Sample Shading: the location of the one sample of each run",
            ),
            (Api::Vulkan, Some(_)) => permit(
                ShadedAt::AnySample,
                "Vulkan: FragCoord, Sample Shading: the location of one of the samples of the run",
            ),
            (Api::OpenGl | Api::OpenGlEs, _) => Self::inputs(api, state),
            (Api::WebGpu, _) => permit(
                ShadedAt::Texel,
                "WebGPU: silent: OpenGL 4.6, 14.3.1: any point of the texel",
            ),
        }
    }

    /// Returns where a shader's inputs are interpolated that ask for no place of their own, in a texel of
    /// several samples.
    pub fn inputs(api: Api, state: &Multisample) -> Permission<ShadedAt> {
        match (api, state.min_sample_shading) {
            (Api::OpenGl, Some(1.0)) => permit(
                ShadedAt::Sample,
                "OpenGL: 14.3.1.1 (ARB_sample_shading): with a share of 1, each sample's inputs are \
                 evaluated at its location",
            ),
            (Api::OpenGlEs, Some(1.0)) => permit(
                ShadedAt::Sample,
                "OpenGL ES: 13.4.1 (OES_sample_shading): with a share of 1, each sample's inputs are \
                 evaluated at its location",
            ),
            (Api::OpenGl, _) => permit(
                ShadedAt::Texel,
                "OpenGL: 14.3.1 (3.3: 3.3.1): anywhere within the texel",
            ),
            (Api::OpenGlEs, _) => permit(
                ShadedAt::Texel,
                "OpenGL ES: 13.4 (3.0: 3.3): anywhere within the texel",
            ),
            (Api::Vulkan, _) => permit(
                ShadedAt::Texel,
                "Vulkan: Interpolation Decorations: an implementation-defined position within the \
                 fragment, unless decorated",
            ),
            (Api::WebGpu, _) => permit(
                ShadedAt::Texel,
                "WebGPU: silent: Vulkan: Interpolation Decorations",
            ),
        }
    }

    /// Returns the clause on sample coverage: 0 draws no sample, 1 all, anything between any, but the same
    /// at each place whenever the value is the same, and the others when inverted. The texts intend the
    /// ends; Khronos tests require them and the constancy of what lies between.
    pub fn sample_coverage(limits: &Limits) -> &'static str {
        let since = |major, minor| limits.version >= ApiVersion::new(major, minor);
        match limits.api {
            Api::OpenGlEs if since(3, 2) => {
                "OpenGL ES 3.2: 13.8.3; dEQP-GLES3.functional.multisample: proportionality, \
                 constancy and inversion of sample coverage"
            }
            Api::OpenGlEs if since(3, 1) => {
                "OpenGL ES 3.1: 13.6.3; dEQP-GLES3.functional.multisample: proportionality, \
                 constancy and inversion of sample coverage"
            }
            Api::OpenGlEs => {
                "OpenGL ES 3.0: 4.1.3; dEQP-GLES3.functional.multisample: proportionality, constancy \
                 and inversion of sample coverage"
            }
            Api::OpenGl if !since(4, 3) && since(3, 3) => "OpenGL 3.3: 4.1.3",
            Api::OpenGl | Api::Vulkan | Api::WebGpu => "OpenGL 4.6: 14.9.3",
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_a_whole_share_pins_attributes_and_only_in_opengl() {
        let with = |share| Multisample {
            min_sample_shading: share,
            ..Multisample::default()
        };
        for api in [Api::OpenGl, Api::OpenGlEs] {
            assert_eq!(Rules::inputs(api, &with(Some(1.0))).value, ShadedAt::Sample);
            assert_eq!(Rules::inputs(api, &with(Some(0.9))).value, ShadedAt::Texel);
            assert_eq!(
                Rules::frag_coord(api, &with(None), 4).value,
                ShadedAt::Texel
            );
        }
        let vulkan = |share| Rules::frag_coord(Api::Vulkan, &with(share), 4).value;
        assert_eq!(vulkan(None), ShadedAt::Center);
        assert_eq!(vulkan(Some(0.0)), ShadedAt::AnySample);
        assert_eq!(vulkan(Some(0.75)), ShadedAt::AnySample);
        assert_eq!(vulkan(Some(0.76)), ShadedAt::Sample);
        let attributes = Rules::inputs(Api::Vulkan, &with(Some(1.0)));
        assert_eq!(attributes.value, ShadedAt::Texel);
        for api in [Api::Vulkan, Api::OpenGl, Api::OpenGlEs, Api::WebGpu] {
            for share in [None, Some(0.5), Some(1.0)] {
                for permission in [
                    Rules::frag_coord(api, &with(share), 4),
                    Rules::inputs(api, &with(share)),
                ] {
                    assert!(permission.citation.contains(':'));
                }
            }
        }
    }
}
