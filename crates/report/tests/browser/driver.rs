//! A headless Chromium with one page, driven by its mouse and keyboard.

use headless_chrome::protocol::cdp::Emulation::SetScriptExecutionDisabled;
use headless_chrome::{Browser, LaunchOptions, Tab};
use serde::de::DeserializeOwned;
use std::ffi::OsStr;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::{Duration, Instant};

/// How long to wait for what must come; nothing that works takes so long.
const PATIENCE: Duration = Duration::from_secs(40);

/// The browser of a test; every page is a tab of it that nothing was opened in before.
pub(crate) struct Chromium {
    browser: Browser,
    /// Removed when the browser is gone.
    _profile: tempfile::TempDir,
}

impl Chromium {
    pub(crate) fn start() -> Self {
        let profile = tempfile::tempdir().unwrap();
        let args = [
            "--disable-component-update",
            // Tests ask what a screen reader is told.
            "--enable-blink-features=ComputedAccessibilityInfo",
            "--lang=en",
        ];
        let options = LaunchOptions {
            path: Some(executable()),
            sandbox: false,
            window_size: Some((1400, 1000)),
            user_data_dir: Some(profile.path().to_owned()),
            args: args.iter().map(OsStr::new).collect(),
            idle_browser_timeout: PATIENCE * 2,
            ..LaunchOptions::default()
        };
        let browser = Browser::new(options).unwrap();
        Self {
            browser,
            _profile: profile,
        }
    }

    /// Opens a file at a fragment, `#` included, and waits until it is loaded.
    pub(crate) fn open(&self, path: &Path, fragment: &str) -> Page {
        let page = self.tab();
        page.go(path, fragment);
        page
    }

    /// As [`Self::open`], with scripts switched off.
    pub(crate) fn open_without_scripts(&self, path: &Path) -> Page {
        let page = self.tab();
        page.tab
            .call_method(SetScriptExecutionDisabled { value: true })
            .unwrap();
        page.go(path, "");
        page
    }

    fn tab(&self) -> Page {
        let tab = self.browser.new_tab().unwrap();
        tab.set_default_timeout(PATIENCE);
        Page { tab }
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
    found.expect("these tests want Chromium: install Debian's package `chromium`, or set CHROMIUM to its path")
}

/// A tab.
pub(crate) struct Page {
    pub(crate) tab: Arc<Tab>,
}

impl Page {
    fn go(&self, path: &Path, fragment: &str) {
        let url = format!("file://{}{fragment}", path.display());
        self.tab.navigate_to(&url).unwrap();
        self.tab.wait_until_navigated().unwrap();
        self.wait("document.readyState === 'complete'");
    }

    /// The value of an expression of the page.
    pub(crate) fn eval<T: DeserializeOwned>(&self, script: &str) -> T {
        let text = format!("JSON.stringify({script})");
        let found = self.tab.evaluate(&text, false).unwrap();
        let value = found.value.unwrap_or_default();
        let json = value.as_str().unwrap_or("null");
        serde_json::from_str(json).unwrap_or_else(|e| panic!("{script} is {json}: {e}"))
    }

    /// Waits until an expression is true.
    pub(crate) fn wait(&self, script: &str) {
        let start = Instant::now();
        while !self.eval::<bool>(&format!("!!({script})")) {
            let now = || self.eval::<String>("document.body.innerText.slice(0, 2000)");
            assert!(
                start.elapsed() < PATIENCE,
                "never true: {script}\n{}",
                now()
            );
            std::thread::sleep(Duration::from_millis(15));
        }
    }

    /// The text of the first element that a selector finds, as it is in the tree.
    pub(crate) fn text(&self, selector: &str) -> String {
        self.eval(&format!("document.querySelector({selector:?}).textContent"))
    }

    /// The texts of all that a selector finds.
    pub(crate) fn texts(&self, selector: &str) -> Vec<String> {
        self.eval(&format!(
            "[...document.querySelectorAll({selector:?})].map(e => e.textContent)"
        ))
    }

    /// Moves the mouse onto an element and clicks.
    pub(crate) fn click(&self, selector: &str) {
        self.tab.find_element(selector).unwrap().click().unwrap();
    }

    /// Presses and lets go of a key: `Tab`, `Enter`, `j`.
    pub(crate) fn press(&self, key: &str) {
        self.tab.press_key(key).unwrap();
    }

    /// Runs a script whose value does not matter.
    pub(crate) fn run(&self, script: &str) {
        self.tab.evaluate(script, false).unwrap();
    }

    /// Puts a text where the cursor is, as a keyboard of another script would.
    pub(crate) fn type_in(&self, text: &str) {
        self.tab.send_character(text).unwrap();
    }

    /// Types a text, key by key.
    pub(crate) fn keys(&self, text: &str) {
        for key in text.chars() {
            self.press(&key.to_string());
        }
    }

    /// Chooses an option of a list with the arrow keys, by how its text begins.
    pub(crate) fn choose(&self, selector: &str, option: &str) {
        self.tab.find_element(selector).unwrap().focus().unwrap();
        self.press("Home");
        let at = format!("document.querySelector({selector:?}).selectedOptions[0].textContent");
        for _ in 0..50 {
            if self.eval::<String>(&at).starts_with(option) {
                return;
            }
            self.press("ArrowDown");
        }
        panic!("{selector} has no {option}");
    }

    /// The ids of the cases in the table, in their order.
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

    /// The id, the text or the name of the focused element.
    pub(crate) fn focused(&self) -> String {
        self.eval(
            "document.activeElement.id || document.activeElement.textContent.trim() \
             || document.activeElement.tagName",
        )
    }
}
