//! Values of a path: the ways a scene reaches the driver, one enumeration per key.
//!
//! They are defined here rather than with scenes because limits name them: an adapter has a value or lacks
//! it. The first value of each enumeration is the default, which every adapter has.

use crate::state_enum;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::fmt;

/// Declares the enumerations of a path, [`PathValue`] over all of them, and `all_values`.
macro_rules! path_values {
    ($($(#[$doc:meta])* $kind:ident($name:ident) = $key:literal
        { $(#[$default_doc:meta])* $default:ident = $default_text:literal, $($(#[$value_doc:meta])* $value:ident = $text:literal),+ $(,)? })+) => {
        $(state_enum! {
            $(#[$doc])*
            #[derive(Default)]
            $name {
                $(#[$default_doc])* #[default] $default = $default_text,
                $($(#[$value_doc])* $value = $text),+
            }
        })+

        /// One value of one key of a path.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
        #[serde(rename_all = "kebab-case")]
        pub enum PathValue {
            $($(#[$doc])* $kind($name)),+
        }

        impl PathValue {
            /// Returns the key in case files.
            pub fn key(self) -> &'static str {
                match self { $(Self::$kind(_) => $key),+ }
            }

            /// Returns the value's name in case files.
            pub fn name(self) -> &'static str {
                match self { $(Self::$kind(value) => value.name()),+ }
            }

            /// Returns true if every adapter has the value.
            pub fn is_default(self) -> bool {
                match self { $(Self::$kind(value) => value == $name::default()),+ }
            }

            /// Returns every value except the defaults, by key.
            pub fn all() -> Vec<Self> {
                let mut all = Vec::new();
                $(all.extend($name::ALL.iter().copied().map(Self::$kind));)+
                all.retain(|value| !value.is_default());
                all
            }
        }
    };
}

path_values! {
    /// The source of attachments' initial contents.
    Start(PathStart) = "start" {
        /// A transfer before the first pass.
        Transfer = "transfer",
        /// The load operation of the first pass.
        LoadOperation = "load-operation",
        /// A clear command at the beginning of the first pass.
        ClearCommand = "clear-command",
        /// A draw at the beginning of the first pass.
        Draw = "draw",
    }
    /// The API object for a pass.
    Pass(PathPass) = "pass" {
        /// Rendering without pass objects; in other APIs, their only kind of pass.
        DynamicRendering = "dynamic-rendering",
        /// A render pass of one subpass, and its framebuffer.
        RenderPass = "render-pass",
        /// The second subpass of a render pass, after one that draws nothing.
        SecondSubpass = "second-subpass",
    }
    /// The way to set state.
    State(PathState) = "state" {
        /// Between the draws, for all state that the API can set there without extensions.
        Dynamic = "dynamic",
        /// In the pipeline.
        Static = "static",
        /// Between the draws, with extended dynamic state 3 in addition.
        ExtendedDynamic3 = "extended-dynamic-3",
        /// Like extended dynamic state 3, but set before the draw's own pipeline is bound.
        BeforePipeline = "before-pipeline",
        /// Between the draws, including the logic operation.
        DynamicLogic = "dynamic-logic",
        /// Twice before every draw, first to other values.
        Overwritten = "overwritten",
        /// Before another pipeline is bound, and then the draw's own again.
        OtherPipeline = "other-pipeline",
        /// Only if it differs from the previous draw's, even across passes.
        Kept = "kept",
        /// Between the draws, including the number of samples.
        DynamicSamples = "dynamic-samples",
        /// Between the draws, including alpha to one.
        DynamicAlphaToOne = "dynamic-alpha-to-one",
        /// Between the draws, including depth clipping.
        DynamicDepthClip = "dynamic-depth-clip",
        /// Between the draws, including the provoking vertex.
        DynamicProvoking = "dynamic-provoking",
        /// Between the draws, including the origin of the tessellated domain.
        DynamicOrigin = "dynamic-origin",
        /// In the pipeline of every second draw, and between the draws for the others.
        Turns = "turns",
    }
    /// The part of a texture that serves as an attachment.
    Target(PathTarget) = "target" {
        /// A texture with one level and one layer.
        Plain = "plain",
        /// A level above 0.
        MipLevel = "mip-level",
        /// A layer above 0.
        ArrayLayer = "array-layer",
        /// A slice above 0 of a three-dimensional texture.
        Slice3d = "slice-3d",
        /// A face above 0 of a cube.
        CubeFace = "cube-face",
        /// A level above 0 of a layer above 0.
        LevelOfLayer = "level-of-layer",
        /// A renderbuffer, which is not a texture.
        Renderbuffer = "renderbuffer",
    }
    /// The command buffers of a submission.
    Commands(PathCommands) = "commands" {
        /// A single command buffer.
        One = "one",
        /// A primary command buffer for each pass.
        Several = "several",
        /// A secondary command buffer for the draws of each pass.
        Secondary = "secondary",
        /// A secondary command buffer for each draw.
        SecondaryEach = "secondary-each",
    }
    /// The kind of draw calls.
    Draws(PathDraws) = "draws" {
        /// The scene's own calls.
        Direct = "direct",
        /// Indexed, with 16-bit indices.
        Indexed16 = "indexed-16",
        /// Indexed, with 32-bit indices.
        Indexed32 = "indexed-32",
        /// Indexed, with a base vertex that is added to every index, after unused vertices and indices.
        BaseVertex = "base-vertex",
        /// With the colour from a buffer that advances once per instance.
        Instanced = "instanced",
        /// With arguments from a buffer.
        Indirect = "indirect",
        /// Arguments come from a buffer, and so does the number of draws, which is less than the stated
        /// maximum.
        IndirectCount = "indirect-count",
        /// With arguments from a buffer, while a buffer for draw counts is bound that no call reads.
        IndirectBeside = "indirect-beside",
        /// The scene's own calls, each after the same call without vertices and without instances.
        AfterEmpty = "after-empty",
        /// Lists as strips that the greatest index restarts.
        Restart = "restart",
        /// Strips and fans without indices while primitive restart is on; restart affects only indexed draws.
        RestartUnindexed = "restart-unindexed",
    }
    /// The route by which an attachment reaches the host.
    End(PathEnd) = "end" {
        /// Directly, by a transfer of the attachment.
        Store = "store",
        /// A copy to another texture, which is then read.
        Copy = "copy",
        /// A blit of equal size to another texture, which is then read.
        Blit = "blit",
        /// A blit that mirrors in both directions; its texels are read in reverse order.
        BlitMirrored = "blit-mirrored",
        /// A blit that scales one texel to six. One of the six is read.
        BlitScaled = "blit-scaled",
        /// Blits of parts that change places, one aspect at a time.
        BlitPart = "blit-part",
        /// A blit with a linear filter between the texels and zeros; twice its result is read.
        BlitLinear = "blit-linear",
        /// The framebuffer that was drawn to; its color attachments are read one after the other.
        ReadBuffer = "read-buffer",
        /// A shader.
        ShaderRead = "shader-read",
        /// Several transfers, each of a part.
        Part = "part",
    }
    /// The render area.
    Area(PathArea) = "area" {
        /// The whole attachments.
        Full = "full",
        /// Half the attachments: every pass is recorded once for each half.
        Part = "part",
        /// Up to four areas whose borders are at an odd column and row.
        Quarters = "quarters",
    }
    /// The calls that clear within passes.
    Clears(PathClears) = "clears" {
        /// One call for each clear.
        Each = "each",
        /// One call for consecutive clears: of several attachments, aspects or rectangles.
        Together = "together",
        /// One call for each clear, after a call that leaves the same contents undefined.
        Undefined = "undefined",
    }
    /// The number of times that queries are read.
    Results(PathResults) = "results" {
        /// Once.
        Once = "once",
        /// Queries are read twice; the second result counts.
        Twice = "twice",
    }
    /// The convention of the clip volume.
    Clip(PathClip) = "clip" {
        /// Clipping is the same for all draws.
        Constant = "constant",
        /// The convention is toggled between the draws.
        Toggled = "toggled",
    }
    /// Viewports and scissor rectangles.
    Viewport(PathViewport) = "viewport" {
        /// One viewport; the pipeline states the number.
        One = "one",
        /// One viewport; its command also sets the number.
        WithCount = "with-count",
        /// An array of viewports; a shader selects the second.
        Array = "array",
    }
    /// The layers of a pass.
    Layers(PathLayers) = "layers" {
        /// A single layer.
        One = "one",
        /// Three layers: a shader selects the second once and the third once. Attachments alternate between the
        /// two when they are read.
        Written = "written",
        /// Three layers; two are views. A draw reaches both, and attachments alternate between them when they
        /// are read.
        Multiview = "multiview",
    }
    /// The tests of aspects that a pass does not have.
    Tests(PathTests) = "tests" {
        /// The tests are off.
        Off = "off",
        /// The tests are on, with functions that never pass. Without an attachment they must have no effect.
        Unattached = "unattached",
    }
    /// The colour attachments of passes.
    Colors(PathColors) = "colors" {
        /// All attachments of the pass.
        Attached = "attached",
        /// Only attachments that something reads; the locations of the others are empty.
        Gaps = "gaps",
    }
    /// The way to resolve colors.
    Resolves(PathResolves) = "resolves" {
        /// Resolves are part of the pass.
        Attached = "attached",
        /// Commands after the pass resolve the attachment in parts, and move each part.
        Moved = "moved",
    }
    /// The format of the textures that color attachments are views of.
    Views(PathViews) = "views" {
        /// The attachment's format.
        Same = "same",
        /// The texture's format has sRGB conversion if the attachment's has not, and vice versa.
        Srgb = "srgb",
        /// Unsigned integers of the same number of bits.
        Uint = "uint",
    }
    /// The way in which shaders read attachments of their own pass.
    Reads(PathReads) = "reads" {
        /// Barriers between the draws: input attachments of a subpass, texture barriers, framebuffer fetch.
        Barriers = "barriers",
        /// Input attachments; each draw that reads begins a subpass.
        Subpasses = "subpasses",
        /// Input attachments without pass objects, with barriers.
        LocalRead = "local-read",
        /// Textures that are in the layout of feedback loops, with barriers.
        FeedbackLoop = "feedback-loop",
        /// Attachments that are accessed in the order of primitives, without barriers.
        Ordered = "ordered",
    }
}

impl fmt::Display for PathValue {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}={}", self.key(), self.name())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeSet;

    #[test]
    fn path_values_have_distinct_names() {
        let values = PathValue::all();
        let names: BTreeSet<_> = values.iter().map(PathValue::to_string).collect();
        assert_eq!(names.len(), values.len());
        assert!(names.contains("start=load-operation"));
        assert!(!names.contains("start=transfer"));
    }
}
