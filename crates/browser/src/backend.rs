//! The backend that draws in a page.

use crate::browser::Browser;
use crate::server::PageServer;
use crate::session::PageSession;
use etalon_backend::{Backend, BackendError, Fault, FrameTime, Prepared, Recording, Unavailable};
use etalon_frame::{AdapterInfo, Frame, Limits};
use etalon_keeper::{Kept, token};
use etalon_scene::Scene;
use etalon_webgpu::message::{PageTimes, Request, take_contents};
use etalon_webgpu::{CallList, Device, adapter, lower, plant};
use std::cell::{Cell, RefCell};
use std::net::SocketAddr;
use std::process::Command;
use std::time::{Duration, Instant};
use std::{io, thread};

/// The time in which a browser must open the page.
const OPENING: Duration = Duration::from_secs(45);
/// The time in which a person must open the page.
pub const WAITING: Duration = Duration::from_secs(15 * 60);
/// The time in which an earlier worker must leave the port.
const LEAVING: Duration = Duration::from_secs(10);

/// Options for [`open`].
#[derive(Debug)]
pub struct BrowserOptions {
    /// The way to reach a browser.
    pub source: PageSource,
    /// Keeps the uncaptured errors of the device for [`Backend::messages`].
    pub validate: bool,
    /// A fault that a test plants in the calls, or in the values read back.
    pub fault: Option<Fault>,
    /// Records the calls, for [`Backend::recording`].
    pub record: bool,
}

/// The way to reach a browser.
#[derive(Debug)]
pub enum PageSource {
    /// A browser that is started, by a keeper with this command.
    Started(Browser, Command),
    /// A browser in which a person opens the page, at this address with this token in its path.
    Listening(SocketAddr, String),
}

/// A device in a browser.
pub struct BrowserBackend {
    info: AdapterInfo,
    device: Device,
    session: PageSession,
    options: BrowserOptions,
    next_slot: Cell<u64>,
    next_number: Cell<u64>,
    /// Slots of scenes that the page can forget.
    dropped: RefCell<Vec<u64>>,
    messages: RefCell<Vec<String>>,
    recorded: RefCell<Option<CallList>>,
}

/// Serves the page, and waits until a browser opens it.
///
/// # Errors
/// If no page opens, or it has no device.
pub fn open(name: &str, mut options: BrowserOptions) -> Result<BrowserBackend, Unavailable> {
    let failed = |reason: String| Unavailable::new(reason, "see the browser's own messages");
    let (address, token) = match &options.source {
        PageSource::Started(..) => (SocketAddr::from(([127, 0, 0, 1], 0)), token()),
        PageSource::Listening(address, token) => (*address, token.clone()),
    };
    let server = listening(address, &token).map_err(|error| {
        Unavailable::new(
            format!("cannot listen at {address}: {error}"),
            "choose another port",
        )
    })?;
    let (kept, patience) = match &mut options.source {
        PageSource::Started(browser, keeper) => {
            let url = format!("http://{}/{token}/", server.address);
            let keeper = std::mem::replace(keeper, Command::new(""));
            let kept = Kept::start(keeper, &browser.program(&url));
            let kept = kept.map_err(|error| failed(format!("no browser is started: {error}")))?;
            (Some(kept), OPENING)
        }
        PageSource::Listening(..) => (None, WAITING),
    };
    let session = PageSession::new(server, kept);
    let hello = session
        .greeting(Instant::now() + patience)
        .map_err(failed)?;
    Ok(BrowserBackend {
        info: adapter::info(name, &hello),
        device: adapter::device(&hello.offer).map_err(failed)?,
        session,
        options,
        next_slot: Cell::new(0),
        next_number: Cell::new(0),
        dropped: RefCell::default(),
        messages: RefCell::default(),
        recorded: RefCell::default(),
    })
}

impl Backend for BrowserBackend {
    fn adapter(&self) -> &AdapterInfo {
        &self.info
    }

    fn limits(&self) -> &Limits {
        &self.device.limits
    }

    fn prepare(&self, scene: &Scene) -> Result<Box<dyn Prepared + '_>, BackendError> {
        let mut list = lower(&self.device, scene).map_err(BackendError::NotSupported)?;
        plant(self.options.fault, &mut list);
        let recorded = self.options.record.then(|| list.clone());
        let (places, contents) = take_contents(&mut list);
        Ok(Box::new(PageScene {
            backend: self,
            slot: step(&self.next_slot),
            list,
            places,
            contents,
            recorded,
            known: false,
            submitted: false,
            frame: None,
        }))
    }

    fn recording(&self) -> Option<Recording> {
        let list = self.recorded.borrow_mut().take()?;
        let offer = self.info.offer.as_ref()?;
        let features = offer.features.clone();
        etalon_webgpu::recording(&list, "webgpu", &self.info.device, features).ok()
    }

    fn messages(&self) -> Vec<String> {
        let messages = self.messages.take();
        if self.options.validate {
            messages
        } else {
            Vec::new()
        }
    }
}

/// Starts a server once an earlier worker has left the port.
fn listening(address: SocketAddr, token: &str) -> io::Result<PageServer> {
    let begun = Instant::now();
    loop {
        match PageServer::start(address, token) {
            Err(error) if error.kind() == io::ErrorKind::AddrInUse && begun.elapsed() < LEAVING => {
                thread::sleep(Duration::from_millis(50));
            }
            other => return other,
        }
    }
}

fn step(counter: &Cell<u64>) -> u64 {
    counter.replace(counter.get() + 1)
}

/// A scene. The page has its list after the first frame.
struct PageScene<'a> {
    backend: &'a BrowserBackend,
    slot: u64,
    list: CallList,
    places: Vec<(usize, usize)>,
    contents: Vec<Vec<u8>>,
    recorded: Option<CallList>,
    /// True if the page has the list.
    known: bool,
    submitted: bool,
    /// The bytes of the last frame, if they came together with its times.
    frame: Option<Vec<u8>>,
}

impl PageScene<'_> {
    /// Draws frames, and reads the last one if `read` is true. A page that was opened again draws anew.
    fn ask(&mut self, frames: u32, read: bool) -> Result<(Vec<PageTimes>, Vec<u8>), BackendError> {
        let backend = self.backend;
        loop {
            let new = !self.known;
            let request = Request {
                number: step(&backend.next_number),
                dropped: backend.dropped.take(),
                slot: self.slot,
                list: new.then_some(&self.list),
                contents: if new { self.places.clone() } else { Vec::new() },
                // A page without the list has no frame to read yet.
                frames: frames.max(new.into()),
                read,
            };
            let contents = if new { self.contents.as_slice() } else { &[] };
            let bytes = if read { self.list.reading.bytes } else { 0 };
            let bytes = usize::try_from(bytes).unwrap_or(usize::MAX);
            let answer = backend.session.ask(&request, contents, bytes)?;
            let Some((answer, bytes)) = answer else {
                if !backend.session.comes_back() {
                    backend.session.give_up();
                }
                self.wait_for_page()?;
                continue;
            };
            backend.messages.borrow_mut().extend(answer.messages);
            if let Some(failed) = answer.error {
                return Err(failed.into());
            }
            self.known = true;
            return Ok((answer.times, bytes));
        }
    }

    /// Waits until a person opens the page again on the same device.
    fn wait_for_page(&mut self) -> Result<(), BackendError> {
        let backend = self.backend;
        self.known = false;
        let hello = backend.session.greeting(Instant::now() + WAITING);
        let hello = hello.map_err(BackendError::lost)?;
        let info = adapter::info(&backend.info.name, &hello);
        if info == backend.info {
            Ok(())
        } else {
            Err(BackendError::lost(format!(
                "the page was opened on another device: {}, {} {}",
                info.device, info.driver, info.driver_version
            )))
        }
    }
}

impl Prepared for PageScene<'_> {
    fn submit(&mut self) -> Result<FrameTime, BackendError> {
        // The first frame is read in the same message, since most scenes are drawn once.
        let read = !self.submitted;
        let (times, bytes) = self.ask(1, read)?;
        self.submitted = true;
        self.frame = read.then_some(bytes);
        let none = || BackendError::internal("the page reported no frame time");
        let times = times.first().ok_or_else(none)?;
        Ok(FrameTime {
            cpu: duration(times.cpu),
            gpu: times.gpu.map(duration),
            wall: duration(times.wall),
        })
    }

    fn read_back(&mut self) -> Result<Frame, BackendError> {
        if !self.submitted {
            return Err(BackendError::internal(
                "read back before anything was drawn",
            ));
        }
        let bytes = match self.frame.take() {
            Some(bytes) => bytes,
            None => self.ask(0, true)?.1,
        };
        let frame = self.list.reading.frame(&bytes);
        let mut frame =
            frame.ok_or_else(|| BackendError::internal("the page's frame is too short"))?;
        if let Some(fault) = self.backend.options.fault {
            for image in &mut frame.images {
                fault.change_codes(&mut image.codes, image.size, image.samples, &image.channels);
            }
        }
        if let Some(list) = &self.recorded {
            self.backend.recorded.replace(Some(list.clone()));
        }
        Ok(frame)
    }
}

impl Drop for PageScene<'_> {
    fn drop(&mut self) {
        if self.known {
            self.backend.dropped.borrow_mut().push(self.slot);
        }
    }
}

/// Returns a time of the page's clock. Invalid values become 0.
fn duration(milliseconds: f64) -> Duration {
    Duration::try_from_secs_f64(milliseconds / 1e3).unwrap_or_default()
}
