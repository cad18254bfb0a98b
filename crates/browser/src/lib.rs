//! WebGPU as browsers implement it.
//!
//! A worker serves a page on a port of this machine, waits for its WebSocket, and sends it lists of WebGPU
//! calls ([`etalon_webgpu`]). The page executes them on its device and returns the bytes that are read.
//! Drawing a scene takes one message in each direction. The page knows nothing about scenes.
//!
//! The worker starts the browser, or a person opens the page. A browser that the worker started is kept by a
//! process of its own ([`keep()`]), which ends it when the worker ends, for whatever reason.

mod adapter;
mod backend;
mod keeper;
mod message;
mod page;
mod request_head;
mod server;
mod session;

pub use backend::{BrowserBackend, Options, Source, WAITING, open, token};
pub use keeper::{Browser, keep};
