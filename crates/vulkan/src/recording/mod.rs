//! Recording of the calls of a scene, at the functions of the device.
//!
//! An instance opened to record returns functions of this module instead of the device's: they call the
//! driver's function and keep the call. Functions that only query or destroy are the driver's own. All other
//! functions are missing, so that a call that would not be recorded ends the process.
//!
//! A function cannot carry a state, so the recorder is kept per thread, as a backend belongs to one thread.

mod functions;
mod layout;
mod needed;
mod recorder;
mod registry;

pub(crate) use needed::Needed;

pub(crate) use recorder::{
    counter_part, counters, image, install, is_installed, memory_types, needs, phase, read,
    recorded, written,
};

use ash::vk;
use recorder::{driver, stands_before};
use std::ffi::{CStr, c_char};

/// Returns the instance with functions that find and record the functions of its devices.
pub(crate) fn instance(instance: &ash::Instance) -> ash::Instance {
    let mut v10 = instance.fp_v1_0().clone();
    stands_before("vkGetDeviceProcAddr", v10.get_device_proc_addr as usize);
    v10.get_device_proc_addr = get_device_proc_addr;
    if let Some(shim) = before("vkCreateDevice", v10.create_device as usize) {
        // SAFETY: the registry gives the name this type.
        v10.create_device =
            unsafe { std::mem::transmute::<*const (), vk::PFN_vkCreateDevice>(shim) };
    }
    ash::Instance::from_parts_1_3(
        instance.handle(),
        v10,
        instance.fp_v1_1().clone(),
        instance.fp_v1_3().clone(),
    )
}

/// Returns the function that records calls of the driver's function with this name. Stores `address`, the
/// driver's function.
fn before(name: &str, address: usize) -> Option<*const ()> {
    let (name, shim) = registry::shim(name)?;
    stands_before(name, address);
    Some(shim)
}

/// Returns the function that the backend finds for a device's function: the recording one, the driver's, or
/// none.
unsafe extern "system" fn get_device_proc_addr(
    device: vk::Device,
    name: *const c_char,
) -> vk::PFN_vkVoidFunction {
    // SAFETY: the address was the driver's function of this type.
    let get_address: vk::PFN_vkGetDeviceProcAddr =
        unsafe { std::mem::transmute(driver("vkGetDeviceProcAddr")) };
    // SAFETY: the caller passed the arguments to a function of this type.
    let address = unsafe { get_address(device, name) }?;
    // SAFETY: the caller's name is zero-terminated.
    let text = unsafe { CStr::from_ptr(name) }.to_str().ok()?;
    if let Some(shim) = before(text, address as usize) {
        // SAFETY: the API returns every function as one without arguments; it is never called with this type.
        return Some(unsafe {
            std::mem::transmute::<*const (), unsafe extern "system" fn()>(shim)
        });
    }
    only_asks(text).then_some(address)
}

/// Returns true if a function only queries the device, waits for all of its work, or destroys an object. It
/// is not recorded.
fn only_asks(name: &str) -> bool {
    ["vkGet", "vkDestroy", "vkFree", "vkDeviceWaitIdle"]
        .iter()
        .any(|start| name.starts_with(start))
}

#[cfg(test)]
#[expect(clippy::unwrap_used, reason = "a test that panics has failed")]
mod tests {
    use std::process::Command;

    #[test]
    fn the_registry_is_what_the_script_writes() {
        let script = concat!(env!("CARGO_MANIFEST_DIR"), "/src/recording/generate");
        let output = Command::new(script).output().unwrap();
        if output.status.code() == Some(77) {
            eprintln!("SKIPPED: {}", String::from_utf8_lossy(&output.stderr));
            return;
        }
        assert!(output.status.success(), "{output:?}");
        let written = String::from_utf8(output.stdout).unwrap();
        let kept = include_str!("registry.rs");
        let version = |text: &str| {
            text.lines()
                .find(|line| line.contains("vk.xml"))
                .map(str::to_owned)
        };
        if version(&written) == version(kept) {
            assert!(written == kept, "run `generate` again");
        } else {
            eprintln!(
                "SKIPPED: {:?} is installed, {:?} is kept",
                version(&written),
                version(kept)
            );
        }
    }
}
