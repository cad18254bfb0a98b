//! What a page may send, and what its server answers.

use etalon_backend::{Backend, BackendError};
use etalon_browser::{BrowserBackend, BrowserOptions, PageSource, open};
use etalon_conformance::{Value, json, scene};
use etalon_frame::ErrorKind;
use etalon_keeper::token;
use std::io::{Read, Write};
use std::net::{SocketAddr, TcpListener, TcpStream};
use std::thread::{self, JoinHandle};
use std::time::Duration;
use tungstenite::{Message, WebSocket};

/// Returns an address without a listener.
fn free_address() -> SocketAddr {
    let listener = TcpListener::bind("127.0.0.1:0").expect("there is a port");
    listener.local_addr().expect("it has an address")
}

/// Returns the description of a device as a page greets with it.
fn hello(vendor: &str) -> Value {
    json!({
        "protocol": 1,
        "browser": { "name": "Test", "version": "1.0" },
        "adapter": { "vendor": vendor, "architecture": "", "device": "", "description": "", "fallback": false },
        "features": [],
        "limits": {
            "maxTextureDimension2D": 8192, "maxTextureDimension3D": 2048, "maxColorAttachments": 8,
            "maxColorAttachmentBytesPerSample": 32, "maxStorageBuffersPerShaderStage": 8,
            "minUniformBufferOffsetAlignment": 256, "minStorageBufferOffsetAlignment": 256
        }
    })
}

/// A page of the tests' own.
struct Page {
    address: SocketAddr,
    token: String,
}

impl Page {
    fn new() -> Self {
        Self {
            address: free_address(),
            token: token(),
        }
    }

    /// Waits for a page as a worker does.
    fn worker(&self) -> JoinHandle<Result<BrowserBackend, String>> {
        let source = PageSource::Listening(self.address, self.token.clone());
        thread::spawn(move || {
            let options = BrowserOptions {
                source,
                validate: true,
                fault: None,
                record: false,
            };
            open("page", options).map_err(|error| error.to_string())
        })
    }

    fn stream(&self) -> TcpStream {
        for _ in 0..500 {
            if let Ok(stream) = TcpStream::connect(self.address) {
                return stream;
            }
            thread::sleep(Duration::from_millis(10));
        }
        panic!("there is no listener");
    }

    /// Opens the WebSocket; `None` if it is refused.
    fn socket(&self, token: &str, origin: &str) -> Option<WebSocket<TcpStream>> {
        let Self { address, .. } = self;
        let request = tungstenite::http::Request::get(format!("ws://{address}/{token}/socket"))
            .header("Host", address.to_string())
            .header("Origin", origin)
            .header("Connection", "Upgrade")
            .header("Upgrade", "websocket")
            .header("Sec-WebSocket-Version", "13")
            .header("Sec-WebSocket-Key", "dGhlIHNhbXBsZSBub25jZQ==")
            .body(())
            .expect("a request");
        let (socket, _) = tungstenite::client(request, self.stream()).ok()?;
        Some(socket)
    }

    /// Opens the WebSocket as the page does.
    fn opened(&self) -> WebSocket<TcpStream> {
        let origin = format!("http://{}", self.address);
        for _ in 0..500 {
            if let Some(socket) = self.socket(&self.token, &origin) {
                return socket;
            }
            thread::sleep(Duration::from_millis(10));
        }
        panic!("the page is refused");
    }

    /// Returns the answer to a request.
    fn get(&self, path: &str) -> String {
        let mut stream = self.stream();
        let request = format!("GET {path} HTTP/1.1\r\nHost: {}\r\n\r\n", self.address);
        stream.write_all(request.as_bytes()).expect("it is sent");
        let mut answer = String::new();
        stream.read_to_string(&mut answer).expect("it is answered");
        answer
    }
}

fn greet(socket: &mut WebSocket<TcpStream>, greeting: &Value) {
    let sent = socket.send(Message::text(greeting.to_string()));
    sent.expect("the greeting is sent");
}

/// Draws a texel, while the page answers the request with these bytes.
fn drawn_with(answer: impl Fn(&Value) -> Message + Send + 'static) -> Result<(), BackendError> {
    let page = Page::new();
    let worker = page.worker();
    let mut socket = page.opened();
    greet(&mut socket, &hello("a"));
    let backend = worker.join().expect("no panic").expect("it opens");
    let answering = thread::spawn(move || {
        let request = socket.read().expect("a request").into_data();
        let length = u32::from_le_bytes(request[..4].try_into().expect("four bytes"));
        let header = &request[4..4 + length as usize];
        let header = serde_json::from_slice(header).expect("a header");
        // The worker ends the connection in the middle of an answer that is too long.
        let _ = socket.send(answer(&header));
        // The connection stays until the worker has looked at the answer.
        let _ = socket.read();
    });
    let drawn = draw(&backend);
    drop(backend);
    answering.join().expect("no panic");
    drawn
}

fn draw(backend: &dyn Backend) -> Result<(), BackendError> {
    let scene = scene(json!({
        "attachments": { "color": { "format": "rgba8unorm", "size": [1, 1], "clear": [1, 0, 0, 1] } },
        "passes": [{ "color": ["color"], "draws": [] }],
        "read": ["color"],
    }));
    let mut prepared = backend.prepare(&scene)?;
    prepared.submit()?;
    let frame = prepared.read_back()?;
    assert_eq!(frame.images[0].sample(0, 0, 0), [255, 0, 0, 255]);
    Ok(())
}

/// Returns a message of a header and bytes.
fn message(header: &Value, bytes: &[u8]) -> Message {
    let header = header.to_string();
    let length = (header.len() as u32).to_le_bytes();
    Message::binary([&length, header.as_bytes(), bytes].concat())
}

fn answer_to(request: &Value) -> Value {
    json!({
        "number": request["number"], "times": [{ "cpu": 1.0, "gpu": null, "wall": 2.0 }],
        "error": null, "messages": []
    })
}

#[test]
fn a_page_draws_a_scene() {
    let drawn = drawn_with(|request| {
        let bytes = request["list"]["reading"]["bytes"].as_u64().expect("bytes");
        let mut bytes = vec![0; bytes as usize];
        bytes[..4].copy_from_slice(&[255, 0, 0, 255]);
        message(&answer_to(request), &bytes)
    });
    assert_eq!(drawn, Ok(()));
}

/// Nothing that a page sends does more than to fail the scene.
#[test]
fn garbage_of_a_page_fails_its_scene_alone() {
    type Garbage = fn(&Value) -> Message;
    let answers: [Garbage; 7] = [
        |_| Message::text("{}"),
        |_| Message::binary(Vec::new()),
        |_| Message::binary(vec![0xff; 64]),
        |request| message(&answer_to(request), &[1, 2, 3]),
        |request| message(&json!({ "number": request["number"] }), &[]),
        |request| {
            let mut answer = answer_to(request);
            answer["number"] = json!(77);
            message(&answer, &[])
        },
        |request| {
            let mut answer = answer_to(request);
            answer["times"] = json!([]);
            message(&answer, &[])
        },
    ];
    for (number, garbage) in answers.into_iter().enumerate() {
        let failed = drawn_with(garbage);
        let is_internal = matches!(
            failed,
            Err(BackendError::Failed {
                kind: ErrorKind::Internal { .. },
                ..
            })
        );
        assert!(is_internal, "garbage {number}: {failed:?}");
    }
}

#[test]
fn an_answer_is_not_longer_than_the_scene_needs() {
    let drawn = drawn_with(|request| {
        let bytes = request["list"]["reading"]["bytes"].as_u64().expect("bytes");
        message(&answer_to(request), &vec![0; bytes as usize + (2 << 20)])
    });
    let text = drawn.expect_err("it is too long").to_string();
    assert!(text.contains("too long"), "{text}");
}

#[test]
fn a_page_that_closes_before_its_greeting_is_waited_for_again() {
    let page = Page::new();
    let worker = page.worker();
    drop(page.opened());
    let mut socket = page.opened();
    socket.close(None).expect("it closes");
    drop(socket);
    greet(&mut page.opened(), &hello("a"));
    worker.join().expect("no panic").expect("it opens");
}

#[test]
fn slow_connections_neither_stay_nor_keep_a_page_out() {
    let page = Page::new();
    let worker = page.worker();
    let slow: Vec<TcpStream> = (0..100)
        .map(|_| {
            let mut stream = page.stream();
            stream.write_all(b"GET /").expect("it is sent");
            stream
        })
        .collect();
    assert!(page.get(&format!("/{}/", page.token)).contains("200 OK"));
    thread::sleep(Duration::from_secs(3));
    for mut stream in slow {
        stream
            .set_read_timeout(Some(Duration::from_millis(100)))
            .expect("a limit");
        // Its end, or an answer that ends.
        let read = stream.read_to_string(&mut String::new());
        let kind = read.map_err(|error| error.kind());
        let waits = matches!(
            kind,
            Err(std::io::ErrorKind::WouldBlock | std::io::ErrorKind::TimedOut)
        );
        assert!(!waits, "a connection without a head is open");
    }
    greet(&mut page.opened(), &hello("a"));
    worker.join().expect("no panic").expect("it opens");
}

#[test]
fn the_errors_of_a_page_keep_their_kinds() {
    for (kind, expected) in [
        ("lost", BackendError::lost("why")),
        ("resource", BackendError::refused("it", "why")),
        ("shader", BackendError::shader("it", "why")),
        ("internal", BackendError::internal_of("it", "why")),
    ] {
        let failed = drawn_with(move |request| {
            let mut answer = answer_to(request);
            answer["error"] = json!({ "kind": kind, "what": "it", "message": "why" });
            message(&answer, &[])
        });
        assert_eq!(failed, Err(expected));
    }
}

#[test]
fn a_request_without_the_token_is_refused() {
    let page = Page::new();
    let worker = page.worker();
    let origin = format!("http://{}", page.address);
    assert!(page.get(&format!("/{}/", page.token)).contains("200 OK"));
    let script = page.get(&format!("/{}/executor.js", page.token));
    assert!(script.contains("text/javascript"));
    for path in [
        "/",
        "/executor.js",
        "/wrong/",
        &format!("/{}/../x", page.token),
    ] {
        assert!(page.get(path).contains("404 Not Found"), "{path}");
    }
    assert!(page.socket("wrong", &origin).is_none());
    assert!(page.socket(&page.token, "http://elsewhere").is_none());
    assert!(page.socket(&page.token, "null").is_none());

    let mut first = page.opened();
    assert!(page.socket(&page.token, &origin).is_none(), "a second page");
    greet(
        &mut first,
        &json!({ "protocol": 1, "unavailable": "no adapter" }),
    );
    let error = worker
        .join()
        .expect("no panic")
        .map(|_| ())
        .expect_err("it is refused");
    assert!(error.contains("no adapter"), "{error}");
}

#[test]
fn a_page_of_another_version_is_refused() {
    let page = Page::new();
    let worker = page.worker();
    let mut greeting = hello("a");
    greeting["protocol"] = json!(2);
    greet(&mut page.opened(), &greeting);
    let error = worker
        .join()
        .expect("no panic")
        .map(|_| ())
        .expect_err("it is refused");
    assert!(error.contains("another version"), "{error}");
}

/// A page that is opened again draws the scene again, on the same device alone.
#[test]
fn a_page_that_comes_back_draws_again() {
    for (vendor, same) in [("a", true), ("b", false)] {
        let page = Page::new();
        let worker = page.worker();
        let mut socket = page.opened();
        greet(&mut socket, &hello("a"));
        let backend = worker.join().expect("no panic").expect("it opens");
        let returning = thread::spawn(move || {
            let _request = socket.read().expect("a request");
            drop(socket);
            let mut socket = page.opened();
            greet(&mut socket, &hello(vendor));
            if same {
                let request = socket.read().expect("the request again").into_data();
                let length = u32::from_le_bytes(request[..4].try_into().expect("four bytes"));
                let header: Value =
                    serde_json::from_slice(&request[4..4 + length as usize]).expect("a header");
                assert!(header["list"].is_object(), "the page has no list any more");
                let bytes = header["list"]["reading"]["bytes"].as_u64().expect("bytes");
                let mut bytes = vec![0; bytes as usize];
                bytes[..4].copy_from_slice(&[255, 0, 0, 255]);
                socket
                    .send(message(&answer_to(&header), &bytes))
                    .expect("the answer");
                let _ = socket.read();
            }
        });
        let drawn = draw(&backend);
        drop(backend);
        returning.join().expect("no panic");
        match drawn {
            Ok(()) => assert!(same),
            Err(error) => {
                assert!(!same, "{error}");
                assert!(error.to_string().contains("another device"), "{error}");
            }
        }
    }
}
