//! Invariance: pictures that must be equal although the rules leave each of them open.

use super::permission::{Permission, Rules, permit};
use etalon_frame::{Api, Band, Limits};
use etalon_scene::Invariance;

impl Rules {
    /// Returns the band of different colours in samples of one frame that a draw computes from the same source and the
    /// same destination: Fail if the specification requires them to be equal, Imprecise if it is silent.
    pub fn equal_operands(limits: &Limits) -> Permission<Band> {
        match limits.api {
            Api::Vulkan => permit(
                Band::Fail,
                "Vulkan: Invariance, Rule 3: the arithmetic of each per-fragment operation is invariant",
            ),
            Api::OpenGl | Api::OpenGlEs => permit(
                Band::Fail,
                "OpenGL: Appendix A, Rule 3: the arithmetic of each per-fragment operation is invariant",
            ),
            Api::WebGpu => permit(
                Band::Imprecise,
                "WebGPU: silent on invariance; Vulkan and OpenGL both require it",
            ),
        }
    }

    /// Returns the band of a difference between two pictures that differ only in this change: Fail if the
    /// specification requires them to be equal, Imprecise if it only suggests equality, or is silent while
    /// the other specifications require it; otherwise `None`.
    pub fn invariance(limits: &Limits, change: Invariance) -> Permission<Option<Band>> {
        use Invariance as By;
        match (limits.api, change) {
            (Api::Vulkan, By::Repeat) => permit(
                Some(Band::Fail),
                "Vulkan: Invariance, Rule 1: the same commands on the same state give the same",
            ),
            (Api::Vulkan, By::Scissor | By::WriteMask | By::Contents) => permit(
                Some(Band::Fail),
                "Vulkan: Invariance, Rule 2: scissor parameters, write masks and attachment contents \
                 have no side effects",
            ),
            (Api::Vulkan, By::Attachments) => permit(
                Some(Band::Fail),
                "Vulkan: Invariance, Corollary 2: images in different colour attachments of one \
                 framebuffer are pixel identical",
            ),
            (Api::Vulkan, By::Translation) => permit(
                None,
                "Vulkan: Invariance: the translation rule of OpenGL does not apply",
            ),
            (Api::OpenGl | Api::OpenGlEs, By::Repeat) => permit(
                Some(Band::Fail),
                "OpenGL: Appendix A, Repeatability: the same command on the same state gives the same",
            ),
            (Api::OpenGl | Api::OpenGlEs, By::Scissor | By::WriteMask | By::Contents) => permit(
                Some(Band::Fail),
                "OpenGL: Appendix A, Rule 2: scissor parameters, write masks and framebuffer contents \
                 have no side effects",
            ),
            (Api::OpenGl | Api::OpenGlEs, By::Attachments) => permit(
                Some(Band::Fail),
                "OpenGL: Appendix A, corollary: images rendered into different colour buffers are \
                 pixel identical",
            ),
            (Api::OpenGl | Api::OpenGlEs, By::Translation) => permit(
                Some(Band::Imprecise),
                "OpenGL: 14.2 Invariance (3.3: 3.2; ES 3.0: 3.2, 3.1: 13.2, 3.2: 13.3): a primitive moved by exactly so \
                 many window units gives the same fragments, moved; a viewport moves it within 1 part \
                 in 10^5",
            ),
            (_, By::Parameters) => permit(
                Some(Band::Imprecise),
                "Vulkan: Invariance, Rule 2; OpenGL: Appendix A, Rule 2: strongly suggested for \
                 stencil, depth and blend parameters",
            ),
            (Api::WebGpu, By::Translation) => permit(
                None,
                "WebGPU: silent on invariance; Vulkan does not promise it",
            ),
            (Api::WebGpu, _) => permit(
                Some(Band::Imprecise),
                "WebGPU: silent on invariance; Vulkan and OpenGL both require it",
            ),
        }
    }
}
