//! Faults of drivers that a test plants between a backend and its driver.
//!
//! A backend that is opened with one puts functions of its own in the place of some of the driver's, and
//! knows nothing of it from there on. Each fault stands for a driver that gets one of many things wrong:
//! a large one, a late one, or one that the draw or pass before has touched.

use serde::{Deserialize, Serialize};

macro_rules! faults {
    ($($(#[$doc:meta])* $fault:ident = $name:literal in $area:literal $(, $only:ident)?;)+) => {
        /// A planted fault of a driver's calls. For tests of the suite only.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
        #[serde(rename_all = "kebab-case")]
        pub enum CallFault {
            $($(#[$doc])* $fault,)+
        }

        impl CallFault {
            /// Every fault.
            pub const ALL: &[Self] = &[$(Self::$fault),+];

            /// The name in adapter names: `gl:llvmpipe:call-fault=last-row`.
            pub fn name(self) -> &'static str {
                match self {
                    $(Self::$fault => $name,)+
                }
            }

            /// The area whose cases must see it.
            pub fn area(self) -> &'static str {
                match self {
                    $(Self::$fault => $area,)+
                }
            }

            /// True if Vulkan has the call.
            pub fn is_in_vulkan(self) -> bool {
                match self {
                    $(Self::$fault => faults!(@vulkan $($only)?),)+
                }
            }

            /// True if OpenGL has the call.
            pub fn is_in_opengl(self) -> bool {
                match self {
                    $(Self::$fault => faults!(@opengl $($only)?),)+
                }
            }
        }
    };
    (@vulkan opengl) => { false };
    (@vulkan $($only:ident)?) => { true };
    (@opengl vulkan) => { false };
    (@opengl $($only:ident)?) => { true };
}

faults! {
    /// Draws reach the first 64×64 texels.
    OnlyFirst64 = "only-first-64" in "size";
    /// Draws do not reach the last row.
    LastRow = "last-row" in "size";
    /// Draws do not reach the last column.
    LastColumn = "last-column" in "size";
    /// Draws do not reach the second tile of 32×32 of the first row.
    SecondTile = "second-tile" in "size";
    /// Scissor rectangles whose right edge is a multiple of 16 are a column too small.
    ScissorEdge = "scissor-edge" in "size";
    /// Draw number 256 of a pass is lost.
    Draw256 = "draw-256" in "size";
    /// Indices past 65,535 are lost.
    Indices65535 = "indices-65535" in "size";
    /// Vertices past 4,096 are lost in draws without indices.
    Vertices4096 = "vertices-4096" in "size";
    /// Points and lines past the first 500 are lost.
    Lines500 = "lines-500" in "size";
    /// The base vertex is 0.
    BaseVertex = "base-vertex" in "size";
    /// The first index is one too late.
    FirstIndex = "first-index" in "size";
    /// The first instance is 0.
    FirstInstance = "first-instance" in "size";
    /// Instances after the first are lost.
    SecondInstance = "second-instance" in "size";
    /// The depth comparison is that of the draw before.
    CompareKept = "compare-kept" in "sequence";
    /// The write mask of depth is that of the draw before.
    DepthWriteKept = "depth-write-kept" in "sequence";
    /// Culling is that of the draw before.
    CullKept = "cull-kept" in "sequence";
    /// The stencil reference is that of the draw before.
    StencilReferenceKept = "stencil-reference-kept" in "sequence";
    /// The blend constant is that of the draw before.
    BlendConstantKept = "blend-constant-kept" in "sequence";
    /// The viewport is that of the draw before.
    ViewportKept = "viewport-kept" in "sequence";
    /// The scissor rectangle is that of the draw before.
    ScissorKept = "scissor-kept" in "sequence";
    /// The first draw of a pass is lost in every pass but the first.
    LaterPassDraw = "later-pass-draw" in "sequence";
    /// The first draw after a pass that writes neither depth nor stencil is lost.
    AfterReadOnly = "after-read-only" in "sequence", vulkan;
    /// Passes after the first clear their colour attachments instead of loading them.
    LoadClears = "load-clears" in "sequence", vulkan;
    /// Clears of passes after the first draw are skipped.
    ClearSkipped = "clear-skipped" in "sequence";
    /// A clear of what was cleared with the same value before is skipped.
    EqualClearSkipped = "equal-clear-skipped" in "sequence";
    /// A clear of a rectangle clears everything.
    ClearRect = "clear-rect" in "sequence";
    /// A clear of depth sets stencil to 0.
    StencilWithDepth = "stencil-with-depth" in "sequence";
    /// Of several targets, only the first is resolved.
    ResolveFirst = "resolve-first" in "sequence";
    /// Every query of a submission has the first one's result.
    QueryFirst = "query-first" in "sequence";
    /// Queries after the first end before their draw.
    QueryEarly = "query-early" in "sequence";
    /// Load operations do not clear colour.
    LoadColorIgnored = "load-color-ignored" in "paths", vulkan;
    /// Load operations do not clear depth.
    LoadDepthIgnored = "load-depth-ignored" in "paths", vulkan;
    /// Load operations do not clear stencil.
    LoadStencilIgnored = "load-stencil-ignored" in "paths", vulkan;
    /// What is drawn in a render pass that is an object is not stored.
    StoreDropped = "store-dropped" in "paths", vulkan;
    /// Attachments are layer 0.
    LayerDropped = "layer-dropped" in "paths";
    /// Attachments are level 0.
    LevelDropped = "level-dropped" in "paths";
    /// Of several targets, the second is not resolved.
    ResolveSecondDropped = "resolve-second-dropped" in "paths", vulkan;
    /// The second target receives what the first is resolved to.
    ResolveSecondFromFirst = "resolve-second-from-first" in "paths", vulkan;
    /// Culling is the pipeline's, although it is dynamic.
    StaticForDynamic = "static-for-dynamic" in "paths", vulkan;
    /// Culling in a pipeline is off.
    StaticIgnored = "static-ignored" in "paths", vulkan;
    /// The first draw of a secondary command buffer is lost.
    SecondaryFirstDraw = "secondary-first-draw" in "paths", vulkan;
    /// The second viewport is the first.
    ViewportFirst = "viewport-first" in "paths";
    /// The first index is 0.
    IndexOffset = "index-offset" in "paths";
    /// Blits leave their target's last column.
    BlitColumn = "blit-column" in "paths";
    /// Attachments are the first face of a cube.
    FaceDropped = "face-dropped" in "paths", opengl;
    /// The clip volume's origin is the upper left.
    ClipOriginKept = "clip-origin-kept" in "paths", opengl;
    /// No index restarts a primitive.
    RestartIgnored = "restart-ignored" in "paths", opengl;
}

impl CallFault {
    /// Returns the fault of this name.
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.iter().copied().find(|fault| fault.name() == name)
    }
}

#[cfg(test)]
mod tests {
    use super::CallFault;

    #[test]
    fn every_fault_is_found_by_its_name() {
        for fault in CallFault::ALL {
            assert_eq!(CallFault::named(fault.name()), Some(*fault));
        }
        assert_eq!(CallFault::named("none"), None);
    }
}
