//! The rasterizer in a process that goes wrong: to show that a run survives everything that drivers do to
//! their processes. `cpu:fault=abort` and its kin are never listed, for they are nobody's driver.

use etalon_backend::{AdapterInfo, Backend, BackendError, FrameTime, Prepared};
use etalon_frame::{Frame, Limits};
use etalon_scene::Scene;
use rustix::process::{Signal, getpid, kill_process};
use serde::{Deserialize, Serialize};
use std::cell::{Cell, RefCell};
use std::fs::File;
use std::hash::{BuildHasher, RandomState};
use std::hint::black_box;
use std::io::Write;
use std::thread;
use std::time::Duration;

/// The name of the adapter up to the fault.
const PREFIX: &str = "cpu:fault=";
/// One scene of so many goes wrong, chosen by a hash of what it draws.
const ONE_OF: u64 = 8;

/// What goes wrong.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub(crate) enum Fault {
    /// The process aborts.
    Abort,
    /// It reads where there is no memory.
    Segv,
    /// It ends with status 7.
    Exit,
    /// Our own code panics.
    Panic,
    /// It sleeps for ever.
    Hang,
    /// It runs for ever.
    Spin,
    /// It takes memory for ever.
    Memory,
    /// It writes what is no message.
    Garbage,
    /// It ends in the middle of a message.
    Half,
    /// The device is lost.
    Lost,
    /// An allocation is refused.
    Refused,
    /// It writes more to standard error than anyone wants to read, then aborts.
    Chatter,
    /// A validation message comes.
    Validation,
    /// The picture is wrong in about every second process.
    Flaky,
    /// The pictures of some scenes are wrong once certain others were drawn in the same process.
    After,
    /// The driver ends the process before it is open.
    Start,
    /// The driver never opens.
    Mute,
}

impl Fault {
    const ALL: [Self; 17] = [
        Self::Abort,
        Self::Segv,
        Self::Exit,
        Self::Panic,
        Self::Hang,
        Self::Spin,
        Self::Memory,
        Self::Garbage,
        Self::Half,
        Self::Lost,
        Self::Refused,
        Self::Chatter,
        Self::Validation,
        Self::Flaky,
        Self::After,
        Self::Start,
        Self::Mute,
    ];

    /// The fault of the adapter of this name.
    pub(crate) fn named(name: &str) -> Option<Self> {
        let word = name.strip_prefix(PREFIX)?;
        Self::ALL
            .into_iter()
            .find(|fault| fault.named_word() == word)
    }

    fn named_word(self) -> String {
        format!("{self:?}").to_lowercase()
    }
}

/// The rasterizer with a fault. `pipe` is the one to the parent.
pub(crate) struct Faulty<B> {
    inner: B,
    info: AdapterInfo,
    fault: Fault,
    pipe: RefCell<File>,
    messages: RefCell<Vec<String>>,
    /// Whether this is a process in which flaky pictures are wrong.
    unlucky: bool,
    /// Whether a scene was drawn that spoils others.
    spoilt: Cell<bool>,
}

impl<B: Backend> Faulty<B> {
    pub(crate) fn new(inner: B, name: &str, fault: Fault, pipe: File) -> Self {
        match fault {
            Fault::Start => {
                eprintln!("the planted driver does not start");
                std::process::exit(9);
            }
            Fault::Mute => sleep_for_ever(),
            _ => {}
        }
        let mut info = inner.adapter().clone();
        name.clone_into(&mut info.name);
        // The standard library seeds its hashers by chance.
        let chance = RandomState::new().hash_one(fault.named_word());
        Self {
            inner,
            info,
            fault,
            pipe: RefCell::new(pipe),
            messages: RefCell::default(),
            unlucky: chance.is_multiple_of(2),
            spoilt: Cell::new(false),
        }
    }

    fn write(&self, bytes: &[u8]) {
        // Where the parent has gone, this process ends soon anyway.
        let _ = self.pipe.borrow_mut().write_all(bytes);
    }

    /// What goes wrong when a marked scene is drawn.
    fn stumble(&self) -> Result<(), BackendError> {
        let planted = || "planted".to_owned();
        match self.fault {
            Fault::Abort => {
                eprintln!("about to abort, as planted");
                std::process::abort()
            }
            Fault::Segv => {
                // The signal itself, since safe code reads nothing that is not there; twice, since the
                // standard library's handler only takes itself away at the first.
                for _ in 0..2 {
                    let _ = kill_process(getpid(), Signal::SEGV);
                }
                sleep_for_ever()
            }
            Fault::Exit => std::process::exit(7),
            Fault::Panic => panic!("a planted panic"),
            Fault::Hang => sleep_for_ever(),
            Fault::Spin => loop {
                black_box(0);
            },
            Fault::Memory => {
                let mut all: Vec<Vec<u8>> = Vec::new();
                loop {
                    all.push(black_box(vec![1; 16 << 20]));
                    thread::sleep(Duration::from_millis(5));
                }
            }
            Fault::Garbage => {
                self.write(&[0xff; 64]);
                Ok(())
            }
            Fault::Half => {
                // A message of 16 bytes of which 2 come.
                self.write(&[16, 0, 0, 0, 1, 0]);
                std::process::exit(0)
            }
            Fault::Lost => Err(BackendError::DeviceLost(planted())),
            Fault::Refused => Err(BackendError::Resource {
                what: "a buffer".to_owned(),
                message: planted(),
            }),
            Fault::Chatter => {
                for line in 0..100_000 {
                    eprintln!("line {line} of much that nobody wants to read");
                }
                std::process::abort()
            }
            Fault::Validation => {
                let message = "VUID-planted: a call that breaks the rules".to_owned();
                self.messages.borrow_mut().push(message);
                Ok(())
            }
            Fault::After => {
                self.spoilt.set(true);
                Ok(())
            }
            Fault::Flaky | Fault::Start | Fault::Mute => Ok(()),
        }
    }
}

fn sleep_for_ever() -> ! {
    loop {
        thread::sleep(Duration::from_secs(3600));
    }
}

/// A number that depends on nothing but what the scene draws.
fn number(scene: &Scene) -> u64 {
    // Not a seeded hasher: the same scenes are marked in each process.
    let text = format!("{scene:?}");
    text.bytes().fold(0xcbf2_9ce4_8422_2325, |hash, byte| {
        (hash ^ u64::from(byte)).wrapping_mul(0x0000_0100_0000_01b3)
    }) >> 32
}

impl<B: Backend> Backend for Faulty<B> {
    fn adapter(&self) -> &AdapterInfo {
        &self.info
    }

    fn limits(&self) -> &Limits {
        self.inner.limits()
    }

    fn prepare(&self, scene: &Scene) -> Result<Box<dyn Prepared + '_>, BackendError> {
        let number = number(scene) % ONE_OF;
        if number == 0 {
            self.stumble()?;
        }
        let wrong = match self.fault {
            Fault::Flaky => number == 0 && self.unlucky,
            Fault::After => number == 1 && self.spoilt.get(),
            _ => false,
        };
        Ok(Box::new(FaultyScene {
            inner: self.inner.prepare(scene)?,
            wrong,
        }))
    }

    fn messages(&self) -> Vec<String> {
        let mut all = self.inner.messages();
        all.append(&mut self.messages.borrow_mut());
        all
    }
}

struct FaultyScene<'a> {
    inner: Box<dyn Prepared + 'a>,
    wrong: bool,
}

impl Prepared for FaultyScene<'_> {
    fn submit(&mut self) -> Result<FrameTime, BackendError> {
        self.inner.submit()
    }

    fn read_back(&mut self) -> Result<Frame, BackendError> {
        let mut frame = self.inner.read_back()?;
        if self.wrong {
            // All bits of all codes: wrong wherever anything is asserted.
            for code in frame.images.iter_mut().flat_map(|i| &mut i.codes) {
                *code ^= 0xff;
            }
        }
        Ok(frame)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_name_says_what_goes_wrong() {
        assert_eq!(Fault::named("cpu:fault=abort"), Some(Fault::Abort));
        for fault in Fault::ALL {
            let name = format!("{PREFIX}{}", fault.named_word());
            assert_eq!(Fault::named(&name), Some(fault));
        }
        for other in ["cpu", "cpu:fault=", "cpu:fault=Abort", "gl:fault=abort"] {
            assert_eq!(Fault::named(other), None, "{other}");
        }
    }
}
