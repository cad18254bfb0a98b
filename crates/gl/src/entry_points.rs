//! Entry points that glow lacks.

use crate::caps::{ADVANCED_BLEND, FETCH_BY_BARRIERS};
use crate::egl::{EglContext, function_at};
use std::collections::HashSet;
use std::ffi::{c_char, c_void};

/// The offset of indices, which is passed as a pointer.
type Offset = *const c_void;

type DebugCallback =
    unsafe extern "system" fn(u32, u32, u32, u32, i32, *const c_char, *const c_void);

macro_rules! entry_points {
    ($($field:ident: fn($($arg:ty),*) $(-> $ret:ty)?;)*) => {
        /// Entry points that glow lacks, or whose presence it takes for support. `None` if neither the
        /// version nor an extension defines them.
        #[derive(Default)]
        pub(crate) struct EntryPoints {
            $(pub(crate) $field: Option<unsafe extern "system" fn($($arg),*) $(-> $ret)?>,)*
        }
    };
}

entry_points! {
    clip_control: fn(u32, u32);
    get_query: fn(u32, u32, *mut i32);
    get_query_result: fn(u32, u32, *mut u64);
    get_reset_status: fn() -> u32;
    debug_callback: fn(Option<DebugCallback>, *const c_void);
    get_multisample: fn(u32, u32, *mut f32);
    sample_mask: fn(u32, u32);
    min_sample_shading: fn(f32);
    logic_op: fn(u32);
    clamp_color: fn(u32, u32);
    blend_barrier: fn();
    texture_barrier: fn();
    fetch_barrier: fn();
    polygon_offset_clamp: fn(f32, f32, f32);
    depth_bounds: fn(f64, f64);
    viewport_indexed: fn(u32, f32, f32, f32, f32);
    viewport_array: fn(u32, i32, *const f32);
    scissor_array: fn(u32, i32, *const i32);
    depth_range_array: fn(u32, i32, *const f64);
    primitive_restart_index: fn(u32);
    provoking_vertex: fn(u32);
    draw_elements_base_vertex: fn(u32, i32, u32, Offset, i32);
    draw_elements_instanced_base_vertex: fn(u32, i32, u32, Offset, i32, i32);
    draw_arrays_instanced_base_instance: fn(u32, i32, i32, i32, u32);
    draw_elements_instanced_base_vertex_base_instance: fn(u32, i32, u32, Offset, i32, i32, u32);
    draw_arrays_indirect_count: fn(u32, Offset, isize, i32, i32);
    draw_elements_indirect_count: fn(u32, u32, Offset, isize, i32, i32);
    texture_view: fn(u32, u32, u32, u32, u32, u32, u32, u32);
}

impl EntryPoints {
    /// Loads the entry points that the version and the extensions define. One entry per function.
    pub(crate) fn load(
        egl: &EglContext,
        es: bool,
        version: (u32, u32),
        known: &HashSet<String>,
    ) -> Self {
        let has = |name: &str| known.contains(name);
        let mut loaded = Self::default();
        macro_rules! load {
            ($field:ident, $name:literal) => {
                // SAFETY: the specification gives this name the field's type, and the caller checked the
                // version or extension that defines it.
                loaded.$field = unsafe { function_at(egl.proc_address($name)) };
            };
        }
        if es {
            if has("GL_EXT_clip_control") {
                load!(clip_control, c"glClipControlEXT");
            }
            if has("GL_EXT_disjoint_timer_query") {
                load!(get_query, c"glGetQueryivEXT");
                load!(get_query_result, c"glGetQueryObjectui64vEXT");
            }
            if version >= (3, 2) {
                load!(debug_callback, c"glDebugMessageCallback");
                load!(get_reset_status, c"glGetGraphicsResetStatus");
            } else {
                if has("GL_KHR_debug") {
                    load!(debug_callback, c"glDebugMessageCallbackKHR");
                }
                if has("GL_KHR_robustness") {
                    load!(get_reset_status, c"glGetGraphicsResetStatusKHR");
                }
            }
            if version >= (3, 1) {
                load!(get_multisample, c"glGetMultisamplefv");
                load!(sample_mask, c"glSampleMaski");
            }
            if version >= (3, 2) {
                load!(min_sample_shading, c"glMinSampleShading");
            } else if has("GL_OES_sample_shading") {
                load!(min_sample_shading, c"glMinSampleShadingOES");
            }
            if has("GL_ANGLE_provoking_vertex") {
                load!(provoking_vertex, c"glProvokingVertexANGLE");
            }
            if has("GL_OES_viewport_array") {
                load!(viewport_indexed, c"glViewportIndexedfOES");
            }
        } else {
            if version >= (4, 5) || has("GL_ARB_clip_control") {
                load!(clip_control, c"glClipControl");
            }
            load!(get_query, c"glGetQueryiv");
            load!(get_query_result, c"glGetQueryObjectui64v");
            load!(get_multisample, c"glGetMultisamplefv");
            load!(sample_mask, c"glSampleMaski");
            load!(logic_op, c"glLogicOp");
            load!(clamp_color, c"glClampColor");
            load!(primitive_restart_index, c"glPrimitiveRestartIndex");
            load!(provoking_vertex, c"glProvokingVertex");
            if version >= (4, 3) || has("GL_KHR_debug") {
                load!(debug_callback, c"glDebugMessageCallback");
            }
            if version >= (4, 5) || has("GL_KHR_robustness") {
                load!(get_reset_status, c"glGetGraphicsResetStatus");
            }
            if version >= (4, 0) {
                load!(min_sample_shading, c"glMinSampleShading");
            } else if has("GL_ARB_sample_shading") {
                load!(min_sample_shading, c"glMinSampleShadingARB");
            }
            if version >= (4, 1) || has("GL_ARB_viewport_array") {
                load!(viewport_indexed, c"glViewportIndexedf");
                load!(viewport_array, c"glViewportArrayv");
                load!(scissor_array, c"glScissorArrayv");
                load!(depth_range_array, c"glDepthRangeArrayv");
            }
        }
        if !es || version >= (3, 2) {
            load!(draw_elements_base_vertex, c"glDrawElementsBaseVertex");
            load!(
                draw_elements_instanced_base_vertex,
                c"glDrawElementsInstancedBaseVertex"
            );
        } else if has("GL_EXT_draw_elements_base_vertex") {
            load!(draw_elements_base_vertex, c"glDrawElementsBaseVertexEXT");
            load!(
                draw_elements_instanced_base_vertex,
                c"glDrawElementsInstancedBaseVertexEXT"
            );
        } else if has("GL_OES_draw_elements_base_vertex") {
            load!(draw_elements_base_vertex, c"glDrawElementsBaseVertexOES");
            load!(
                draw_elements_instanced_base_vertex,
                c"glDrawElementsInstancedBaseVertexOES"
            );
        }
        if !es && (version >= (4, 2) || has("GL_ARB_base_instance")) {
            load!(
                draw_arrays_instanced_base_instance,
                c"glDrawArraysInstancedBaseInstance"
            );
            load!(
                draw_elements_instanced_base_vertex_base_instance,
                c"glDrawElementsInstancedBaseVertexBaseInstance"
            );
        } else if es && has("GL_EXT_base_instance") {
            load!(
                draw_arrays_instanced_base_instance,
                c"glDrawArraysInstancedBaseInstanceEXT"
            );
            load!(
                draw_elements_instanced_base_vertex_base_instance,
                c"glDrawElementsInstancedBaseVertexBaseInstanceEXT"
            );
        }
        if !es && version >= (4, 6) {
            load!(
                draw_arrays_indirect_count,
                c"glMultiDrawArraysIndirectCount"
            );
            load!(
                draw_elements_indirect_count,
                c"glMultiDrawElementsIndirectCount"
            );
        } else if !es && has("GL_ARB_indirect_parameters") {
            load!(
                draw_arrays_indirect_count,
                c"glMultiDrawArraysIndirectCountARB"
            );
            load!(
                draw_elements_indirect_count,
                c"glMultiDrawElementsIndirectCountARB"
            );
        }
        let viewed = [
            "GL_ARB_texture_view",
            "GL_ARB_texture_storage_multisample",
            "GL_ARB_internalformat_query",
        ];
        if !es && (version >= (4, 3) || viewed.into_iter().all(has)) {
            load!(texture_view, c"glTextureView");
        } else if has("GL_OES_texture_view") {
            load!(texture_view, c"glTextureViewOES");
        } else if has("GL_EXT_texture_view") {
            load!(texture_view, c"glTextureViewEXT");
        }
        if !es && (version >= (4, 6) || has("GL_ARB_polygon_offset_clamp")) {
            load!(polygon_offset_clamp, c"glPolygonOffsetClamp");
        } else if has("GL_EXT_polygon_offset_clamp") {
            load!(polygon_offset_clamp, c"glPolygonOffsetClampEXT");
        }
        if es && version >= (3, 2) {
            load!(blend_barrier, c"glBlendBarrier");
        } else if has(ADVANCED_BLEND) {
            load!(blend_barrier, c"glBlendBarrierKHR");
        }
        if !es && (version >= (4, 5) || has("GL_ARB_texture_barrier")) {
            load!(texture_barrier, c"glTextureBarrier");
        } else if has("GL_NV_texture_barrier") {
            load!(texture_barrier, c"glTextureBarrierNV");
        }
        if has(FETCH_BY_BARRIERS) {
            load!(fetch_barrier, c"glFramebufferFetchBarrierEXT");
        }
        if !es && has("GL_EXT_depth_bounds_test") {
            load!(depth_bounds, c"glDepthBoundsEXT");
        }
        loaded
    }
}
