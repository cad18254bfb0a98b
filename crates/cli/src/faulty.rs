//! The rasterizer with a planted fault: `cpu:fault=abort` and similar names show that a run survives
//! everything that drivers do to their processes. `cpu:slower=5%` shows that `etalon diff` finds a slow-down.

use crate::output::say;
use etalon_backend::{
    Backend, BackendError, Fault, FaultyScenes, FrameTime, Prepared, ProcessFault,
};
use etalon_cpu::CpuBackend;
use etalon_frame::{AdapterInfo, Frame, Limits, TextureFormat};
use etalon_scene::Scene;
use std::cell::{Cell, RefCell};
use std::fs::File;
use std::hash::{BuildHasher, RandomState};
use std::hint::{black_box, spin_loop};
use std::io::Write;
use std::process::Command;
use std::thread;
use std::time::{Duration, Instant};

/// If a hash chooses the failing scenes, one in this many fails.
const ONE_OF: u64 = 8;
/// The format that `misread` reads back wrong.
const MISREAD: TextureFormat = TextureFormat::Rgb10a2Unorm;
/// The times for which a scene of `latency` waits: for its pipelines and for its frame.
const LATENCY: [Duration; 2] = [Duration::from_millis(5), Duration::from_millis(1)];

/// The rasterizer's span code with a fault in its frames or its process.
pub(crate) struct Faulty {
    inner: CpuBackend,
    info: AdapterInfo,
    limits: Limits,
    fault: Fault,
    /// The pipe to the parent.
    pipe: RefCell<File>,
    messages: RefCell<Vec<String>>,
    /// True if this process draws flaky pictures wrong.
    unlucky: bool,
    /// True once a scene was drawn that makes later ones fail.
    spoilt: Cell<bool>,
}

impl Faulty {
    pub(crate) fn new(name: &str, fault: Fault, pipe: File) -> Self {
        let inner = CpuBackend::spans(name);
        let mut info = inner.adapter().clone();
        let mut limits = inner.limits().clone();
        match fault {
            Fault::Process(ProcessFault::Start, _) => {
                say!("the planted driver does not start");
                std::process::exit(9);
            }
            Fault::Process(ProcessFault::Mute, _) => sleep_endlessly(),
            Fault::Limit(fault) => fault.apply(&mut limits),
            // Keeps the rasterizer's name, so that `etalon diff` compares the two.
            Fault::Slower(percent) => {
                "cpu".clone_into(&mut info.name);
                info.driver_version = format!("{}, slower by {percent} %", info.driver_version);
            }
            _ => {}
        }
        Self {
            inner,
            info,
            limits,
            fault,
            pipe: RefCell::new(pipe),
            messages: RefCell::default(),
            // The standard library seeds its hashers at random.
            unlucky: RandomState::new().hash_one(name).is_multiple_of(2),
            spoilt: Cell::new(false),
        }
    }

    fn write(&self, bytes: &[u8]) {
        // If the parent has ended, this process ends soon.
        let _ = self.pipe.borrow_mut().write_all(bytes);
    }

    /// Fails in the planted way.
    fn fail(&self, fault: ProcessFault) -> Result<(), BackendError> {
        let planted = || "planted".to_owned();
        match fault {
            ProcessFault::Abort => {
                say!("about to abort, as planted");
                std::process::abort()
            }
            ProcessFault::Segv => etalon_process::crash(),
            ProcessFault::Exit => std::process::exit(7),
            ProcessFault::Child => {
                let pipe = self.pipe.borrow().try_clone();
                let started = pipe.and_then(|pipe| {
                    let mut program = Command::new("sleep");
                    program.arg("1000").stdout(pipe).spawn()
                });
                say!("{}", started.map_or_else(|e| e.to_string(), |_| planted()));
                std::process::abort()
            }
            ProcessFault::Panic => panic!("a planted panic"),
            ProcessFault::Hang => sleep_endlessly(),
            ProcessFault::Spin => loop {
                black_box(0);
            },
            ProcessFault::Memory => {
                let mut hoard: Vec<Vec<u8>> = Vec::new();
                loop {
                    hoard.push(black_box(vec![1; 16 << 20]));
                    thread::sleep(Duration::from_millis(5));
                }
            }
            ProcessFault::Garbage => {
                self.write(&[0xff; 64]);
                Ok(())
            }
            ProcessFault::Half => {
                // Announces a message of 16 bytes and sends 2 of them.
                self.write(&[16, 0, 0, 0, 1, 0]);
                std::process::exit(0)
            }
            ProcessFault::Lost => Err(BackendError::lost(planted())),
            ProcessFault::Refused => Err(BackendError::refused("a buffer", planted())),
            ProcessFault::Chatter => {
                for line in 0..100_000 {
                    say!("line {line} of a long output");
                }
                std::process::abort()
            }
            ProcessFault::Validation => {
                let message = "VUID-planted: a call that breaks the rules".to_owned();
                self.messages.borrow_mut().push(message);
                Ok(())
            }
            ProcessFault::After => {
                self.spoilt.set(true);
                Ok(())
            }
            ProcessFault::Close
            | ProcessFault::Flaky
            | ProcessFault::Latency
            | ProcessFault::Misread
            | ProcessFault::Start
            | ProcessFault::Mute => Ok(()),
        }
    }
}

impl Drop for Faulty {
    fn drop(&mut self) {
        if matches!(self.fault, Fault::Process(ProcessFault::Close, _)) {
            etalon_process::crash();
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
    // The hash is unseeded, so that each process chooses the same scenes. It covers the serialized scene, so
    // that a new kind of state at its default changes no hash.
    let text = serde_json::to_string(scene).unwrap_or_default();
    // The youngest key of a path is always written.
    let text = text.replace(",\"reads\":\"barriers\"", "");
    text.bytes().fold(0xcbf2_9ce4_8422_2325, |hash, byte| {
        (hash ^ u64::from(byte)).wrapping_mul(0x0000_0100_0000_01b3)
    }) >> 32
}

impl Backend for Faulty {
    fn adapter(&self) -> &AdapterInfo {
        &self.info
    }

    fn limits(&self) -> &Limits {
        &self.limits
    }

    fn prepare(&self, scene: &Scene) -> Result<Box<dyn Prepared + '_>, BackendError> {
        let (mut slower, mut wrong, mut misread) = (0.0, false, Vec::new());
        let waits = matches!(self.fault, Fault::Process(ProcessFault::Latency, _));
        if waits {
            thread::sleep(LATENCY[0]);
        }
        match self.fault {
            Fault::Slower(percent) => slower = percent,
            Fault::Process(fault, scenes) => {
                let number = number(scene, scenes);
                if number == 0 {
                    self.fail(fault)?;
                }
                wrong = match fault {
                    ProcessFault::Flaky => number == 0 && self.unlucky,
                    ProcessFault::After => number == 1 && self.spoilt.get(),
                    _ => false,
                };
                if fault == ProcessFault::Misread {
                    let attachments = scene.attachments.iter().filter(|a| a.format == MISREAD);
                    misread = attachments.map(|a| a.name.clone()).collect();
                }
            }
            _ => {}
        }
        Ok(Box::new(FaultyScene {
            inner: self.inner.prepare(scene)?,
            slower,
            waits,
            wrong,
            misread,
        }))
    }

    fn messages(&self) -> Vec<String> {
        let mut messages = self.inner.messages();
        messages.append(&mut self.messages.borrow_mut());
        messages
    }
}

/// Returns a number that depends only on the scene: 0 if the scene fails.
fn number(scene: &Scene, scenes: FaultyScenes) -> u64 {
    let mut draws = scene.passes.iter().flat_map(|pass| &pass.draws);
    match scenes {
        // A round trip never fails.
        _ if scene.passes.is_empty() => ONE_OF,
        FaultyScenes::ByHash => hash(scene) % ONE_OF,
        FaultyScenes::Scissor if draws.any(|draw| draw.scissor.is_some()) => 0,
        FaultyScenes::Scissor => ONE_OF,
    }
}

struct FaultyScene<'a> {
    inner: Box<dyn Prepared + 'a>,
    /// The slow-down of the frame in percent.
    slower: f64,
    /// True if the frame comes late.
    waits: bool,
    /// True if the frame is read back wrong.
    wrong: bool,
    /// The attachments that are read back wrong.
    misread: Vec<String>,
}

impl Prepared for FaultyScene<'_> {
    fn submit(&mut self) -> Result<FrameTime, BackendError> {
        let mut time = self.inner.submit()?;
        let longer = time.wall.mul_f64(self.slower / 100.0);
        // Sleeping would overshoot by more than the duration of a short frame.
        let start = Instant::now();
        while start.elapsed() < longer {
            spin_loop();
        }
        let waited = start.elapsed();
        time.cpu += waited;
        time.wall += waited;
        Ok(time)
    }

    fn read_back(&mut self) -> Result<Frame, BackendError> {
        let mut frame = self.inner.read_back()?;
        if self.waits {
            thread::sleep(LATENCY[1]);
        }
        if self.wrong {
            // Flips all bits of all codes, so that every asserted texel is wrong.
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
