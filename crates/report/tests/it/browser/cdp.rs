//! The part of the Chrome DevTools Protocol that these tests need: requests and answers over one websocket. A
//! client of the whole protocol takes longer to compile than this crate.

use serde_json::{Value, json};
use std::cell::RefCell;
use std::io::{BufRead, BufReader};
use std::net::TcpStream;
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::time::Duration;
use tungstenite::{Message, WebSocket};

/// The time limit of an answer.
const ANSWER: Duration = Duration::from_secs(60);

/// A browser and the connection to it.
pub(super) struct Connection {
    process: Child,
    socket: RefCell<WebSocket<TcpStream>>,
    requests: RefCell<u64>,
}

impl Connection {
    /// Starts a headless Chromium with its own profile.
    pub(super) fn start(executable: &Path, profile: &Path) -> Self {
        let mut process = Command::new(executable)
            .args([
                "--headless",
                // As root, as in most containers, Chromium does not start with its sandbox.
                "--no-sandbox",
                "--disable-gpu",
                "--disable-dev-shm-usage",
                "--disable-background-networking",
                "--disable-component-update",
                "--disable-extensions",
                "--disable-sync",
                "--no-first-run",
                "--lang=en",
                "--window-size=1400,1000",
                "--remote-debugging-port=0",
                // Tests ask for the text that a screen reader gets.
                "--enable-blink-features=ComputedAccessibilityInfo",
            ])
            .arg(format!("--user-data-dir={}", profile.display()))
            .stdin(Stdio::null())
            .stdout(Stdio::null())
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        let mut lines = BufReader::new(process.stderr.take().unwrap()).lines();
        let address = lines
            .by_ref()
            .map_while(Result::ok)
            .find_map(|line| Some(line.split_once("DevTools listening on ")?.1.to_owned()))
            .expect("Chromium says where it listens");
        // Without a reader, a full pipe would block the browser.
        std::thread::spawn(move || lines.for_each(drop));
        let host = address.strip_prefix("ws://").unwrap();
        let stream = TcpStream::connect(host.split_once('/').unwrap().0).unwrap();
        stream.set_read_timeout(Some(ANSWER)).unwrap();
        let (socket, _) = tungstenite::client(address.as_str(), stream).unwrap();
        Self {
            process,
            socket: RefCell::new(socket),
            requests: RefCell::new(0),
        }
    }

    /// Returns the answer to a request, of a session if there is one; skips events.
    pub(super) fn try_call(
        &self,
        session: Option<&str>,
        method: &str,
        params: &Value,
    ) -> Result<Value, String> {
        let id = {
            let mut requests = self.requests.borrow_mut();
            *requests += 1;
            *requests
        };
        let mut request = json!({ "id": id, "method": method, "params": params });
        if let Some(session) = session {
            request["sessionId"] = json!(session);
        }
        let mut socket = self.socket.borrow_mut();
        socket.send(Message::text(request.to_string())).unwrap();
        loop {
            let message = socket
                .read()
                .unwrap_or_else(|e| panic!("no answer to {request}: {e}"));
            let Message::Text(text) = message else {
                continue;
            };
            let mut answer: Value = serde_json::from_str(&text).unwrap();
            if answer["id"] != id {
                continue;
            }
            return match answer.get("error") {
                Some(error) => Err(error.to_string()),
                None => Ok(answer["result"].take()),
            };
        }
    }

    /// Like [`Self::try_call`], but an error fails the test.
    pub(super) fn call(&self, session: Option<&str>, method: &str, params: &Value) -> Value {
        self.try_call(session, method, params)
            .unwrap_or_else(|e| panic!("{method} {params}: {e}"))
    }
}

impl Drop for Connection {
    fn drop(&mut self) {
        // The browser may have ended already.
        let _ = self.process.kill();
        let _ = self.process.wait();
    }
}
