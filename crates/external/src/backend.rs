//! The backend that draws in a program.

use crate::limits::limits;
use crate::message::{Answer, FrameAnswer, Hello, ImageAnswer, PROTOCOL};
use crate::program::{Program, garbage};
use crate::scene::{Request, SentScene};
use crate::shaders::ShaderLanguage;
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use etalon_backend::texels::AspectForm;
use etalon_backend::{Backend, BackendError, FrameTime, Prepared, Unavailable};
use etalon_frame::{AdapterInfo, Frame, Image, Limits, printable};
use etalon_scene::Scene;
use std::cell::{Cell, RefCell};
use std::collections::BTreeSet;
use std::process::Command;
use std::time::{Duration, Instant};

/// The largest length of a description in bytes, and of an answer without its texels.
const MOST_WORDS: u64 = 1 << 20;
/// The time in which a program must send its description.
const GREETING: Duration = Duration::from_secs(30);
/// The most characters of a text that a program gives.
const MOST_TEXT: usize = 400;

/// A device in a program.
pub struct ExternalBackend {
    info: AdapterInfo,
    limits: Limits,
    shaders: BTreeSet<ShaderLanguage>,
    program: RefCell<Program>,
    next_number: Cell<u64>,
}

/// Starts a program and waits for its description.
///
/// # Errors
/// If it cannot be started, or sends no valid description.
pub fn open(name: &str, mut command: Command) -> Result<ExternalBackend, Unavailable> {
    let word = command.get_program().to_string_lossy().into_owned();
    let failed = |reason: String| {
        let remedy = "see ci/adapters/external.md, and `etalon schema --protocol`";
        Unavailable::new(format!("the program `{word}`: {reason}"), remedy)
    };
    let mut program = Program::start(&mut command)
        .map_err(|error| failed(format!("it cannot be started: {error}")))?;
    let line = program.greeting(MOST_WORDS, GREETING).map_err(failed)?;
    let hello = hello(&line).map_err(failed)?;
    let limits = limits(&hello).map_err(failed)?;
    Ok(ExternalBackend {
        info: AdapterInfo {
            name: name.to_owned(),
            backend: "external".to_owned(),
            device: hello.device,
            driver: hello.driver,
            driver_version: hello.driver_version,
            driver_id: String::new(),
            api_version: format!("protocol {PROTOCOL}"),
            software: hello.software,
            offer: None,
        },
        limits,
        shaders: hello.shaders,
        program: RefCell::new(program),
        next_number: Cell::new(0),
    })
}

/// Reads a description.
fn hello(line: &[u8]) -> Result<Hello, String> {
    let wrong = |error| format!("its first line is not a description: {error}");
    // Another version has other keys.
    let value: serde_json::Value = serde_json::from_slice(line).map_err(wrong)?;
    match &value["protocol"] {
        version if *version == PROTOCOL => serde_json::from_value(value).map_err(wrong),
        serde_json::Value::Number(version) => Err(format!(
            "it speaks protocol {version}, and this etalon protocol {PROTOCOL}"
        )),
        _ => Err("its first line has no number `protocol`".to_owned()),
    }
}

impl Backend for ExternalBackend {
    fn adapter(&self) -> &AdapterInfo {
        &self.info
    }

    fn limits(&self) -> &Limits {
        &self.limits
    }

    fn prepare(&self, scene: &Scene) -> Result<Box<dyn Prepared + '_>, BackendError> {
        if let Some(missing) = self.limits.missing(&scene.requirements()) {
            return Err(BackendError::NotSupported(missing));
        }
        Ok(Box::new(ExternalScene {
            backend: self,
            scene: SentScene::new(scene, &self.shaders)?,
            read: AspectForm::of_scene(scene),
            frame: None,
        }))
    }
}

/// A scene, which is sent for each frame.
struct ExternalScene<'a> {
    backend: &'a ExternalBackend,
    scene: SentScene,
    read: Vec<AspectForm>,
    frame: Option<Frame>,
}

impl ExternalScene<'_> {
    /// Returns the most bytes that an answer needs.
    fn most_bytes(&self) -> u64 {
        // Base64 has four characters for three bytes.
        let texels = self.read.iter();
        let texels = texels.map(|form| (form.all_bytes() as u64 / 3 + 1) * 4);
        MOST_WORDS + texels.sum::<u64>()
    }

    /// Returns the frame of an answer, or what is wrong with it.
    fn frame(&self, answer: &FrameAnswer) -> Result<Frame, String> {
        let (expected, came) = (self.read.len(), answer.images.len());
        let counters = answer.counters.len();
        if came != expected {
            return Err(format!("{came} images, {expected} were requested"));
        }
        if counters != self.scene.counters.len() {
            let requested = self.scene.counters.len();
            return Err(format!("{counters} counters, {requested} were requested"));
        }
        let images = self.read.iter().zip(&answer.images);
        let images = images.map(|(form, came)| image(form, came));
        Ok(Frame {
            images: images.collect::<Result<_, _>>()?,
            counters: answer.counters.clone(),
        })
    }
}

/// Returns the image of an answer, or what is wrong with it.
fn image(form: &AspectForm, came: &ImageAnswer) -> Result<Image, String> {
    if !form.is(&came.attachment, came.aspect) {
        let other = printable(&came.attachment, MOST_TEXT);
        return Err(format!("{} of {other} in place of {form}", came.aspect));
    }
    let bytes = STANDARD.decode(&came.texels);
    let bytes = bytes.map_err(|error| format!("{form} is not base64: {error}"))?;
    form.image(&bytes)
}

impl Prepared for ExternalScene<'_> {
    fn submit(&mut self) -> Result<FrameTime, BackendError> {
        self.frame = None;
        let number = self
            .backend
            .next_number
            .replace(self.backend.next_number.get() + 1);
        let scene = &self.scene;
        let mut line = serde_json::to_vec(&Request { number, scene })
            .map_err(|error| BackendError::internal_of("a scene is not sent", error.to_string()))?;
        line.push(b'\n');
        let begun = Instant::now();
        let answer = self
            .backend
            .program
            .borrow_mut()
            .exchange(&line, self.most_bytes())?;
        let elapsed = begun.elapsed().max(Duration::from_nanos(1));
        let answer: Answer = serde_json::from_slice(&answer)
            .map_err(|error| garbage(&printable(&error.to_string(), MOST_TEXT)))?;
        if answer.number != number {
            return Err(garbage(&format!(
                "it has number {} instead of {number}",
                answer.number
            )));
        }
        let frame = match (answer.frame, answer.unsupported, answer.error) {
            (Some(frame), None, None) => frame,
            (None, Some(what), None) => {
                return Err(BackendError::Unsupported(printable(&what, MOST_TEXT)));
            }
            (None, None, Some(mut failure)) => {
                failure.message = printable(&failure.message, MOST_TEXT);
                return Err(failure.into());
            }
            _ => {
                return Err(garbage(
                    "it has not exactly one of `frame`, `unsupported` and `error`",
                ));
            }
        };
        let wall = match answer.seconds {
            None => elapsed,
            Some(seconds) => match Duration::try_from_secs_f64(seconds) {
                Ok(told) if told <= elapsed => told.max(Duration::from_nanos(1)),
                _ => return Err(garbage("its `seconds` are impossible")),
            },
        };
        self.frame = Some(self.frame(&frame).map_err(|why| garbage(&why))?);
        Ok(FrameTime {
            cpu: wall,
            gpu: None,
            wall,
        })
    }

    fn read_back(&mut self) -> Result<Frame, BackendError> {
        let none = || BackendError::internal("read back before anything was drawn");
        self.frame.clone().ok_or_else(none)
    }
}
