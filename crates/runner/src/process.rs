//! A worker process as the parent holds it.

use crate::protocol::{Hello, Payload, Request, Response, receive, send};
use etalon_backend::{BackendError, Unavailable};
use etalon_case::{Case, Scene};
use etalon_frame::Frame;
use std::collections::VecDeque;
use std::io::{self, BufReader, BufWriter, Read};
use std::path::PathBuf;
use std::process::{Child, ChildStdin, Command, ExitStatus, Stdio};
use std::sync::mpsc::{Receiver, RecvTimeoutError, channel};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread;
use std::time::Duration;
use thiserror::Error;

/// How long a driver may take to start.
const START_TIMEOUT: Duration = Duration::from_secs(60);
/// How long one scene may take before its worker is given up.
pub(crate) const DRAW_TIMEOUT: Duration = Duration::from_secs(60);
/// How much of a worker's stderr is kept: its end.
const STDERR_BYTES: usize = 4096;

/// How to start a worker.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Launch {
    /// The adapter's name.
    pub adapter: String,
    /// The program.
    pub program: PathBuf,
    /// Its arguments.
    pub arguments: Vec<String>,
    /// Environment variables on top of the parent's; `None` removes one.
    pub environment: Vec<(String, Option<String>)>,
}

/// Why a worker did not start.
#[derive(Debug, Error)]
pub enum StartError {
    /// It says so itself.
    #[error("{0}")]
    Unavailable(Unavailable),
    /// It died, hung or talked nonsense.
    #[error("{0}")]
    Broken(String),
}

/// A running worker whose adapter is open.
pub struct Worker {
    /// Who it said it is.
    pub hello: Hello,
    pub(crate) link: Link,
}

impl Worker {
    /// Starts a worker and waits for its first words.
    ///
    /// # Errors
    /// When the program cannot be started, says that its adapter is unavailable, or does not answer.
    pub fn start(launch: &Launch) -> Result<Self, StartError> {
        let mut link = Link::start(launch)?;
        match link.response(START_TIMEOUT) {
            Ok(Response::Hello(Ok(hello))) => Ok(Self {
                hello: *hello,
                link,
            }),
            Ok(Response::Hello(Err(unavailable))) => Err(StartError::Unavailable(unavailable)),
            Ok(Response::Done { .. }) => Err(StartError::Broken(
                "the worker's first message is not a greeting".to_owned(),
            )),
            Err(loss) => Err(StartError::Broken(format!(
                "the driver did not start: {}",
                link.obituary(loss)
            ))),
        }
    }
}

impl Worker {
    /// Draws the scenes of a case and reads each back.
    ///
    /// # Errors
    /// What the backend says, or how the worker was lost.
    pub fn draw(&mut self, case: &Case) -> Result<Vec<Frame>, DrawError> {
        for scene in case.scenes() {
            self.link.draw(0, scene);
        }
        let (drawn, _) = self.link.drawn(case.scene_count(), DRAW_TIMEOUT);
        match drawn {
            Drawn::Frames(frames) => Ok(frames),
            Drawn::Error(error) => Err(DrawError::Backend(error)),
            Drawn::Lost(loss) => Err(DrawError::Lost(self.link.obituary(loss))),
        }
    }
}

/// Why a scene could not be drawn.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
pub enum DrawError {
    /// The backend's word.
    #[error(transparent)]
    Backend(BackendError),
    /// The worker died, hung or talked nonsense.
    #[error("{0}")]
    Lost(String),
}

/// What drawing a scene came to.
pub(crate) enum Drawn {
    Frames(Vec<Frame>),
    Error(BackendError),
    Lost(Loss),
}

/// A worker's process and its pipes.
pub(crate) struct Link {
    child: Child,
    input: Option<BufWriter<ChildStdin>>,
    responses: Receiver<io::Result<Response>>,
    stderr: Arc<Mutex<VecDeque<u8>>>,
}

impl Link {
    fn start(launch: &Launch) -> Result<Self, StartError> {
        let mut command = Command::new(&launch.program);
        command.args(&launch.arguments);
        for (name, value) in &launch.environment {
            match value {
                Some(value) => command.env(name, value),
                None => command.env_remove(name),
            };
        }
        let mut child = command
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .map_err(|e| StartError::Broken(format!("the worker cannot be started: {e}")))?;
        let broken = || StartError::Broken("the worker has no pipes".to_owned());
        let input = BufWriter::new(child.stdin.take().ok_or_else(broken)?);
        let output = child.stdout.take().ok_or_else(broken)?;
        let errors = child.stderr.take().ok_or_else(broken)?;

        let stderr = Arc::new(Mutex::new(VecDeque::new()));
        let kept = Arc::clone(&stderr);
        thread::spawn(move || keep_end(errors, &kept));
        let (sender, responses) = channel();
        thread::spawn(move || {
            let mut output = BufReader::new(output);
            loop {
                let message = receive::<Response>(&mut output).transpose();
                let Some(message) = message else { break };
                let failed = message.is_err();
                if sender.send(message).is_err() || failed {
                    break;
                }
            }
        });
        Ok(Self {
            child,
            input: Some(input),
            responses,
            stderr,
        })
    }

    /// Sends a request. A broken pipe shows when the answer is awaited.
    pub(crate) fn request(&mut self, request: &Request) {
        if let Some(input) = &mut self.input
            && send(input, request).is_err()
        {
            self.input = None;
        }
    }

    /// The next answer.
    pub(crate) fn response(&mut self, timeout: Duration) -> Result<Response, Loss> {
        match self.responses.recv_timeout(timeout) {
            Ok(Ok(response)) => Ok(response),
            Ok(Err(e)) => Err(Loss::Garbage(e.to_string())),
            Err(RecvTimeoutError::Timeout) => Err(Loss::Timeout(timeout)),
            Err(RecvTimeoutError::Disconnected) => Err(Loss::Died),
        }
    }

    /// Asks for everything that one frame of a scene takes; [`Link::drawn`] takes the answers.
    pub(crate) fn draw(&mut self, slot: u32, scene: &Scene) {
        self.request(&Request::Prepare {
            slot,
            scene: Box::new(scene.clone()),
        });
        self.request(&Request::Submit { slot, times: 1 });
        self.request(&Request::ReadBack { slot });
        self.request(&Request::Drop { slot });
    }

    /// The answers to so many [`Link::draw`]s, and how long the worker took over them.
    pub(crate) fn drawn(&mut self, scenes: usize, timeout: Duration) -> (Drawn, Duration) {
        let mut total = Duration::ZERO;
        let mut frames = Vec::new();
        let mut error = None;
        for _ in 0..4 * scenes {
            match self.response(timeout) {
                Ok(Response::Done {
                    outcome, elapsed, ..
                }) => {
                    total += elapsed;
                    match outcome {
                        Ok(Payload::Frame(frame)) => frames.push(*frame),
                        Ok(_) => {}
                        Err(e) => {
                            error.get_or_insert(e);
                        }
                    }
                }
                Ok(Response::Hello(_)) => {
                    let loss = Loss::Garbage("a second greeting".to_owned());
                    return (Drawn::Lost(loss), total);
                }
                Err(loss) => return (Drawn::Lost(loss), total),
            }
        }
        let drawn = match error {
            Some(error) => Drawn::Error(error),
            None if frames.len() == scenes => Drawn::Frames(frames),
            None => Drawn::Error(BackendError::Internal("no frame came back".to_owned())),
        };
        (drawn, total)
    }

    /// Ends the worker and says how it ended, with the end of its stderr.
    pub(crate) fn obituary(&mut self, loss: Loss) -> String {
        let how = match loss {
            Loss::Timeout(limit) => {
                self.kill();
                format!("no answer within {} s", limit.as_secs())
            }
            Loss::Garbage(what) => {
                self.kill();
                format!("the worker wrote garbage: {what}")
            }
            Loss::Died => match self.wait(Duration::from_secs(5)) {
                Some(status) => describe(status),
                None => {
                    self.kill();
                    "the worker closed its pipe".to_owned()
                }
            },
        };
        // The reader of stderr may still be a moment behind.
        thread::sleep(Duration::from_millis(20));
        let kept = self.stderr.lock().unwrap_or_else(PoisonError::into_inner);
        let bytes: Vec<u8> = kept.iter().copied().collect();
        let text = String::from_utf8_lossy(&bytes);
        let text = text.trim();
        if text.is_empty() {
            how
        } else {
            format!("{how}; its last words: {text}")
        }
    }

    fn wait(&mut self, limit: Duration) -> Option<ExitStatus> {
        let step = Duration::from_millis(10);
        let mut waited = Duration::ZERO;
        loop {
            match self.child.try_wait() {
                Ok(Some(status)) => return Some(status),
                Ok(None) if waited < limit => thread::sleep(step),
                _ => return None,
            }
            waited += step;
        }
    }

    fn kill(&mut self) {
        // It may have ended by itself; then there is nothing to kill.
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

impl Drop for Link {
    /// Closing the pipe asks the worker to end; it is not waited for longer than a moment.
    fn drop(&mut self) {
        self.input = None;
        if self.wait(Duration::from_secs(2)).is_none() {
            self.kill();
        }
    }
}

/// How a worker was lost.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum Loss {
    /// It did not answer in time.
    Timeout(Duration),
    /// It wrote what is no message.
    Garbage(String),
    /// Its end of the pipe is closed.
    Died,
}

fn describe(status: ExitStatus) -> String {
    #[cfg(unix)]
    {
        use std::os::unix::process::ExitStatusExt;
        if let Some(signal) = status.signal() {
            return format!("the worker died of signal {signal}{}", signal_name(signal));
        }
    }
    format!("the worker ended with {status}")
}

#[cfg(unix)]
fn signal_name(signal: i32) -> &'static str {
    match signal {
        4 => " (illegal instruction)",
        6 => " (abort)",
        7 => " (bus error)",
        8 => " (arithmetic exception)",
        9 => " (killed)",
        11 => " (segmentation fault)",
        15 => " (terminated)",
        _ => "",
    }
}

fn keep_end(mut from: impl Read, kept: &Mutex<VecDeque<u8>>) {
    let mut buffer = [0; 1024];
    while let Ok(n) = from.read(&mut buffer) {
        if n == 0 {
            break;
        }
        let mut kept = kept.lock().unwrap_or_else(PoisonError::into_inner);
        kept.extend(&buffer[..n]);
        let excess = kept.len().saturating_sub(STDERR_BYTES);
        kept.drain(..excess);
    }
}
