//! WebGPU as browsers implement it.
//!
//! A worker serves a page on a port of this machine, waits for its WebSocket, and sends it lists of WebGPU
//! calls ([`etalon_webgpu`]). The page executes them on its device and returns the bytes that are read.
//! Drawing a scene takes one message in each direction. The page knows nothing about scenes.
//!
//! The browser is started by the worker, or by a person who opens the page. A started one is kept by a process of its
//! own ([`etalon_keeper`]), which ends it together with the worker however that ends.

mod backend;
mod browser;
mod page;
mod request_head;
mod server;
mod session;

pub use backend::{BrowserBackend, BrowserOptions, PageSource, WAITING, open};
pub use browser::Browser;
