//! The parent's end of a worker: its process, its pipes, and the eye on both.

use crate::loss::{Loss, Obituary, keep_end};
use crate::process::{Drawn, Launch, StartError};
use crate::protocol::{Payload, Request, Response, encode, receive};
use etalon_backend::BackendError;
use etalon_scene::Scene;
use std::collections::VecDeque;
use std::fs;
use std::io::{self, BufReader, Write};
use std::process::{Child, ChildStdin, Command, ExitStatus, Stdio};
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender, channel};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread;
use std::time::{Duration, Instant};

/// How often a waiting parent looks whether it is to stop.
const GLANCE: Duration = Duration::from_millis(100);
/// How often a worker's memory is looked at.
const WATCH: Duration = Duration::from_millis(50);

/// How long an answer is waited for.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Patience<'a> {
    /// How long one case may take.
    pub(crate) timeout: Duration,
    /// Set when nobody wants the answer any more.
    pub(crate) stop: Option<&'a AtomicBool>,
}

impl Patience<'_> {
    /// So long, whatever happens.
    pub(crate) fn of(timeout: Duration) -> Self {
        Self {
            timeout,
            stop: None,
        }
    }
}

/// A worker's process and its pipes.
pub(crate) struct Link {
    child: Arc<Mutex<Child>>,
    /// To the thread that writes requests: a worker that does not read must not stop the parent.
    requests: Option<Sender<Vec<u8>>>,
    responses: Receiver<(Instant, io::Result<Response>)>,
    stderr: Arc<Mutex<VecDeque<u8>>>,
    /// MiB that the worker held when it was killed for it.
    held: Arc<AtomicU64>,
    limit: u64,
    /// When the last answer came, or the worker was started.
    answered: Instant,
    /// Set when the eye may close.
    over: Arc<AtomicBool>,
}

impl Link {
    pub(crate) fn start(launch: &Launch) -> Result<Self, StartError> {
        let mut command = Command::new(&launch.program);
        command.args(&launch.arguments);
        for (name, value) in &launch.environment {
            match value {
                Some(value) => command.env(name, value),
                None => command.env_remove(name),
            };
        }
        // Ctrl-C is meant for the parent, which then ends its workers in good order.
        #[cfg(unix)]
        std::os::unix::process::CommandExt::process_group(&mut command, 0);
        let mut child = command
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .map_err(|e| StartError::Broken(format!("the worker cannot be started: {e}")))?;
        let broken = || StartError::Broken("the worker has no pipes".to_owned());
        let input = child.stdin.take().ok_or_else(broken)?;
        let output = child.stdout.take().ok_or_else(broken)?;
        let errors = child.stderr.take().ok_or_else(broken)?;

        let (requests, to_write) = channel();
        thread::spawn(move || write_all(input, &to_write));
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
                if sender.send((Instant::now(), message)).is_err() || failed {
                    break;
                }
            }
        });
        Ok(Self {
            child: Arc::new(Mutex::new(child)),
            requests: Some(requests),
            responses,
            stderr,
            held: Arc::default(),
            limit: 0,
            answered: Instant::now(),
            over: Arc::default(),
        })
    }

    /// Kills the worker as soon as it holds more than so many MiB of memory. Where the system does not
    /// tell what a process holds, nothing happens.
    pub(crate) fn guard(&mut self, limit: u64) {
        self.limit = limit;
        let (child, held) = (Arc::clone(&self.child), Arc::clone(&self.held));
        let over = Arc::clone(&self.over);
        let id = lock(&child).id();
        thread::spawn(move || {
            while !over.load(Ordering::Relaxed) {
                let Some(now) = memory(id) else { return };
                if now > limit {
                    held.store(now, Ordering::Relaxed);
                    // It may have ended by itself; then there is nothing to kill.
                    let _ = lock(&child).kill();
                    return;
                }
                thread::sleep(WATCH);
            }
        });
    }

    /// Sends a request. A broken pipe shows when the answer is awaited.
    pub(crate) fn request(&mut self, request: &Request) {
        let sent = encode(request).map(|bytes| match &self.requests {
            Some(requests) => requests.send(bytes).is_ok(),
            None => false,
        });
        if !matches!(sent, Ok(true)) {
            self.requests = None;
        }
    }

    /// The next answer, until a point in time.
    pub(crate) fn response_until(
        &mut self,
        until: Instant,
        patience: Patience<'_>,
    ) -> Result<Response, Loss> {
        let stopped = || patience.stop.is_some_and(|s| s.load(Ordering::Relaxed));
        loop {
            let left = until.saturating_duration_since(Instant::now());
            match self.responses.recv_timeout(left.min(GLANCE)) {
                Ok((at, Ok(response))) => {
                    self.answered = at;
                    return Ok(response);
                }
                Ok((_, Err(e))) => return Err(self.died().unwrap_or(Loss::Garbage(e.to_string()))),
                Err(RecvTimeoutError::Timeout) if stopped() => return Err(Loss::Stopped),
                Err(RecvTimeoutError::Timeout) if left > GLANCE => {}
                Err(RecvTimeoutError::Timeout) => {
                    return Err(self.died().unwrap_or(Loss::Timeout(patience.timeout)));
                }
                Err(RecvTimeoutError::Disconnected) => {
                    return Err(self.died().unwrap_or(Loss::Died));
                }
            }
        }
    }

    /// The next answer.
    pub(crate) fn response(&mut self, timeout: Duration) -> Result<Response, Loss> {
        self.response_until(Instant::now() + timeout, Patience::of(timeout))
    }

    /// Whether the worker was killed for what it held.
    fn died(&self) -> Option<Loss> {
        let held = self.held.load(Ordering::Relaxed);
        (held > 0).then_some(Loss::Memory {
            held,
            limit: self.limit,
        })
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

    /// The answers to so many [`Link::draw`]s of a slot that were asked for at a time.
    pub(crate) fn drawn(
        &mut self,
        slot: u32,
        scenes: usize,
        asked: Instant,
        patience: Patience<'_>,
    ) -> Drawing {
        // The worker came to this case when it was done with the one before.
        let turn = asked.max(self.answered);
        let until = turn + patience.timeout;
        let mut drawing = Drawing {
            drawn: Drawn::Lost(Loss::Died),
            working: Duration::ZERO,
            since: Duration::ZERO,
            messages: Vec::new(),
        };
        let mut frames = Vec::new();
        let mut error = None;
        for _ in 0..4 * scenes {
            let loss = match self.response_until(until, patience) {
                Ok(Response::Done {
                    slot: answered,
                    outcome,
                    elapsed,
                    messages,
                }) if answered == slot => {
                    drawing.working += elapsed;
                    drawing.messages.extend(messages);
                    match outcome {
                        Ok(Payload::Frame(frame)) => frames.push(*frame),
                        Ok(_) => {}
                        Err(e) => {
                            error.get_or_insert(e);
                        }
                    }
                    continue;
                }
                Ok(Response::Done { .. }) => {
                    Loss::Garbage("an answer to another request".to_owned())
                }
                Ok(Response::Hello(_)) => Loss::Garbage("a second greeting".to_owned()),
                Err(loss) => loss,
            };
            drawing.drawn = Drawn::Lost(loss);
            drawing.since = turn.elapsed();
            return drawing;
        }
        drawing.drawn = match error {
            Some(error) => Drawn::Error(error),
            None if frames.len() == scenes => Drawn::Frames(frames),
            None => Drawn::Error(BackendError::Internal("no frame came back".to_owned())),
        };
        drawing.since = turn.elapsed();
        drawing
    }

    /// Ends the worker and says how it ended, with the end of its stderr.
    pub(crate) fn obituary(&mut self, loss: Loss) -> Obituary {
        let status = match loss {
            Loss::Died => {
                let status = self.wait(Duration::from_secs(5));
                if status.is_none() {
                    self.kill();
                }
                status
            }
            _ => {
                self.kill();
                None
            }
        };
        // The reader of stderr may still be a moment behind.
        thread::sleep(Duration::from_millis(20));
        let kept = lock(&self.stderr);
        let bytes: Vec<u8> = kept.iter().copied().collect();
        let text = String::from_utf8_lossy(&bytes).trim().to_owned();
        Obituary::new(loss, status, text)
    }

    fn wait(&mut self, limit: Duration) -> Option<ExitStatus> {
        let step = Duration::from_millis(10);
        let start = Instant::now();
        loop {
            let status = lock(&self.child).try_wait();
            match status {
                Ok(Some(status)) => return Some(status),
                Ok(None) if start.elapsed() < limit => thread::sleep(step),
                _ => return None,
            }
        }
    }

    fn kill(&mut self) {
        self.over.store(true, Ordering::Relaxed);
        let mut child = lock(&self.child);
        // It may have ended by itself; then there is nothing to kill.
        let _ = child.kill();
        let _ = child.wait();
    }
}

impl Drop for Link {
    /// Closing the pipe asks the worker to end; it is not waited for longer than a moment.
    fn drop(&mut self) {
        self.requests = None;
        if self.wait(Duration::from_secs(2)).is_none() {
            self.kill();
        }
        self.over.store(true, Ordering::Relaxed);
    }
}

/// What drawing the scenes of a case came to.
pub(crate) struct Drawing {
    pub(crate) drawn: Drawn,
    /// How long the worker says that it worked.
    pub(crate) working: Duration,
    /// How long it took since the case's turn came.
    pub(crate) since: Duration,
    /// What validation layers and debug output said meanwhile.
    pub(crate) messages: Vec<String>,
}

fn lock<T>(mutex: &Mutex<T>) -> std::sync::MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Writes requests until there are no more or the worker does not take them.
fn write_all(mut input: ChildStdin, requests: &Receiver<Vec<u8>>) {
    while let Ok(bytes) = requests.recv() {
        if input
            .write_all(&bytes)
            .and_then(|()| input.flush())
            .is_err()
        {
            return;
        }
    }
}

/// How many MiB of memory a process holds, in pages and in swap; `None` where the system does not tell.
fn memory(process: u32) -> Option<u64> {
    let status = fs::read_to_string(format!("/proc/{process}/status")).ok()?;
    let field = |name: &str| -> Option<u64> {
        let line = status.lines().find_map(|l| l.strip_prefix(name))?;
        line.trim_end_matches("kB").trim().parse().ok()
    };
    Some((field("VmRSS:")? + field("VmSwap:").unwrap_or(0)) / 1024)
}
