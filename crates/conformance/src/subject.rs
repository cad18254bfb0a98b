//! An open backend under test: draws scenes, and records the scenes that its limits deny.

use crate::scenes::scene;
use etalon_backend::{Backend, BackendError, FrameTime, Prepared};
use etalon_frame::{
    AdapterInfo, Feature, FormatSupport, Frame, Limits, PathValue, Requirement, TextureFormat,
};
use etalon_scene::Scene;
use serde_json::Value;
use std::cell::{Cell, RefCell};
use std::collections::BTreeSet;
use std::time::Duration;

/// The error for a scene that the limits deny, or that the backend does not support by its own words.
#[derive(Clone, Copy, Debug)]
pub struct Missing;

/// The result of a check that did not fail.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum CheckResult {
    /// Everything was drawn except scenes that need one of these.
    Passed(BTreeSet<Requirement>),
    /// Nothing was drawn, because every scene needs one of these, or is not supported by the backend's own words.
    Skipped(BTreeSet<Requirement>),
}

/// A backend, with a record of what its checks have drawn.
pub struct CheckedBackend<'a> {
    /// The backend under test, with its own limits: scenes use [`Self::limits`].
    pub backend: &'a dyn Backend,
    /// Parts of messages that are not the backend's fault.
    pub tolerated: &'a [&'a str],
    /// The backend's limits, without what the driver offers but gets wrong.
    limits: Limits,
    drawn: Cell<bool>,
    missing: RefCell<BTreeSet<Requirement>>,
    /// True if a scene is not supported by the backend's own words.
    unsupported: Cell<bool>,
}

impl<'a> CheckedBackend<'a> {
    /// Creates a record in which nothing is drawn yet.
    pub fn new(backend: &'a dyn Backend, tolerated: &'a [&'a str]) -> Self {
        Self {
            backend,
            tolerated,
            limits: backend.limits().clone(),
            drawn: Cell::default(),
            missing: RefCell::default(),
            unsupported: Cell::default(),
        }
    }

    /// Leaves out scenes with four samples, which the driver offers but gets wrong.
    #[must_use]
    pub fn without_four_samples(mut self) -> Self {
        for support in self.limits.formats.values_mut() {
            support.samples.retain(|count| *count != 4);
        }
        self.limits.sample_positions.remove(&4);
        self
    }

    /// Leaves out scenes with a feature that the driver offers but gets wrong.
    #[must_use]
    pub fn without_feature(mut self, feature: Feature) -> Self {
        self.limits.features.remove(&feature);
        self
    }

    /// Leaves out scenes with a path that the driver offers but gets wrong.
    #[must_use]
    pub fn without_path(mut self, path: PathValue) -> Self {
        self.limits.paths.remove(&path);
        self
    }

    /// Returns the backend's limits that scenes may use.
    pub fn limits(&self) -> &Limits {
        &self.limits
    }

    /// Returns the backend's adapter.
    pub fn adapter(&self) -> &AdapterInfo {
        self.backend.adapter()
    }

    /// Returns true if the limits offer the feature.
    pub fn offers(&self, feature: Feature) -> bool {
        self.limits().features.contains(&feature)
    }

    /// Returns the support of a format.
    pub(crate) fn support(&self, format: TextureFormat) -> Result<&FormatSupport, Missing> {
        self.limits.formats.get(&format).ok_or_else(|| {
            let needed = Requirement::Format(format);
            self.missing.borrow_mut().insert(needed);
            Missing
        })
    }

    /// Returns the result of everything that was drawn since the last call.
    pub(crate) fn outcome(&self) -> CheckResult {
        let missing = self.missing.take();
        let denied = self.unsupported.take() || !missing.is_empty();
        if self.drawn.take() || !denied {
            CheckResult::Passed(missing)
        } else {
            CheckResult::Skipped(missing)
        }
    }

    /// Checks that the limits allow the scene. If the backend's own limits deny it, asserts that the
    /// backend refuses it for the same reason.
    pub(crate) fn check_offered(&self, scene: &Scene) -> Result<(), Missing> {
        let Some(requirement) = self.limits().missing(&scene.requirements()) else {
            return Ok(());
        };
        let denied = self.backend.limits().missing(&scene.requirements());
        if let Some(denied) = denied {
            let refused = self.backend.prepare(scene).err();
            assert_eq!(refused, Some(BackendError::NotSupported(denied)));
        }
        self.missing.borrow_mut().insert(requirement);
        Err(Missing)
    }

    /// Prepares a scene that the limits allow.
    pub(crate) fn prepare(&self, scene: &Scene) -> Result<Box<dyn Prepared + '_>, Missing> {
        self.check_offered(scene)?;
        let prepared = self.backend.prepare(scene);
        Ok(prepared.unwrap_or_else(|e| panic!("the scene is not prepared: {e}")))
    }

    /// Draws a prepared scene, unless the backend does not support it by its own words.
    pub(crate) fn submit(&self, prepared: &mut dyn Prepared) -> Result<FrameTime, Missing> {
        match prepared.submit() {
            Ok(time) => {
                self.drawn.set(true);
                Ok(time)
            }
            Err(BackendError::Unsupported(_)) => {
                self.unsupported.set(true);
                Err(Missing)
            }
            Err(error) => panic!("the scene is not drawn: {error}"),
        }
    }

    /// Draws a scene twice, and asserts that both frames are complete and equal, and that validation
    /// reports nothing.
    pub(crate) fn draw(&self, scene: &Scene) -> Result<Frame, Missing> {
        let mut prepared = self.prepare(scene)?;
        let mut draw = || {
            let time = self.submit(prepared.as_mut())?;
            assert!(
                time.cpu <= time.wall && time.wall > Duration::ZERO,
                "{time:?}"
            );
            let frame = prepared.read_back();
            Ok(frame.unwrap_or_else(|e| panic!("the frame is not read back: {e}")))
        };
        let (first, second) = (draw()?, draw()?);
        drop(prepared);
        assert_eq!(first, second, "two submits give the same frame");
        check_shape(scene, &first);
        self.check_silence("a scene");
        Ok(first)
    }

    /// Draws a scene given as JSON, as [`Self::draw`] does.
    pub(crate) fn show(&self, body: Value) -> Result<Frame, Missing> {
        self.draw(&scene(body))
    }

    /// Draws a scene of several, as [`Self::show`] does; `None` if the limits deny it. The check goes on with the
    /// other scenes, and its result names what this one needs.
    pub(crate) fn show_if_offered(&self, body: Value) -> Option<Frame> {
        self.show(body).ok()
    }

    /// Asserts that validation and debug output reported nothing except tolerated messages.
    #[track_caller]
    pub fn check_silence(&self, after: &str) {
        let mut messages = self.backend.messages();
        messages.retain(|m| !self.tolerated.iter().any(|part| m.contains(part)));
        assert!(messages.is_empty(), "{after}: {}", messages.join("\n"));
    }
}

/// Asserts that each image is the requested one, and complete.
#[track_caller]
pub(crate) fn check_shape(scene: &Scene, frame: &Frame) {
    let expected: Vec<_> = scene
        .read
        .iter()
        .map(|index| &scene.attachments[*index])
        .flat_map(|a| a.format.aspects().iter().map(|aspect| (&a.name, *aspect)))
        .collect();
    let images = frame.images.iter();
    let came: Vec<_> = images.map(|i| (&i.attachment, i.aspect)).collect();
    assert_eq!(came, expected);
    for image in &frame.images {
        assert_eq!(image.codes.len(), image.expected_len());
    }
    assert_eq!(frame.counters.len(), scene.counters.len());
}
