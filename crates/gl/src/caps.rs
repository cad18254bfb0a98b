//! The capabilities of a context, from its version and extensions.

use glow::HasContext;
use naga::back::glsl;

/// The extension that lets vertex shaders select a viewport.
pub(crate) const SECOND_VIEWPORT: &str = "GL_ARB_shader_viewport_layer_array";

/// The extensions that let vertex shaders select a layer.
const VERTEX_LAYER: [&str; 2] = [SECOND_VIEWPORT, "GL_AMD_vertex_shader_layer"];

/// Framebuffer fetch in the order of primitives.
pub(crate) const FETCH: &str = "GL_EXT_shader_framebuffer_fetch";
/// Framebuffer fetch with barriers.
pub(crate) const FETCH_BY_BARRIERS: &str = "GL_EXT_shader_framebuffer_fetch_non_coherent";
/// Framebuffer fetch of depth and stencil.
pub(crate) const FETCH_DEPTH_STENCIL: &str = "GL_ARM_shader_framebuffer_fetch_depth_stencil";
/// The extension that lets fragment shaders allow advanced blend equations.
pub(crate) const ADVANCED_BLEND: &str = "GL_KHR_blend_equation_advanced";

/// The extension that lets fragment shaders write the stencil reference.
pub(crate) const STENCIL_EXPORT: &str = "GL_ARB_shader_stencil_export";

/// The capabilities that this backend uses.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Caps {
    pub(crate) es: bool,
    pub(crate) version: (u32, u32),
    pub(crate) glsl: glsl::Version,
    /// `glClipControl` sets WebGPU's conventions; otherwise the shaders adapt.
    pub(crate) clip_control: bool,
    /// Blend functions and write masks can differ between colour targets.
    pub(crate) indexed_blend: bool,
    /// Blend factors can use the fragment shader's second source.
    pub(crate) dual_source: bool,
    /// Advanced blends see the writes of earlier draws without a barrier.
    pub(crate) coherent_blend: bool,
    /// 32-bit float attachments can be blended.
    pub(crate) float_blend: bool,
    /// Signed normalized attachments can be drawn to.
    pub(crate) snorm_attachments: bool,
    /// Depths can be clamped instead of clipped.
    pub(crate) depth_clamp: bool,
    /// Alpha can be set to one (`GL_SAMPLE_ALPHA_TO_ONE`).
    pub(crate) alpha_to_one: bool,
    /// Shaders have the sample index, and run per sample if they use it.
    pub(crate) sample_variables: bool,
    /// Multisampled textures exist.
    pub(crate) multisample_textures: bool,
    /// `GL_PRIMITIVE_RESTART_FIXED_INDEX` exists.
    pub(crate) fixed_restart: bool,
    /// A shader can fetch the stencil of a depth-stencil texture.
    pub(crate) stencil_texturing: bool,
    /// Fragment shaders write the stencil reference ([`STENCIL_EXPORT`]).
    pub(crate) stencil_export: bool,
    /// Shaders read what the framebuffer holds, in the order of primitives ([`FETCH`]).
    pub(crate) fetches_in_order: bool,
    /// Shaders read the depth and stencil that the framebuffer holds.
    pub(crate) fetches_depth_stencil: bool,
    /// Stencil-only textures exist.
    pub(crate) stencil_textures: bool,
    /// Shaders can force early fragment tests.
    pub(crate) early_tests: bool,
    /// Shaders have clip distances.
    pub(crate) clip_distances: bool,
    /// Shaders have cull distances.
    pub(crate) cull_distances: bool,
    /// The `#extension` lines of a tessellation shader, empty if it needs none; `None` if tessellation is not
    /// supported.
    pub(crate) tessellation: Option<&'static str>,
    /// Shaders can declare conservative depth.
    pub(crate) conservative_depth: bool,
    /// The offset alignment of storage buffers; `None` if fragment shaders have no storage buffers.
    pub(crate) storage_alignment: Option<usize>,
    /// The largest storage buffer in bytes; `None` if fragment shaders have no storage buffers.
    pub(crate) max_storage: Option<u64>,
    /// Draws can take their arguments from buffers.
    pub(crate) indirect: bool,
    /// `glCopyImageSubData` exists.
    pub(crate) copy_image: bool,
    /// Vertex shaders can select a viewport ([`SECOND_VIEWPORT`]).
    pub(crate) second_viewport: bool,
    /// The extension that lets vertex shaders select a layer, if there is one.
    pub(crate) vertex_layer: Option<&'static str>,
    /// `glInvalidateFramebuffer` exists.
    pub(crate) invalidate: bool,
    /// `GL_SAMPLES_PASSED` queries work.
    pub(crate) samples_passed: bool,
    /// `GL_FRAGMENT_SHADER_INVOCATIONS` queries work.
    pub(crate) fragment_invocations: bool,
    /// `GL_TIME_ELAPSED` queries work.
    pub(crate) timer: bool,
    pub(crate) max_color_targets: usize,
    /// The sample count that every required format supports, except integer formats.
    pub(crate) max_samples: u32,
    /// Sub-pixel bits of viewports; `None` if viewports are integers.
    pub(crate) viewport_bits: Option<u8>,
    pub(crate) max_viewport: [i32; 2],
}

/// Versions for features that no version, or every version, has.
const NEVER: (u32, u32) = (u32::MAX, 0);
const ALWAYS: (u32, u32) = (0, 0);

impl Caps {
    /// Queries the current context. The caller sets `clip_control` and checks that queries work.
    pub(crate) fn query(gl: &glow::Context, es: bool, version: (u32, u32)) -> Self {
        let known = gl.supported_extensions();
        let has = |name: &str| known.contains(name);
        let since =
            |core: (u32, u32), embedded: (u32, u32)| version >= if es { embedded } else { core };
        let viewports = since((4, 1), NEVER)
            || has("GL_ARB_viewport_array")
            || (es && has("GL_OES_viewport_array"));
        let dual_source = since(ALWAYS, NEVER) || has("GL_EXT_blend_func_extended");
        let integer = |name| {
            // SAFETY: the context is current, and only limits that it has are queried.
            unsafe { gl.get_parameter_i32(name) }
        };
        let targets = integer(glow::MAX_DRAW_BUFFERS).min(integer(glow::MAX_COLOR_ATTACHMENTS));
        let dual_targets =
            dual_source.then(|| integer(glow::MAX_DUAL_SOURCE_DRAW_BUFFERS)) >= Some(1);
        let viewport_bits =
            viewports.then(|| u8::try_from(integer(glow::VIEWPORT_SUBPIXEL_BITS)).unwrap_or(0));
        // naga writes bindings from GLSL 4.20 on, and enables the extension by name.
        let storage = since((4, 2), (3, 1)) && (es || has("GL_ARB_shader_storage_buffer_object"));
        let storage = storage && integer(glow::MAX_FRAGMENT_SHADER_STORAGE_BLOCKS) > 0;
        let storage_alignment = storage.then(|| {
            let alignment = integer(glow::SHADER_STORAGE_BUFFER_OFFSET_ALIGNMENT);
            usize::try_from(alignment).unwrap_or(0)
        });
        let max_storage = storage.then(|| {
            let bytes = integer(glow::MAX_SHADER_STORAGE_BLOCK_SIZE);
            u64::try_from(bytes).unwrap_or(0)
        });
        let mut max_viewport = [0; 2];
        // SAFETY: the context is current, and the array has room for both values.
        unsafe { gl.get_parameter_i32_slice(glow::MAX_VIEWPORT_DIMS, &mut max_viewport) };
        Self {
            es,
            version,
            glsl: glsl_version(es, version),
            clip_control: false,
            indexed_blend: since((4, 0), (3, 2)) || (!es && has("GL_ARB_draw_buffers_blend")),
            dual_source: dual_source && dual_targets,
            coherent_blend: has("GL_KHR_blend_equation_advanced_coherent"),
            float_blend: since(ALWAYS, NEVER) || has("GL_EXT_float_blend"),
            snorm_attachments: !es || has("GL_EXT_render_snorm"),
            depth_clamp: since(ALWAYS, NEVER) || has("GL_EXT_depth_clamp"),
            alpha_to_one: since(ALWAYS, NEVER) || has("GL_EXT_multisample_compatibility"),
            // naga enables the ES extension by name, and version 3.2 need not list it.
            sample_variables: since((4, 0), NEVER) || (es && has("GL_OES_sample_variables")),
            multisample_textures: since(ALWAYS, (3, 1)),
            fixed_restart: since((4, 3), ALWAYS) || has("GL_ARB_ES3_compatibility"),
            stencil_texturing: since((4, 3), (3, 1)) || has("GL_ARB_stencil_texturing"),
            stencil_export: !es && has(STENCIL_EXPORT),
            fetches_in_order: has(FETCH),
            fetches_depth_stencil: has(FETCH_DEPTH_STENCIL),
            stencil_textures: since((4, 4), (3, 2))
                || has("GL_ARB_texture_stencil8")
                || has("GL_OES_texture_stencil8"),
            early_tests: since((4, 2), (3, 1)) || has("GL_ARB_shader_image_load_store"),
            // naga enables the ES extension by name.
            conservative_depth: since((4, 2), NEVER)
                || has("GL_ARB_conservative_depth")
                || (es && has("GL_EXT_conservative_depth")),
            cull_distances: since((4, 5), NEVER) || has("GL_EXT_clip_cull_distance"),
            clip_distances: !es || has("GL_EXT_clip_cull_distance"),
            tessellation: if since((4, 0), (3, 2)) {
                Some("")
            } else if !es && has("GL_ARB_tessellation_shader") {
                Some("#extension GL_ARB_tessellation_shader : require\n")
            } else if es && version >= (3, 1) && has("GL_EXT_tessellation_shader") {
                Some("#extension GL_EXT_tessellation_shader : require\n")
            } else {
                None
            },
            storage_alignment,
            max_storage,
            indirect: since((4, 0), (3, 1)) || (!es && has("GL_ARB_draw_indirect")),
            copy_image: since((4, 3), (3, 2)) || (!es && has("GL_ARB_copy_image")),
            second_viewport: !es && has(SECOND_VIEWPORT),
            vertex_layer: VERTEX_LAYER.into_iter().find(|name| !es && has(name)),
            invalidate: since((4, 3), ALWAYS) || has("GL_ARB_invalidate_subdata"),
            // ES only has `GL_ANY_SAMPLES_PASSED`.
            samples_passed: !es,
            fragment_invocations: since((4, 6), NEVER)
                || (!es && has("GL_ARB_pipeline_statistics_query")),
            timer: since(ALWAYS, NEVER) || has("GL_EXT_disjoint_timer_query"),
            max_color_targets: usize::try_from(targets).unwrap_or(0),
            max_samples: u32::try_from(integer(glow::MAX_SAMPLES)).unwrap_or(0),
            viewport_bits,
            max_viewport,
        }
    }
}

/// Returns the GLSL version of a context, but no newer version than naga supports.
fn glsl_version(es: bool, (major, minor): (u32, u32)) -> glsl::Version {
    let number = (major * 100 + minor * 10) as u16;
    if es {
        glsl::Version::new_gles(number.min(320))
    } else {
        glsl::Version::Desktop(number.min(460))
    }
}
