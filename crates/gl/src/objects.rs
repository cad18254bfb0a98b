//! The objects of a context that outlive a scene. They are separate from the backend because a prepared scene
//! needs only them.

use crate::context::Context;
use crate::pool::ObjectPool;
use crate::probe::{self, Probed};
use crate::program::Programs;
use crate::recording;
use crate::sanity;
use crate::support::Support;
use etalon_backend::{Phase, Unavailable};
use etalon_frame::TextureFormat;
use etalon_scene::Params;
use glow::HasContext;
use std::cell::RefCell;
use std::collections::BTreeMap;

/// The objects that outlive a scene, and the supported formats.
pub(crate) struct Objects {
    pub(crate) formats: BTreeMap<TextureFormat, Support>,
    pub(crate) pool: RefCell<ObjectPool>,
    pub(crate) programs: RefCell<Programs>,
    /// The distance between parameter blocks in bytes.
    pub(crate) params_stride: usize,
    pub(crate) vertex_array: glow::VertexArray,
    pub(crate) no_vertices: glow::VertexArray,
    pub(crate) timer: Option<glow::Query>,
}

impl Objects {
    /// Creates the objects and probes the formats and features.
    pub(crate) fn new(context: &Context) -> Result<(Self, Probed), Unavailable> {
        let gl = &context.gl;
        let refused = |message: String| Unavailable::new(message, "use another driver");
        let probed = probe::probe(context);
        // The objects of scenes are created after the probes, so that a recording contains only these
        // objects.
        recording::begin(Phase::Prepare);
        // SAFETY: the context is current, and has had the limit since version 3.
        let (alignment, vertex_array, no_vertices, timer) = unsafe {
            let no_vertices = gl.create_vertex_array().map_err(refused)?;
            let vertex_array = gl.create_vertex_array().map_err(refused)?;
            gl.bind_vertex_array(Some(vertex_array));
            for attribute in 0..3 {
                gl.enable_vertex_attrib_array(attribute);
            }
            let timer = if context.caps.timer && !recording::is_installed() {
                Some(gl.create_query().map_err(refused)?)
            } else {
                None
            };
            (
                gl.get_parameter_i32(glow::UNIFORM_BUFFER_OFFSET_ALIGNMENT),
                vertex_array,
                no_vertices,
                timer,
            )
        };
        let alignment = sanity::alignment("GL_UNIFORM_BUFFER_OFFSET_ALIGNMENT", alignment)?;
        recording::end();
        let objects = Self {
            formats: probed.formats.clone(),
            pool: RefCell::default(),
            programs: RefCell::default(),
            params_stride: size_of::<Params>().next_multiple_of(alignment),
            vertex_array,
            no_vertices,
            timer,
        };
        Ok((objects, probed))
    }
}
