//! The suite in a page: selects cases, lowers them to lists of WebGPU calls, judges what comes back, and shows records.
//!
//! A worker of the page holds one [`Suite`] and one device. It passes messages to the suite through the four functions
//! of [`abi`], and lists to the executor of `crates/browser/page`. A message is a JSON header and bytes, as between a
//! page and the relay ([`etalon_webgpu::message`]). Nothing here does I/O or reads a clock.

pub mod abi;
mod case_draw;
mod message;
mod opening;
mod session;
mod suite;
mod tile;
mod verdict;

pub use suite::Suite;
