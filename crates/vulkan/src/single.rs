//! Setting of a state that is dynamic alone.
//!
//! The state is set twice before the pipeline is bound: first to another value, then to the draw's. The
//! pipeline has the other value.

use crate::device::Device;
use crate::single_state::{SingleState, other_origin, other_samples, provoking};
use crate::state;
use ash::vk;
use etalon_scene::{DomainOrigin, Draw, ProvokingVertex};

/// The values that a draw gives the state.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Single {
    state: SingleState,
    samples: u32,
    alpha_to_one: bool,
    clips: bool,
    provoking: ProvokingVertex,
    origin: DomainOrigin,
}

impl Single {
    pub(crate) fn new(state: SingleState, draw: &Draw, samples: u32) -> Self {
        Self {
            state,
            samples,
            alpha_to_one: draw.multisample.alpha_to_one,
            clips: !draw.depth_clamp,
            provoking: provoking(draw),
            origin: draw
                .tessellation
                .map_or(DomainOrigin::UpperLeft, |t| t.origin),
        }
    }

    /// Returns other values.
    fn opposite(self) -> Self {
        Self {
            samples: other_samples(self.samples),
            alpha_to_one: !self.alpha_to_one,
            clips: !self.clips,
            provoking: match self.provoking {
                ProvokingVertex::First => ProvokingVertex::Last,
                ProvokingVertex::Last => ProvokingVertex::First,
            },
            origin: other_origin(self.origin),
            ..self
        }
    }

    /// Records other values, then these.
    ///
    /// # Safety
    /// `commands` is being recorded.
    pub(crate) unsafe fn set(self, device: &Device, commands: vk::CommandBuffer) {
        for value in [self.opposite(), self] {
            // SAFETY: upheld by the caller.
            unsafe { value.set_once(device, commands) };
        }
    }

    /// # Safety
    /// `commands` is being recorded.
    unsafe fn set_once(self, device: &Device, commands: vk::CommandBuffer) {
        let Some(api) = &device.extended else {
            return;
        };
        // SAFETY: upheld by the caller; the feature is enabled if the path is offered.
        unsafe {
            match self.state {
                SingleState::Samples => {
                    let samples = state::samples(self.samples);
                    (api.cmd_set_rasterization_samples_ext)(commands, samples);
                }
                SingleState::AlphaToOne => {
                    (api.cmd_set_alpha_to_one_enable_ext)(commands, self.alpha_to_one.into());
                }
                SingleState::DepthClip => {
                    (api.cmd_set_depth_clip_enable_ext)(commands, self.clips.into());
                }
                SingleState::Provoking => {
                    let mode = match self.provoking {
                        ProvokingVertex::First => vk::ProvokingVertexModeEXT::FIRST_VERTEX,
                        ProvokingVertex::Last => vk::ProvokingVertexModeEXT::LAST_VERTEX,
                    };
                    (api.cmd_set_provoking_vertex_mode_ext)(commands, mode);
                }
                SingleState::Origin => {
                    let origin = match self.origin {
                        DomainOrigin::UpperLeft => vk::TessellationDomainOrigin::UPPER_LEFT,
                        DomainOrigin::LowerLeft => vk::TessellationDomainOrigin::LOWER_LEFT,
                    };
                    (api.cmd_set_tessellation_domain_origin_ext)(commands, origin);
                }
            }
        }
    }
}
