//! Enumeration of adapters and the open adapter.

use crate::gpu::Gpu;
use crate::limits::{offer, used_features};
use crate::messages;
use crate::prepared::WgpuScene;
use etalon_backend::{Backend, BackendError, Fault, Prepared, Recording, Unavailable};
use etalon_frame::{AdapterInfo, Limits};
use etalon_scene::Scene;
use std::cell::RefCell;
use std::panic::{AssertUnwindSafe, catch_unwind};
use wgpu::{Backends, InstanceFlags};

/// The API under wgpu.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Via {
    /// Vulkan.
    Vulkan,
    /// OpenGL through EGL, or OpenGL ES if OpenGL is not available. On Windows through WGL.
    Gl,
    /// Direct3D 12.
    Dx12,
    /// Metal.
    Metal,
}

/// Options for [`open`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WgpuOptions {
    /// The API under wgpu.
    pub via: Via,
    /// The adapter's index in [`enumerate`].
    pub device: usize,
    /// Enables the Vulkan validation layer or OpenGL's debug output. Their messages are returned by
    /// [`Backend::messages`], unless the program has set its own logger, which receives them.
    pub validate: bool,
    /// A fault that a test plants in the calls or in the values read back.
    pub fault: Option<Fault>,
    /// Records the calls, for [`Backend::recording`]. The frame times then have no device time.
    pub record: bool,
}

/// An open WebGPU device.
pub struct WgpuBackend {
    info: AdapterInfo,
    via: Via,
    validate: bool,
    gpu: Gpu,
}

/// Returns the adapters that wgpu finds over an API in this process's environment.
///
/// # Errors
/// If there is no adapter.
pub fn enumerate(via: Via) -> Result<Vec<AdapterInfo>, Unavailable> {
    let adapters = adapters(via, InstanceFlags::empty())?;
    let infos = adapters.iter().map(|a| info(via, a));
    Ok(infos.collect())
}

/// Opens an adapter. `name` becomes [`AdapterInfo::name`].
///
/// # Errors
/// If there is no such adapter, it provides no device, or validation is requested but not available.
pub fn open(name: &str, options: &WgpuOptions) -> Result<WgpuBackend, Unavailable> {
    let mut flags = InstanceFlags::empty();
    if options.validate {
        flags = WATCHED;
        messages::collect();
        if messages::misses_layer(|| drop(instance(options.via, flags))) {
            return Err(Unavailable::new(
                "the Vulkan validation layer is not installed",
                "apt-get install vulkan-validationlayers",
            ));
        }
    }
    let adapters = adapters(options.via, flags)?;
    let count = adapters.len();
    let Some(adapter) = adapters.into_iter().nth(options.device) else {
        return Err(Unavailable::new(
            format!("there is no adapter {}; {count} found", options.device),
            "choose one from `etalon adapters`",
        ));
    };
    let mut info = info(options.via, &adapter);
    name.clone_into(&mut info.name);
    let gpu = device(&adapter, options).map_err(|reason| {
        Unavailable::new(
            format!("{} provides no device: {reason}", info.device),
            remedy(options.via),
        )
    })?;
    Ok(WgpuBackend {
        info,
        via: options.via,
        validate: options.validate,
        gpu,
    })
}

impl Backend for WgpuBackend {
    fn adapter(&self) -> &AdapterInfo {
        &self.info
    }

    fn limits(&self) -> &Limits {
        &self.gpu.facts.limits
    }

    fn prepare(&self, scene: &Scene) -> Result<Box<dyn Prepared + '_>, BackendError> {
        Ok(Box::new(WgpuScene::new(&self.gpu, scene)?))
    }

    fn recording(&self) -> Option<Recording> {
        let api = word(self.via);
        let list = self.gpu.recorded.as_ref()?.borrow();
        let features = self.gpu.device.features();
        let features = features.iter_names().map(|(name, _)| name.to_owned());
        match etalon_webgpu::recording(&list, api, &self.info.device, features.collect()) {
            Ok(recording) => Some(recording),
            Err(error) => {
                log::error!("the calls cannot be recorded: {error}");
                None
            }
        }
    }

    fn messages(&self) -> Vec<String> {
        if self.validate {
            messages::take()
        } else {
            Vec::new()
        }
    }
}

/// `VALIDATION` enables the layer. `DEBUG` adds the messenger in Vulkan and the debug context in OpenGL;
/// without it, no message arrives.
const WATCHED: InstanceFlags = InstanceFlags::VALIDATION.union(InstanceFlags::DEBUG);

fn instance(via: Via, flags: InstanceFlags) -> wgpu::Instance {
    wgpu::Instance::new(wgpu::InstanceDescriptor {
        backends: backends(via),
        flags,
        ..wgpu::InstanceDescriptor::new_without_display_handle()
    })
}

fn adapters(via: Via, flags: InstanceFlags) -> Result<Vec<wgpu::Adapter>, Unavailable> {
    // wgpu panics if it cannot make an EGL context current.
    let find = || {
        let instance = instance(via, flags);
        pollster::block_on(instance.enumerate_adapters(backends(via)))
    };
    let found = catch_unwind(AssertUnwindSafe(find)).unwrap_or_default();
    if found.is_empty() {
        return Err(Unavailable::new(
            format!("wgpu finds no adapter over {}", api(via)),
            remedy(via),
        ));
    }
    Ok(found)
}

fn device(adapter: &wgpu::Adapter, options: &WgpuOptions) -> Result<Gpu, String> {
    let mut features = adapter.features() & used_features();
    let mut required_limits = adapter.limits();
    if options.record {
        features.remove(wgpu::Features::TIMESTAMP_QUERY);
        // Alignments that every device supports.
        let everywhere = wgpu::Limits::default();
        required_limits.min_uniform_buffer_offset_alignment =
            everywhere.min_uniform_buffer_offset_alignment;
        required_limits.min_storage_buffer_offset_alignment =
            everywhere.min_storage_buffer_offset_alignment;
    }
    let descriptor = wgpu::DeviceDescriptor {
        label: None,
        required_features: features,
        required_limits,
        experimental_features: wgpu::ExperimentalFeatures::disabled(),
        // Scenes are small, and many processes run at once.
        memory_hints: wgpu::MemoryHints::MemoryUsage,
        trace: wgpu::Trace::Off,
    };
    let request = || pollster::block_on(adapter.request_device(&descriptor));
    let (device, queue) = catch_unwind(AssertUnwindSafe(request))
        .map_err(|_| "wgpu panicked".to_owned())?
        .map_err(|error| error.to_string())?;
    let mut facts = etalon_webgpu::Device::new(offer(adapter, features, &device.limits()));
    let storage = device.limits().max_storage_buffer_binding_size;
    facts.limits.max_storage = Some(storage.min(device.limits().max_buffer_size));
    let opened = Gpu::new(device, queue, facts, options.fault);
    let mut gpu = opened.map_err(|error| error.to_string())?;
    gpu.recorded = options.record.then(RefCell::default);
    Ok(gpu)
}

fn backends(via: Via) -> Backends {
    match via {
        Via::Vulkan => Backends::VULKAN,
        Via::Gl => Backends::GL,
        Via::Dx12 => Backends::DX12,
        Via::Metal => Backends::METAL,
    }
}

fn api(via: Via) -> &'static str {
    match via {
        Via::Vulkan => "Vulkan",
        Via::Gl => "OpenGL",
        Via::Dx12 => "Direct3D 12",
        Via::Metal => "Metal",
    }
}

/// Returns the API's name in adapter names.
fn word(via: Via) -> &'static str {
    match via {
        Via::Vulkan => "vulkan",
        Via::Gl => "gl",
        Via::Dx12 => "dx12",
        Via::Metal => "metal",
    }
}

fn remedy(via: Via) -> &'static str {
    match via {
        Via::Vulkan => {
            "apt-get install libvulkan1 mesa-vulkan-drivers, and check that VK_DRIVER_FILES and \
             VK_ICD_FILENAMES, if set, name a driver"
        }
        Via::Gl => "apt-get install libegl1 libgl1-mesa-dri",
        Via::Dx12 => "install the driver of the GPU's vendor; Direct3D 12 needs Windows",
        Via::Metal => "Metal needs macOS",
    }
}

/// Returns Vulkan's number of the driver version, in the form that `etalon-vulkan` writes, for drivers
/// without a version string.
fn version_number(adapter: &wgpu::Adapter) -> Option<String> {
    // SAFETY: the properties are only read.
    let native = unsafe { adapter.as_hal::<wgpu::hal::api::Vulkan>() }?;
    let properties = native.physical_device_capabilities().properties();
    Some(format!("{:#x}", properties.driver_version))
}

fn info(via: Via, adapter: &wgpu::Adapter) -> AdapterInfo {
    let found = adapter.get_info();
    let words = format!("{} {}", found.name, found.driver).to_lowercase();
    let emulates = ["llvmpipe", "softpipe", "swiftshader"];
    let software = found.device_type == wgpu::DeviceType::Cpu
        || emulates.iter().any(|driver| words.contains(driver));
    let driver = driver(via, &words);
    let named = if found.driver.is_empty() {
        driver.clone()
    } else {
        found.driver.clone()
    };
    AdapterInfo {
        name: format!("wgpu:{}:{driver}", word(via)),
        backend: "wgpu".to_owned(),
        device: found.name.clone(),
        driver: named,
        driver_version: match found.driver_info.as_str() {
            "" => version_number(adapter).unwrap_or_default(),
            words => words.to_owned(),
        },
        driver_id: format!("{}, {:04x}:{:04x}", api(via), found.vendor, found.device),
        api_version: format!("WebGPU (wgpu 30 over {})", api(via)),
        software,
        offer: None,
    }
}

/// Returns the driver's name in adapter names: a well-known name in the device's and driver's
/// strings, or else their first word.
fn driver(via: Via, words: &str) -> String {
    let known = ["zink", "angle", "softpipe", "swiftshader", "lavapipe"];
    if let Some(name) = known.into_iter().find(|name| words.contains(name)) {
        return name.to_owned();
    }
    // Mesa's Vulkan driver reports the name of the rasterizer that it shares with Mesa's OpenGL driver.
    if words.contains("llvmpipe") {
        let name = if via == Via::Gl {
            "llvmpipe"
        } else {
            "lavapipe"
        };
        return name.to_owned();
    }
    let is_letter = |c: char| c.is_ascii_alphanumeric();
    let mut parts = words
        .split(|c| !is_letter(c))
        .filter(|word| !word.is_empty());
    parts.next().unwrap_or("unknown").to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn watched(via: Via) -> WgpuBackend {
        let options = WgpuOptions {
            via,
            device: 0,
            validate: true,
            fault: None,
            record: false,
        };
        let backend = open("wgpu", &options).expect("this test needs a driver and its validation");
        assert_eq!(backend.messages(), Vec::<String>::new());
        backend
    }

    /// The layer reports errors: without this, its silence elsewhere would prove nothing.
    #[test]
    fn an_error_planted_below_wgpu_is_reported_by_the_layer() {
        let backend = watched(Via::Vulkan);
        // SAFETY: the layer stops the call because the size is zero; otherwise the buffer that the driver
        // makes is leaked.
        let made = unsafe {
            let device = backend.gpu.device.as_hal::<wgpu::hal::api::Vulkan>();
            let device = device.expect("the device is Vulkan's");
            device.raw_device().create_buffer(&Default::default(), None)
        };
        let messages = backend.messages();
        assert!(
            messages
                .iter()
                .any(|m| m.contains("VUID-VkBufferCreateInfo")),
            "{messages:?} after {made:?}"
        );
        assert_eq!(backend.messages(), Vec::<String>::new());
    }

    /// The same check for OpenGL's debug output.
    #[test]
    fn an_error_planted_below_wgpu_is_reported_by_opengl() {
        let backend = watched(Via::Gl);
        // SAFETY: the lock keeps the context current, and GL gives this name this type.
        unsafe {
            let device = backend.gpu.device.as_hal::<wgpu::hal::api::Gles>();
            let device = device.expect("the device is OpenGL's");
            let egl = device.context().egl_instance().expect("it came from EGL");
            let enable = egl.get_proc_address("glEnable").expect("all of GL has it");
            let enable =
                std::mem::transmute::<extern "system" fn(), unsafe extern "system" fn(u32)>(enable);
            let _current = device.context().lock();
            enable(0xFFFF);
        }
        let messages = backend.messages();
        assert_eq!(messages.len(), 1, "{messages:?}");
        assert!(messages[0].contains("/Error]"), "{messages:?}");
    }

    #[test]
    fn drivers_get_their_well_known_names() {
        let llvmpipe = "llvmpipe (llvm 15.0.6, 256 bits) llvmpipe";
        assert_eq!(driver(Via::Vulkan, llvmpipe), "lavapipe");
        assert_eq!(driver(Via::Gl, llvmpipe), "llvmpipe");
        assert_eq!(driver(Via::Gl, "zink (llvmpipe (llvm 15.0.6)) "), "zink");
        assert_eq!(driver(Via::Vulkan, "nvidia h200 nvidia"), "nvidia");
        assert_eq!(driver(Via::Gl, ""), "unknown");
    }
}
