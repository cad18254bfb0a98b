//! The program, and lines from and to it.

use etalon_backend::BackendError;
use std::io::{self, BufRead, BufReader, Read, Write};
use std::process::{Child, ChildStdin, ChildStdout, Command, ExitStatus, Stdio};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::thread;
use std::time::{Duration, Instant};

/// The time that a program has to end after its input ended.
const GRACE: Duration = Duration::from_secs(1);
/// The pause between checks of a program.
const PAUSE: Duration = Duration::from_millis(5);

/// A running program.
pub(crate) struct Program {
    child: Arc<Mutex<Child>>,
    input: Option<ChildStdin>,
    output: BufReader<ChildStdout>,
}

/// The reason why there is no line.
pub(crate) enum NoLine {
    /// The output has ended.
    Ended,
    /// The line is longer than this many bytes.
    TooLong(u64),
    /// The system's error.
    Failed(io::Error),
}

impl Program {
    /// Starts a program, which ends with this process.
    pub(crate) fn start(command: &mut Command) -> io::Result<Self> {
        command.stdin(Stdio::piped()).stdout(Stdio::piped());
        etalon_process::end_with_thread(command);
        let mut child = command.spawn()?;
        let (Some(input), Some(output)) = (child.stdin.take(), child.stdout.take()) else {
            return Err(io::Error::other("the program has no pipes"));
        };
        Ok(Self {
            child: Arc::new(Mutex::new(child)),
            input: Some(input),
            output: BufReader::new(output),
        })
    }

    /// Returns the first line, for which the program has a limited time.
    pub(crate) fn greeting(&mut self, most: u64, within: Duration) -> Result<Vec<u8>, String> {
        let child = Arc::clone(&self.child);
        let (done, waits) = std::sync::mpsc::channel::<()>();
        let watched = thread::Builder::new().spawn(move || {
            let timed_out =
                waits.recv_timeout(within) == Err(std::sync::mpsc::RecvTimeoutError::Timeout);
            if timed_out {
                // It might have ended already.
                let _ = lock(&child).kill();
            }
            timed_out
        });
        let watched = watched.map_err(|error| format!("no thread can be started: {error}"))?;
        let line = self.line(most);
        drop(done);
        if watched.join().unwrap_or(false) {
            return Err(format!("it said nothing within {} s", within.as_secs()));
        }
        line.map_err(|none| match none {
            NoLine::Ended => match self.status() {
                Some(status) => format!("it ended with {status} before its first line"),
                None => "it closed its output before its first line".to_owned(),
            },
            NoLine::TooLong(most) => format!("its first line is longer than {most} bytes"),
            NoLine::Failed(error) => error.to_string(),
        })
    }

    /// Sends a line and returns the answer, which has at most `most` bytes. A program that writes without reading
    /// does not block.
    pub(crate) fn exchange(&mut self, line: &[u8], most: u64) -> Result<Vec<u8>, BackendError> {
        let mut input = self.input.take();
        let answer = thread::scope(|scope| {
            let sending = thread::Builder::new().spawn_scoped(scope, || {
                // A program that has ended is noticed by the end of its output.
                let _ = input.iter_mut().try_for_each(|input| {
                    input.write_all(line)?;
                    input.flush()
                });
            });
            if let Err(error) = sending {
                return Err(NoLine::Failed(error));
            }
            let answer = self.line(most);
            if answer.is_err() {
                // Nothing else ends the sending to a program that does not read.
                let _ = lock(&self.child).kill();
            }
            answer
        });
        self.input = input;
        match answer {
            Ok(line) => Ok(line),
            Err(NoLine::Ended) => self.end(),
            Err(NoLine::TooLong(most)) => Err(garbage(&format!(
                "it is longer than {most} bytes, the most that an answer to this scene needs"
            ))),
            Err(NoLine::Failed(error)) => Err(garbage(&error.to_string())),
        }
    }

    fn line(&mut self, most: u64) -> Result<Vec<u8>, NoLine> {
        let mut line = Vec::new();
        let mut limited = (&mut self.output).take(most + 1);
        limited
            .read_until(b'\n', &mut line)
            .map_err(NoLine::Failed)?;
        match line.pop() {
            Some(b'\n') => Ok(line),
            Some(_) if line.len() as u64 >= most => Err(NoLine::TooLong(most)),
            _ => Err(NoLine::Ended),
        }
    }

    /// Ends this process as the program has ended.
    fn end(&mut self) -> ! {
        let Some(status) = self.status() else {
            eprintln!("the program closed its output");
            std::process::exit(1)
        };
        eprintln!("the program has ended: {status}");
        if status.success() {
            std::process::exit(1)
        }
        etalon_process::end_like(status)
    }

    /// Returns the exit status, if the program ends within the grace time.
    fn status(&self) -> Option<ExitStatus> {
        let begun = Instant::now();
        loop {
            match lock(&self.child).try_wait() {
                Ok(None) if begun.elapsed() < GRACE => {}
                Ok(status) => return status,
                Err(_) => return None,
            }
            thread::sleep(PAUSE);
        }
    }
}

impl Drop for Program {
    /// Closes the program's input, which asks it to end, and kills it if it does not.
    fn drop(&mut self) {
        self.input = None;
        if self.status().is_none() {
            let mut child = lock(&self.child);
            // It might have ended already.
            let _ = child.kill();
            let _ = child.wait();
        }
    }
}

fn lock(child: &Mutex<Child>) -> MutexGuard<'_, Child> {
    child.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Returns the error for a line that is not an answer.
pub(crate) fn garbage(why: &str) -> BackendError {
    BackendError::internal_of("the program's line is not an answer", why)
}

#[cfg(all(test, unix))]
#[expect(clippy::unwrap_used, reason = "a test that panics has failed")]
mod tests {
    use super::*;

    fn program(script: &str) -> Program {
        Program::start(Command::new("sh").args(["-c", script])).unwrap()
    }

    #[test]
    fn a_silent_program_is_not_waited_for() {
        let begun = Instant::now();
        let silent = program("exec sleep 1000").greeting(10, Duration::from_secs(1));
        assert_eq!(silent, Err("it said nothing within 1 s".to_owned()));
        assert!(begun.elapsed() < Duration::from_secs(60));
    }

    #[test]
    fn a_program_that_does_not_read_its_input_can_answer() {
        let mut program = program("echo hello; echo answer; exec sleep 1000");
        let hello = program.greeting(10, Duration::from_secs(60));
        assert_eq!(hello, Ok(b"hello".to_vec()));
        // Less than a pipe holds is sent, whoever reads it.
        let answer = program.exchange(&[b'x'; 1000], 10);
        assert_eq!(answer, Ok(b"answer".to_vec()));
    }

    #[test]
    fn a_flood_ends_while_the_scene_is_still_being_sent() {
        let mut program = program("exec cat /dev/zero");
        let flood = program.exchange(&vec![b'x'; 1 << 20], 1000);
        let long = "it is longer than 1000 bytes, the most that an answer to this scene needs";
        assert_eq!(flood, Err(garbage(long)));
    }
}
