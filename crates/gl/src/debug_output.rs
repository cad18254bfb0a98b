//! Debug output (KHR_debug): collects the messages that a correct program never causes.

use std::ffi::{c_char, c_void};
use std::sync::{Mutex, PoisonError};

/// The largest number of debug messages kept between two calls of [`crate::context::Context::messages`].
const MAX_MESSAGES: usize = 1000;

/// The messages collected since they were last taken.
pub(crate) type Log = Mutex<Vec<String>>;

/// Collects a message in the [`Log`] that `user` points to.
pub(crate) extern "system" fn collect(
    _source: u32,
    kind: u32,
    id: u32,
    severity: u32,
    length: i32,
    message: *const c_char,
    user: *const c_void,
) {
    let Some(kind) = mistake_name(kind, severity) else {
        return;
    };
    if message.is_null() {
        return;
    }
    let length = usize::try_from(length).unwrap_or(0);
    // SAFETY: the driver passes a message of this length and the pointer of the callback, which
    // outlives the context.
    let (bytes, log) = unsafe {
        (
            std::slice::from_raw_parts(message.cast::<u8>(), length),
            &*user.cast::<Log>(),
        )
    };
    let mut log = log.lock().unwrap_or_else(PoisonError::into_inner);
    if log.len() < MAX_MESSAGES {
        log.push(format!(
            "{kind} {id}: {}",
            String::from_utf8_lossy(bytes).trim()
        ));
    }
}

/// Returns the name of a message type if the message reports a mistake: errors and undefined
/// behaviour at any severity, deprecated and unportable use from medium severity, others at high
/// severity.
fn mistake_name(kind: u32, severity: u32) -> Option<&'static str> {
    let high = severity == glow::DEBUG_SEVERITY_HIGH;
    let medium = high || severity == glow::DEBUG_SEVERITY_MEDIUM;
    match kind {
        glow::DEBUG_TYPE_ERROR => Some("error"),
        glow::DEBUG_TYPE_UNDEFINED_BEHAVIOR => Some("undefined behaviour"),
        glow::DEBUG_TYPE_DEPRECATED_BEHAVIOR if medium => Some("deprecated"),
        glow::DEBUG_TYPE_PORTABILITY if medium => Some("portability"),
        glow::DEBUG_TYPE_OTHER if high => Some("other"),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn mistakes_are_reported_and_hints_are_not() {
        let low = glow::DEBUG_SEVERITY_LOW;
        let medium = glow::DEBUG_SEVERITY_MEDIUM;
        let high = glow::DEBUG_SEVERITY_HIGH;
        assert!(mistake_name(glow::DEBUG_TYPE_ERROR, low).is_some());
        assert!(mistake_name(glow::DEBUG_TYPE_UNDEFINED_BEHAVIOR, low).is_some());
        assert!(mistake_name(glow::DEBUG_TYPE_PORTABILITY, medium).is_some());
        assert!(mistake_name(glow::DEBUG_TYPE_PORTABILITY, low).is_none());
        assert!(mistake_name(glow::DEBUG_TYPE_OTHER, high).is_some());
        assert!(mistake_name(glow::DEBUG_TYPE_OTHER, medium).is_none());
        assert!(mistake_name(glow::DEBUG_TYPE_PERFORMANCE, high).is_none());
    }
}
