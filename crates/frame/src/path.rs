//! Values of a path: the ways in which a scene reaches the driver, one enumeration per key.
//!
//! They stand here, and not beside scenes, because limits name them: an adapter has a value or lacks it.
//! The first value of each enumeration is the default, which every adapter has.

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
            /// The key in case files.
            pub fn key(self) -> &'static str {
                match self { $(Self::$kind(_) => $key),+ }
            }

            /// The value's name in case files.
            pub fn name(self) -> &'static str {
                match self { $(Self::$kind(value) => value.name()),+ }
            }

            /// True if every adapter has the value.
            pub fn is_default(self) -> bool {
                match self { $(Self::$kind(value) => value == $name::default()),+ }
            }

            /// Every value but the defaults, by key.
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
    /// The way in which attachments receive their initial contents.
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
    /// The object that a pass is.
    Pass(PathPass) = "pass" {
        /// Rendering without objects; in APIs that know no other pass, theirs.
        DynamicRendering = "dynamic-rendering",
        /// A render pass of one subpass, and its framebuffer.
        RenderPass = "render-pass",
        /// The second subpass of a render pass, behind one that draws nothing.
        SecondSubpass = "second-subpass",
    }
    /// The way in which state is set.
    State(PathState) = "state" {
        /// Between the draws, as far as the API has it without extensions.
        Dynamic = "dynamic",
        /// In the pipeline.
        Static = "static",
        /// Between the draws, with extended dynamic state 3 too.
        ExtendedDynamic3 = "extended-dynamic-3",
        /// As with extended dynamic state 3, but before the pipeline is bound and while another one is.
        BeforePipeline = "before-pipeline",
        /// Between the draws, with the logic operation too.
        DynamicLogic = "dynamic-logic",
        /// Twice before every draw, to other values first.
        Overwritten = "overwritten",
        /// Before another pipeline is bound, and the draw's own again.
        OtherPipeline = "other-pipeline",
        /// Only if it differs from that of the draw before, also of another pass.
        Kept = "kept",
        /// Between the draws, with the number of samples too.
        DynamicSamples = "dynamic-samples",
        /// Between the draws, with alpha to one too.
        DynamicAlphaToOne = "dynamic-alpha-to-one",
        /// Between the draws, with depth clipping too.
        DynamicDepthClip = "dynamic-depth-clip",
        /// Between the draws, with the provoking vertex too.
        DynamicProvoking = "dynamic-provoking",
        /// Between the draws, with the origin of the tessellated domain too.
        DynamicOrigin = "dynamic-origin",
    }
    /// The part of a texture that an attachment is.
    Target(PathTarget) = "target" {
        /// A texture of one level and layer.
        Plain = "plain",
        /// A level above 0.
        MipLevel = "mip-level",
        /// A layer above 0.
        ArrayLayer = "array-layer",
        /// A slice above 0 of a three-dimensional texture.
        Slice3d = "slice-3d",
        /// A face above 0 of a cube.
        CubeFace = "cube-face",
        /// A renderbuffer, which has no texture.
        Renderbuffer = "renderbuffer",
    }
    /// The command buffers of a submission.
    Commands(PathCommands) = "commands" {
        /// One.
        One = "one",
        /// A primary command buffer for each pass.
        Several = "several",
        /// A secondary command buffer for the draws of each pass.
        Secondary = "secondary",
    }
    /// The kind of draw calls.
    Draws(PathDraws) = "draws" {
        /// The scene's own.
        Direct = "direct",
        /// Indexed with 16 bits.
        Indexed16 = "indexed-16",
        /// Indexed with 32 bits.
        Indexed32 = "indexed-32",
        /// Indexed, with a number that is added to every index, behind unused vertices and indices.
        BaseVertex = "base-vertex",
        /// The colour from a buffer that advances once an instance.
        Instanced = "instanced",
        /// Arguments from a buffer.
        Indirect = "indirect",
        /// Arguments from a buffer, and the number of draws from another place, less than the most that is stated.
        IndirectCount = "indirect-count",
        /// Arguments from a buffer, while another one is bound for numbers of draws, which no call reads.
        IndirectBeside = "indirect-beside",
        /// Lists as strips that the greatest index ends.
        Restart = "restart",
        /// Strips and fans without indices, while restart is on, which acts on indices alone.
        RestartUnindexed = "restart-unindexed",
    }
    /// The way from an attachment to the host.
    End(PathEnd) = "end" {
        /// A transfer of the attachment.
        Store = "store",
        /// A copy to another texture, which is then read.
        Copy = "copy",
        /// A blit of equal size to another texture, which is then read.
        Blit = "blit",
        /// A blit that mirrors in both directions; its texels are read in reverse.
        BlitMirrored = "blit-mirrored",
        /// A blit that makes six texels of one; one of the six is read.
        BlitScaled = "blit-scaled",
        /// Blits of parts that change places, each of one aspect.
        BlitPart = "blit-part",
        /// A blit with linear filter between the texels and others of zeros; twice its result is read.
        BlitLinear = "blit-linear",
        /// The framebuffer that was drawn to, whose color attachments are read one after the other.
        ReadBuffer = "read-buffer",
        /// A shader.
        ShaderRead = "shader-read",
        /// Several transfers, each of a part.
        Part = "part",
    }
    /// The render area.
    Area(PathArea) = "area" {
        /// The whole of the attachments.
        Full = "full",
        /// A part: every pass is recorded once for each half of its attachments.
        Part = "part",
    }
    /// The calls that clear within passes.
    Clears(PathClears) = "clears" {
        /// One for each clear.
        Each = "each",
        /// One for clears that follow one another: of several attachments, aspects or rectangles.
        Together = "together",
        /// Each behind a call that leaves undefined what it clears.
        Undefined = "undefined",
    }
    /// The reading of queries.
    Results(PathResults) = "results" {
        /// Once.
        Once = "once",
        /// Twice, and what comes second counts.
        Twice = "twice",
    }
    /// The clip volume's convention.
    Clip(PathClip) = "clip" {
        /// One for all draws.
        Constant = "constant",
        /// Another one between the draws.
        Toggled = "toggled",
    }
    /// Viewports and scissor rectangles.
    Viewport(PathViewport) = "viewport" {
        /// One, whose number the pipeline states.
        One = "one",
        /// One, whose number is set with it.
        WithCount = "with-count",
        /// An array of which a shader names the second.
        Array = "array",
    }
    /// The layers of a pass.
    Layers(PathLayers) = "layers" {
        /// One.
        One = "one",
        /// Three: a shader names the layer, once the second and once the third, which are read in turns.
        Written = "written",
        /// Three, of which two are views: a draw reaches both, which are read in turns.
        Multiview = "multiview",
    }
    /// The tests of aspects that a pass lacks.
    Tests(PathTests) = "tests" {
        /// Off.
        Off = "off",
        /// On, and none passes, which nothing may come of without an attachment.
        Unattached = "unattached",
    }
    /// The colour attachments of passes.
    Colors(PathColors) = "colors" {
        /// All.
        Attached = "attached",
        /// Those that something reads; the locations of the others have no attachment.
        Gaps = "gaps",
    }
    /// The resolves of colors.
    Resolves(PathResolves) = "resolves" {
        /// With the pass.
        Attached = "attached",
        /// Commands behind the pass, each of a part that changes its place.
        Moved = "moved",
    }
    /// The format of the textures that color attachments are views of.
    Views(PathViews) = "views" {
        /// The attachment's.
        Same = "same",
        /// With sRGB conversion if the attachment lacks it, and without if it has it.
        Srgb = "srgb",
        /// Unsigned integers of as many bits.
        Uint = "uint",
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
    fn values_are_told_apart() {
        let all = PathValue::all();
        let names: BTreeSet<_> = all.iter().map(PathValue::to_string).collect();
        assert_eq!(names.len(), all.len());
        assert!(names.contains("start=load-operation"));
        assert!(!names.contains("start=transfer"));
    }
}
