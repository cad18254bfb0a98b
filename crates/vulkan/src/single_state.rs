//! States of extended dynamic state 3 that the path makes dynamic one at a time.

use ash::vk;
use etalon_frame::PathState;
use etalon_scene::{DomainOrigin, Draw, Multisample, ProvokingVertex, Tessellation};

/// A state that is dynamic in addition to Vulkan 1.3's.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) enum SingleState {
    /// The number of samples.
    Samples,
    /// Alpha to one.
    AlphaToOne,
    /// Clipping at the near and the far plane.
    DepthClip,
    /// The provoking vertex, which gives flat attributes their values.
    Provoking,
    /// The origin of the tessellated domain.
    Origin,
}

impl SingleState {
    /// Every state.
    pub(crate) const ALL: [Self; 5] = [
        Self::Samples,
        Self::AlphaToOne,
        Self::DepthClip,
        Self::Provoking,
        Self::Origin,
    ];

    /// Returns the state that is dynamic if state is set in the way of `state`.
    pub(crate) fn of(state: PathState) -> Option<Self> {
        match state {
            PathState::DynamicSamples => Some(Self::Samples),
            PathState::DynamicAlphaToOne => Some(Self::AlphaToOne),
            PathState::DynamicDepthClip => Some(Self::DepthClip),
            PathState::DynamicProvoking => Some(Self::Provoking),
            PathState::DynamicOrigin => Some(Self::Origin),
            PathState::Dynamic
            | PathState::Static
            | PathState::ExtendedDynamic3
            | PathState::BeforePipeline
            | PathState::DynamicLogic
            | PathState::Overwritten
            | PathState::OtherPipeline
            | PathState::Kept
            | PathState::Turns => None,
        }
    }

    /// Returns Vulkan's dynamic state.
    pub(crate) fn dynamic(self) -> vk::DynamicState {
        match self {
            Self::Samples => vk::DynamicState::RASTERIZATION_SAMPLES_EXT,
            Self::AlphaToOne => vk::DynamicState::ALPHA_TO_ONE_ENABLE_EXT,
            Self::DepthClip => vk::DynamicState::DEPTH_CLIP_ENABLE_EXT,
            Self::Provoking => vk::DynamicState::PROVOKING_VERTEX_MODE_EXT,
            Self::Origin => vk::DynamicState::TESSELLATION_DOMAIN_ORIGIN_EXT,
        }
    }

    /// Returns the draw that a pipeline is made from: its value of the state differs from the draw's, if a
    /// draw has the value. Draws of both values share the pipeline.
    pub(crate) fn held(self, draw: &Draw) -> Draw {
        match self {
            Self::AlphaToOne => Draw {
                multisample: Multisample {
                    alpha_to_one: !draw.multisample.alpha_to_one,
                    ..draw.multisample
                },
                ..draw.clone()
            },
            Self::Provoking => Draw {
                provoking: Some(match provoking(draw) {
                    ProvokingVertex::First => ProvokingVertex::Last,
                    ProvokingVertex::Last => ProvokingVertex::First,
                }),
                ..draw.clone()
            },
            Self::Origin => Draw {
                tessellation: draw.tessellation.map(|tessellation| Tessellation {
                    origin: other_origin(tessellation.origin),
                    ..tessellation
                }),
                ..draw.clone()
            },
            Self::Samples | Self::DepthClip => draw.clone(),
        }
    }
}

/// Returns the provoking vertex of a draw, or the default of a pipeline if the draw has none.
pub(crate) fn provoking(draw: &Draw) -> ProvokingVertex {
    draw.provoking.unwrap_or(ProvokingVertex::First)
}

/// Returns the other origin.
pub(crate) fn other_origin(origin: DomainOrigin) -> DomainOrigin {
    match origin {
        DomainOrigin::UpperLeft => DomainOrigin::LowerLeft,
        DomainOrigin::LowerLeft => DomainOrigin::UpperLeft,
    }
}

/// Returns a different number of samples.
pub(crate) fn other_samples(samples: u32) -> u32 {
    if samples == 1 { 4 } else { 1 }
}
