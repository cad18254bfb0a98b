//! The functions that the page's JavaScript calls. They pass one message in and one out.
//!
//! The page calls [`etalon_room`] with the length of a message, writes the message there, and calls [`etalon_ask`]. The
//! answer has [`etalon_length`] bytes at [`etalon_answer`], until the next call.

use crate::suite::Suite;
use std::cell::RefCell;

#[derive(Default)]
struct Exchange {
    suite: Suite,
    message: Vec<u8>,
    answer: Vec<u8>,
}

thread_local! {
    static EXCHANGE: RefCell<Exchange> = RefCell::default();
}

/// Returns the address of room for a message of this length.
#[unsafe(no_mangle)]
pub extern "C" fn etalon_room(length: usize) -> *mut u8 {
    EXCHANGE.with_borrow_mut(|exchange| {
        exchange.message.clear();
        exchange.message.resize(length, 0);
        exchange.message.as_mut_ptr()
    })
}

/// Answers the message.
#[unsafe(no_mangle)]
pub extern "C" fn etalon_ask() {
    EXCHANGE.with_borrow_mut(|exchange| {
        let message = std::mem::take(&mut exchange.message);
        exchange.answer = exchange.suite.answer(&message);
    });
}

/// Returns the address of the answer.
#[unsafe(no_mangle)]
pub extern "C" fn etalon_answer() -> *const u8 {
    EXCHANGE.with_borrow(|exchange| exchange.answer.as_ptr())
}

/// Returns the length of the answer.
#[unsafe(no_mangle)]
pub extern "C" fn etalon_length() -> usize {
    EXCHANGE.with_borrow(|exchange| exchange.answer.len())
}
