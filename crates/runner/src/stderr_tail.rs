//! The end of what a process writes to standard error.

use crate::sync::lock;
use std::collections::VecDeque;
use std::io::Read;
use std::sync::{Arc, Mutex};
use std::thread;

/// The bytes that are kept.
const CAPACITY: usize = 4096;

/// The end of a stream, which a thread of its own reads so that the writer never blocks.
#[derive(Debug)]
pub(crate) struct StderrTail(Arc<Mutex<VecDeque<u8>>>);

impl StderrTail {
    /// Reads a stream until its end.
    pub(crate) fn of(mut stream: impl Read + Send + 'static) -> Self {
        let tail = Self(Arc::default());
        let kept = Arc::clone(&tail.0);
        thread::spawn(move || {
            let mut buffer = [0; 1024];
            while let Ok(n) = stream.read(&mut buffer) {
                if n == 0 {
                    break;
                }
                let mut kept = lock(&kept);
                kept.extend(&buffer[..n]);
                let excess = kept.len().saturating_sub(CAPACITY);
                kept.drain(..excess);
            }
        });
        tail
    }

    /// The text read so far, or its end.
    pub(crate) fn text(&self) -> String {
        let bytes: Vec<u8> = lock(&self.0).iter().copied().collect();
        String::from_utf8_lossy(&bytes).trim().to_owned()
    }
}
