//! The calls of a scene, recorded at the functions of the device.
//!
//! An instance that is opened to record answers with functions of this module where the device's would be: they call
//! the driver's and keep what was asked of it. Functions that only ask or destroy are the driver's own. Any other one is
//! missing, so that a call which nobody records ends the process.
//!
//! As functions have nothing but their arguments to tell devices apart, the state is the thread's, as a backend is.

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

/// Returns the instance with the functions that find and record those of its devices.
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

/// Returns the function that records one of the driver's, which is at an address.
fn before(name: &str, address: usize) -> Option<*const ()> {
    let (name, shim) = registry::shim(name)?;
    stands_before(name, address);
    Some(shim)
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
    if let Some(shim) = before(text, address as usize) {
        // SAFETY: a function's address is one of a function without arguments, which nobody calls as such.
        return Some(unsafe {
            std::mem::transmute::<*const (), unsafe extern "system" fn()>(shim)
        });
    }
    only_asks(text).then_some(address)
}

/// True if a function only asks about the device, waits for all of it, or destroys: it stays the driver's own.
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
