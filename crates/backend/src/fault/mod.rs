//! Faults that a test plants.

mod call;
mod read;

pub use call::CallFault;
pub use read::ReadFault;
