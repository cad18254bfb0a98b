//! The calls of a scene, recorded at the entry points.
//!
//! A backend that is opened to record finds functions of this module where the driver's would be: they call the
//! driver's and keep what was asked of it. Functions that only ask about the context, or delete, are the driver's own.
//! Any other function is missing, so that a call which nobody records cannot be made.
//!
//! As entry points have nothing but their arguments to tell contexts apart, the state is the thread's, as a context
//! is.

mod functions;
mod kinds;
mod names;
mod recorder;

pub(crate) use recorder::{
    Pointer, WHOLE, begin, counter_part, counters, end, images, install, is_installed, memory,
    plane, recorded,
};

use recorder::stands_before;
use std::ffi::CStr;

/// Returns the address under which the backend finds an entry point.
pub(crate) fn address(name: &CStr, address: Pointer) -> Pointer {
    if address.is_null() || !is_installed() {
        return address;
    }
    let text = name.to_str().unwrap_or_default();
    if let Some((known, shim)) = functions::shim(text) {
        stands_before(known, address);
        return shim;
    }
    if functions::only_asks(text) {
        address
    } else {
        std::ptr::null()
    }
}
