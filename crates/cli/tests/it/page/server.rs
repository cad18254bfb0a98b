//! A web server for the files of one folder.

use std::fs;
use std::io::{BufRead, BufReader, Write};
use std::net::{SocketAddr, TcpListener, TcpStream};
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex};

/// A server; it ends with the test.
pub(super) struct Server {
    pub(super) address: SocketAddr,
    /// The paths that were requested.
    pub(super) requested: Arc<Mutex<Vec<String>>>,
}

impl Server {
    /// Serves a folder without subfolders.
    pub(super) fn start(folder: &Path) -> Self {
        let listener = TcpListener::bind("127.0.0.1:0").unwrap();
        let address = listener.local_addr().unwrap();
        let folder = folder.to_owned();
        let requested = Arc::new(Mutex::new(Vec::new()));
        let paths = Arc::clone(&requested);
        std::thread::spawn(move || {
            for stream in listener.incoming().flatten() {
                let (folder, paths) = (folder.clone(), Arc::clone(&paths));
                // A browser that closes a connection early affects nothing else.
                std::thread::spawn(move || answer(&stream, folder, &paths));
            }
        });
        Self { address, requested }
    }
}

fn answer(mut stream: &TcpStream, folder: PathBuf, paths: &Mutex<Vec<String>>) -> Option<()> {
    let mut lines = BufReader::new(stream).lines().map_while(Result::ok);
    let path = lines.next()?.split(' ').nth(1)?.to_owned();
    lines.take_while(|line| !line.is_empty()).for_each(drop);
    let name = match path.split('?').next()?.trim_start_matches('/') {
        "" => "index.html",
        name => name,
    };
    paths.lock().ok()?.push(name.to_owned());
    let media = match name.rsplit('.').next()? {
        "html" => "text/html",
        "js" => "text/javascript",
        "css" => "text/css",
        // Some servers do not know WebAssembly.
        _ => "application/octet-stream",
    };
    let (status, body) = match fs::read(folder.join(name)) {
        Ok(body) => ("200 OK", body),
        Err(_) => ("404 Not Found", Vec::new()),
    };
    let head = format!(
        "HTTP/1.1 {status}\r\nContent-Type: {media}\r\nContent-Length: {}\r\nConnection: close\r\n\r\n",
        body.len()
    );
    stream.write_all(head.as_bytes()).ok()?;
    stream.write_all(&body).ok()
}
