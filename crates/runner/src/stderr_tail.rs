//! The last part of a process's standard error.

use crate::sync::lock;
use std::collections::VecDeque;
use std::io::{self, Read};
use std::sync::{Arc, Condvar, Mutex, PoisonError};
use std::thread;
use std::time::Duration;

/// The number of bytes that are kept.
const CAPACITY: usize = 4096;

/// The last part of a stream. A separate thread reads the stream, so that the writer never blocks.
#[derive(Debug)]
pub(crate) struct StderrTail(Arc<SharedTail>);

#[derive(Debug, Default)]
struct SharedTail {
    kept: Mutex<KeptBytes>,
    /// Signals the stream's end.
    end: Condvar,
}

#[derive(Debug, Default)]
struct KeptBytes {
    bytes: VecDeque<u8>,
    ended: bool,
}

impl StderrTail {
    /// Reads a stream until its end.
    ///
    /// # Errors
    /// If the system refuses a thread.
    pub(crate) fn of(mut stream: impl Read + Send + 'static) -> io::Result<Self> {
        let tail = Self(Arc::default());
        let shared = Arc::clone(&tail.0);
        thread::Builder::new().spawn(move || {
            let mut buffer = [0; 1024];
            while let Ok(n) = stream.read(&mut buffer) {
                if n == 0 {
                    break;
                }
                let mut kept = lock(&shared.kept);
                kept.bytes.extend(&buffer[..n]);
                let excess = kept.bytes.len().saturating_sub(CAPACITY);
                kept.bytes.drain(..excess);
            }
            lock(&shared.kept).ended = true;
            shared.end.notify_all();
        })?;
        Ok(tail)
    }

    /// Returns the end of the stream or, after a time limit, the end of what was read so far: a child of
    /// the process can keep the stream open.
    pub(crate) fn text(&self, limit: Duration) -> String {
        let kept = lock(&self.0.kept);
        let kept = self.0.end.wait_timeout_while(kept, limit, |k| !k.ended);
        let (kept, _) = kept.unwrap_or_else(PoisonError::into_inner);
        let bytes: Vec<u8> = kept.bytes.iter().copied().collect();
        String::from_utf8_lossy(&bytes).trim().to_owned()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::io::{self, Write};

    #[test]
    fn late_output_is_read_and_an_open_stream_is_not_waited_for() {
        let (reader, mut writer) = io::pipe().expect("a pipe");
        let tail = StderrTail::of(reader).expect("a thread");
        assert_eq!(tail.text(Duration::from_millis(1)), "");
        let late = thread::spawn(move || {
            thread::sleep(Duration::from_millis(50));
            writer.write_all(b"last words\n").expect("writes");
        });
        assert_eq!(tail.text(Duration::from_secs(60)), "last words");
        late.join().expect("no panic");
    }
}
