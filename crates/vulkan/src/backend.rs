//! Adapter enumeration and the open adapter.

use crate::device::{Device, identify};
use crate::error::unavailable;
use crate::gpu::Gpu;
use crate::instance::{INSTANCE_VERSION, Instance};
use crate::prepared::VulkanScene;
use crate::recording;
use etalon_backend::{Backend, BackendError, Fault, Phase, Prepared, Recording, Unavailable};
use etalon_frame::{AdapterInfo, Limits};
use etalon_scene::Scene;
use std::rc::Rc;

/// Options for [`open`].
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct VulkanOptions {
    /// The device's index in `vkEnumeratePhysicalDevices`, which is also the order of
    /// [`enumerate`].
    pub device: usize,
    /// Enables the Khronos validation layer, synchronization validation included. Its messages are
    /// returned by [`Backend::messages`].
    pub validate: bool,
    /// A fault that a test plants in the calls to the driver or in the values read back.
    pub fault: Option<Fault>,
    /// Records the calls of the first scene that is prepared, for [`Backend::recording`]. The device then has no
    /// timestamps.
    pub record: bool,
}

/// An open Vulkan device. It belongs to one thread.
pub struct VulkanBackend {
    info: AdapterInfo,
    gpu: Gpu,
}

/// Returns all physical devices of the installed drivers, in the order of [`VulkanOptions::device`]. An
/// adapter's name is `vulkan:<driver>`; two devices of one driver share a name.
///
/// The list includes devices without Vulkan 1.3, which [`open`] refuses.
///
/// # Errors
/// If there is no Vulkan loader, no driver, or no device.
pub fn enumerate() -> Result<Vec<AdapterInfo>, Unavailable> {
    let instance = Instance::new(false)?;
    let devices = instance.physical_devices()?.into_iter();
    Ok(devices.map(|d| identify(&instance, d).info).collect())
}

/// Opens a device. `name` becomes [`AdapterInfo::name`].
///
/// # Errors
/// If there is no such device, it lacks Vulkan 1.3, its driver fails, or the validation layer is
/// requested and not installed.
pub fn open(name: &str, options: &VulkanOptions) -> Result<VulkanBackend, Unavailable> {
    recording::install(options.record);
    let mut instance = Instance::new(options.validate)?;
    if options.record {
        instance.record();
    }
    let instance = Rc::new(instance);
    let devices = instance.physical_devices()?;
    let Some(physical) = devices.get(options.device).copied() else {
        return Err(Unavailable::new(
            format!(
                "there is no Vulkan device {}; {} found",
                options.device,
                devices.len()
            ),
            "list the adapters again: the installed drivers might have changed",
        ));
    };
    let identity = identify(&instance, physical);
    let device = Device::new(instance, physical, &identity)?;
    #[cfg(feature = "faults")]
    let device = crate::planted::plant(device, options.fault);
    Ok(VulkanBackend {
        info: AdapterInfo {
            name: name.to_owned(),
            ..identity.info
        },
        gpu: Gpu::new(device, options.fault).map_err(|error| unavailable(&error))?,
    })
}

impl Backend for VulkanBackend {
    fn adapter(&self) -> &AdapterInfo {
        &self.info
    }

    fn limits(&self) -> &Limits {
        &self.gpu.limits
    }

    fn prepare(&self, scene: &Scene) -> Result<Box<dyn Prepared + '_>, BackendError> {
        Ok(Box::new(VulkanScene::new(&self.gpu, scene)?))
    }

    fn recording(&self) -> Option<Recording> {
        recording::phase(Phase::Prepare);
        recording::recorded(&self.info.device, INSTANCE_VERSION)
    }

    fn messages(&self) -> Vec<String> {
        self.gpu.device.instance.take_messages()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use ash::vk;
    use etalon_case::{Library, Profile};

    /// The layer reports errors: without this, its silence elsewhere would prove nothing.
    #[test]
    fn a_planted_error_is_reported() {
        let options = VulkanOptions {
            device: 0,
            validate: true,
            fault: None,
            record: false,
        };
        let backend = open("vulkan:0", &options).expect("this test needs a Vulkan driver");
        assert_eq!(backend.messages(), Vec::<String>::new());
        // SAFETY: the layer stops the call because the usage is empty; without it, the driver makes an empty
        // buffer or refuses the call.
        let buffer = unsafe {
            let info = vk::BufferCreateInfo::default().size(16);
            backend.gpu.device.raw.create_buffer(&info, None)
        };
        let messages = backend.messages();
        assert!(messages.iter().any(|m| m.contains("usage")), "{messages:?}");
        assert_eq!(backend.messages(), Vec::<String>::new());
        if let Ok(buffer) = buffer {
            // SAFETY: the buffer was just made, and nothing uses it.
            unsafe { backend.gpu.device.raw.destroy_buffer(buffer, None) };
        }
    }

    /// The validation layer reports every object that outlives its device.
    #[test]
    fn a_closed_backend_leaves_nothing_behind() {
        let options = VulkanOptions {
            device: 0,
            validate: true,
            fault: None,
            record: false,
        };
        let backend = open("vulkan:0", &options).expect("this test needs a Vulkan driver");
        let library = Library::built_in();
        for case in library.cases(Profile::Full).step_by(251) {
            let scene = case.build().expect("built-in cases build").scene;
            if backend.limits().missing(&scene.requirements()).is_none() {
                let mut prepared = backend.prepare(&scene).expect("the limits allow it");
                prepared.submit().expect("a working driver");
                prepared.read_back().expect("a working driver");
            }
        }
        let instance = backend.gpu.device.instance.clone();
        drop(backend);
        assert_eq!(instance.take_messages(), Vec::<String>::new());
    }
}
