//! The rasterizer in a process that fails, such as `cpu:fault=abort`: to show that a run survives everything that
//! drivers do to their processes.

use crate::output::say;
use etalon_backend::{AdapterInfo, Backend, BackendError, FrameTime, Prepared};
use etalon_frame::{Frame, Limits, TextureFormat};
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

/// The start of the name, before the fault.
const PREFIX: &str = "cpu:fault=";
/// One scene out of this many fails, chosen by a hash of the scene; one without passes, a round trip, never does.
const ONE_OF: u64 = 8;
/// The format that a fault reads back wrong.
const MISREAD: TextureFormat = TextureFormat::Rgb10a2Unorm;

/// A fault.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub(crate) enum Fault {
    /// The process aborts.
    Abort,
    /// It reads where there is no memory.
    Segv,
    /// It ends with status 7.
    Exit,
    /// The code of the suite panics.
    Panic,
    /// It sleeps endlessly.
    Hang,
    /// It loops endlessly.
    Spin,
    /// It allocates memory endlessly.
    Memory,
    /// It writes bytes that are not a message.
    Garbage,
    /// It ends in the middle of a message.
    Half,
    /// The device is lost.
    Lost,
    /// An allocation is refused.
    Refused,
    /// It writes 100,000 lines to standard error, then aborts.
    Chatter,
    /// It reports a validation message.
    Validation,
    /// Pictures are wrong in about half of all processes.
    Flaky,
    /// Every code of [`MISREAD`] is read back one too high, round trips included.
    Misread,
    /// Pictures of some scenes are wrong after certain others were drawn in the same process.
    After,
    /// The driver ends the process while it opens.
    Start,
    /// The driver never opens.
    Mute,
}

/// The scenes that fail.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub(crate) enum Marked {
    /// One out of [`ONE_OF`], chosen by a hash.
    #[default]
    ByHash,
    /// Those of which a draw has a scissor rectangle: `cpu:fault=abort@scissor`.
    Scissor,
}

impl Fault {
    const ALL: [Self; 18] = [
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
        Self::Misread,
        Self::After,
        Self::Start,
        Self::Mute,
    ];

    /// Returns the fault of the adapter of this name, and the scenes that it marks.
    pub(crate) fn named(name: &str) -> Option<(Self, Marked)> {
        let word = name.strip_prefix(PREFIX)?;
        let (word, marked) = match word.strip_suffix("@scissor") {
            Some(word) => (word, Marked::Scissor),
            None => (word, Marked::ByHash),
        };
        let mut all = Self::ALL.into_iter();
        let fault = all.find(|fault| fault.named_word() == word)?;
        Some((fault, marked))
    }

    fn named_word(self) -> String {
        format!("{self:?}").to_lowercase()
    }
}

/// The rasterizer with a fault. `pipe` leads to the parent.
pub(crate) struct Faulty<B> {
    inner: B,
    info: AdapterInfo,
    fault: Fault,
    marked: Marked,
    pipe: RefCell<File>,
    messages: RefCell<Vec<String>>,
    /// True if flaky pictures are wrong in this process.
    unlucky: bool,
    /// True once a scene was drawn that makes others fail.
    spoilt: Cell<bool>,
}

impl<B: Backend> Faulty<B> {
    pub(crate) fn new(inner: B, name: &str, (fault, marked): (Fault, Marked), pipe: File) -> Self {
        match fault {
            Fault::Start => {
                say!("the planted driver does not start");
                std::process::exit(9);
            }
            Fault::Mute => sleep_endlessly(),
            _ => {}
        }
        let mut info = inner.adapter().clone();
        name.clone_into(&mut info.name);
        // The standard library seeds its hashers at random.
        let chance = RandomState::new().hash_one(fault.named_word());
        Self {
            inner,
            info,
            fault,
            marked,
            pipe: RefCell::new(pipe),
            messages: RefCell::default(),
            unlucky: chance.is_multiple_of(2),
            spoilt: Cell::new(false),
        }
    }

    fn write(&self, bytes: &[u8]) {
        // Without its parent this process ends soon.
        let _ = self.pipe.borrow_mut().write_all(bytes);
    }

    /// Fails, when a marked scene is drawn.
    fn fail(&self) -> Result<(), BackendError> {
        let planted = || "planted".to_owned();
        match self.fault {
            Fault::Abort => {
                say!("about to abort, as planted");
                std::process::abort()
            }
            Fault::Segv => {
                // The signal itself, since safe code cannot read invalid memory; twice, since the first one
                // only removes the standard library's handler.
                for _ in 0..2 {
                    let _ = kill_process(getpid(), Signal::SEGV);
                }
                sleep_endlessly()
            }
            Fault::Exit => std::process::exit(7),
            Fault::Panic => panic!("a planted panic"),
            Fault::Hang => sleep_endlessly(),
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
                    say!("line {line} of a long output");
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
            Fault::Flaky | Fault::Misread | Fault::Start | Fault::Mute => Ok(()),
        }
    }
}

fn sleep_endlessly() -> ! {
    loop {
        thread::sleep(Duration::from_secs(3600));
    }
}

/// Returns a hash of the scene.
fn hash(scene: &Scene) -> u64 {
    // Unseeded, so that each process marks the same scenes; over what a file of the case would hold, so that a new kind
    // of state changes none of them.
    let text = serde_json::to_string(scene).unwrap_or_default();
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
        let spared = scene.passes.is_empty();
        let scissored = || {
            let mut draws = scene.passes.iter().flat_map(|pass| &pass.draws);
            draws.any(|draw| draw.scissor.is_some())
        };
        let number = match self.marked {
            _ if spared => ONE_OF,
            Marked::ByHash => hash(scene) % ONE_OF,
            Marked::Scissor => {
                if scissored() {
                    0
                } else {
                    ONE_OF
                }
            }
        };
        if number == 0 {
            self.fail()?;
        }
        let wrong = match self.fault {
            Fault::Flaky => number == 0 && self.unlucky,
            Fault::After => number == 1 && self.spoilt.get(),
            _ => false,
        };
        let misread = match self.fault {
            Fault::Misread => {
                let all = scene.attachments.iter();
                let all = all.filter(|a| a.format == MISREAD);
                all.map(|a| a.name.clone()).collect()
            }
            _ => Vec::new(),
        };
        Ok(Box::new(FaultyScene {
            inner: self.inner.prepare(scene)?,
            wrong,
            misread,
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
    /// The attachments that are read back wrong.
    misread: Vec<String>,
}

impl Prepared for FaultyScene<'_> {
    fn submit(&mut self) -> Result<FrameTime, BackendError> {
        self.inner.submit()
    }

    fn read_back(&mut self) -> Result<Frame, BackendError> {
        let mut frame = self.inner.read_back()?;
        if self.wrong {
            // Flips all bits of all codes: wrong wherever anything is asserted.
            for code in frame.images.iter_mut().flat_map(|i| &mut i.codes) {
                *code ^= 0xff;
            }
        }
        for image in &mut frame.images {
            if self.misread.contains(&image.attachment) {
                for (i, code) in image.codes.iter_mut().enumerate() {
                    let encoding = image.channels[i % image.channels.len()];
                    let next = encoding.order_of_code(*code) + 1;
                    *code = encoding.code_of_order(next.min(encoding.max_order()));
                }
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
        for fault in Fault::ALL {
            let name = format!("{PREFIX}{}", fault.named_word());
            assert_eq!(Fault::named(&name), Some((fault, Marked::ByHash)));
            let scissor = format!("{name}@scissor");
            assert_eq!(Fault::named(&scissor), Some((fault, Marked::Scissor)));
        }
        for other in [
            "cpu",
            "cpu:fault=",
            "cpu:fault=Abort",
            "gl:fault=abort",
            "cpu:fault=abort@",
        ] {
            assert_eq!(Fault::named(other), None, "{other}");
        }
    }
}
