//! Capabilities that an adapter can lack.

use crate::state_enum;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

state_enum! {
    /// A capability that a scene can need and that not every adapter has.
    Feature: array {
        /// Advanced blending: `multiply`, `screen` and the other modes that take no factors.
        AdvancedBlend = "advanced-blend",
        /// Advanced blending over what the same pass has already drawn, in order.
        AdvancedBlendCoherent = "advanced-blend-coherent",
        /// Alpha to coverage with a single sample per texel.
        AlphaToCoverageOfOneSample = "alpha-to-coverage-of-one-sample",
        /// Alpha to coverage if the first color attachment lacks alpha, stores integers or is absent.
        AlphaToCoverageWithoutAlpha = "alpha-to-coverage-without-alpha",
        /// Alpha counting as 1 after alpha to coverage.
        AlphaToOne = "alpha-to-one",
        /// A number that a draw call adds to every index.
        BaseVertex = "base-vertex",
        /// Attributes interpolated inside the part of a texel that a primitive covers.
        CentroidInterpolation = "centroid-interpolation",
        /// Clears between the draws of a pass, of all texels or a rectangle.
        ClearCommands = "clear-commands",
        /// Turning off individual clip distances of a shader.
        ClipDistanceMask = "clip-distance-mask",
        /// Shaders that write clip distances.
        ClipDistances = "clip-distances",
        /// Shaders that declare on which side of the fragment's own depth their depth is.
        ConservativeDepth = "conservative-depth",
        /// The factors `constant-alpha` and `one-minus-constant-alpha` for colour.
        ConstantAlphaBlendFactor = "constant-alpha-blend-factor",
        /// Shaders that discard primitives by the cull distances of all vertices.
        CullDistances = "cull-distances",
        /// A limit on depth bias.
        DepthBiasClamp = "depth-bias-clamp",
        /// Rejecting fragments by the stored depth.
        DepthBounds = "depth-bounds",
        /// Clamping of depths beyond the viewport's range to its ends.
        DepthClamp = "depth-clamp",
        /// Shaders that write a depth without a depth attachment.
        DepthOutputWithoutDepth = "depth-output-without-depth",
        /// Resolving depth to the average of its samples.
        DepthResolveAverage = "depth-resolve-average",
        /// Resolving depth to its greatest sample.
        DepthResolveMax = "depth-resolve-max",
        /// Resolving depth to its least sample.
        DepthResolveMin = "depth-resolve-min",
        /// Resolving depth and stencil to their first samples.
        DepthStencilResolve = "depth-stencil-resolve",
        /// Blending with two sources.
        DualSourceBlending = "dual-source-blending",
        /// Instances that do not start from the first one.
        FirstInstance = "first-instance",
        /// Flat attributes from a primitive's first vertex.
        FirstProvokingVertex = "first-provoking-vertex",
        /// Shaders that are forced to run after the depth and stencil tests.
        ForcedEarlyTests = "forced-early-tests",
        /// Forced early tests with a shader that writes a depth, which then has no effect.
        ForcedEarlyTestsWithDepth = "forced-early-tests-with-depth",
        /// A viewport whose place or size has fractions of a texel.
        FractionalViewport = "fractional-viewport",
        /// Pipeline statistics of fragment shader runs.
        FragmentInvocations = "fragment-invocations",
        /// Draws without a fragment shader.
        FragmentShaderAbsent = "fragment-shader-absent",
        /// Draws without a fragment shader that have colour attachments, with all channels masked.
        FragmentShaderAbsentWithColor = "fragment-shader-absent-with-color",
        /// Fragment shaders that write storage with atomics; later passes read it.
        FragmentStorage = "fragment-storage",
        /// Culling front and back faces together.
        FrontAndBackCulling = "front-and-back-culling",
        /// Blending and write masks that differ between colour attachments.
        IndependentBlend = "independent-blend",
        /// Resolving depth in one way and stencil in another.
        IndependentResolve = "independent-resolve",
        /// Resolving depth but not stencil, or stencil but not depth.
        IndependentResolveNone = "independent-resolve-none",
        /// Queries that continue in secondary command buffers.
        InheritedQueries = "inherited-queries",
        /// Flat attributes from a primitive's last vertex.
        LastProvokingVertex = "last-provoking-vertex",
        /// Attributes that are interpolated linearly in the window.
        LinearInterpolation = "linear-interpolation",
        /// Logic operations.
        LogicOperations = "logic-operations",
        /// Clear commands that leave masked channels and bits unchanged.
        MaskedClears = "masked-clears",
        /// The operations `min` and `max` with factors other than `one` (which they ignore).
        MinMaxBlendFactors = "min-max-blend-factors",
        /// Sample shading: the shader runs for at least a given fraction of each texel's samples.
        MinSampleShading = "min-sample-shading",
        /// A viewport of negative height, which flips the picture.
        MirroredViewport = "mirrored-viewport",
        /// Flat attributes from the first vertex in one draw and from the last in another draw of the same
        /// pass.
        MixedProvokingVertices = "mixed-provoking-vertices",
        /// Shaders that read the depth that earlier draws of the pass left under the fragment.
        OwnPassDepthReads = "own-pass-depth-reads",
        /// Shaders that read the colours that earlier draws of the pass left under the fragment.
        OwnPassReads = "own-pass-reads",
        /// The same for draws that overlap themselves: each fragment reads what the previous one left.
        OwnPassReadsInOrder = "own-pass-reads-in-order",
        /// Shaders that read the stencil that earlier draws of the pass left under the fragment.
        OwnPassStencilReads = "own-pass-stencil-reads",
        /// Drawing the edges of polygons.
        PolygonModeLine = "polygon-mode-line",
        /// Occlusion queries that count samples exactly.
        PreciseOcclusion = "precise-occlusion",
        /// Queries that enclose passes.
        QueriesOverPasses = "queries-over-passes",
        /// Discarding primitives before rasterization.
        RasterizerDiscard = "rasterizer-discard",
        /// A viewport whose near depth is above its far depth.
        ReversedDepthRange = "reversed-depth-range",
        /// Sample coverage: drawing only a given fraction of each texel's samples, or only the rest.
        SampleCoverage = "sample-coverage",
        /// Attributes interpolated at the sample that is being shaded.
        SampleInterpolation = "sample-interpolation",
        /// Sample masks that fragment shaders read.
        SampleMaskInput = "sample-mask-input",
        /// Sample masks that fragment shaders write.
        SampleMaskOutput = "sample-mask-output",
        /// Sample masks that fragment shaders write, together with alpha to coverage.
        SampleMaskOutputWithAlphaToCoverage = "sample-mask-output-with-alpha-to-coverage",
        /// Shaders that run once per sample and know which sample it is.
        SampleShading = "sample-shading",
        /// A scissor rectangle that reaches beyond the attachments.
        ScissorOutside = "scissor-outside",
        /// Stencil masks or references that differ between front and back faces.
        SeparateStencilMasks = "separate-stencil-masks",
        /// Stencil references that fragment shaders write.
        StencilExport = "stencil-export",
        /// Resolving stencil to its greatest sample.
        StencilResolveMax = "stencil-resolve-max",
        /// Resolving stencil to its least sample.
        StencilResolveMin = "stencil-resolve-min",
        /// Fragment shaders that count in storage buffers.
        StorageCounters = "storage-counters",
        /// Tessellation of triangles.
        Tessellation = "tessellation",
        /// Triangle fans.
        TriangleFans = "triangle-fans",
        /// A tessellation domain whose origin is the upper left corner.
        UpperLeftDomain = "upper-left-domain",
        /// A viewport that reaches beyond the attachments.
        ViewportOutside = "viewport-outside",
    }
}
