//! Recording of the calls of a scene, at the entry points.
//!
//! A backend opened to record finds functions of this module instead of the driver's: they call the driver's
//! function and keep the call. Functions that only query the context, or delete, are the driver's own. All
//! other functions are missing, so that a call that would not be recorded cannot be made.
//!
//! An entry point cannot carry a state, so the recorder is kept per thread, as a context is.

mod functions;
mod kinds;
mod names;
mod recorder;

pub(crate) use recorder::{
    CallPointer, WHOLE, begin, counter_part, counters, end, images, install, is_installed, memory,
    plane, recorded,
};

use recorder::stands_before;
use std::ffi::CStr;

/// Returns the address that the backend finds for an entry point.
pub(crate) fn address(name: &CStr, address: CallPointer) -> CallPointer {
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
