//! The connection with a page.

use crate::server::{PageServer, Socket};
use etalon_backend::BackendError;
use etalon_keeper::Kept;
use etalon_webgpu::message::{Answer, Greeting, Hello, PROTOCOL, Request, packed, unpacked};
use std::cell::RefCell;
use std::time::{Duration, Instant};
use tungstenite::{Error, Message};

/// The time without a message after which the browser is pinged.
const SILENCE: Duration = Duration::from_secs(10);
/// The time in which a page must send its greeting.
const GREETING: Duration = Duration::from_secs(40);
/// The largest header of an answer in bytes, without the times of its frames.
const MAX_HEADER: usize = 1 << 20;
/// The largest text of the times of a frame in bytes.
const MAX_TIMES: usize = 256;

/// A server, its page and the browser that shows it.
pub(crate) struct PageSession {
    server: PageServer,
    socket: RefCell<Option<Socket>>,
    /// The browser, if this worker started it.
    kept: RefCell<Option<Kept>>,
}

/// The reason why a page does not answer.
enum Gone {
    /// The connection ended.
    Closed,
    /// The page sent something that is not an answer.
    Garbage(String),
}

impl PageSession {
    pub(crate) fn new(server: PageServer, kept: Option<Kept>) -> Self {
        Self {
            server,
            socket: RefCell::new(None),
            kept: RefCell::new(kept),
        }
    }

    /// Waits for a page until `deadline`. Returns the description of its device, or the reason why no page
    /// came. A person can close the page before its greeting, and open it again.
    pub(crate) fn greeting(&self, deadline: Instant) -> Result<Hello, String> {
        loop {
            match self.next_greeting(deadline)? {
                Some(hello) => return Ok(hello),
                None if self.comes_back() => {}
                None => {
                    return Err(
                        "the page closed its connection before sending a greeting".to_owned()
                    );
                }
            }
        }
    }

    /// Returns the greeting of the next page, or `None` if it closed its connection before.
    fn next_greeting(&self, deadline: Instant) -> Result<Option<Hello>, String> {
        let lives = || {
            let mut kept = self.kept.borrow_mut();
            kept.as_mut().is_none_or(Kept::lives)
        };
        let Some(mut socket) = self.server.socket(deadline, lives) else {
            return Err(if lives() {
                "no page has opened its connection".to_owned()
            } else {
                "the browser ended before it opened the page".to_owned()
            });
        };
        let message = receive(&mut socket, Some(GREETING));
        let text = match message {
            Ok(Message::Text(text)) => text,
            Ok(_) => return Err("the page's first message is not a greeting".to_owned()),
            Err(_) => return Ok(None),
        };
        let greeting: Greeting = serde_json::from_str(&text)
            .map_err(|error| format!("the page's first message is not a greeting: {error}"))?;
        let (protocol, hello) = match greeting {
            Greeting::Hello(hello) => (hello.protocol, Ok(*hello)),
            Greeting::Unavailable {
                protocol,
                unavailable,
            } => (protocol, Err(unavailable)),
        };
        if protocol != PROTOCOL {
            return Err("the page has another version; reload it".to_owned());
        }
        let hello = hello?;
        self.socket.replace(Some(socket));
        Ok(Some(hello))
    }

    /// Returns true if a person opened the page, who can open it again.
    pub(crate) fn comes_back(&self) -> bool {
        self.kept.borrow().is_none()
    }

    /// Sends a request and returns the header and the bytes of the answer, or `None` if the connection ended
    /// first. The answer has at most `bytes` bytes after its header.
    ///
    /// # Errors
    /// If the request cannot be sent, or the page's message is not its answer.
    pub(crate) fn ask(
        &self,
        request: &Request<'_>,
        contents: &[Vec<u8>],
        bytes: usize,
    ) -> Result<Option<(Answer, Vec<u8>)>, BackendError> {
        let message = packed(request, contents.iter().map(Vec::as_slice));
        let message =
            message.map_err(|error| BackendError::internal_of("a list is not sent", error))?;
        let mut socket = self.socket.borrow_mut();
        let answer = match socket.as_mut() {
            Some(socket) => {
                let times = MAX_TIMES.saturating_mul(request.frames as usize);
                socket.limit(MAX_HEADER.saturating_add(times).saturating_add(bytes));
                exchange(socket, message)
            }
            None => Err(Gone::Closed),
        };
        match answer {
            Ok((answer, bytes)) if answer.number == request.number => Ok(Some((answer, bytes))),
            Ok(_) => Err(garbage("the answer to another request")),
            Err(Gone::Garbage(why)) => Err(garbage(&why)),
            Err(Gone::Closed) => {
                *socket = None;
                Ok(None)
            }
        }
    }

    /// Ends this process, because the browser that it started, or the page in that browser, has ended. The
    /// browser's messages are in standard error.
    pub(crate) fn give_up(&self) -> ! {
        if let Some(kept) = self.kept.borrow_mut().as_mut() {
            kept.wait();
        }
        eprintln!("the page was closed");
        std::process::exit(1)
    }
}

fn garbage(why: &str) -> BackendError {
    BackendError::internal_of("the page's message is not an answer", why)
}

fn exchange(socket: &mut Socket, message: Vec<u8>) -> Result<(Answer, Vec<u8>), Gone> {
    let sent = socket.socket.send(Message::binary(message));
    sent.map_err(|_| Gone::Closed)?;
    match receive(socket, None) {
        Ok(Message::Binary(message)) => {
            let (answer, bytes) = unpacked(&message).map_err(Gone::Garbage)?;
            Ok((answer, bytes.to_vec()))
        }
        Ok(_) => Err(Gone::Garbage("it is text".to_owned())),
        Err(Error::Capacity(error)) => Err(Gone::Garbage(error.to_string())),
        Err(_) => Err(Gone::Closed),
    }
}

/// Returns the next message that is not a control frame. Pings a silent browser, since a phone that is locked
/// does not close the connection.
fn receive(socket: &mut Socket, within: Option<Duration>) -> Result<Message, Error> {
    let begun = Instant::now();
    let stream = socket.socket.get_ref();
    stream.set_read_timeout(Some(SILENCE))?;
    let mut asked = false;
    loop {
        match socket.socket.read() {
            Ok(message @ (Message::Text(_) | Message::Binary(_))) => return Ok(message),
            Ok(Message::Close(_)) => return Err(Error::ConnectionClosed),
            Ok(_) => asked = false,
            Err(Error::Io(error)) if is_timeout(&error) => {
                if asked || within.is_some_and(|within| begun.elapsed() > within) {
                    return Err(Error::ConnectionClosed);
                }
                socket.socket.send(Message::Ping(Default::default()))?;
                asked = true;
            }
            Err(error) => return Err(error),
        }
    }
}

fn is_timeout(error: &std::io::Error) -> bool {
    matches!(
        error.kind(),
        std::io::ErrorKind::WouldBlock | std::io::ErrorKind::TimedOut
    )
}
