//! Faults of calls.
//!
//! Each stands for a driver that gets one of many things wrong: a large one, a late one, or one that the draw or pass
//! before has touched.

use etalon_frame::Api;
use serde::{Deserialize, Serialize};

macro_rules! faults {
    ($($(#[$doc:meta])* $fault:ident = $name:literal in $cases:literal $(of $($api:ident)+)?;)+) => {
        /// A planted fault of a driver's calls.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
        pub enum CallFault {
            $($(#[$doc])* #[serde(rename = $name)] $fault,)+
        }

        impl CallFault {
            /// Every fault.
            pub const ALL: &[Self] = &[$(Self::$fault),+];

            /// The name in adapter names: `last-row`.
            pub fn name(self) -> &'static str {
                match self {
                    $(Self::$fault => $name,)+
                }
            }

            /// The quick cases that are made for what it breaks, as a glob.
            pub fn cases(self) -> &'static str {
                match self {
                    $(Self::$fault => $cases,)+
                }
            }

            /// True if an API has the call.
            pub fn is_in(self, api: Api) -> bool {
                let apis: &[Api] = match self {
                    $(Self::$fault => faults!(@apis $($($api)+)?),)+
                };
                apis.contains(&api)
            }
        }
    };
    (@apis $($api:ident)+) => { &[$(Api::$api),+] };
    (@apis) => { &[Api::Vulkan, Api::OpenGl] };
}

faults! {
    /// Draws reach the first 64×64 texels.
    OnlyFirst64 = "only-first-64" in "size/spanning/*";
    /// Draws do not reach the last row.
    LastRow = "last-row" in "size/spanning/*";
    /// Draws do not reach the last column.
    LastColumn = "last-column" in "size/spanning/*";
    /// Draws do not reach the second tile of 32×32 of the first row.
    SecondTile = "second-tile" in "size/spanning/*";
    /// Scissor rectangles whose right edge is a multiple of 16 are a column too small.
    ScissorEdge = "scissor-edge" in "size/tiles/sizes/by=scissor/*" of Vulkan OpenGl WebGpu;
    /// Draw number 256 of a pass is lost.
    Draw256 = "draw-256" in "size/tiles/draws/*";
    /// Indices past 65,535 are lost.
    Indices65535 = "indices-65535" in "size/primitives/past-16-bits/*";
    /// Vertices past 4,096 are lost in draws without indices.
    Vertices4096 = "vertices-4096" in "size/primitives/points/*";
    /// Points and lines past the first 500 are lost.
    Lines500 = "lines-500" in "size/primitives/{lines,points}/*";
    /// The base vertex is 0.
    BaseVertex = "base-vertex" in "size/offsets/indexed/*" of Vulkan OpenGl WebGpu;
    /// The first index is one too late.
    FirstIndex = "first-index" in "size/offsets/indexed/*" of Vulkan OpenGl WebGpu;
    /// The first instance is 0.
    FirstInstance = "first-instance" in "size/instances/*" of Vulkan OpenGl WebGpu;
    /// Instances after the first are lost.
    SecondInstance = "second-instance" in "size/instances/*" of Vulkan OpenGl WebGpu;
    /// The depth comparison is that of the draw before.
    CompareKept = "compare-kept" in "sequence/state/depth-compare/*" of Vulkan OpenGl WebGpu;
    /// The write mask of depth is that of the draw before.
    DepthWriteKept = "depth-write-kept" in "sequence/state/depth-write/*" of Vulkan OpenGl WebGpu;
    /// Culling is that of the draw before.
    CullKept = "cull-kept" in "sequence/state/cull/*" of Vulkan OpenGl WebGpu;
    /// The stencil reference is that of the draw before.
    StencilReferenceKept = "stencil-reference-kept" in "sequence/state/stencil-*reference/*" of Vulkan OpenGl WebGpu;
    /// The blend constant is that of the draw before.
    BlendConstantKept = "blend-constant-kept" in "sequence/state/blend-constant/*" of Vulkan OpenGl WebGpu;
    /// The viewport is that of the draw before.
    ViewportKept = "viewport-kept" in "sequence/state/viewport-rect/*" of Vulkan OpenGl WebGpu;
    /// The scissor rectangle is that of the draw before.
    ScissorKept = "scissor-kept" in "sequence/state/scissor/*" of Vulkan OpenGl WebGpu;
    /// The first draw of a pass is lost in every pass but the first.
    LaterPassDraw = "later-pass-draw" in "sequence/depth-left/*" of Vulkan OpenGl WebGpu;
    /// The first draw after a pass that writes neither depth nor stencil is lost.
    AfterReadOnly = "after-read-only" in "sequence/read-only-between/*" of Vulkan;
    /// Passes after the first clear their colour attachments instead of loading them.
    LoadClears = "load-clears" in "sequence/stored-and-loaded/*" of Vulkan WebGpu;
    /// Clears of passes after the first draw are skipped.
    ClearSkipped = "clear-skipped" in "sequence/cleared-*/*";
    /// A clear of what was cleared with the same value before is skipped.
    EqualClearSkipped = "equal-clear-skipped" in "sequence/again/*";
    /// A clear of a rectangle clears everything.
    ClearRect = "clear-rect" in "sequence/cleared-{by-command,in-parts}/*";
    /// A clear of depth sets stencil to 0.
    StencilWithDepth = "stencil-with-depth" in "sequence/cleared-*/*";
    /// Of several targets, only the first is resolved.
    ResolveFirst = "resolve-first" in "sequence/resolve-several/*" of Vulkan OpenGl WebGpu;
    /// Every query of a submission has the first one's result.
    QueryFirst = "query-first" in "sequence/queries-*/*";
    /// Queries after the first end before their draw.
    QueryEarly = "query-early" in "sequence/queries-*/*";
    /// Queries end after their first draw, if they can end within a pass.
    QueryOneDraw = "query-one-draw" in "sequence/spans/*";
    /// Queries begin again at each draw.
    QueryLastDraw = "query-last-draw" in "sequence/spans/*" of OpenGl;
    /// Queries that begin before a pass end after it.
    QueryOnePass = "query-one-pass" in "sequence/spans/*";
    /// Clears count in queries.
    QueryClear = "query-clear" in "sequence/spans/*" of OpenGl;
    /// Results that are read again are 0.
    ResultOnce = "result-once" in "sequence/spans/*/results=twice/*";
    /// Load operations do not clear colour.
    LoadColorIgnored = "load-color-ignored" in "paths/write-masks/*/start=load-operation" of Vulkan WebGpu;
    /// Load operations do not clear depth.
    LoadDepthIgnored = "load-depth-ignored" in "paths/depth-stencil/*/start=load-operation/*" of Vulkan WebGpu;
    /// Load operations do not clear stencil.
    LoadStencilIgnored = "load-stencil-ignored" in "paths/depth-stencil/*/start=load-operation/*" of Vulkan WebGpu;
    /// What is drawn in a render pass that is an object is not stored.
    StoreDropped = "store-dropped" in "paths/two-passes/*/pass=render-pass/*" of Vulkan;
    // OpenGL reads through attachments too, and sees what it drew there unless it is copied first.
    /// Attachments are layer 0.
    LayerDropped = "layer-dropped" in "paths/{srgb,integers}/*/target=array-layer" of Vulkan OpenGl WebGpu;
    /// Attachments are level 0.
    LevelDropped = "level-dropped" in "paths/{srgb,blend-float}/*/target=mip-level" of Vulkan OpenGl WebGpu;
    /// Of several targets, the second is not resolved.
    ResolveSecondDropped = "resolve-second-dropped" in "paths/resolve/pass=dynamic-rendering/*" of Vulkan WebGpu;
    /// The second target receives what the first is resolved to.
    ResolveSecondFromFirst = "resolve-second-from-first" in "paths/resolve/pass=dynamic-rendering/*" of Vulkan;
    /// Culling is the pipeline's, although it is dynamic.
    StaticForDynamic = "static-for-dynamic" in "paths/cull/*/state=dynamic/*" of Vulkan;
    /// Culling in a pipeline is off.
    StaticIgnored = "static-ignored" in "paths/cull/*/state=static/*" of Vulkan;
    /// The first draw of a secondary command buffer is lost.
    SecondaryFirstDraw = "secondary-first-draw" in "paths/strip/commands=secondary/*" of Vulkan WebGpu;
    /// The second viewport is the first.
    ViewportFirst = "viewport-first" in "paths/viewport/*/viewport=array";
    /// The first index is 0.
    IndexOffset = "index-offset" in "paths/strip/*/draws=base-vertex/*" of Vulkan OpenGl WebGpu;
    /// Blits leave their target's last column.
    BlitColumn = "blit-column" in "paths/depth-ends/end=blit/*";
    /// Attachments are the first face of a cube.
    FaceDropped = "face-dropped" in "paths/{blend-float,integers}/end=copy/*/target=cube-face" of OpenGl;
    /// The clip volume's origin is the upper left.
    ClipOriginKept = "clip-origin-kept" in "paths/renderbuffer/clip=toggled/*" of OpenGl;
    /// Alpha to coverage is that of the draw before, where it is dynamic.
    CoverageKept = "coverage-kept" in "sequence/shared/multisample/*/state=extended-dynamic-3/*" of Vulkan;
    /// The sample mask is that of the draw before, where it is dynamic.
    SampleMaskKept = "sample-mask-kept" in "sequence/shared/multisample/*/state=extended-dynamic-3/*" of Vulkan;
    /// The polygon mode is that of the draw before, where it is dynamic.
    PolygonModeKept = "polygon-mode-kept" in "sequence/shared/polygon-mode/*/state=extended-dynamic-3/*" of Vulkan;
    /// Depth clamping is that of the draw before, where it is dynamic.
    DepthClampKept = "depth-clamp-kept" in "sequence/shared/depth-clamp/*/state=extended-dynamic-3/*" of Vulkan;
    /// A sample mask that is set before the pipeline is bound is lost: it is the pipeline's.
    SetBeforeBind = "set-before-bind" in "sequence/shared/multisample/*/state=before-pipeline/*" of Vulkan;
    /// Depth tests that none passes lose their draws, also without an attachment.
    TestUnattached = "test-unattached" in "paths/tests/*/tests=unattached" of Vulkan;
    /// Behind a location without a colour attachment nothing is written.
    GapEnds = "gap-ends" in "paths/gaps/*/pass=dynamic-rendering/*" of Vulkan OpenGl WebGpu;
    /// Restart ends a draw without indices before its last vertex.
    RestartUnindexed = "restart-unindexed" in "paths/restart-unindexed/*";
    /// Rasterizer discard is that of the draw before, where it is dynamic.
    DiscardKept = "discard-kept" in "sequence/shared/rasterizer-discard/*" of Vulkan;
    /// Of several targets, only the first is cleared when a pass begins.
    ClearFirstTarget = "clear-first-target" in "sequence/loads-by-target/*";
    /// Passes without draws resolve nothing.
    EmptyResolve = "empty-resolve" in "sequence/empty-resolve/*" of OpenGl;
    /// As many draws as there may be take place, whatever their number in the buffer.
    IndirectMost = "indirect-most" in "paths/indirect-count/*/draws=indirect-count/indexed=false/*" of Vulkan;
    /// Of draws whose number is in a buffer, the last is lost.
    IndirectFewer = "indirect-fewer" in "paths/indirect-count/*/draws=indirect-count/indexed=false/*";
    /// Blits read the first color attachment.
    BlitReadsFirst = "blit-reads-first" in "paths/blits/*" of OpenGl;
    /// Blits mirror nothing.
    BlitMirror = "blit-mirror" in "paths/blits*/end=blit-mirrored/*";
    /// Blits scale nothing.
    BlitScale = "blit-scale" in "paths/blits*/end=blit-scaled/*";
    /// Blits filter nothing.
    BlitFilter = "blit-filter" in "paths/blits/end=blit-linear/*";
    /// Blits begin at the first texel of the destination.
    BlitPlace = "blit-place" in "paths/blits/end=blit-part/*";
    /// Blits of depth alone to another place are skipped, and those of stencil alone.
    BlitAspectAlone = "blit-aspect-alone" in "paths/blits-depth-stencil/end=blit-part/*" of OpenGl;
    /// Of the regions of a blit, only the first is copied.
    BlitFirstRegion = "blit-first-region" in "paths/blits/end=blit-part/*" of Vulkan;
    /// What is read is the first color attachment.
    ReadBufferFirst = "read-buffer-first" in "paths/blits/end=read-buffer/*" of OpenGl;
    /// Of several rectangles, only the first is cleared.
    ClearFirstRect = "clear-first-rect" in "paths/clears/clears=together/*" of Vulkan;
    /// Of several aspects or attachments in one call, only the first is cleared.
    ClearFirstOfCall = "clear-first-of-call" in "paths/clears/clears=together/*";
    /// A clear of some draw buffers clears all of them.
    ClearAllBuffers = "clear-all-buffers" in "paths/clears/clears=together/*" of OpenGl;
    /// The first clear behind what leaves contents undefined is skipped.
    ClearUndefinedSkipped = "clear-undefined-skipped" in "paths/clears/clears=undefined/*";
    /// What leaves a part of an attachment undefined changes all of it.
    InvalidateAll = "invalidate-all" in "paths/clears/clears=undefined/*" of OpenGl;
    /// Other attachments come with open masks, and without culling.
    StateForgotten = "state-forgotten" in "paths/state-kept/*";
    /// Vertex shaders write no layer.
    LayerUnwritten = "layer-unwritten" in "sequence/layers/*/layers=written/*";
    /// Of several views, only the first is drawn to.
    ViewFirst = "view-first" in "sequence/layers/*/layers=multiview/*" of Vulkan;
    /// Of several layers, clears within passes reach the first.
    ClearFirstLayer = "clear-first-layer" in "sequence/layers/*/layers=written/*";
    /// Of several ranges, only the first is cleared.
    ClearFirstRange = "clear-first-range" in "sequence/layers/*/layers=written/*" of Vulkan;
    /// Resolved parts stay in their places.
    ResolvePlace = "resolve-place" in "sequence/resolves/*";
    /// Behind a clear, the second scissor rectangle is the first.
    ScissorFirst = "scissor-first" in "paths/scissor-array/*";
    /// All channels of colour are written.
    WriteMaskOpen = "write-mask-open" in "paths/write-masks/*/start=load-operation" of WebGpu;
    /// Views have their texture's format.
    ViewFormat = "view-format" in "paths/views/*/views=srgb" of Vulkan OpenGl WebGpu;
    /// No index restarts a primitive.
    RestartIgnored = "restart-ignored" in "paths/{lines,strip}/*/draws=restart/*" of OpenGl;
}
