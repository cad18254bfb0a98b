//! The files of the page.

/// A file that the worker serves.
pub(crate) struct ServedFile {
    /// The path after the token.
    pub(crate) path: &'static str,
    /// The media type.
    pub(crate) media: &'static str,
    /// The file's text.
    pub(crate) text: &'static str,
}

/// All files.
pub(crate) const FILES: [ServedFile; 6] = [
    ServedFile {
        path: "",
        media: "text/html; charset=utf-8",
        text: include_str!("../page/index.html"),
    },
    ServedFile {
        path: "scenes.js",
        media: "text/javascript; charset=utf-8",
        text: include_str!("../page/scenes.js"),
    },
    ServedFile {
        path: "device.js",
        media: "text/javascript; charset=utf-8",
        text: include_str!("../page/device.js"),
    },
    ServedFile {
        path: "executor.js",
        media: "text/javascript; charset=utf-8",
        text: include_str!("../page/executor.js"),
    },
    ServedFile {
        path: "page.js",
        media: "text/javascript; charset=utf-8",
        text: include_str!("../page/page.js"),
    },
    ServedFile {
        path: "host.js",
        media: "text/javascript; charset=utf-8",
        text: include_str!("../page/host.js"),
    },
];

/// The path of the WebSocket.
pub(crate) const SOCKET: &str = "socket";
