//! Opening an adapter: its context, objects and limits.

use crate::context::Context;
use crate::egl::{self, ContextRequest};
use crate::objects::Objects;
use crate::options::{GlOptions, Profile, Tuning};
use crate::path;
use crate::prepared::GlScene;
use crate::probe::Probed;
use crate::recording;
use crate::state;
use etalon_backend::{Backend, BackendError, Prepared, Recording, Unavailable};
use etalon_frame::{AdapterInfo, Api, ApiVersion, Limits, Property, standard_sample_positions};
use etalon_scene::Scene;
use glow::HasContext;

/// An open OpenGL context.
pub struct GlBackend {
    info: AdapterInfo,
    limits: Limits,
    objects: Objects,
    pub(crate) context: Context,
    options: GlOptions,
}

/// Opens an adapter. `name` becomes [`AdapterInfo::name`].
///
/// # Errors
/// If libEGL, the driver or the version is missing; the error names a remedy.
pub fn open(name: &str, options: &GlOptions) -> Result<GlBackend, Unavailable> {
    open_with(name, options, Tuning { clip_control: true })
}

pub(crate) fn open_with(
    name: &str,
    options: &GlOptions,
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
    let request = ContextRequest {
        es,
        debug: options.debug,
    };
    let versions: &[(i32, i32)] = if es { &ES } else { &CORE };
    let egl_context =
        egl::library(options.library.as_deref())?.context(options.platform, request, versions)?;
    let context = Context::new(egl_context, options, tuning)?;
    state::reset(&context);
    let unusable = |e: BackendError| Unavailable::new(e.to_string(), "use another driver");
    let (objects, probed) = Objects::new(&context)?;
    let limits = limits(&context, &probed);
    let backend = GlBackend {
        info: info(name, &context),
        limits,
        objects,
        context,
        options: options.clone(),
    };
    backend
        .context
        .check("opening the adapter")
        .map_err(unusable)?;
    // Drops the messages that the probes caused.
    backend.context.messages();
    // Arms the fault after the probes. Otherwise the probes would deny the features that scenes must find
    // broken.
    #[cfg(feature = "faults")]
    crate::planted::arm(options.fault);
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
        offer: None,
    }
}

fn version((major, minor): (u32, u32)) -> ApiVersion {
    let part = |number| u8::try_from(number).unwrap_or(u8::MAX);
    ApiVersion::new(part(major), part(minor))
}

fn limits(context: &Context, probed: &Probed) -> Limits {
    let gl = &context.gl;
    let [width, height] = context.caps.max_viewport;
    // SAFETY: the context is current, and has had these limits since version 3.
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
    sample_positions.insert(1, standard_sample_positions(1));
    let max_size = sides.into_iter().min().unwrap_or(0);
    Limits {
        api: if context.caps.es {
            Api::OpenGlEs
        } else {
            Api::OpenGl
        },
        version: version(context.caps.version),
        properties: context
            .caps
            .clip_control
            .then_some(Property::DepthFromZero)
            .into_iter()
            .collect(),
        exempt: probed.exempt.clone(),
        // OpenGL 4.6, table 23.53: at least 4.
        sub_pixel_bits: u8::try_from(bits).unwrap_or(4).max(4),
        viewport_bits: context.caps.viewport_bits,
        texel_bits: None,
        max_size: u32::try_from(max_size).unwrap_or(0),
        max_storage: context.caps.max_storage,
        max_color_attachments: u32::try_from(context.caps.max_color_targets).unwrap_or(0),
        formats: probed
            .formats
            .iter()
            .map(|(format, support)| (*format, support.limits.clone()))
            .collect(),
        features: probed.features.clone(),
        paths: path::offered(context, &probed.features),
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
        Ok(Box::new(GlScene::new(
            &self.context,
            &self.objects,
            &scene.on_path(),
        )?))
    }

    fn messages(&self) -> Vec<String> {
        self.context.messages()
    }

    fn recording(&self) -> Option<Recording> {
        recording::recorded(self.options.recorded_context(self.context.caps.version))
    }
}
