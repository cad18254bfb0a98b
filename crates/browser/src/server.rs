//! The server of the page: its files, and one WebSocket.

use crate::page::{FILES, SOCKET};
use crate::request_head::{MAX_BYTES, RequestHead};
use std::collections::VecDeque;
use std::io::{self, Read, Write};
use std::net::{Shutdown, SocketAddr, TcpListener, TcpStream};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender, channel};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::thread;
use std::time::{Duration, Instant};
use tungstenite::WebSocket;
use tungstenite::handshake::server::{Request, Response};
use tungstenite::protocol::WebSocketConfig;

/// The longest wait for the head of a request. A browser that opens a connection before it needs one opens another.
const HEAD_TIMEOUT: Duration = Duration::from_secs(2);
/// The longest wait for a reader.
const ANSWER_TIMEOUT: Duration = Duration::from_secs(20);
/// The pause between checks of an incomplete head, and before the next connection if too many wait.
const PAUSE: Duration = Duration::from_millis(10);
/// The number of connections whose heads are awaited at the same time. One more ends the oldest. Addresses do not
/// count: behind a proxy all have the same.
const MOST_WAITING: usize = 16;
/// The largest greeting of a page in bytes.
pub(crate) const MAX_GREETING: usize = 1 << 20;

/// The headers of every answer. The last two give the page's clock a resolution of 5 µs instead of 100.
const HEADERS: &str = "Cache-Control: no-store\r\n\
    Connection: close\r\n\
    Content-Security-Policy: default-src 'none'; script-src 'self'; connect-src 'self'; img-src data:\r\n\
    Referrer-Policy: no-referrer\r\n\
    X-Content-Type-Options: nosniff\r\n\
    Cross-Origin-Opener-Policy: same-origin\r\n\
    Cross-Origin-Embedder-Policy: require-corp\r\n";

/// The socket of a page. While it exists, no other page is served.
pub(crate) struct Socket {
    pub(crate) socket: WebSocket<TcpStream>,
    taken: Arc<AtomicBool>,
}

impl Socket {
    /// Refuses later messages that are longer than `most` bytes.
    pub(crate) fn limit(&mut self, most: usize) {
        self.socket.set_config(|config| {
            config.max_message_size = Some(most);
            config.max_frame_size = Some(most);
        });
    }
}

impl Drop for Socket {
    fn drop(&mut self) {
        self.taken.store(false, Ordering::SeqCst);
    }
}

/// The connections whose heads have not come yet, the oldest first.
#[derive(Default)]
struct Waiting {
    streams: VecDeque<(u64, TcpStream)>,
    next: u64,
}

impl Waiting {
    fn is_full(&self) -> bool {
        self.streams.len() >= MOST_WAITING
    }

    /// Adds a connection and returns its number. Ends the oldest if there are too many.
    fn add(&mut self, stream: &TcpStream) -> io::Result<u64> {
        let number = self.next;
        self.next += 1;
        self.streams.push_back((number, stream.try_clone()?));
        if self.streams.len() > MOST_WAITING
            && let Some((_, oldest)) = self.streams.pop_front()
        {
            // The other side can have ended it.
            let _ = oldest.shutdown(Shutdown::Both);
        }
        Ok(number)
    }

    fn remove(&mut self, number: u64) {
        self.streams.retain(|(other, _)| *other != number);
    }
}

/// A server on a port.
pub(crate) struct PageServer {
    /// The address at which it listens.
    pub(crate) address: SocketAddr,
    sockets: Receiver<Socket>,
}

impl PageServer {
    /// Starts serving at an address, at paths that begin with a token.
    ///
    /// # Errors
    /// If the address is not available.
    pub(crate) fn start(address: SocketAddr, token: &str) -> io::Result<Self> {
        let listener = TcpListener::bind(address)?;
        let address = listener.local_addr()?;
        let (sender, sockets) = channel();
        let token: Arc<str> = token.into();
        let taken = Arc::new(AtomicBool::new(false));
        let waiting = Arc::<Mutex<Waiting>>::default();
        thread::Builder::new().spawn(move || {
            for stream in listener.incoming().flatten() {
                let (token, taken, sender) =
                    (Arc::clone(&token), Arc::clone(&taken), sender.clone());
                let waiting = Arc::clone(&waiting);
                // Connections without end must not keep a processor busy.
                if lock(&waiting).is_full() {
                    thread::sleep(PAUSE);
                }
                let Ok(number) = lock(&waiting).add(&stream) else {
                    continue;
                };
                // A connection without a request must not make others wait. Its errors affect nothing else.
                let _ = thread::Builder::new().spawn(move || {
                    let head = awaited_head(&stream);
                    lock(&waiting).remove(number);
                    serve(stream, head?, &token, &taken, &sender)
                });
            }
        })?;
        Ok(Self { address, sockets })
    }

    /// Returns the next socket of a page, unless `deadline` passes or `waits` returns false first.
    pub(crate) fn socket(
        &self,
        deadline: Instant,
        mut waits: impl FnMut() -> bool,
    ) -> Option<Socket> {
        loop {
            match self.sockets.recv_timeout(Duration::from_millis(50)) {
                Ok(socket) => return Some(socket),
                Err(RecvTimeoutError::Timeout) if Instant::now() < deadline && waits() => {}
                Err(_) => return None,
            }
        }
    }
}

fn lock(waiting: &Mutex<Waiting>) -> MutexGuard<'_, Waiting> {
    waiting.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Waits for the head of a connection's request; see [`peek_head`].
fn awaited_head(stream: &TcpStream) -> io::Result<Option<RequestHead>> {
    stream.set_nodelay(true)?;
    stream.set_read_timeout(Some(HEAD_TIMEOUT))?;
    stream.set_write_timeout(Some(ANSWER_TIMEOUT))?;
    peek_head(stream)
}

/// Answers the request of a connection.
fn serve(
    mut stream: TcpStream,
    head: Option<RequestHead>,
    token: &str,
    taken: &Arc<AtomicBool>,
    sockets: &Sender<Socket>,
) -> io::Result<()> {
    let Some(head) = head else {
        return answer(&mut stream, "400 Bad Request", "text/plain", "");
    };
    let path = head.path_behind(token);
    if head.upgrades && path == Some(SOCKET) && !head.is_foreign() {
        if taken.swap(true, Ordering::SeqCst) {
            skip(&mut stream, head.length)?;
            return answer(
                &mut stream,
                "409 Conflict",
                "text/plain",
                "another page is open",
            );
        }
        let taken = Arc::clone(taken);
        let mut config = WebSocketConfig::default();
        config.max_message_size = Some(MAX_GREETING);
        config.max_frame_size = Some(MAX_GREETING);
        #[expect(clippy::result_large_err, reason = "the signature is tungstenite's")]
        let admit = |_: &Request, response: Response| Ok(response);
        match tungstenite::accept_hdr_with_config(stream, admit, Some(config)) {
            // If the worker has ended, nothing receives the socket.
            Ok(socket) => drop(sockets.send(Socket { socket, taken })),
            Err(_) => taken.store(false, Ordering::SeqCst),
        }
        return Ok(());
    }
    skip(&mut stream, head.length)?;
    let file = path.and_then(|path| FILES.iter().find(|file| file.path == path));
    match file {
        _ if head.is_foreign() => answer(&mut stream, "403 Forbidden", "text/plain", ""),
        Some(file) => answer(&mut stream, "200 OK", file.media, file.text),
        None => answer(&mut stream, "404 Not Found", "text/plain", ""),
    }
}

/// Returns the head of the request without consuming it, since the handshake of a WebSocket reads it again.
/// `None` if the bytes are not a request.
fn peek_head(stream: &TcpStream) -> io::Result<Option<RequestHead>> {
    let mut bytes = vec![0; MAX_BYTES];
    let begun = Instant::now();
    let mut known = 0;
    loop {
        let length = stream.peek(&mut bytes)?;
        match RequestHead::parse(&bytes[..length]) {
            Ok(Some(head)) => return Ok(Some(head)),
            Ok(None) if length < MAX_BYTES && length > 0 && begun.elapsed() < HEAD_TIMEOUT => {
                if length == known {
                    thread::sleep(PAUSE);
                }
                known = length;
            }
            _ => return Ok(None),
        }
    }
}

/// Consumes the head of a request: closing with unread bytes would cut off the answer.
fn skip(stream: &mut TcpStream, length: usize) -> io::Result<()> {
    stream.read_exact(&mut vec![0; length])
}

fn answer(stream: &mut TcpStream, status: &str, media: &str, text: &str) -> io::Result<()> {
    let length = text.len();
    let head = format!(
        "HTTP/1.1 {status}\r\nContent-Type: {media}\r\nContent-Length: {length}\r\n{HEADERS}\r\n"
    );
    stream.write_all(head.as_bytes())?;
    stream.write_all(text.as_bytes())?;
    stream.flush()
}
