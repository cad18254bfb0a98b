//! The loader, the instance and the messages of the validation layer.

use crate::error::describe;
use crate::recording;
use ash::{ext, vk};
use etalon_backend::Unavailable;
use std::ffi::{CStr, c_void};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, OnceLock, PoisonError};

/// The version that instances request.
pub(crate) const INSTANCE_VERSION: u32 = vk::API_VERSION_1_3;

const VALIDATION_LAYER: &CStr = c"VK_LAYER_KHRONOS_validation";
/// The largest number of messages kept between two calls of [`Instance::take_messages`].
const MAX_MESSAGES: usize = 1000;
const NO_DRIVER: &str =
    "apt-get install mesa-vulkan-drivers libvulkan1, or install the GPU's own driver";

/// A Vulkan instance, with a debug messenger if validation is enabled.
pub(crate) struct Instance {
    raw: ash::Instance,
    messenger: Option<Messenger>,
}

/// The first version whose text has `VK_KHR_dynamic_rendering_local_read`.
const LOCAL_READS: u32 = vk::make_api_version(0, 1, 3, 276);

struct Messenger {
    functions: ext::debug_utils::Instance,
    raw: vk::DebugUtilsMessengerEXT,
    /// Messages of the layer, which keeps this pointer until the messenger is destroyed. Freed by hand.
    messages: *mut Messages,
}

#[derive(Default)]
struct Messages {
    kept: Mutex<Vec<String>>,
    /// True while the commands of a scene with a dynamic number of samples are made.
    dynamic_samples: AtomicBool,
}

/// Returns the loader, which is never unloaded: some drivers do not survive `dlclose`.
fn entry() -> Result<&'static ash::Entry, Unavailable> {
    static ENTRY: OnceLock<Result<ash::Entry, String>> = OnceLock::new();
    // SAFETY: the system's Vulkan loader is safe to load, and it is never unloaded.
    let loaded = ENTRY.get_or_init(|| unsafe { ash::Entry::load() }.map_err(|e| e.to_string()));
    loaded
        .as_ref()
        .map_err(|message| Unavailable::new(format!("no Vulkan loader ({message})"), NO_DRIVER))
}

impl Instance {
    pub(crate) fn new(validate: bool) -> Result<Self, Unavailable> {
        let entry = entry()?;
        // SAFETY: no requirements beyond a loaded entry.
        let version = unsafe { entry.try_enumerate_instance_version() }
            .ok()
            .flatten()
            .unwrap_or(vk::API_VERSION_1_0);
        if version < vk::API_VERSION_1_1 {
            return Err(Unavailable::new(
                "the Vulkan loader supports only Vulkan 1.0",
                "apt-get install libvulkan1 of a current distribution",
            ));
        }
        let has_sync_validation = validate && validation_extensions(entry)?;

        let application = vk::ApplicationInfo::default()
            .application_name(c"etalon")
            .engine_name(c"etalon")
            .api_version(INSTANCE_VERSION);
        let mut layers = Vec::new();
        let mut extensions = Vec::new();
        let mut messages = None;
        if validate {
            layers.push(VALIDATION_LAYER.as_ptr());
            extensions.push(ext::debug_utils::NAME.as_ptr());
            if has_sync_validation {
                extensions.push(ext::validation_features::NAME.as_ptr());
            }
            messages = Some(Box::into_raw(Box::new(Messages::default())));
        }
        let mut info = vk::InstanceCreateInfo::default()
            .application_info(&application)
            .enabled_layer_names(&layers)
            .enabled_extension_names(&extensions);
        let checks = [vk::ValidationFeatureEnableEXT::SYNCHRONIZATION_VALIDATION];
        let mut features =
            vk::ValidationFeaturesEXT::default().enabled_validation_features(&checks);
        if has_sync_validation {
            info = info.push_next(&mut features);
        }
        // SAFETY: every pointer in `info` outlives the call.
        let raw = unsafe { entry.create_instance(&info, None) }.map_err(|code| {
            if let Some(messages) = messages {
                // SAFETY: the pointer is from `Box::into_raw` above, and is not shared yet.
                drop(unsafe { Box::from_raw(messages) });
            }
            let reason = format!("no Vulkan instance: {}", describe(code));
            Unavailable::new(reason, NO_DRIVER)
        })?;
        let mut instance = Self {
            raw,
            messenger: None,
        };
        if let Some(messages) = messages {
            instance.messenger = Some(messenger(entry, &instance.raw, messages)?);
        }
        Ok(instance)
    }

    /// Returns true unless a validation layer is enabled that is older than local reads, and calls them errors.
    pub(crate) fn knows_local_reads(&self) -> bool {
        let layer = entry().ok().and_then(validation_layer);
        self.messenger.is_none() || layer.is_some_and(|layer| layer.spec_version >= LOCAL_READS)
    }

    /// Records the calls to devices that are created later.
    pub(crate) fn record(&mut self) {
        self.raw = recording::instance(&self.raw);
    }

    pub(crate) fn raw(&self) -> &ash::Instance {
        &self.raw
    }

    pub(crate) fn physical_devices(&self) -> Result<Vec<vk::PhysicalDevice>, Unavailable> {
        // SAFETY: the instance is alive.
        let devices = unsafe { self.raw.enumerate_physical_devices() }.map_err(|code| {
            let reason = format!("the Vulkan drivers list no device: {}", describe(code));
            Unavailable::new(reason, NO_DRIVER)
        })?;
        if devices.is_empty() {
            return Err(Unavailable::new("no Vulkan driver is installed", NO_DRIVER));
        }
        Ok(devices)
    }

    /// Returns the messages since the last call, oldest first.
    pub(crate) fn take_messages(&self) -> Vec<String> {
        let Some(messenger) = &self.messenger else {
            return Vec::new();
        };
        // SAFETY: the pointer came from a box that lives until the messenger is dropped, and the
        // mutex makes sharing it with the callback sound.
        let messages = unsafe { &*messenger.messages };
        std::mem::take(&mut *messages.kept.lock().unwrap_or_else(PoisonError::into_inner))
    }

    /// Tells whether the commands from now on belong to a scene with a dynamic number of samples.
    pub(crate) fn samples_are_dynamic(&self, dynamic: bool) {
        if let Some(messenger) = &self.messenger {
            // SAFETY: as above; the field is atomic.
            let messages = unsafe { &*messenger.messages };
            messages.dynamic_samples.store(dynamic, Ordering::Relaxed);
        }
    }
}

impl Drop for Instance {
    fn drop(&mut self) {
        if let Some(messenger) = &self.messenger {
            // SAFETY: the messenger is valid and destroyed once.
            unsafe {
                messenger
                    .functions
                    .destroy_debug_utils_messenger(messenger.raw, None);
            }
        }
        // SAFETY: devices hold the instance in an `Rc`, so no device is left.
        unsafe { self.raw.destroy_instance(None) };
        if let Some(messenger) = self.messenger.take() {
            // SAFETY: the pointer is from `Box::into_raw`; the messenger that used it is destroyed.
            drop(unsafe { Box::from_raw(messenger.messages) });
        }
    }
}

/// Returns the properties of the validation layer; `None` if it is not installed.
fn validation_layer(entry: &ash::Entry) -> Option<vk::LayerProperties> {
    // SAFETY: no requirements beyond a loaded entry.
    let layers = unsafe { entry.enumerate_instance_layer_properties() }.unwrap_or_default();
    let mut layers = layers.into_iter();
    layers.find(|layer| layer.layer_name_as_c_str() == Ok(VALIDATION_LAYER))
}

/// Returns true if the validation layer has synchronization validation.
fn validation_extensions(entry: &ash::Entry) -> Result<bool, Unavailable> {
    if validation_layer(entry).is_none() {
        return Err(Unavailable::new(
            "the layer VK_LAYER_KHRONOS_validation is not installed",
            "apt-get install vulkan-validationlayers",
        ));
    }
    // SAFETY: the layer's name is a static string.
    let extensions =
        unsafe { entry.enumerate_instance_extension_properties(Some(VALIDATION_LAYER)) }
            .unwrap_or_default();
    Ok(extensions
        .iter()
        .any(|e| e.extension_name_as_c_str() == Ok(ext::validation_features::NAME)))
}

fn messenger(
    entry: &ash::Entry,
    instance: &ash::Instance,
    messages: *mut Messages,
) -> Result<Messenger, Unavailable> {
    let functions = ext::debug_utils::Instance::new(entry, instance);
    // General messages are about drivers and the loader; performance warnings are not errors.
    let info = vk::DebugUtilsMessengerCreateInfoEXT::default()
        .message_severity(
            vk::DebugUtilsMessageSeverityFlagsEXT::WARNING
                | vk::DebugUtilsMessageSeverityFlagsEXT::ERROR,
        )
        .message_type(vk::DebugUtilsMessageTypeFlagsEXT::VALIDATION)
        .pfn_user_callback(Some(on_message))
        .user_data(messages.cast());
    // SAFETY: `messages` stays valid until the messenger is destroyed.
    let raw = unsafe { functions.create_debug_utils_messenger(&info, None) };
    match raw {
        Ok(raw) => Ok(Messenger {
            functions,
            raw,
            messages,
        }),
        Err(code) => {
            // SAFETY: the pointer is from `Box::into_raw`; no messenger uses it.
            drop(unsafe { Box::from_raw(messages) });
            Err(Unavailable::new(
                format!("no validation messages: {}", describe(code)),
                "apt-get install vulkan-validationlayers",
            ))
        }
    }
}

/// Returns true for a warning about something legal and intended: neither a depth-only pass nor a location
/// without an attachment uses the colour that the shader writes.
fn is_intended(id: &CStr, text: &CStr) -> bool {
    let id = id.to_bytes();
    if id == b"UNASSIGNED-CoreValidation-Shader-InterfaceTypeMismatch" {
        let text = text.to_string_lossy();
        return text.contains("Attachment") && text.contains("VK_FORMAT_UNDEFINED");
    }
    // Since layer version 1.4, the second is the name of the message.
    [
        &b"Undefined-Value-ShaderOutputNotConsumed"[..],
        b"WARNING-Shader-OutputNotConsumed",
        b"UNASSIGNED-CoreValidation-Shader-OutputNotConsumed",
    ]
    .iter()
    .any(|known| id.starts_with(known))
}

/// Returns true for a message about the number of samples in a pipeline, which is not used if the number is
/// dynamic (Vulkan, VkDynamicState). Layer version 1.3.239 does not know that.
fn is_about_samples(id: &CStr) -> bool {
    let id = id.to_bytes();
    [
        &b"-colorAttachmentCount-06188"[..],
        b"-pDepthAttachment-06189",
        b"-pStencilAttachment-06190",
        b"-rasterizationSamples-04740",
        b"-multisampledRenderToSingleSampled-06853",
    ]
    .iter()
    .any(|known| id.ends_with(known))
}

unsafe extern "system" fn on_message(
    _severity: vk::DebugUtilsMessageSeverityFlagsEXT,
    _kind: vk::DebugUtilsMessageTypeFlagsEXT,
    data: *const vk::DebugUtilsMessengerCallbackDataEXT<'_>,
    user: *mut c_void,
) -> vk::Bool32 {
    // SAFETY: the layer passes valid data or null, and `user` is the pointer of the messenger.
    let (data, messages) = unsafe { (data.as_ref(), user.cast::<Messages>().as_ref()) };
    if let (Some(data), Some(messages)) = (data, messages) {
        // SAFETY: the layer's strings are null or zero-terminated, and live during the call.
        let (id, text) = unsafe { (data.message_id_name_as_c_str(), data.message_as_c_str()) };
        let text = text.unwrap_or_default();
        let dynamic = messages.dynamic_samples.load(Ordering::Relaxed);
        let is_none = |id| is_intended(id, text) || dynamic && is_about_samples(id);
        if !id.is_some_and(is_none) {
            let mut kept = messages.kept.lock().unwrap_or_else(PoisonError::into_inner);
            if kept.len() < MAX_MESSAGES {
                kept.push(text.to_string_lossy().into_owned());
            }
        }
    }
    vk::FALSE
}
