//! The names of the reference's operations.

use crate::event::{Effect, Event, Rejection, Step};
use crate::state_enum;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

state_enum! {
    /// An operation of the reference, without its values.
    Operation {
        /// A pass draws to attachments of another size or sample count.
        Attachments = "attachments",
        /// Texels are uploaded.
        Upload = "upload",
        /// A clear.
        Clear = "clear",
        /// A shader's discard, or a store operation that discards.
        Discard = "discard",
        /// A resolve.
        Resolve = "resolve",
        /// Rasterizer discard.
        RasterizerDiscard = "rasterizer discard",
        /// The scissor test.
        Scissor = "scissor",
        /// Clipping by the sides of the view volume.
        Viewport = "viewport",
        /// Clipping by the near and far planes or by clip distances.
        Clipping = "clipping",
        /// Coverage of the sample.
        Coverage = "coverage",
        /// The contents of the attachments in one world.
        World = "world",
        /// Culling.
        Culling = "culling",
        /// Sample coverage.
        SampleCoverage = "sample coverage",
        /// The fragment shader.
        Shade = "shade",
        /// The sample mask that the shader reads.
        InputMask = "input sample mask",
        /// The shader's sample mask.
        ShaderMask = "shader's sample mask",
        /// The draw's sample mask.
        SampleMask = "sample mask",
        /// Alpha to coverage.
        AlphaToCoverage = "alpha to coverage",
        /// Forced early tests.
        EarlyTests = "early tests",
        /// The depth bounds test.
        DepthBounds = "depth bounds",
        /// The stencil test.
        StencilTest = "stencil test",
        /// The stencil value changes.
        StoreStencil = "store stencil",
        /// The stencil value stays.
        KeepStencil = "keep stencil",
        /// The depth test.
        DepthTest = "depth test",
        /// Depth is stored.
        StoreDepth = "store depth",
        /// Depth is not stored.
        KeepDepth = "keep depth",
        /// An advanced blend operation.
        AdvancedBlend = "advanced blend",
        /// Blending.
        Blend = "blend",
        /// A logic operation.
        LogicOperation = "logic operation",
        /// Colour is stored.
        StoreColor = "store color",
        /// Colour is not stored.
        KeepColor = "keep color",
        /// The shader writes the stencil reference.
        StencilExport = "stencil export",
        /// There are too many worlds.
        GiveUp = "give up",
        /// An attachment is read back.
        ReadBack = "read back",
        /// Two pictures must be the same.
        Relation = "relation",
    }
}

impl Event {
    /// Returns the operation that the event is part of. The effect decides if several operations share a step.
    pub fn operation(&self) -> Operation {
        match &self.step {
            Step::OtherAttachments { .. } => Operation::Attachments,
            Step::Upload(_) => Operation::Upload,
            Step::Clear(_) | Step::ClearElsewhere => Operation::Clear,
            Step::StoreDiscard(_) | Step::Discard { .. } => Operation::Discard,
            Step::Resolve { .. } | Step::ResolveDepthStencil { .. } => Operation::Resolve,
            Step::RasterizerDiscard => Operation::RasterizerDiscard,
            Step::Scissor(_) => Operation::Scissor,
            Step::Primitives { .. } | Step::Clipping => match self.effect.rejection() {
                Some(Rejection::Viewport) => Operation::Viewport,
                Some(Rejection::Coverage) => Operation::Coverage,
                _ => Operation::Clipping,
            },
            Step::Coverage(_) => Operation::Coverage,
            Step::World(_) => Operation::World,
            Step::Culling { .. } => Operation::Culling,
            Step::SampleCoverage { .. } => Operation::SampleCoverage,
            Step::Shade { .. } => Operation::Shade,
            Step::InputMask { .. } => Operation::InputMask,
            Step::ShaderMask { .. } => Operation::ShaderMask,
            Step::SampleMask { .. } => Operation::SampleMask,
            Step::AlphaToCoverage { .. } => Operation::AlphaToCoverage,
            Step::LostAfterEarlyTests => Operation::EarlyTests,
            Step::DepthBounds { .. } => Operation::DepthBounds,
            Step::StencilTest { .. } => Operation::StencilTest,
            Step::StencilUpdate { .. } => match self.effect {
                Effect::Stores(_) => Operation::StoreStencil,
                _ => Operation::KeepStencil,
            },
            Step::DepthTest(_) => Operation::DepthTest,
            Step::StoreDepth { .. } => Operation::StoreDepth,
            Step::KeepDepth { .. } => Operation::KeepDepth,
            Step::AdvancedBlend { .. } => Operation::AdvancedBlend,
            Step::Blend(_) => Operation::Blend,
            Step::Logic { .. } => Operation::LogicOperation,
            Step::StoreColor { .. } => Operation::StoreColor,
            Step::KeepColor { .. } => Operation::KeepColor,
            Step::StencilExport { .. } | Step::LateStencilExport { .. } => Operation::StencilExport,
            Step::GiveUp { .. } => Operation::GiveUp,
            Step::ReadBack { .. } => Operation::ReadBack,
            Step::Relation(_) => Operation::Relation,
        }
    }
}
