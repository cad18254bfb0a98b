//! The calls of a scene, recorded at the functions of the device.
//!
//! An instance that is opened to record answers with functions of this module where the device's would be: they call
//! the driver's and keep what was asked of it. Functions that only ask or destroy are the driver's own. Any other one is
//! missing, so that a call which nobody records ends the process.
//!
//! As functions have nothing but their arguments to tell devices apart, the state is the thread's, as a backend is.

mod functions;
mod layout;
mod layouts;
mod needed;
mod recorder;

pub(crate) use functions::values;
pub(crate) use needed::Needed;

pub(crate) use recorder::{
    counter_part, counters, image, install, is_installed, memory_types, needs, phase, read,
    recorded, written,
};

use ash::vk;
use recorder::{driver, stands_before};
use std::ffi::{CStr, c_char};

/// Returns the instance with the functions that find and record those of its devices.
pub(crate) fn instance(instance: &ash::Instance) -> ash::Instance {
    let mut v10 = instance.fp_v1_0().clone();
    stands_before("vkGetDeviceProcAddr", v10.get_device_proc_addr as usize);
    stands_before("vkCreateDevice", v10.create_device as usize);
    v10.get_device_proc_addr = get_device_proc_addr;
    v10.create_device = functions::create_device;
    ash::Instance::from_parts_1_3(
        instance.handle(),
        v10,
        instance.fp_v1_1().clone(),
        instance.fp_v1_3().clone(),
    )
}

/// Returns the function under which the backend finds one of the device's.
unsafe extern "system" fn get_device_proc_addr(
    device: vk::Device,
    name: *const c_char,
) -> vk::PFN_vkVoidFunction {
    // SAFETY: the address was the driver's function of this type.
    let own: vk::PFN_vkGetDeviceProcAddr =
        unsafe { std::mem::transmute(driver("vkGetDeviceProcAddr")) };
    // SAFETY: the arguments are the caller's.
    let address = unsafe { own(device, name) }?;
    // SAFETY: the caller's name is terminated.
    let text = unsafe { CStr::from_ptr(name) }.to_str().ok()?;
    if let Some((known, shim)) = functions::shim(text) {
        stands_before(known, address as usize);
        // SAFETY: a function's address is one of a function without arguments, which nobody calls as such.
        return Some(unsafe {
            std::mem::transmute::<*const (), unsafe extern "system" fn()>(shim)
        });
    }
    functions::only_asks(text).then_some(address)
}
