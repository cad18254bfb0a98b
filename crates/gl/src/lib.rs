//! The OpenGL and OpenGL ES backend, through glow and EGL.
//!
//! [`open`] makes a context without a window and wraps it as a [`Backend`]. Which driver answers is
//! up to the environment of the process (`LIBGL_ALWAYS_SOFTWARE`, `GALLIUM_DRIVER`, …) or to the
//! EGL device; a process should hold one driver only. libEGL is loaded at run time.
//!
//! WebGPU's conventions come from `glClipControl(UPPER_LEFT, ZERO_TO_ONE)`, under which row 0 of
//! every image is the top one, depth is what Vulkan computes and windings keep their sense; without
//! it the vertex shaders mirror y and remap z, and front faces are told apart the other way round.
//!
//! Attachments with several samples are textures; a shader reads them back, sample by sample.

mod caps;
mod codes;
mod context;
mod counters;
mod draw;
mod egl;
mod extra;
mod format;
mod pool;
mod prepared;
mod probe;
mod program;
mod read;
mod state;
mod surface;
#[cfg(test)]
mod tests;
mod words;

pub use egl::{EglDevice, Platform, enumerate};

use crate::context::Context;
use crate::egl::{Wanted, egl};
use crate::format::Support;
use crate::pool::Pool;
use crate::prepared::GlPrepared;
use crate::probe::Probed;
use crate::program::Programs;
use crate::read::Reading;
use etalon_backend::{AdapterInfo, Backend, BackendError, Prepared, Unavailable};
use etalon_frame::{Api, Limits, TextureFormat};
use etalon_scene::{Params, Scene};
use glow::HasContext;
use std::cell::RefCell;
use std::collections::BTreeMap;
use std::path::PathBuf;

/// Which OpenGL to open.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Profile {
    /// OpenGL 3.3 to 4.6, core profile; the highest that the driver has.
    Core,
    /// OpenGL ES 3.0 to 3.2; the highest that the driver has.
    Es,
}

/// How to open an adapter.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct Options {
    /// The API.
    pub profile: Profile,
    /// The way to the driver.
    pub platform: Platform,
    /// The EGL library: a path, or a name that the system's loader looks for; without it, `libEGL.so.1`.
    pub library: Option<PathBuf>,
    /// Whether to collect the driver's debug messages, see [`Backend::messages`].
    pub debug: bool,
}

/// What tests may hold back.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Tuning {
    /// Use `glClipControl` where there is one.
    pub(crate) clip_control: bool,
}

/// An open context of one driver.
pub struct GlBackend {
    info: AdapterInfo,
    limits: Limits,
    formats: BTreeMap<TextureFormat, Support>,
    pool: RefCell<Pool>,
    programs: RefCell<Programs>,
    /// The distance of parameter blocks in bytes.
    params_stride: usize,
    vertex_array: glow::VertexArray,
    no_vertices: glow::VertexArray,
    timer: Option<glow::Query>,
    context: Context,
}

/// Opens an adapter; `name` becomes its name.
///
/// # Errors
/// When libEGL, the driver or the version is missing, with what would help.
pub fn open(name: &str, options: &Options) -> Result<GlBackend, Unavailable> {
    open_with(name, options, Tuning { clip_control: true })
}

pub(crate) fn open_with(
    name: &str,
    options: &Options,
    tuning: Tuning,
) -> Result<GlBackend, Unavailable> {
    const CORE: [(i32, i32); 8] = [
        (4, 6),
        (4, 5),
        (4, 4),
        (4, 3),
        (4, 2),
        (4, 1),
        (4, 0),
        (3, 3),
    ];
    const ES: [(i32, i32); 3] = [(3, 2), (3, 1), (3, 0)];
    let es = options.profile == Profile::Es;
    let wanted = Wanted {
        es,
        debug: options.debug,
    };
    let versions: &[(i32, i32)] = if es { &ES } else { &CORE };
    let egl_context =
        egl(options.library.as_deref())?.context(options.platform, wanted, versions)?;
    let context = Context::new(egl_context, options, tuning)?;
    state::reset(&context);
    let unusable = |e: BackendError| Unavailable::new(e.to_string(), "use another driver");
    let gl = &context.gl;
    let refused = |message: String| Unavailable::new(message, "use another driver");
    // SAFETY: the context is current and has the limit since version 3.
    let (alignment, vertex_array, no_vertices, timer) = unsafe {
        let no_vertices = gl.create_vertex_array().map_err(refused)?;
        let vertex_array = gl.create_vertex_array().map_err(refused)?;
        gl.bind_vertex_array(Some(vertex_array));
        for attribute in 0..3 {
            gl.enable_vertex_attrib_array(attribute);
        }
        let timer = if context.caps.timer {
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
    let alignment = usize::try_from(alignment).unwrap_or(0).max(1);
    let (mut pool, mut programs) = (Pool::default(), Programs::default());
    let probed = probe::probe(&mut Reading {
        context: &context,
        pool: &mut pool,
        programs: &mut programs,
        no_vertices,
    });
    let limits = limits(&context, &probed);
    let backend = GlBackend {
        info: info(name, &context),
        limits,
        formats: probed.formats,
        pool: RefCell::new(pool),
        programs: RefCell::new(programs),
        params_stride: size_of::<Params>().next_multiple_of(alignment),
        vertex_array,
        no_vertices,
        timer,
        context,
    };
    backend
        .context
        .check("opening the adapter")
        .map_err(unusable)?;
    // What probing made the driver say concerns nobody.
    backend.context.messages();
    Ok(backend)
}

fn info(name: &str, context: &Context) -> AdapterInfo {
    let (major, minor) = context.caps.version;
    AdapterInfo {
        name: name.to_owned(),
        backend: "gl".to_owned(),
        device: context.names.renderer.clone(),
        driver: context.names.vendor.clone(),
        driver_version: context.names.driver_version().to_owned(),
        driver_id: context.driver_id(),
        api_version: if context.caps.es {
            format!("OpenGL ES {major}.{minor}")
        } else {
            format!("OpenGL {major}.{minor} core")
        },
        software: context.is_software(),
    }
}

fn limits(context: &Context, probed: &Probed) -> Limits {
    let gl = &context.gl;
    let [width, height] = context.caps.max_viewport;
    // SAFETY: the context is current and has these limits since version 3.
    let (bits, sides) = unsafe {
        (
            gl.get_parameter_i32(glow::SUBPIXEL_BITS),
            [
                gl.get_parameter_i32(glow::MAX_TEXTURE_SIZE),
                gl.get_parameter_i32(glow::MAX_RENDERBUFFER_SIZE),
                width,
                height,
            ],
        )
    };
    let mut sample_positions = probed.positions.clone();
    sample_positions.insert(1, vec![[128, 128]]);
    let max_size = sides.into_iter().min().unwrap_or(0);
    Limits {
        api: if context.caps.es {
            Api::OpenGlEs
        } else {
            Api::OpenGl
        },
        // OpenGL 4.6, table 23.53: at least 4.
        sub_pixel_bits: u8::try_from(bits).unwrap_or(4).max(4),
        max_size: u32::try_from(max_size).unwrap_or(0),
        max_color_attachments: u32::try_from(context.caps.max_color_targets).unwrap_or(0),
        formats: probed
            .formats
            .iter()
            .map(|(format, support)| (*format, support.limits.clone()))
            .collect(),
        features: probed.features.clone(),
        sample_positions,
    }
}

impl Backend for GlBackend {
    fn adapter(&self) -> &AdapterInfo {
        &self.info
    }

    fn limits(&self) -> &Limits {
        &self.limits
    }

    fn prepare(&self, scene: &Scene) -> Result<Box<dyn Prepared + '_>, BackendError> {
        if let Some(requirement) = self.limits.missing(&scene.requirements()) {
            return Err(BackendError::NotSupported(requirement));
        }
        self.context.make_current()?;
        Ok(Box::new(GlPrepared::new(self, scene)?))
    }

    fn messages(&self) -> Vec<String> {
        self.context.messages()
    }
}
