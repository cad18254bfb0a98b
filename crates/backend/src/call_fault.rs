//! Faults of calls.
//!
//! Each simulates a driver that gets a call wrong because the call is large, late, or affected by the
//! previous draw or pass.

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

            /// Returns the name that adapter names use: `last-row`.
            pub fn name(self) -> &'static str {
                match self {
                    $(Self::$fault => $name,)+
                }
            }

            /// Returns the quick cases that exercise what the fault breaks, as a glob.
            pub fn cases(self) -> &'static str {
                match self {
                    $(Self::$fault => $cases,)+
                }
            }

            /// Returns true if an API has the call.
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
    /// Draws skip the last row.
    LastRow = "last-row" in "size/spanning/*";
    /// Draws skip the last column.
    LastColumn = "last-column" in "size/spanning/*";
    /// Draws skip the second tile of 32×32 texels in the first row.
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
    /// The depth comparison stays the previous draw's.
    CompareKept = "compare-kept" in "sequence/state/depth-compare/*" of Vulkan OpenGl WebGpu;
    /// The write mask of depth stays the previous draw's.
    DepthWriteKept = "depth-write-kept" in "sequence/state/depth-write/*" of Vulkan OpenGl WebGpu;
    /// Culling stays the previous draw's.
    CullKept = "cull-kept" in "sequence/state/cull/*" of Vulkan OpenGl WebGpu;
    /// The stencil reference stays the previous draw's.
    StencilReferenceKept = "stencil-reference-kept" in "sequence/state/stencil-*reference/*" of Vulkan OpenGl WebGpu;
    /// The blend constant stays the previous draw's.
    BlendConstantKept = "blend-constant-kept" in "sequence/state/blend-constant/*" of Vulkan OpenGl WebGpu;
    /// The viewport stays the previous draw's.
    ViewportKept = "viewport-kept" in "sequence/state/viewport-rect/*" of Vulkan OpenGl WebGpu;
    /// The scissor rectangle stays the previous draw's.
    ScissorKept = "scissor-kept" in "sequence/state/scissor/*" of Vulkan OpenGl WebGpu;
    /// The first draw of a pass is lost in every pass but the first.
    LaterPassDraw = "later-pass-draw" in "sequence/depth-left/*" of Vulkan OpenGl WebGpu;
    /// The first draw after a pass that writes neither depth nor stencil is lost.
    AfterReadOnly = "after-read-only" in "sequence/read-only-between/*" of Vulkan;
    /// Passes after the first clear their colour attachments instead of loading them.
    LoadClears = "load-clears" in "sequence/stored-and-loaded/*" of Vulkan WebGpu;
    /// Clears of passes after the first draw are skipped.
    ClearSkipped = "clear-skipped" in "sequence/cleared-*/*";
    /// A clear to the value of the previous clear is skipped.
    EqualClearSkipped = "equal-clear-skipped" in "sequence/again/*";
    /// A clear of a rectangle clears everything.
    ClearRect = "clear-rect" in "sequence/cleared-{by-command,in-parts}/*";
    /// A clear of depth sets stencil to 0.
    StencilWithDepth = "stencil-with-depth" in "sequence/cleared-*/*";
    /// Of several targets, only the first is resolved.
    ResolveFirst = "resolve-first" in "sequence/resolve-several/*" of Vulkan OpenGl WebGpu;
    /// Every query of a submission has the result of the first.
    QueryFirst = "query-first" in "sequence/queries-*/*";
    /// All queries except the first end before their draw.
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
    /// Drawing in a render pass object is not stored.
    StoreDropped = "store-dropped" in "paths/two-passes/*/pass=render-pass/*" of Vulkan;
    // The OpenGL backend reads through attachments too, so it would see what it drew there unless it copies
    // first.
    /// Attachments are always layer 0.
    LayerDropped = "layer-dropped" in "paths/{srgb,integers}/*/target=array-layer" of Vulkan OpenGl WebGpu;
    /// Attachments are always level 0.
    LevelDropped = "level-dropped" in "paths/{srgb,blend-float}/*/target=mip-level" of Vulkan OpenGl WebGpu;
    /// Of several targets, the second is not resolved.
    ResolveSecondDropped = "resolve-second-dropped" in "paths/resolve/pass=dynamic-rendering/*" of Vulkan WebGpu;
    /// The second resolve target receives the resolve of the first attachment.
    ResolveSecondFromFirst = "resolve-second-from-first" in "paths/resolve/pass=dynamic-rendering/*" of Vulkan;
    /// Culling is the pipeline's although it is dynamic.
    StaticForDynamic = "static-for-dynamic" in "paths/cull/*/state=dynamic/*" of Vulkan;
    /// Culling in a pipeline is disabled.
    StaticIgnored = "static-ignored" in "paths/cull/*/state=static/*" of Vulkan;
    /// The first draw of a secondary command buffer is lost.
    SecondaryFirstDraw = "secondary-first-draw" in "paths/strip/commands=secondary/*" of Vulkan WebGpu;
    /// The second viewport is the first.
    ViewportFirst = "viewport-first" in "paths/viewport/*/viewport=array";
    /// The first index is 0.
    IndexOffset = "index-offset" in "paths/strip/*/draws=base-vertex/*" of Vulkan OpenGl WebGpu;
    /// Blits skip the last column of their target.
    BlitColumn = "blit-column" in "paths/depth-ends/end=blit/*";
    /// Attachments are always the first face of a cube map.
    FaceDropped = "face-dropped" in "paths/{blend-float,integers}/end=copy/*/target=cube-face" of OpenGl;
    /// The origin of the clip volume stays the upper left.
    ClipOriginKept = "clip-origin-kept" in "paths/renderbuffer/clip=toggled/*" of OpenGl;
    /// Alpha to coverage stays the previous draw's, if it is dynamic.
    CoverageKept = "coverage-kept" in "sequence/shared/multisample/*/state=extended-dynamic-3/*" of Vulkan;
    /// The sample mask stays the previous draw's, if it is dynamic.
    SampleMaskKept = "sample-mask-kept" in "sequence/shared/multisample/*/state=extended-dynamic-3/*" of Vulkan;
    /// The polygon mode stays the previous draw's, if it is dynamic.
    PolygonModeKept = "polygon-mode-kept" in "sequence/shared/polygon-mode/*/state=extended-dynamic-3/*" of Vulkan;
    /// Depth clamping stays the previous draw's, if it is dynamic.
    DepthClampKept = "depth-clamp-kept" in "sequence/shared/depth-clamp/*/state=extended-dynamic-3/*" of Vulkan;
    /// A sample mask that is set before the pipeline is bound is replaced by the pipeline's.
    SetBeforeBind = "set-before-bind" in "sequence/shared/multisample/*/state=before-pipeline/*" of Vulkan;
    /// Draws whose depth test is enabled are lost if the pass has no depth attachment.
    TestUnattached = "test-unattached" in "paths/tests/*/tests=unattached" of Vulkan;
    /// Locations after one without a colour attachment are not written.
    GapEnds = "gap-ends" in "paths/gaps/*/pass=dynamic-rendering/*" of Vulkan OpenGl WebGpu;
    /// Primitive restart drops the last vertex of a draw without indices.
    RestartUnindexed = "restart-unindexed" in "paths/restart-unindexed/*";
    /// Rasterizer discard stays the previous draw's, if it is dynamic.
    DiscardKept = "discard-kept" in "sequence/shared/rasterizer-discard/*" of Vulkan;
    /// Of several targets, only the first is cleared when a pass begins.
    ClearFirstTarget = "clear-first-target" in "sequence/loads-by-target/*";
    /// Passes without draws resolve nothing.
    EmptyResolve = "empty-resolve" in "sequence/empty-resolve/*" of OpenGl;
    /// An indirect draw executes the largest number of draws, whatever the number in the buffer.
    IndirectMost = "indirect-most" in "paths/indirect-count/*/draws=indirect-count/indexed=false/*" of Vulkan;
    /// An indirect draw whose number of draws is in a buffer loses the last draw.
    IndirectFewer = "indirect-fewer" in "paths/indirect-count/*/draws=indirect-count/indexed=false/*";
    /// Blits read the first color attachment.
    BlitReadsFirst = "blit-reads-first" in "paths/blits/*" of OpenGl;
    /// Blits mirror nothing.
    BlitMirror = "blit-mirror" in "paths/blits*/end=blit-mirrored/*";
    /// Blits scale nothing.
    BlitScale = "blit-scale" in "paths/blits*/end=blit-scaled/*";
    /// Blits filter nothing.
    BlitFilter = "blit-filter" in "paths/blits/end=blit-linear/*";
    /// Blits begin at the destination's first texel, whatever their offset.
    BlitPlace = "blit-place" in "paths/blits/end=blit-part/*";
    /// Blits of only depth, or only stencil, to another position are skipped.
    BlitAspectAlone = "blit-aspect-alone" in "paths/blits-depth-stencil/end=blit-part/*" of OpenGl;
    /// Of the regions of a blit, only the first is copied.
    BlitFirstRegion = "blit-first-region" in "paths/blits/end=blit-part/*" of Vulkan;
    /// The first colour attachment is read, whichever is selected.
    ReadBufferFirst = "read-buffer-first" in "paths/blits/end=read-buffer/*" of OpenGl;
    /// Of several rectangles, only the first is cleared.
    ClearFirstRect = "clear-first-rect" in "paths/clears/clears=together/*" of Vulkan;
    /// Of several aspects or attachments in one call, only the first is cleared.
    ClearFirstOfCall = "clear-first-of-call" in "paths/clears/clears=together/*";
    /// A clear of some draw buffers clears all of them.
    ClearAllBuffers = "clear-all-buffers" in "paths/clears/clears=together/*" of OpenGl;
    /// A draw of no instances draws one.
    EmptyAsOne = "empty-as-one" in "size/places/place=after-empty/*" of Vulkan;
    /// Of several secondary command buffers, only the first is executed.
    SecondarySecond = "secondary-second" in "sequence/kept/way=secondary-each/*" of Vulkan;
    /// Render areas begin at even columns and rows.
    AreaEven = "area-even" in "size/places/place=quarters-loaded/*" of Vulkan;
    /// A clear command forgets the blend constant and the stencil reference.
    ClearForgets = "clear-forgets" in "sequence/kept/way=kept/with=clear" of Vulkan;
    /// A cull mode that was the last dynamic one is not set again, although a pipeline has set another.
    DynamicSkipped = "dynamic-skipped" in "sequence/shared/tests/*/state=turns/*" of Vulkan;
    /// A view of a level above 0 has layer 0.
    LayerOfLevelDropped = "layer-of-level-dropped" in "size/places/place=level-of-layer/*" of Vulkan;
    /// The first clear after a call that leaves contents undefined is skipped.
    ClearUndefinedSkipped = "clear-undefined-skipped" in "paths/clears/clears=undefined/*";
    /// A call that leaves a part of an attachment undefined changes all of it.
    InvalidateAll = "invalidate-all" in "paths/clears/clears=undefined/*" of OpenGl;
    /// Changing attachments opens write masks and disables culling.
    StateForgotten = "state-forgotten" in "paths/state-kept/*";
    /// Vertex shaders write no layer.
    LayerUnwritten = "layer-unwritten" in "sequence/layers/*/layers=written/*";
    /// Of several views, only the first is drawn to.
    ViewFirst = "view-first" in "sequence/layers/*/layers=multiview/*" of Vulkan;
    /// Clears within passes reach only the first of several layers.
    ClearFirstLayer = "clear-first-layer" in "sequence/layers/*/layers=written/*";
    /// Of several ranges, only the first is cleared.
    ClearFirstRange = "clear-first-range" in "sequence/layers/*/layers=written/*" of Vulkan;
    /// Resolved parts keep their places.
    ResolvePlace = "resolve-place" in "sequence/resolves/*";
    /// After a clear, the second scissor rectangle equals the first.
    ScissorFirst = "scissor-first" in "paths/scissor-array/*";
    /// All channels of colour are written.
    WriteMaskOpen = "write-mask-open" in "paths/write-masks/*/start=load-operation" of WebGpu;
    /// Views have their texture's format.
    ViewFormat = "view-format" in "paths/views/*/views=srgb" of Vulkan OpenGl WebGpu;
    /// No index restarts a primitive.
    RestartIgnored = "restart-ignored" in "paths/{lines,strip}/*/draws=restart/*" of OpenGl;
}
