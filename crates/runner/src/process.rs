//! A worker's process and its pipes.
//!
//! Each pipe has its own thread, so that a worker that stops reading or writing never blocks the parent:
//! the parent waits with a time limit, then kills the worker.

use crate::greeting;
use crate::launch::{Launch, Setup, StartError};
use crate::loss::Loss;
use crate::memory::MemoryLimit;
use crate::process_end::process_end;
use crate::protocol::{Request, Response, encode, encode_after, receive};
use crate::stderr_tail::StderrTail;
use crate::sync::lock;
use etalon_process::ProcessGroup;
use etalon_record::ProcessEnd;
use std::collections::VecDeque;
use std::io::{BufReader, Error, Write};
use std::process::{Child, ChildStdin, ExitStatus, Stdio};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender, channel};
use std::sync::{Arc, Mutex};
use std::thread;
use std::time::{Duration, Instant};

/// The interval at which a waiting parent checks whether the run is being stopped.
const POLL_INTERVAL: Duration = Duration::from_millis(100);
/// The time that a worker may take to exit after its pipe broke.
const EXIT_TIMEOUT: Duration = Duration::from_secs(5);
/// The longest time between two looks at whether a worker has exited.
const LONGEST_STEP: Duration = Duration::from_millis(10);
/// The time to wait for the rest of a worker's standard error.
const LAST_WORDS: Duration = Duration::from_secs(2);
/// The time that a worker which is no longer needed may take to exit.
const CLOSE_TIMEOUT: Duration = Duration::from_secs(2);

/// The limits of waiting for an answer.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Wait<'a> {
    /// The time that one case may take.
    pub(crate) timeout: Duration,
    /// Set when the run is being stopped and the answer is no longer needed.
    pub(crate) stop: Option<&'a AtomicBool>,
}

impl Wait<'_> {
    /// Returns a limit with only a timeout.
    pub(crate) fn of(timeout: Duration) -> Self {
        Self {
            timeout,
            stop: None,
        }
    }
}

/// The settings of glibc's allocator in workers; other C libraries ignore them. A driver frees the images
/// of a case before it allocates those of the next. Memory that was returned to the system in between must
/// be mapped, cleared and faulted in again for every case.
const MALLOC: (&str, &str) = (
    "GLIBC_TUNABLES",
    "glibc.malloc.trim_threshold=268435456:glibc.malloc.mmap_threshold=33554432:glibc.malloc.top_pad=16777216",
);

/// An answer, or the end of all answers, with the time of its arrival.
type WorkerAnswer = (Instant, Result<Response, Loss>);

/// A worker's process and its pipes.
pub(crate) struct WorkerProcess {
    child: Arc<Mutex<Child>>,
    /// The processes of the worker: itself, its launcher, and what they start.
    group: ProcessGroup,
    /// True if the process is a launcher, whose signals and memory say nothing about the worker.
    launched: bool,
    /// Set once the worker has sent its greeting.
    greeted: Arc<AtomicBool>,
    /// Sends requests to the thread that writes them.
    requests: Option<Sender<Vec<u8>>>,
    responses: Receiver<Vec<WorkerAnswer>>,
    /// Answers that have arrived but that no caller has taken yet.
    came: VecDeque<WorkerAnswer>,
    stderr: StderrTail,
    memory: Option<MemoryLimit>,
    /// The time of the last answer, or of the start.
    answered: Instant,
    /// Set when the process has ended, or must end.
    ended: Arc<AtomicBool>,
}

impl WorkerProcess {
    pub(crate) fn spawn(launch: &Launch) -> Result<Self, StartError> {
        let mut command = launch.command();
        let chosen = |name: &str| launch.environment.iter().any(|(n, _)| n == name);
        if std::env::var_os(MALLOC.0).is_none() && !chosen(MALLOC.0) {
            command.env(MALLOC.0, MALLOC.1);
        }
        // Ctrl-C is meant for the parent, which then ends its workers in an orderly way.
        command
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped());
        let started = ProcessGroup::start_worker(&mut command);
        let (mut child, group) = started.map_err(|e| cannot_start(launch, &e))?;
        let no_pipe = || StartError::Broken("the worker has no pipes".to_owned());
        let input = child.stdin.take().ok_or_else(no_pipe)?;
        let output = child.stdout.take().ok_or_else(no_pipe)?;
        let errors = child.stderr.take().ok_or_else(no_pipe)?;

        let (requests, to_write) = channel();
        if let Some(launcher) = &launch.launcher {
            let setup = Setup {
                open: launcher.open.clone(),
                environment: launch.environment.clone(),
            };
            let bytes = encode(&setup).map_err(|e| StartError::Broken(e.to_string()))?;
            // A broken pipe is noticed when the greeting is awaited.
            let _ = requests.send(bytes);
        }
        let writing = thread::Builder::new().spawn(move || write_all(input, &to_write));
        let (sender, responses) = channel();
        let launched = launch.launcher.is_some();
        let greeted = Arc::<AtomicBool>::default();
        let greets = Arc::clone(&greeted);
        let reading = thread::Builder::new().spawn(move || {
            let mut output = BufReader::new(output);
            let mut answers = Vec::new();
            match greeting::check(&mut output, launched) {
                Ok(true) => greets.store(true, Ordering::Relaxed),
                Ok(false) => return,
                Err(loss) => {
                    // If the parent no longer waits, a lost message does not matter.
                    let _ = sender.send(vec![(Instant::now(), Err(loss))]);
                    return;
                }
            }
            loop {
                let message = receive::<Response>(&mut output).transpose();
                let ended = !matches!(message, Some(Ok(_)));
                let message = message.map(|m| m.map_err(|e| Loss::Garbage(e.to_string())));
                answers.extend(message.map(|message| (Instant::now(), message)));
                // Answers that arrived together are passed on together.
                let drained = ended || output.buffer().is_empty();
                let unwanted = drained && sender.send(std::mem::take(&mut answers)).is_err();
                if ended || unwanted {
                    break;
                }
            }
        });
        let stderr = StderrTail::of(errors);
        let stderr = writing.and(reading).and(stderr).map_err(|e| {
            // The process may have ended already; then there is nothing to kill.
            group.kill();
            let _ = child.kill();
            let _ = child.wait();
            no_thread(&e)
        })?;
        Ok(Self {
            child: Arc::new(Mutex::new(child)),
            group,
            launched,
            greeted,
            requests: Some(requests),
            responses,
            came: VecDeque::new(),
            stderr,
            memory: None,
            answered: Instant::now(),
            ended: Arc::default(),
        })
    }

    /// Kills the worker when it uses more than `limit` MiB of memory, unless the worker runs behind a
    /// launcher.
    ///
    /// # Errors
    /// If the system refuses the thread that watches it.
    pub(crate) fn limit_memory(&mut self, limit: u64) -> Result<(), StartError> {
        if !self.launched {
            let (child, ended) = (Arc::clone(&self.child), Arc::clone(&self.ended));
            let watched = MemoryLimit::watch(child, limit, ended);
            self.memory = Some(watched.map_err(|e| no_thread(&e))?);
        }
        Ok(())
    }

    /// Returns true if the worker has sent its greeting.
    pub(crate) fn has_greeted(&self) -> bool {
        self.greeted.load(Ordering::Relaxed)
    }

    /// Returns the time of the last answer, or of the start.
    pub(crate) fn answered(&self) -> Instant {
        self.answered
    }

    /// Sends requests in a single write. A broken pipe is noticed when the answer is awaited.
    pub(crate) fn request<'s>(&mut self, requests: impl IntoIterator<Item = Request<'s>>) {
        let mut requests = requests.into_iter();
        let bytes = requests.try_fold(Vec::new(), |bytes, request| encode_after(bytes, &request));
        let sent = bytes.map(|bytes| match &self.requests {
            Some(requests) => requests.send(bytes).is_ok(),
            None => false,
        });
        if !matches!(sent, Ok(true)) {
            self.requests = None;
        }
    }

    /// Returns the next answer, if it arrives before `until`.
    pub(crate) fn response_until(
        &mut self,
        until: Instant,
        wait: Wait<'_>,
    ) -> Result<Response, Loss> {
        let stopped = || wait.stop.is_some_and(|s| s.load(Ordering::Relaxed));
        let mut has_exited = false;
        loop {
            match self.came.pop_front() {
                Some((since, Ok(response))) => {
                    self.answered = since;
                    return Ok(response);
                }
                Some((_, Err(loss))) => return Err(self.cause(loss)),
                None => {}
            }
            let left = until.saturating_duration_since(Instant::now());
            let step = if has_exited { LONGEST_STEP } else { left };
            match self.responses.recv_timeout(step.min(POLL_INTERVAL)) {
                Ok(answers) => self.came.extend(answers),
                Err(RecvTimeoutError::Timeout) if stopped() => return Err(Loss::Cancelled),
                // What it wrote before its end has been read.
                Err(RecvTimeoutError::Timeout) if has_exited => {
                    return Err(self.cause(Loss::Died));
                }
                Err(RecvTimeoutError::Timeout) => {
                    // A child of the driver can hold the pipe, so that the pipe does not end with the worker.
                    has_exited = !self.launched && self.exited().is_some();
                    if !has_exited && left <= POLL_INTERVAL {
                        return Err(self.cause(Loss::Timeout(wait.timeout)));
                    }
                }
                Err(RecvTimeoutError::Disconnected) => return Err(self.cause(Loss::Died)),
            }
        }
    }

    /// Returns the next answer.
    pub(crate) fn response(&mut self, timeout: Duration) -> Result<Response, Loss> {
        self.response_until(Instant::now() + timeout, Wait::of(timeout))
    }

    /// Returns the memory limit if the worker was killed for exceeding it, otherwise the observed loss.
    fn cause(&self, shown: Loss) -> Loss {
        match self.memory.as_ref().and_then(MemoryLimit::exceeded) {
            Some((held, limit)) => Loss::Memory { held, limit },
            None => shown,
        }
    }

    /// Ends the worker and returns how it ended.
    pub(crate) fn end_of(&mut self, loss: Loss) -> ProcessEnd {
        let status = match loss {
            Loss::Died => {
                let status = self.wait(EXIT_TIMEOUT);
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
        let words = self.stderr.text(LAST_WORDS);
        process_end(loss, status, self.launched, words)
    }

    fn wait(&mut self, limit: Duration) -> Option<ExitStatus> {
        let mut step = Duration::from_millis(1);
        let start = Instant::now();
        loop {
            match self.exited() {
                Some(status) => return Some(status),
                None if start.elapsed() < limit => {
                    thread::sleep(step);
                    step = (2 * step).min(LONGEST_STEP);
                }
                None => return None,
            }
        }
    }

    /// Returns the exit status of the process, if it has exited. Kills what it left.
    fn exited(&self) -> Option<ExitStatus> {
        let status = lock(&self.child).try_wait().ok().flatten()?;
        // After the first time, the number of the group can be another's.
        if !self.ended.swap(true, Ordering::Relaxed) {
            self.group.kill();
        }
        Some(status)
    }

    fn kill(&mut self) {
        let mut child = lock(&self.child);
        // The process may have ended already; then there is nothing to kill.
        if !self.ended.swap(true, Ordering::Relaxed) {
            self.group.kill();
        }
        let _ = child.kill();
        let _ = child.wait();
    }
}

impl WorkerProcess {
    /// Asks the worker to exit. Returns false if it does not within `patience`, and kills it.
    pub(crate) fn close(mut self, patience: Duration) -> bool {
        self.requests = None;
        self.wait(patience).is_some()
    }
}

impl WorkerProcess {
    /// Asks the worker to exit, and reports how it ended unless it exited in order. Kills it if it does not exit.
    pub(crate) fn bad_end(mut self) -> Option<ProcessEnd> {
        self.requests = None;
        let Some(status) = self.wait(CLOSE_TIMEOUT) else {
            self.kill();
            return None;
        };
        // A launcher has a status of its own.
        let is_bad = etalon_process::signal(status).is_some() || !self.launched;
        if status.success() || !is_bad {
            return None;
        }
        let words = self.stderr.text(LAST_WORDS);
        Some(process_end(Loss::Died, Some(status), self.launched, words))
    }
}

impl Drop for WorkerProcess {
    /// Closes the pipe, which asks the worker to exit, and kills it if it does not.
    fn drop(&mut self) {
        self.requests = None;
        if self.wait(CLOSE_TIMEOUT).is_none() {
            self.kill();
        }
        self.ended.store(true, Ordering::Relaxed);
    }
}

/// Returns the error for a worker whose process cannot be started.
fn cannot_start(launch: &Launch, error: &Error) -> StartError {
    match launch.launcher.as_ref().and_then(|l| l.prefix.first()) {
        Some(word) => StartError::Launcher(format!(
            "the launcher `{}` cannot be started: {error}",
            word.escape_debug()
        )),
        None => StartError::Broken(format!("the worker cannot be started: {error}")),
    }
}

/// Returns the error for a worker that cannot be used because the system refuses a thread.
fn no_thread(error: &Error) -> StartError {
    StartError::Broken(format!(
        "no thread can be started for the worker: {error}; raise the limit of processes"
    ))
}

/// Writes requests until there are no more, or until the worker no longer reads them.
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
