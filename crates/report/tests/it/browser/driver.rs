//! A headless Chromium, driven by mouse and keyboard.

use super::cdp::Connection;
use serde::de::DeserializeOwned;
use serde_json::{Value, json};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

/// The longest time to wait for a change of the page; nothing that works takes so long.
const PATIENCE: Duration = Duration::from_secs(40);

/// The browser; every page is a new tab.
pub(crate) struct Chromium {
    connection: Connection,
    /// Removed after the browser has ended.
    _profile: tempfile::TempDir,
}

impl Chromium {
    pub(crate) fn start() -> Self {
        let profile = tempfile::tempdir().unwrap();
        Self {
            connection: Connection::start(&executable(), profile.path()),
            _profile: profile,
        }
    }

    /// Opens a file at a fragment, `#` included, and waits until it is loaded.
    pub(crate) fn open(&self, path: &Path, fragment: &str) -> Page<'_> {
        let page = self.tab();
        page.go(path, fragment);
        page
    }

    /// Like [`Self::open`], with scripts switched off.
    pub(crate) fn open_without_scripts(&self, path: &Path) -> Page<'_> {
        let page = self.tab();
        let off = json!({ "value": true });
        page.call("Emulation.setScriptExecutionDisabled", &off);
        page.go(path, "");
        page
    }

    fn tab(&self) -> Page<'_> {
        let call = |method, params| self.connection.call(None, method, &params);
        let text = |value: &Value| value.as_str().unwrap().to_owned();
        let made = call("Target.createTarget", json!({ "url": "about:blank" }));
        let target = text(&made["targetId"]);
        let attach = json!({ "targetId": target, "flatten": true });
        let session = text(&call("Target.attachToTarget", attach)["sessionId"]);
        let page = Page {
            connection: &self.connection,
            target,
            session,
        };
        page.call("Page.enable", &json!({}));
        page.call("Page.bringToFront", &json!({}));
        let focus = json!({ "enabled": true });
        page.call("Emulation.setFocusEmulationEnabled", &focus);
        page
    }
}

/// Chromium, from `CHROMIUM` or the search path.
fn executable() -> PathBuf {
    if let Some(path) = std::env::var_os("CHROMIUM") {
        return path.into();
    }
    let path = std::env::var_os("PATH").unwrap_or_default();
    let found = std::env::split_paths(&path)
        .map(|folder| folder.join("chromium"))
        .find(|file| file.is_file());
    found.expect(
        "this test needs Chromium: install Debian's package `chromium`, or set CHROMIUM to its path",
    )
}

/// A tab, closed when it is dropped.
pub(crate) struct Page<'a> {
    connection: &'a Connection,
    target: String,
    session: String,
}

impl Drop for Page<'_> {
    fn drop(&mut self) {
        let target = json!({ "targetId": self.target });
        // A test that fails may have lost its browser.
        if !std::thread::panicking() {
            self.connection.call(None, "Target.closeTarget", &target);
        }
    }
}

impl Page<'_> {
    fn call(&self, method: &str, params: &Value) -> Value {
        self.connection.call(Some(&self.session), method, params)
    }

    fn go(&self, path: &Path, fragment: &str) {
        let url = format!("file://{}{fragment}", path.display());
        self.call("Page.navigate", &json!({ "url": url }));
        self.wait("location.protocol === 'file:' && document.readyState === 'complete'");
    }

    /// Returns the value of an expression of the page, as JSON; an error while the page changes.
    fn evaluate(&self, script: &str) -> Result<Value, String> {
        let params = json!({ "expression": script, "returnByValue": true });
        let answer = self
            .connection
            .try_call(Some(&self.session), "Runtime.evaluate", &params)?;
        match answer.get("exceptionDetails") {
            Some(details) => Err(details.to_string()),
            None => Ok(answer["result"]["value"].clone()),
        }
    }

    /// Returns the value of an expression of the page.
    pub(crate) fn eval<T: DeserializeOwned>(&self, script: &str) -> T {
        let value = self.evaluate(&format!("JSON.stringify({script})"));
        let value = value.unwrap_or_else(|e| panic!("{script}: {e}"));
        let json = value.as_str().unwrap_or("null");
        serde_json::from_str(json).unwrap_or_else(|e| panic!("{script} is {json}: {e}"))
    }

    /// Waits until an expression is true.
    pub(crate) fn wait(&self, script: &str) {
        let start = Instant::now();
        loop {
            let found = self.evaluate(&format!("!!({script})"));
            if found == Ok(json!(true)) {
                return;
            }
            if start.elapsed() > PATIENCE {
                let now = self.evaluate("document.body.innerText.slice(0, 2000)");
                panic!("never true: {script}: {found:?}\n{now:?}");
            }
            std::thread::sleep(Duration::from_millis(15));
        }
    }

    /// Returns the text of the first element that a selector finds, as it is in the tree.
    pub(crate) fn text(&self, selector: &str) -> String {
        self.eval(&format!("document.querySelector({selector:?}).textContent"))
    }

    /// Returns the texts of all elements that a selector finds.
    pub(crate) fn texts(&self, selector: &str) -> Vec<String> {
        self.eval(&format!(
            "[...document.querySelectorAll({selector:?})].map(e => e.textContent)"
        ))
    }

    /// Moves the mouse onto an element and clicks.
    pub(crate) fn click(&self, selector: &str) {
        let [x, y]: [f64; 2] = self.eval(&format!(
            "(e => {{ e.scrollIntoViewIfNeeded(); const r = e.getClientRects()[0]; \
             return [r.x + r.width / 2, r.y + r.height / 2]; }})(document.querySelector({selector:?}))"
        ));
        for (kind, button, clicks) in [
            ("mouseMoved", "none", 0),
            ("mousePressed", "left", 1),
            ("mouseReleased", "left", 1),
        ] {
            let event =
                json!({ "type": kind, "x": x, "y": y, "button": button, "clickCount": clicks });
            self.call("Input.dispatchMouseEvent", &event);
        }
    }

    /// Moves the mouse onto an element; again if the page moved the element meanwhile.
    pub(crate) fn hover(&self, selector: &str) {
        let start = Instant::now();
        loop {
            let [x, y]: [f64; 2] = self.eval(&format!(
                "(e => {{ e.scrollIntoViewIfNeeded(); const r = e.getClientRects()[0]; \
                 return [r.x + r.width / 2, r.y + r.height / 2]; }})(document.querySelector({selector:?}))"
            ));
            let event = json!({ "type": "mouseMoved", "x": x, "y": y });
            self.call("Input.dispatchMouseEvent", &event);
            let under = format!("document.querySelector({selector:?}).matches(':hover')");
            if self.eval(&under) {
                return;
            }
            assert!(start.elapsed() < PATIENCE, "the mouse misses {selector}");
            std::thread::sleep(Duration::from_millis(50));
        }
    }

    /// Sets the size of the window.
    pub(crate) fn resize(&self, width: u32, height: u32) {
        let metrics =
            json!({ "width": width, "height": height, "deviceScaleFactor": 1, "mobile": false });
        self.call("Emulation.setDeviceMetricsOverride", &metrics);
    }

    /// Presses and releases a key: `Tab`, `Enter`, `j`.
    pub(crate) fn press(&self, key: &str) {
        let (number, text) = match key {
            "Tab" => (9, ""),
            "Enter" => (13, "\r"),
            "Escape" => (27, ""),
            "Home" => (36, ""),
            "ArrowLeft" => (37, ""),
            "ArrowUp" => (38, ""),
            "ArrowRight" => (39, ""),
            "ArrowDown" => (40, ""),
            character => (0, character),
        };
        let kind = if text.is_empty() {
            "rawKeyDown"
        } else {
            "keyDown"
        };
        let code = if number == 0 { "" } else { key };
        for (kind, text) in [(kind, text), ("keyUp", "")] {
            let event = json!({ "type": kind, "key": key, "code": code, "text": text, "windowsVirtualKeyCode": number });
            self.call("Input.dispatchKeyEvent", &event);
        }
    }

    /// Runs a script whose value does not matter.
    pub(crate) fn run(&self, script: &str) {
        self.evaluate(script)
            .unwrap_or_else(|e| panic!("{script}: {e}"));
    }

    /// Inserts a text at the cursor, as an input method does.
    pub(crate) fn type_in(&self, text: &str) {
        self.call("Input.insertText", &json!({ "text": text }));
    }

    /// Types a text, key by key.
    pub(crate) fn keys(&self, text: &str) {
        for key in text.chars() {
            self.press(&key.to_string());
        }
    }

    /// Chooses an option of a list with the arrow keys, by the start of its text.
    pub(crate) fn choose(&self, selector: &str, option: &str) {
        self.run(&format!("document.querySelector({selector:?}).focus()"));
        self.press("Home");
        let selected =
            format!("document.querySelector({selector:?}).selectedOptions[0].textContent");
        for _ in 0..50 {
            if self.eval::<String>(&selected).starts_with(option) {
                return;
            }
            self.press("ArrowDown");
        }
        panic!("{selector} has no {option}");
    }

    /// Returns the ids of the cases in the table, in order.
    pub(crate) fn rows(&self) -> Vec<String> {
        self.eval(
            "[...document.querySelectorAll('#case-table tbody th a')]\
             .map(a => decodeURIComponent(a.getAttribute('href').slice('#case='.length)))",
        )
    }

    /// Waits for this many of the cases.
    pub(crate) fn wait_count(&self, count: &str) {
        self.wait(&format!(
            "document.querySelector('#count').textContent.startsWith({count:?})"
        ));
    }

    /// Waits for the address to end in a fragment.
    pub(crate) fn wait_hash(&self, hash: &str) {
        self.wait(&format!("location.hash === {hash:?}"));
    }

    /// Returns the id, the text or the name of the focused element.
    pub(crate) fn focused(&self) -> String {
        self.eval(
            "document.activeElement.id || document.activeElement.textContent.trim() \
             || document.activeElement.tagName",
        )
    }
}
