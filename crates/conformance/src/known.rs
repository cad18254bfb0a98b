//! The software drivers under test: their missing features and known faults.

use crate::lacks::Lacks;
use crate::subject::CheckedBackend;
use etalon_backend::Backend;
use etalon_frame::{Api, Feature, PathTarget, PathValue};

/// A check and its defect in a driver. Instead of a check, the name can be [`FOUR_SAMPLES`],
/// [`COUNTING_SHADERS`], sample masks or mip levels.
pub type Defect = (&'static str, &'static str);

/// The name of a defect of four samples: scenes that need them are left out.
pub const FOUR_SAMPLES: &str = "four samples";
/// The name of a defect of shaders that count or write other storage: scenes that need them are left out.
pub const COUNTING_SHADERS: &str = "counting shaders";
/// The name of a defect of sample masks: scenes whose shaders read or write a mask are left out.
pub(crate) const SAMPLE_MASKS: &str = "sample masks";
/// The name of a defect of mip levels: scenes that draw to a level other than the first are left out.
pub(crate) const MIP_LEVELS: &str = "mip levels";
/// The names of defects that do not belong to a check.
pub(crate) const WHOLE: [&str; 4] = [FOUR_SAMPLES, COUNTING_SHADERS, SAMPLE_MASKS, MIP_LEVELS];

/// The known faults and missing features of a driver.
#[derive(Clone, Copy, Debug)]
pub struct KnownFaults {
    /// The adapter's name.
    pub name: &'static str,
    /// The API whose rules apply to the adapter.
    pub api: Api,
    /// The features that the driver lacks; `None` if unknown, which excuses any missing feature.
    pub lacks: Option<Lacks>,
    /// Checks that the driver fails. They are not run.
    pub defects: &'static [&'static [Defect]],
}

impl KnownFaults {
    /// Returns an open backend as the subject of checks, without features that the driver offers but gets
    /// wrong.
    pub fn subject<'a>(
        &self,
        backend: &'a dyn Backend,
        tolerated: &'a [&'a str],
    ) -> CheckedBackend<'a> {
        let defects = self.defects.iter().copied().flatten();
        defects.fold(
            CheckedBackend::new(backend, tolerated),
            |subject, (name, _)| match *name {
                FOUR_SAMPLES => subject.without_four_samples(),
                COUNTING_SHADERS => subject
                    .without_feature(Feature::StorageCounters)
                    .without_feature(Feature::FragmentStorage),
                SAMPLE_MASKS => subject
                    .without_feature(Feature::SampleMaskInput)
                    .without_feature(Feature::SampleMaskOutput),
                MIP_LEVELS => subject.without_path(PathValue::Target(PathTarget::MipLevel)),
                _ => subject,
            },
        )
    }
}

/// Returns what is known about the adapter with this name.
///
/// # Panics
/// If nothing is known.
pub fn known(name: &str) -> KnownFaults {
    let found = KNOWN.iter().find(|known| known.name == name);
    *found.unwrap_or_else(|| panic!("{name} is not described"))
}

const fn driver(
    name: &'static str,
    api: Api,
    lacks: Lacks,
    defects: &'static [&'static [Defect]],
) -> KnownFaults {
    KnownFaults {
        name,
        api,
        lacks: Some(lacks),
        defects,
    }
}

/// The software drivers on which the backends' tests run all checks.
pub const KNOWN: &[KnownFaults] = &[
    driver("vulkan:lavapipe", Api::Vulkan, VULKAN, &[LAVAPIPE_WRONG]),
    driver("gl:llvmpipe", Api::OpenGl, GL, &[]),
    driver("gl:zink", Api::OpenGl, GL_ZINK, &[ZINK_WRONG]),
    driver("gl:softpipe", Api::OpenGl, GL_SOFTPIPE, SOFTPIPE_DEFECTS),
    driver("gl:es:llvmpipe", Api::OpenGlEs, ES, &[]),
    driver("gl:es:zink", Api::OpenGlEs, ES_ZINK, &[ZINK_WRONG]),
    driver(
        "gl:virgl",
        Api::OpenGl,
        GL_VIRGL,
        &[VIRGL_WRONG, VIRGL_SOURCES],
    ),
    driver("gl:es:virgl", Api::OpenGlEs, ES_VIRGL, &[VIRGL_SOURCES]),
    driver(
        "gl:es:softpipe",
        Api::OpenGlEs,
        ES_SOFTPIPE,
        SOFTPIPE_DEFECTS,
    ),
    driver("wgpu:vulkan:lavapipe", Api::WebGpu, WGPU_VULKAN, &[]),
    driver(
        "wgpu:gl:llvmpipe",
        Api::WebGpu,
        WGPU_GL,
        &[WGPU_GL_WRONG, FACTORS],
    ),
    driver(
        "wgpu:gl:softpipe",
        Api::WebGpu,
        WGPU_SOFTPIPE,
        &[SOFTPIPE_WRONG, WGPU_GL_WRONG, WGPU_SOFTPIPE_WRONG],
    ),
    driver("webgpu:chromium", Api::WebGpu, BROWSER, &[]),
    driver("webgpu:compatibility", Api::WebGpu, COMPATIBILITY, &[]),
    driver("webgpu:firefox", Api::WebGpu, FIREFOX, &[]),
    driver("webgpu:dawn", Api::WebGpu, BROWSER, &[]),
    driver("webgpu:deno", Api::WebGpu, DENO, &[]),
];

const NOTHING: Lacks = Lacks {
    features: &[],
    formats: &[],
    drawing: &[],
    blending: &[],
    samples: &[],
};

const EVERY_FORMAT: &str = "r8unorm rg8unorm rgba8unorm rgba8unorm-srgb bgra8unorm rgba8snorm \
    rgb10a2unorm b5g6r5unorm bgr5a1unorm bgra4unorm rg11b10ufloat rgba8uint rgba16float rgba32float \
    r16unorm rg16unorm rgba16unorm bgra8unorm-srgb r8snorm rg8snorm r8uint rgb10a2uint r16uint rg16uint rgba16uint \
    r16float rg16float r32float rg32float \
    depth16unorm depth24plus depth24plus-stencil8 depth32float depth32float-stencil8 stencil8";

const SNORM: &str = "r8snorm rg8snorm rgba8snorm";
const UNORM16: &str = "r16unorm rg16unorm rgba16unorm";
const INTEGERS: &str = "r8uint rgba8uint rgb10a2uint r16uint rg16uint rgba16uint";

const VULKAN: Lacks = Lacks {
    features: &[
        "advanced-blend advanced-blend-coherent clip-distance-mask depth-bounds depth-resolve-max depth-resolve-min independent-resolve \
        independent-resolve-none inherited-queries masked-clears sample-coverage stencil-resolve-max stencil-resolve-min",
    ],
    blending: &[SNORM],
    samples: &["depth24plus depth24plus-stencil8"],
    ..NOTHING
};

/// OpenGL does not specify which sample a blit takes, and WebGPU resolves neither depth nor stencil.
const RESOLVES: &str = "depth-resolve-average depth-resolve-max depth-resolve-min \
    depth-stencil-resolve independent-resolve independent-resolve-none stencil-resolve-max \
    stencil-resolve-min";

/// Reads of the own pass, which need texture barriers or framebuffer fetch.
const OWN_PASS: &str =
    "own-pass-reads own-pass-reads-in-order own-pass-depth-reads own-pass-stencil-reads";
const GL_FEATURES: &str = "depth-bounds inherited-queries mirrored-viewport upper-left-domain";

/// The core profile of llvmpipe. No OpenGL driver stores blue first. No fetch returns 24 bits with
/// certainty.
const GL: Lacks = Lacks {
    features: &[GL_FEATURES, RESOLVES],
    formats: &["bgra8unorm bgra8unorm-srgb"],
    samples: &["depth24plus depth24plus-stencil8"],
    ..NOTHING
};
const GL_ZINK: Lacks = Lacks {
    features: &[GL_FEATURES, RESOLVES, "own-pass-reads-in-order"],
    ..GL
};
const GL_SOFTPIPE: Lacks = Lacks {
    features: &[
        "advanced-blend advanced-blend-coherent cull-distances depth-bias-clamp fragment-storage inherited-queries min-sample-shading \
        mirrored-viewport sample-interpolation sample-mask-input sample-mask-output sample-mask-output-with-alpha-to-coverage \
        sample-shading storage-counters tessellation upper-left-domain",
        RESOLVES,
        OWN_PASS,
    ],
    samples: &[EVERY_FORMAT],
    ..GL
};
/// virgl offers OpenGL 4.3 over a llvmpipe that has 4.5.
const GL_VIRGL: Lacks = Lacks {
    features: &[
        "advanced-blend-coherent cull-distances depth-bounds fragment-invocations inherited-queries mirrored-viewport \
        own-pass-reads-in-order upper-left-domain",
        RESOLVES,
    ],
    ..GL
};

const ES_FEATURES: &str = "alpha-to-one conservative-depth depth-bounds first-provoking-vertex \
    forced-early-tests-with-depth fragment-invocations fragment-shader-absent fragment-shader-absent-with-color inherited-queries linear-interpolation logic-operations \
    mirrored-viewport mixed-provoking-vertices polygon-mode-line precise-occlusion stencil-export \
    upper-left-domain";
/// OpenGL ES of llvmpipe.
const ES: Lacks = Lacks {
    features: &[ES_FEATURES, RESOLVES],
    formats: &["bgra8unorm bgra8unorm-srgb"],
    ..NOTHING
};
const ES_ZINK: Lacks = Lacks {
    features: &[ES_FEATURES, RESOLVES, OWN_PASS],
    ..ES
};
const ES_VIRGL: Lacks = Lacks {
    features: &[ES_FEATURES, RESOLVES, OWN_PASS, "advanced-blend-coherent"],
    ..ES
};
const ES_SOFTPIPE: Lacks = Lacks {
    features: &[
        ES_FEATURES,
        RESOLVES,
        OWN_PASS,
        "advanced-blend advanced-blend-coherent depth-bias-clamp independent-blend \
        min-sample-shading sample-interpolation sample-mask-input sample-mask-output \
        sample-mask-output-with-alpha-to-coverage sample-shading tessellation",
    ],
    samples: &[EVERY_FORMAT],
    ..ES
};

const WGPU_FEATURES: &str = "advanced-blend advanced-blend-coherent alpha-to-coverage-of-one-sample alpha-to-coverage-without-alpha alpha-to-one clear-commands \
    clip-distance-mask cull-distances fragment-shader-absent-with-color \
    sample-mask-output-with-alpha-to-coverage constant-alpha-blend-factor depth-bounds \
    depth-output-without-depth front-and-back-culling inherited-queries last-provoking-vertex \
    logic-operations masked-clears min-max-blend-factors min-sample-shading mirrored-viewport \
    mixed-provoking-vertices own-pass-reads own-pass-reads-in-order own-pass-depth-reads own-pass-stencil-reads \
    polygon-mode-line precise-occlusion queries-over-passes rasterizer-discard reversed-depth-range \
    sample-coverage scissor-outside separate-stencil-masks stencil-export tessellation triangle-fans \
    upper-left-domain";
/// The samples' codes of two formats cannot be read with certainty; WebGPU does not resolve integers.
const WGPU_VULKAN: Lacks = Lacks {
    features: &[WGPU_FEATURES, RESOLVES],
    formats: &["b5g6r5unorm bgr5a1unorm bgra4unorm"],
    blending: &[SNORM],
    samples: &[SNORM, UNORM16, INTEGERS, "depth16unorm"],
    ..NOTHING
};
/// A browser has the features of WebGPU. Over SwiftShader it offers no second source.
const BROWSER: Lacks = Lacks {
    features: &[
        WGPU_FEATURES,
        RESOLVES,
        "conservative-depth dual-source-blending forced-early-tests forced-early-tests-with-depth fragment-invocations",
    ],
    formats: &["b5g6r5unorm bgr5a1unorm bgra4unorm", UNORM16],
    drawing: &[SNORM],
    blending: &[],
    samples: &[
        SNORM,
        INTEGERS,
        "r32float rg32float rgba32float depth16unorm",
    ],
};
/// Compatibility mode has no views in other formats, which are needed to read samples of sRGB.
const COMPATIBILITY: Lacks = Lacks {
    features: &[
        WGPU_FEATURES,
        RESOLVES,
        "conservative-depth depth-bias-clamp dual-source-blending first-provoking-vertex forced-early-tests \
        forced-early-tests-with-depth fragment-invocations independent-blend linear-interpolation \
        sample-interpolation sample-mask-input sample-mask-output sample-shading",
    ],
    formats: &[
        "b5g6r5unorm bgr5a1unorm bgra4unorm bgra8unorm-srgb",
        UNORM16,
    ],
    samples: &[
        SNORM,
        INTEGERS,
        "rgba8unorm-srgb rgba16float r32float rg32float rgba32float depth16unorm",
    ],
    ..BROWSER
};
const FIREFOX: Lacks = Lacks {
    features: &[
        WGPU_FEATURES,
        RESOLVES,
        "clip-distances conservative-depth dual-source-blending forced-early-tests forced-early-tests-with-depth \
        fragment-invocations",
    ],
    blending: &["r32float rg32float rgba32float"],
    ..BROWSER
};
const DENO: Lacks = Lacks {
    features: &[
        WGPU_FEATURES,
        RESOLVES,
        "conservative-depth forced-early-tests forced-early-tests-with-depth fragment-invocations",
    ],
    ..BROWSER
};
/// wgpu 30 over OpenGL requires extensions that core contexts do not need. It has no views in other
/// formats, and reads all depths with a shader.
const WGPU_GL: Lacks = Lacks {
    features: &[
        WGPU_FEATURES,
        RESOLVES,
        "depth-bias-clamp fragment-invocations",
    ],
    drawing: &[SNORM, "rg11b10ufloat r32float rg32float rgba32float"],
    blending: &[],
    samples: &[SNORM, UNORM16, INTEGERS, "rgba8unorm-srgb bgra8unorm-srgb"],
    ..WGPU_VULKAN
};
const WGPU_SOFTPIPE: Lacks = Lacks {
    features: &[
        WGPU_FEATURES,
        RESOLVES,
        "depth-bias-clamp fragment-invocations independent-blend sample-interpolation sample-shading",
    ],
    drawing: &[SNORM],
    blending: &["r32float rg32float rgba32float"],
    ..WGPU_GL
};

#[rustfmt::skip]
const LAVAPIPE_WRONG: &[Defect] = &[
    ("resolves::depths_are_averaged", "the first sample instead of the average"),
];
#[rustfmt::skip]
const ZINK_WRONG: &[Defect] = &[
    ("clears::masked_clears_keep_the_rest", "stencil that a masked clear sets to 0 instead of its value"),
];
/// Defects of virglrenderer through OpenGL. OpenGL ES reads depth by a shader.
#[rustfmt::skip]
const VIRGL_WRONG: &[Defect] = &[
    ("depth::depths_start_from_their_clear", SIXTEEN_BITS),
    ("depth::depths_are_compared_with_the_stored_one", SIXTEEN_BITS),
    ("targets::logic_operations_follow_their_truth_tables", "the first operation, as long as operations stay enabled"),
];
const SIXTEEN_BITS: &str = "depths of 24 bits that are read back without their low eight";
/// Functions of targets without blending stay as they were, and OpenGL refuses a draw to two targets.
#[rustfmt::skip]
const VIRGL_SOURCES: &[Defect] = &[
    ("targets::later_draws_have_one_source", "a connection that the server closes after the draw fails"),
];
/// Softpipe's defects through OpenGL and OpenGL ES.
const SOFTPIPE_DEFECTS: &[&[Defect]] = &[SOFTPIPE_WRONG, SOFTPIPE_CLAMPS, SOFTPIPE_CLEARS];
#[rustfmt::skip]
/// Checks that softpipe fails in OpenGL and OpenGL ES.
pub const SOFTPIPE_CLEARS: &[Defect] = &[
    ("clears::clears_know_their_target", "a clear of integers that is lost to the clear of a rectangle after it"),
];
/// Checks that softpipe fails in every API.
#[rustfmt::skip]
pub const SOFTPIPE_WRONG: &[Defect] = &[
    ("depth::a_slope_bias_counts_the_slope", "a bias that is not the slope times its factor"),
    ("sampling::neighbours_in_the_mirror_are_averaged", "the wrong neighbour in the mirror"),
    ("formats::uploads_are_fetched", "the lowest code of rgba8snorm, fetched as less than -1"),
    ("counters::rejected_fragments_run", EARLY),
    ("counters::forced_tests_come_before_the_shader", EARLY),
];
const EARLY: &str = "fragments that are rejected before a shader that counts";
/// Checks that it fails with clip control.
const SOFTPIPE_CLAMPS: &[Defect] = &[
    ("depth::depths_outside_are_clamped", CLAMP),
    ("depth::depths_are_clamped_to_a_reversed_range", CLAMP),
];
/// Near = translate - scale in `sp_quad_depth_test.c`.
const CLAMP: &str = "depths are clamped to the range that clip depths from -1 to 1 would have";

/// wgpu's OpenGL never enables primitive restart.
#[rustfmt::skip]
const WGPU_GL_WRONG: &[Defect] = &[
    ("raster::strips_begin_again", "strips that are joined"),
    ("fetch::strips_of_16_bit_indices_restart", "strips that are joined"),
    ("formats::uploads_come_back", "negative codes of rgba8snorm that come back as 0"),
    // wgpu's OpenGL offers four samples even if the driver supports only one, and creates no texture from
    // which a shader could read them.
    (FOUR_SAMPLES, "textures of four samples that stay empty"),
    (SAMPLE_MASKS, "gl_SampleMask and gl_SampleMaskIn as one integer, which does not compile"),
];
/// wgpu's OpenGL does not reset the factors of a draw with two sources, and Mesa then rejects later draws
/// to several targets with GL_INVALID_OPERATION.
#[rustfmt::skip]
const FACTORS: &[Defect] = &[
    ("targets::later_draws_have_one_source", "factors of a second source that outlive their draw"),
];
#[rustfmt::skip]
const WGPU_SOFTPIPE_WRONG: &[Defect] = &[
    (COUNTING_SHADERS, "storage buffers that wgpu does not translate to GLSL 330"),
    // Without glTexStorage it does not set GL_TEXTURE_MAX_LEVEL, so a texture of two levels is incomplete.
    (MIP_LEVELS, "framebuffers of a mip level that are incomplete with OpenGL 3.3"),
    ("integers::integers_are_drawn_through_the_write_mask", "a clear that is lost to the pass's draws"),
    ("targets::the_second_source_is_a_factor", SECOND),
    ("targets::the_second_source_weighs_one_side", SECOND),
    ("targets::later_draws_have_one_source", SECOND),
    ("counters::any_samples_that_pass_are_told", TIMESTAMP),
    ("counters::any_samples_of_several_passes_are_told", TIMESTAMP),
    ("counters::a_query_counts_what_it_encloses", TIMESTAMP),
];
/// Mesa's `softpipe_end_query` decrements the number of active queries even for a timestamp, which never
/// began. The occlusion queries between the first two timestamps of a context therefore count nothing.
const TIMESTAMP: &str = "occlusion queries that stay 0 after a context's first timestamp";
const SECOND: &str = "a second source that comes as the first";
