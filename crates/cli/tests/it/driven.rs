//! A browser that a test drives: Chromium by its DevTools protocol, Firefox by WebDriver BiDi. Commands and profiles are
//! those of the adapters.
#![expect(clippy::unwrap_used, reason = "a test that panics has failed")]

use serde_json::{Value, json};
use std::cell::{Cell, RefCell};
use std::io::{BufRead, BufReader};
use std::net::TcpStream;
use std::os::unix::process::CommandExt;
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};
use std::{fs, thread};
use tungstenite::{Message, WebSocket};

/// The descriptions of the built-in adapters.
const ADAPTERS: &str = include_str!("../../../adapters/adapters.json");
/// The time limit of one answer.
const ANSWER: Duration = Duration::from_secs(120);

/// The protocol by which a browser is driven.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Protocol {
    DevTools,
    BiDi,
}

/// A browser with one page.
pub(crate) struct Driven {
    process: Child,
    protocol: Protocol,
    socket: RefCell<WebSocket<TcpStream>>,
    number: Cell<u64>,
    /// The session of the page in DevTools, or the browsing context in BiDi.
    page: String,
    _profile: tempfile::TempDir,
}

impl Driven {
    /// Starts the browser of an adapter.
    pub(crate) fn start(adapter: &str) -> Self {
        let adapters: Vec<Value> = serde_json::from_str(ADAPTERS).unwrap();
        let description = adapters.iter().find(|a| a["name"] == adapter).unwrap();
        let profile = tempfile::tempdir().unwrap();
        for (name, text) in description["profile"].as_object().into_iter().flatten() {
            fs::write(profile.path().join(name), text.as_str().unwrap()).unwrap();
        }
        let folder = profile.path().to_str().unwrap();
        let words = description["browser"].as_array().unwrap().iter();
        let words = words.map(|word| word.as_str().unwrap());
        let words = words.map(|word| word.replace("{profile}", folder));
        let words: Vec<String> = words.map(|w| w.replace("{url}", "about:blank")).collect();
        let mut command = Command::new(&words[0]);
        command
            .args(&words[1..])
            .arg("--remote-debugging-port=0")
            .stdin(Stdio::null())
            .stdout(Stdio::null())
            .stderr(Stdio::piped())
            .process_group(0);
        for manifest in description["manifests"].as_array().into_iter().flatten() {
            let path = Path::new("/usr/share/vulkan/icd.d").join(manifest.as_str().unwrap());
            if path.is_file() {
                command.env("VK_DRIVER_FILES", path);
                break;
            }
        }
        let remedy = description["remedy"].as_str().unwrap();
        let process = command.spawn();
        let mut process = process.unwrap_or_else(|e| panic!("{}: {e}; {remedy}", words[0]));
        let mut lines = BufReader::new(process.stderr.take().unwrap()).lines();
        let (protocol, address) = lines
            .by_ref()
            .map_while(Result::ok)
            .find_map(|line| {
                let (name, address) = line.split_once(" listening on ")?;
                match name {
                    "DevTools" => Some((Protocol::DevTools, address.to_owned())),
                    _ => Some((Protocol::BiDi, format!("{address}/session"))),
                }
            })
            .expect("the browser says where it listens");
        // Without a reader, a full pipe would block the browser.
        thread::spawn(move || lines.for_each(drop));
        let host = address.strip_prefix("ws://").unwrap();
        let stream = TcpStream::connect(host.split_once('/').unwrap().0).unwrap();
        stream.set_read_timeout(Some(ANSWER)).unwrap();
        let (socket, _) = tungstenite::client(address.as_str(), stream).unwrap();
        let mut driven = Self {
            process,
            protocol,
            socket: RefCell::new(socket),
            number: Cell::new(0),
            page: String::new(),
            _profile: profile,
        };
        driven.page = driven.open();
        driven
    }

    /// Returns the session or the context of a page.
    fn open(&self) -> String {
        let text = |value: &Value| value.as_str().unwrap().to_owned();
        match self.protocol {
            Protocol::DevTools => {
                let made = self.call("Target.createTarget", &json!({ "url": "about:blank" }));
                let attach = json!({ "targetId": made["targetId"], "flatten": true });
                text(&self.call("Target.attachToTarget", &attach)["sessionId"])
            }
            Protocol::BiDi => {
                self.call("session.new", &json!({ "capabilities": {} }));
                let tree = self.call("browsingContext.getTree", &json!({}));
                text(&tree["contexts"][0]["context"])
            }
        }
    }

    /// Returns the answer to a command.
    fn try_call(&self, method: &str, params: &Value) -> Result<Value, String> {
        self.number.set(self.number.get() + 1);
        let mut command = json!({ "id": self.number.get(), "method": method, "params": params });
        if self.protocol == Protocol::DevTools && !self.page.is_empty() {
            command["sessionId"] = json!(self.page);
        }
        let mut socket = self.socket.borrow_mut();
        socket.send(Message::text(command.to_string())).unwrap();
        loop {
            let message = socket.read();
            let message = message.unwrap_or_else(|e| panic!("no answer to {method}: {e}"));
            let Message::Text(text) = message else {
                continue;
            };
            let mut answer: Value = serde_json::from_str(&text).unwrap();
            if answer["id"] != self.number.get() {
                continue;
            }
            return match answer.get("error") {
                Some(_) => Err(answer.to_string()),
                None => Ok(answer["result"].take()),
            };
        }
    }

    fn call(&self, method: &str, params: &Value) -> Value {
        let answer = self.try_call(method, params);
        answer.unwrap_or_else(|e| panic!("{method} {params}: {e}"))
    }

    /// Opens an address.
    pub(crate) fn go(&self, url: &str) {
        match self.protocol {
            Protocol::DevTools => self.call("Page.navigate", &json!({ "url": url })),
            Protocol::BiDi => self.call(
                "browsingContext.navigate",
                &json!({ "context": self.page, "url": url, "wait": "complete" }),
            ),
        };
    }

    /// Sets the width of the window, and dark mode.
    pub(crate) fn narrow(&self) {
        let size = json!({ "width": 390, "height": 844, "deviceScaleFactor": 2, "mobile": true });
        self.call("Emulation.setDeviceMetricsOverride", &size);
        let dark = json!([{ "name": "prefers-color-scheme", "value": "dark" }]);
        self.call("Emulation.setEmulatedMedia", &json!({ "features": dark }));
    }

    /// Kills the processes of the browser that draw, which loses all devices.
    pub(crate) fn kill_gpu(&self) {
        let processes = fs::read_dir("/proc").unwrap().flatten();
        let numbers = processes.filter_map(|entry| entry.file_name().to_str()?.parse().ok());
        let draws = |number: &i32| {
            let line = fs::read(format!("/proc/{number}/cmdline")).unwrap_or_default();
            let stat = fs::read_to_string(format!("/proc/{number}/stat")).unwrap_or_default();
            // After the name in parentheses: state, parent, process group.
            let group = stat
                .rsplit(") ")
                .next()
                .and_then(|rest| rest.split(' ').nth(2));
            String::from_utf8_lossy(&line).contains("--type=gpu-process")
                && group == Some(&self.process.id().to_string())
        };
        let killed = numbers
            .filter(draws)
            .filter_map(rustix::process::Pid::from_raw);
        let killed =
            killed.map(|pid| rustix::process::kill_process(pid, rustix::process::Signal::KILL));
        assert!(killed.count() > 0, "no process draws");
    }

    /// Returns the value of an expression, whose promise is awaited; an error while the page changes.
    fn try_eval(&self, script: &str) -> Result<Value, String> {
        let script =
            format!("Promise.resolve({script}).then(value => JSON.stringify(value) ?? \"null\")");
        let text = match self.protocol {
            Protocol::DevTools => {
                let params =
                    json!({ "expression": script, "returnByValue": true, "awaitPromise": true });
                let answer = self.try_call("Runtime.evaluate", &params)?;
                answer["result"]["value"].clone()
            }
            Protocol::BiDi => {
                let target = json!({ "context": self.page });
                let params =
                    json!({ "expression": script, "target": target, "awaitPromise": true });
                let answer = self.try_call("script.evaluate", &params)?;
                answer["result"]["value"].clone()
            }
        };
        let text = text.as_str().ok_or_else(|| format!("{script}: {text}"))?;
        serde_json::from_str(text).map_err(|error| error.to_string())
    }

    /// Returns the value of an expression.
    pub(crate) fn eval(&self, script: &str) -> Value {
        self.try_eval(script)
            .unwrap_or_else(|e| panic!("{script}: {e}"))
    }

    /// Waits until an expression is true.
    pub(crate) fn wait(&self, seconds: u64, script: &str) {
        let begun = Instant::now();
        loop {
            let found = self.try_eval(&format!("!!({script})"));
            if found == Ok(json!(true)) {
                return;
            }
            if begun.elapsed() > Duration::from_secs(seconds) {
                let text = self.try_eval("document.body.innerText.slice(0, 3000)");
                panic!("never true: {script}: {found:?}\n{text:?}");
            }
            thread::sleep(Duration::from_millis(50));
        }
    }
}

impl Drop for Driven {
    fn drop(&mut self) {
        if let Some(group) = rustix::process::Pid::from_raw(self.process.id().cast_signed()) {
            // The browser can have ended already.
            let _ = rustix::process::kill_process_group(group, rustix::process::Signal::KILL);
        }
        let _ = self.process.wait();
    }
}
