//! The process that keeps a browser. It ends the browser and removes its profile when the worker ends, for
//! whatever reason.

use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::io::{self, BufRead, Write};
use std::path::Path;
use std::process::{Child, ChildStdin, Command, ExitStatus, Stdio};
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::thread;
use std::time::{Duration, Instant};

/// The time that a browser has to end on request.
const GRACE: Duration = Duration::from_secs(2);
/// The pause between checks of a browser.
const PAUSE: Duration = Duration::from_millis(20);

/// The word of a command that is replaced by the page's address.
const URL: &str = "{url}";
/// The part of a word that is replaced by the profile's folder.
const PROFILE: &str = "{profile}";

/// A browser, as an adapter's description defines it.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Browser {
    /// The words of its command. `{url}` and `{profile}` are replaced.
    pub command: Vec<String>,
    /// The files of its profile, which is a new folder: names and contents.
    pub profile: BTreeMap<String, String>,
}

impl Browser {
    /// Returns what is wrong with the description, if anything.
    pub fn fault(&self) -> Option<&'static str> {
        let has = |word: &str| self.command.iter().any(|w| w.contains(word));
        if self.command.first().is_none_or(String::is_empty) {
            Some("`browser` names no command")
        } else if !has(URL) {
            Some("`browser` needs a word `{url}`, the address of the page")
        } else if !has(PROFILE) {
            Some("`browser` needs a word with `{profile}`, a new folder for the browser's profile")
        } else if self.profile.keys().any(|name| !is_plain(name)) {
            Some("a file of `profile` needs a plain name")
        } else {
            None
        }
    }
}

fn is_plain(name: &str) -> bool {
    let plain = |c: char| c.is_ascii_alphanumeric() || "._-".contains(c);
    !name.starts_with('.') && !name.is_empty() && name.chars().all(plain)
}

/// The message to a keeper.
#[derive(Serialize, Deserialize)]
struct Order {
    browser: Browser,
    url: String,
}

/// The worker's handle of a keeper. Dropping it makes the keeper end the browser.
pub(crate) struct Kept {
    keeper: Child,
    /// The pipe to the keeper. Its end shows that the worker ended.
    _input: ChildStdin,
}

impl Kept {
    /// Starts a keeper by its command, and a browser that opens an address.
    ///
    /// # Errors
    /// If the keeper cannot be started.
    pub(crate) fn start(mut keeper: Command, browser: &Browser, url: &str) -> io::Result<Self> {
        // A separate process group, so that the worker's signals do not reach it.
        #[cfg(unix)]
        std::os::unix::process::CommandExt::process_group(&mut keeper, 0);
        let mut keeper = keeper.stdin(Stdio::piped()).stdout(Stdio::null()).spawn()?;
        let missing = || io::Error::other("the keeper has no input");
        let mut input = keeper.stdin.take().ok_or_else(missing)?;
        let order = Order {
            browser: browser.clone(),
            url: url.to_owned(),
        };
        serde_json::to_writer(&mut input, &order)?;
        input.write_all(b"\n")?;
        input.flush()?;
        Ok(Self {
            keeper,
            _input: input,
        })
    }

    /// Returns true while the browser runs.
    pub(crate) fn lives(&mut self) -> bool {
        matches!(self.keeper.try_wait(), Ok(None))
    }

    /// Waits a moment for the keeper's last messages about a browser that seems to have ended.
    pub(crate) fn wait(&mut self) {
        let begun = Instant::now();
        while self.lives() && begun.elapsed() < GRACE {
            thread::sleep(PAUSE);
        }
    }
}

/// Keeps a browser until `input` or the browser ends. Messages go to standard error.
///
/// # Errors
/// If the first line of `input` is not a valid order, or the browser cannot be started.
pub fn keep(mut input: impl BufRead + Send + 'static) -> io::Result<()> {
    let mut line = String::new();
    input.read_line(&mut line)?;
    let Order { browser, url } = serde_json::from_str(&line)?;
    let profile = tempfile::Builder::new()
        .prefix("etalon-browser-")
        .tempdir()?;
    for (name, text) in &browser.profile {
        std::fs::write(profile.path().join(name), text)?;
    }
    let mut browser = start(&browser.command, &url, profile.path())?;
    let (sender, ended) = channel::<()>();
    thread::Builder::new().spawn(move || {
        // Nothing is sent; only the end matters.
        let _ = io::copy(&mut input, &mut io::sink());
        drop(sender);
    })?;
    loop {
        if let Some(status) = browser.try_wait()? {
            eprintln!("the browser has ended: {status}");
            end(&mut browser);
            break;
        }
        match ended.recv_timeout(PAUSE) {
            Err(RecvTimeoutError::Timeout) => {}
            _ => {
                end(&mut browser);
                break;
            }
        }
    }
    remove(profile);
    Ok(())
}

fn start(words: &[String], url: &str, profile: &Path) -> io::Result<Child> {
    let profile = profile.display().to_string();
    let mut words = words
        .iter()
        .map(|word| word.replace(URL, url).replace(PROFILE, &profile));
    let program = words.next().unwrap_or_default();
    let mut command = Command::new(&program);
    command
        .args(words)
        .stdin(Stdio::null())
        .stdout(Stdio::null());
    // A process group, so that all processes of the browser can be ended together.
    #[cfg(unix)]
    std::os::unix::process::CommandExt::process_group(&mut command, 0);
    command
        .spawn()
        .map_err(|error| io::Error::new(error.kind(), format!("{program}: {error}")))
}

/// Ends a browser and all its processes.
fn end(browser: &mut Child) {
    signal(browser, false);
    let begun = Instant::now();
    while waited(browser).is_none() && begun.elapsed() < GRACE {
        thread::sleep(PAUSE);
    }
    signal(browser, true);
    // It has ended, or cannot be ended.
    let _ = browser.kill();
    let _ = browser.wait();
}

fn waited(browser: &mut Child) -> Option<ExitStatus> {
    browser.try_wait().ok().flatten()
}

/// Asks the processes of a browser to end, or kills them if `at_once` is true.
#[cfg(unix)]
fn signal(browser: &Child, at_once: bool) {
    use rustix::process::{Pid, Signal, kill_process_group};
    let signal = if at_once { Signal::KILL } else { Signal::TERM };
    if let Some(group) = i32::try_from(browser.id()).ok().and_then(Pid::from_raw) {
        // The processes might have ended by themselves.
        let _ = kill_process_group(group, signal);
    }
}

#[cfg(not(unix))]
fn signal(_: &Child, _: bool) {}

/// Removes a profile. Processes that are ending can still write to it, so this retries.
fn remove(profile: tempfile::TempDir) {
    let folder = profile.keep();
    let begun = Instant::now();
    while std::fs::remove_dir_all(&folder).is_err() && folder.exists() && begun.elapsed() < GRACE {
        thread::sleep(PAUSE);
    }
}
