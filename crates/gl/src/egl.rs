//! EGL, loaded at run time: displays, devices and contexts without a surface.
//!
//! `khronos-egl` loads the entry points. They are called without its wrappers, which panic on
//! unknown error codes.

use crate::recording;
use etalon_backend::Unavailable;
use khronos_egl::api::{EGL1_0 as _, EGL1_2 as _, EGL1_4 as _};
use khronos_egl::{self as egl, Dynamic, EGL1_4};
use libloading::Library;
use std::collections::HashSet;
use std::ffi::{CStr, c_char, c_void};
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};

type Display = *mut c_void;
type Config = *mut c_void;
type ContextHandle = *mut c_void;
type Device = *mut c_void;

/// Constants of extensions that `khronos-egl` lacks.
mod ext {
    pub(super) const CONTEXT_FLAGS_KHR: i32 = 0x30FC;
    pub(super) const CONTEXT_OPENGL_DEBUG_BIT_KHR: i32 = 0x0001;
    pub(super) const CONTEXT_OPENGL_RESET_NOTIFICATION_STRATEGY_EXT: i32 = 0x3138;
    pub(super) const PLATFORM_SURFACELESS_MESA: u32 = 0x31DD;
    pub(super) const PLATFORM_DEVICE_EXT: u32 = 0x313F;
    pub(super) const DEVICE_EXT: i32 = 0x322C;
    pub(super) const DRM_DEVICE_FILE_EXT: i32 = 0x3233;
    pub(super) const DRM_RENDER_NODE_FILE_EXT: i32 = 0x3377;
    pub(super) const RENDERER_EXT: i32 = 0x335F;
}

/// The system's dispatch library.
const SYSTEM: &str = if cfg!(windows) {
    "libEGL.dll"
} else if cfg!(target_vendor = "apple") {
    "libEGL.dylib"
} else {
    "libEGL.so.1"
};
const INSTALL_EGL: &str = if cfg!(target_os = "linux") {
    "apt-get install libegl1 libgl1-mesa-dri"
} else {
    "install ANGLE, and name its libEGL in the adapter's entry (`egl`)"
};

/// The EGL platform, which selects the driver.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Platform {
    /// `EGL_MESA_platform_surfaceless`, or the default display if EGL lacks it. The environment selects the
    /// driver.
    Surfaceless,
    /// The device with this index in the order of `EGL_EXT_device_enumeration`.
    Device(usize),
}

/// An EGL device.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct EglDevice {
    /// The index for [`Platform::Device`].
    pub index: usize,
    /// True for a software rasterizer (`EGL_MESA_device_software`).
    pub software: bool,
    /// The DRM render node (`/dev/dri/renderD128`), or else the primary node.
    pub drm_node: Option<String>,
    /// The renderer's name (`EGL_EXT_device_query_name`).
    pub renderer: Option<String>,
    /// The driver's short name in lower case: `radeonsi`, `nvidia`. `None` if EGL has no name, and for
    /// software devices, which are not opened to find out.
    pub driver: Option<String>,
}

/// The client extensions that define the device queries.
const DEVICE_QUERY: [&str; 2] = ["EGL_EXT_device_base", "EGL_EXT_device_query"];

type GetProcAddress = unsafe extern "system" fn(*const c_char) -> *const c_void;
type GetPlatformDisplay = unsafe extern "system" fn(u32, *mut c_void, *const i32) -> Display;
type QueryDevices = unsafe extern "system" fn(i32, *mut Device, *mut i32) -> u32;
type QueryDeviceString = unsafe extern "system" fn(Device, i32) -> *const c_char;
type QueryDisplayAttrib = unsafe extern "system" fn(Display, i32, *mut isize) -> u32;
type GetDisplayDriverName = unsafe extern "system" fn(Display) -> *const c_char;

/// A loaded EGL library. It is never unloaded, since some drivers do not survive that.
pub(crate) struct Egl {
    functions: Dynamic<Arc<Library>, EGL1_4>,
    /// `khronos-egl` declares that this returns a function pointer, which cannot be null.
    get_proc_address: GetProcAddress,
    extensions: HashSet<String>,
}

/// Returns the entry points of a library, loaded at the first call. The default is the system's.
pub(crate) fn library(library: Option<&Path>) -> Result<&'static Egl, Unavailable> {
    type Loaded = (PathBuf, Result<&'static Egl, Unavailable>);
    static LOADED: Mutex<Vec<Loaded>> = Mutex::new(Vec::new());
    let path = library.unwrap_or(Path::new(SYSTEM));
    let mut loaded = LOADED.lock().unwrap_or_else(PoisonError::into_inner);
    if let Some((_, egl)) = loaded.iter().find(|(p, _)| p == path) {
        return egl.clone();
    }
    let egl = Egl::load(path).map(|egl| &*Box::leak(Box::new(egl)));
    loaded.push((path.to_owned(), egl.clone()));
    egl
}

/// The API and debug flag of a context.
#[derive(Clone, Copy)]
pub(crate) struct ContextRequest {
    pub(crate) es: bool,
    pub(crate) debug: bool,
}

/// An initialised display.
struct OpenDisplay {
    display: Display,
    is_1_5: bool,
    extensions: HashSet<String>,
}

impl OpenDisplay {
    fn has(&self, extension: &str) -> bool {
        self.extensions.contains(extension)
    }

    /// Returns the attribute that requests reset notification, if EGL has one.
    fn robustness(&self, es: bool) -> Option<i32> {
        if self.is_1_5 && !es {
            Some(egl::CONTEXT_OPENGL_RESET_NOTIFICATION_STRATEGY)
        } else if self.has("EGL_EXT_create_context_robustness") {
            Some(ext::CONTEXT_OPENGL_RESET_NOTIFICATION_STRATEGY_EXT)
        } else {
            None
        }
    }

    /// Returns the terminated attribute list of a context.
    fn context_attributes(
        &self,
        request: ContextRequest,
        (major, minor): (i32, i32),
        reset_strategy: Option<i32>,
    ) -> Vec<i32> {
        let mut list = vec![
            egl::CONTEXT_MAJOR_VERSION,
            major,
            egl::CONTEXT_MINOR_VERSION,
            minor,
        ];
        if !request.es {
            list.extend([
                egl::CONTEXT_OPENGL_PROFILE_MASK,
                egl::CONTEXT_OPENGL_CORE_PROFILE_BIT,
            ]);
        }
        if request.debug && self.is_1_5 {
            list.extend([egl::CONTEXT_OPENGL_DEBUG, 1]);
        } else if request.debug {
            list.extend([ext::CONTEXT_FLAGS_KHR, ext::CONTEXT_OPENGL_DEBUG_BIT_KHR]);
        }
        if let Some(name) = reset_strategy {
            list.extend([name, egl::LOSE_CONTEXT_ON_RESET]);
        }
        list.push(egl::NONE);
        list
    }
}

impl Egl {
    fn load(path: &Path) -> Result<Self, Unavailable> {
        let name = path.display();
        // SAFETY: libEGL's initialisers have no preconditions.
        let library = unsafe { Library::new(path) }.map_err(|e| {
            let reason = if path == Path::new(SYSTEM) {
                format!("{name} not found")
            } else {
                format!("{name} cannot be loaded: {e}")
            };
            Unavailable::new(reason, INSTALL_EGL)
        })?;
        let library = Arc::new(library);
        let unusable =
            |e: String| Unavailable::new(format!("{name} is not usable: {e}"), INSTALL_EGL);
        // SAFETY: a library of this name has the types of the EGL headers.
        let functions = unsafe { Dynamic::<_, EGL1_4>::load_required(Arc::clone(&library)) }
            .map_err(|e| unusable(e.to_string()))?;
        // SAFETY: the EGL header declares this type, and `functions` keeps the library loaded.
        let get_proc_address = *unsafe { library.get::<GetProcAddress>(b"eglGetProcAddress\0") }
            .map_err(|e| unusable(e.to_string()))?;
        let mut egl = Self {
            functions,
            get_proc_address,
            extensions: HashSet::new(),
        };
        egl.extensions = egl.display_extensions(std::ptr::null_mut());
        Ok(egl)
    }

    /// Returns the address of an entry point of GL or of an EGL extension. An address does not prove support:
    /// dispatch libraries return stubs for unknown names.
    pub(crate) fn proc_address(&self, name: &CStr) -> *const c_void {
        // SAFETY: the name is zero-terminated.
        unsafe { (self.get_proc_address)(name.as_ptr()) }
    }

    /// Returns a function if EGL has one of the client extensions that define it.
    ///
    /// # Safety
    /// `F` is the type of the function of this name.
    unsafe fn function<F: Copy>(&self, extensions: &[&str], name: &CStr) -> Option<F> {
        let supported = extensions.iter().any(|e| self.extensions.contains(*e));
        let address = supported.then(|| self.proc_address(name))?;
        // SAFETY: upheld by the caller.
        unsafe { function_at(address) }
    }

    fn display_extensions(&self, display: Display) -> HashSet<String> {
        // SAFETY: EGL accepts any display handle that it returned, and null for client extensions.
        let text = unsafe { text(self.functions.eglQueryString(display, egl::EXTENSIONS)) };
        // Without client extensions the query fails. This clears the error, so that no later call reports it.
        if text.is_none() {
            self.error();
        }
        words(text)
    }

    fn error(&self) -> String {
        // SAFETY: no preconditions.
        error_name(unsafe { self.functions.eglGetError() })
    }

    fn devices(&self) -> Result<Vec<Device>, Unavailable> {
        let extensions = ["EGL_EXT_device_base", "EGL_EXT_device_enumeration"];
        // SAFETY: the extensions give this name this type.
        let query: Option<QueryDevices> =
            unsafe { self.function(&extensions, c"eglQueryDevicesEXT") };
        let query = query
            .ok_or_else(|| Unavailable::new("EGL lacks EGL_EXT_device_enumeration", INSTALL_EGL))?;
        let mut devices = [std::ptr::null_mut(); 64];
        let mut count = 0;
        // SAFETY: the array has the length that is passed.
        let done = unsafe { query(devices.len() as i32, devices.as_mut_ptr(), &mut count) };
        if done == 0 {
            let reason = format!("eglQueryDevicesEXT failed: {}", self.error());
            return Err(Unavailable::new(reason, INSTALL_EGL));
        }
        let count = usize::try_from(count).unwrap_or(0).min(devices.len());
        Ok(devices[..count].to_vec())
    }

    fn device_string(&self, device: Device, name: i32) -> Option<String> {
        // SAFETY: the extensions give this name this type.
        let query: QueryDeviceString =
            unsafe { self.function(&DEVICE_QUERY, c"eglQueryDeviceStringEXT") }?;
        // SAFETY: the handle came from EGL.
        let result = unsafe { text(query(device, name)) };
        if result.is_none() {
            self.error();
        }
        result
    }

    fn is_software(&self, device: Device) -> bool {
        words(self.device_string(device, egl::EXTENSIONS)).contains("EGL_MESA_device_software")
    }

    fn display(&self, platform: Platform) -> Result<Display, Unavailable> {
        let (platform, native) = match platform {
            Platform::Surfaceless if !self.extensions.contains("EGL_MESA_platform_surfaceless") => {
                // SAFETY: the default display has no preconditions.
                let display = unsafe { self.functions.eglGetDisplay(std::ptr::null_mut()) };
                return self.some_display(display, "there is no default EGL display");
            }
            Platform::Surfaceless => (ext::PLATFORM_SURFACELESS_MESA, std::ptr::null_mut()),
            Platform::Device(index) => {
                let devices = self.devices()?;
                let device = devices.get(index).copied().ok_or_else(|| {
                    Unavailable::new(
                        format!("EGL device {index} requested, {} found", devices.len()),
                        "name one of the devices that EGL enumerates",
                    )
                })?;
                (ext::PLATFORM_DEVICE_EXT, device)
            }
        };
        let extension = "EGL_EXT_platform_base";
        // SAFETY: the extension gives this name this type.
        let get: Option<GetPlatformDisplay> =
            unsafe { self.function(&[extension], c"eglGetPlatformDisplayEXT") };
        let get =
            get.ok_or_else(|| Unavailable::new(format!("EGL lacks {extension}"), INSTALL_EGL))?;
        // SAFETY: the native handle is what the platform requires: null, or a device.
        let display = unsafe { get(platform, native, [egl::NONE].as_ptr()) };
        self.some_display(display, "EGL has no display for this platform")
    }

    fn some_display(&self, display: Display, reason: &str) -> Result<Display, Unavailable> {
        if display.is_null() {
            let reason = format!("{reason}: {}", self.error());
            return Err(Unavailable::new(reason, INSTALL_EGL));
        }
        Ok(display)
    }

    fn display_is_software(&self, display: Display) -> bool {
        // SAFETY: the extensions give this name this type.
        let query: Option<QueryDisplayAttrib> =
            unsafe { self.function(&DEVICE_QUERY, c"eglQueryDisplayAttribEXT") };
        let Some(query) = query else {
            return false;
        };
        let mut device = 0_isize;
        // SAFETY: the display is initialised and the result has room.
        if unsafe { query(display, ext::DEVICE_EXT, &mut device) } == 0 || device == 0 {
            self.error();
            return false;
        }
        self.is_software(device as Device)
    }

    /// Returns the short name of an initialised display's driver, or else the first word of the display's
    /// vendor.
    fn driver_name(&self, display: Display) -> Option<String> {
        let known = self.display_extensions(display);
        let address = if known.contains("EGL_MESA_query_driver") {
            self.proc_address(c"eglGetDisplayDriverName")
        } else {
            std::ptr::null()
        };
        // SAFETY: the extension gives this name this type.
        let name = if let Some(get) = unsafe { function_at::<GetDisplayDriverName>(address) } {
            // SAFETY: the display is initialised.
            unsafe { text(get(display)) }
        } else {
            // SAFETY: as above.
            unsafe { text(self.functions.eglQueryString(display, egl::VENDOR)) }
        };
        if name.is_none() {
            self.error();
        }
        let name = name?.split_whitespace().next()?.to_lowercase();
        Some(name)
    }

    /// Returns the short name of the driver of a device that is not open.
    fn device_driver(&self, index: usize) -> Option<String> {
        let display = self.display(Platform::Device(index)).ok()?;
        // SAFETY: the display came from EGL; the version pointers may be null.
        if unsafe {
            self.functions
                .eglInitialize(display, std::ptr::null_mut(), std::ptr::null_mut())
        } == 0
        {
            self.error();
            return None;
        }
        // The display is not terminated, which would invalidate the process's other contexts on it.
        self.driver_name(display)
    }

    /// Opens the display, and creates a context of the first version of `versions` that the driver supports.
    pub(crate) fn context(
        &'static self,
        platform: Platform,
        request: ContextRequest,
        versions: &[(i32, i32)],
    ) -> Result<EglContext, Unavailable> {
        let opened = self.open(platform)?;
        let display = opened.display;
        let config = self.bind_api(&opened, request.es)?;
        let robust = opened.robustness(request.es);
        let mut failure = String::new();
        for &version in versions {
            // A driver without reset notification refuses only the first attempt.
            let strategies = [robust, None];
            for &strategy in &strategies[usize::from(robust.is_none())..] {
                let list = opened.context_attributes(request, version, strategy);
                // SAFETY: the display is initialised, the config is one of its own or null, and the list is
                // terminated.
                let context = unsafe {
                    self.functions.eglCreateContext(
                        display,
                        config,
                        std::ptr::null_mut(),
                        list.as_ptr(),
                    )
                };
                if context.is_null() {
                    failure = self.error();
                } else {
                    return self.current(display, context);
                }
            }
        }
        let (major, minor) = versions.last().copied().unwrap_or_default();
        let api = if request.es {
            "OpenGL ES"
        } else {
            "OpenGL core"
        };
        Err(Unavailable::new(
            format!("no {api} context of version {major}.{minor} or above: {failure}"),
            "use a newer driver, or check the environment variables that choose it",
        ))
    }

    /// Initialises a display. It must support contexts without a surface.
    fn open(&self, platform: Platform) -> Result<OpenDisplay, Unavailable> {
        let display = self.display(platform)?;
        let (mut major, mut minor) = (0, 0);
        // SAFETY: the display came from EGL and the results have room.
        if unsafe {
            self.functions
                .eglInitialize(display, &mut major, &mut minor)
        } == 0
        {
            let reason = format!("eglInitialize failed: {}", self.error());
            return Err(Unavailable::new(
                reason,
                "check the driver's installation and the environment variables that choose it",
            ));
        }
        let opened = OpenDisplay {
            display,
            is_1_5: (major, minor) >= (1, 5),
            extensions: self.display_extensions(display),
        };
        if !opened.has("EGL_KHR_surfaceless_context") {
            return Err(Unavailable::new(
                "the driver lacks EGL_KHR_surfaceless_context",
                "use a driver that draws without a window",
            ));
        }
        if !opened.is_1_5 && !opened.has("EGL_KHR_create_context") {
            return Err(Unavailable::new(
                "the driver lacks EGL 1.5 and EGL_KHR_create_context",
                "use a newer driver",
            ));
        }
        Ok(opened)
    }

    /// Selects OpenGL or OpenGL ES for new contexts. Returns their configuration, or null if they need none.
    fn bind_api(&self, opened: &OpenDisplay, es: bool) -> Result<Config, Unavailable> {
        let api = if es {
            egl::OPENGL_ES_API
        } else {
            egl::OPENGL_API
        };
        // SAFETY: no preconditions.
        if unsafe { self.functions.eglBindAPI(api) } == 0 {
            let reason = format!("eglBindAPI failed: {}", self.error());
            return Err(Unavailable::new(reason, "use a driver that has this API"));
        }
        if opened.has("EGL_KHR_no_config_context") || opened.has("EGL_MESA_configless_context") {
            Ok(std::ptr::null_mut())
        } else {
            self.choose_config(opened.display, es)
        }
    }

    /// Makes a new context current.
    fn current(
        &'static self,
        display: Display,
        context: ContextHandle,
    ) -> Result<EglContext, Unavailable> {
        let context = EglContext {
            egl: self,
            display,
            context,
            software: self.display_is_software(display),
            driver: self.driver_name(display),
        };
        context.make_current().map_err(|(_, e)| {
            Unavailable::new(
                format!("eglMakeCurrent failed: {e}"),
                "use a driver that draws without a window",
            )
        })?;
        Ok(context)
    }

    fn choose_config(&self, display: Display, es: bool) -> Result<Config, Unavailable> {
        let renderable = if es {
            egl::OPENGL_ES3_BIT
        } else {
            egl::OPENGL_BIT
        };
        let list = [
            egl::SURFACE_TYPE,
            0,
            egl::RENDERABLE_TYPE,
            renderable,
            egl::NONE,
        ];
        let (mut config, mut count) = (std::ptr::null_mut(), 0);
        // SAFETY: the display is initialised, the list is terminated and the result has room.
        let done = unsafe {
            self.functions
                .eglChooseConfig(display, list.as_ptr(), &mut config, 1, &mut count)
        };
        if done == 0 || count < 1 {
            return Err(Unavailable::new(
                format!("no EGL config: {}", self.error()),
                "use a driver that has this API",
            ));
        }
        Ok(config)
    }
}

/// Returns the EGL devices.
///
/// # Errors
/// If there is no EGL, or it cannot enumerate devices.
pub fn enumerate() -> Result<Vec<EglDevice>, Unavailable> {
    let egl = library(None)?;
    let mut result = Vec::new();
    for (index, device) in egl.devices()?.into_iter().enumerate() {
        let extensions = words(egl.device_string(device, egl::EXTENSIONS));
        let query = |extension: &str, name| {
            let known = extensions.contains(extension);
            known.then(|| egl.device_string(device, name)).flatten()
        };
        let software = extensions.contains("EGL_MESA_device_software");
        result.push(EglDevice {
            index,
            software,
            driver: (!software).then(|| egl.device_driver(index)).flatten(),
            drm_node: query(
                "EGL_EXT_device_drm_render_node",
                ext::DRM_RENDER_NODE_FILE_EXT,
            )
            .or_else(|| query("EGL_EXT_device_drm", ext::DRM_DEVICE_FILE_EXT)),
            renderer: query("EGL_EXT_device_query_name", ext::RENDERER_EXT),
        });
    }
    Ok(result)
}

/// A context, destroyed on drop. The raw handles keep it on the thread that created it.
pub(crate) struct EglContext {
    egl: &'static Egl,
    display: Display,
    context: ContextHandle,
    software: bool,
    driver: Option<String>,
}

impl EglContext {
    /// Makes the context current on this thread. The error is a pair: true if the context is lost, and the name
    /// of EGL's error.
    pub(crate) fn make_current(&self) -> Result<(), (bool, String)> {
        let functions = &self.egl.functions;
        let none = std::ptr::null_mut();
        // SAFETY: display and context live; no surface is needed (EGL_KHR_surfaceless_context).
        unsafe {
            // A query costs less than a cache, which other users of EGL in this process could invalidate.
            if functions.eglGetCurrentContext() == self.context
                || functions.eglMakeCurrent(self.display, none, none, self.context) != 0
            {
                return Ok(());
            }
            let error = functions.eglGetError();
            Err((error == egl::CONTEXT_LOST, error_name(error)))
        }
    }

    /// Returns true if EGL reports a software device.
    pub(crate) fn is_software(&self) -> bool {
        self.software
    }

    /// Returns the driver's short name, if EGL has one.
    pub(crate) fn driver(&self) -> Option<&str> {
        self.driver.as_deref()
    }

    /// Returns true if the driver has a function, recorded or not.
    pub(crate) fn has_function(&self, name: &CStr) -> bool {
        !self.egl.proc_address(name).is_null()
    }

    /// See [`Egl::proc_address`].
    pub(crate) fn proc_address(&self, name: &CStr) -> *const c_void {
        let address = self.egl.proc_address(name);
        #[cfg(feature = "faults")]
        let address = crate::planted::address(name, address);
        recording::address(name, address)
    }
}

impl Drop for EglContext {
    fn drop(&mut self) {
        let functions = &self.egl.functions;
        let none = std::ptr::null_mut();
        // SAFETY: display and context live. All contexts of the process share the display, so it is never
        // terminated.
        unsafe {
            if functions.eglGetCurrentContext() == self.context {
                functions.eglMakeCurrent(self.display, none, none, none);
            }
            functions.eglDestroyContext(self.display, self.context);
        }
    }
}

/// Returns the function at an address, or `None` if the address is null.
///
/// # Safety
/// `F` is the type of the function there.
pub(crate) unsafe fn function_at<F: Copy>(address: *const c_void) -> Option<F> {
    const { assert!(size_of::<F>() == size_of::<*const c_void>()) };
    // SAFETY: function pointers have the size of an address, and the caller promises the type.
    (!address.is_null()).then(|| unsafe { std::mem::transmute_copy(&address) })
}

/// Returns a driver's string, or `None` if it is null.
///
/// # Safety
/// The pointer is null or points to a zero-terminated string.
unsafe fn text(pointer: *const c_char) -> Option<String> {
    if pointer.is_null() {
        return None;
    }
    // SAFETY: not null, and the caller guarantees a zero-terminated string.
    let text = unsafe { CStr::from_ptr(pointer) };
    Some(text.to_string_lossy().into_owned())
}

fn words(text: Option<String>) -> HashSet<String> {
    let text = text.unwrap_or_default();
    text.split_whitespace().map(str::to_owned).collect()
}

fn error_name(code: i32) -> String {
    let name = match code {
        egl::SUCCESS => "EGL_SUCCESS",
        egl::NOT_INITIALIZED => "EGL_NOT_INITIALIZED",
        egl::BAD_ACCESS => "EGL_BAD_ACCESS",
        egl::BAD_ALLOC => "EGL_BAD_ALLOC",
        egl::BAD_ATTRIBUTE => "EGL_BAD_ATTRIBUTE",
        egl::BAD_CONFIG => "EGL_BAD_CONFIG",
        egl::BAD_CONTEXT => "EGL_BAD_CONTEXT",
        egl::BAD_DISPLAY => "EGL_BAD_DISPLAY",
        egl::BAD_MATCH => "EGL_BAD_MATCH",
        egl::BAD_PARAMETER => "EGL_BAD_PARAMETER",
        egl::CONTEXT_LOST => "EGL_CONTEXT_LOST",
        _ => return format!("EGL error 0x{code:04X}"),
    };
    name.to_owned()
}
