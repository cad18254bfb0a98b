//! A scene prepared for drawing.

use crate::lists::TexelLists;
use crate::memory::{CountedKind, Memory};
use crate::pass;
use crate::steps::{Moment, Steps};
use crate::surface::{CpuSurface, depth_encoding};
use etalon_backend::{BackendError, FrameTime, Prepared};
use etalon_frame::{Aspect, ChannelEncoding, CounterKind, Frame, Image, ReadPath};
use etalon_scene::Scene;
use std::time::Instant;

/// A scene and the steps that draw it.
#[derive(Debug)]
pub struct CpuScene<S> {
    scene: Scene,
    surfaces: Vec<CpuSurface>,
    counters: Vec<CountedKind>,
    steps: S,
}

impl<S> CpuScene<S> {
    /// Returns the scene, prepared to be drawn by these steps.
    pub fn new(scene: Scene, steps: S) -> Self {
        Self {
            scene,
            surfaces: Vec::new(),
            counters: Vec::new(),
            steps,
        }
    }
}

/// Returns the frame of a scene, without its counters. `codes` returns the codes of an aspect of an
/// attachment, given the number of channels.
///
/// # Errors
/// If `drawn` is false.
pub(crate) fn frame(
    scene: &Scene,
    drawn: bool,
    codes: impl Fn(usize, Aspect, usize) -> Vec<u32>,
) -> Result<Frame, BackendError> {
    if !drawn {
        return Err(BackendError::internal(
            "read back before anything was drawn",
        ));
    }
    let mut frame = Frame::default();
    for index in &scene.read {
        let attachment = &scene.attachments[*index];
        for aspect in attachment.format.aspects() {
            let channels = match aspect {
                Aspect::Color => attachment.format.color_channels().to_vec(),
                Aspect::Depth => depth_encoding(attachment.format).into_iter().collect(),
                Aspect::Stencil => vec![ChannelEncoding::Uint(8)],
            };
            frame.images.push(Image {
                attachment: attachment.name.clone(),
                aspect: *aspect,
                size: attachment.size,
                samples: attachment.samples,
                read: ReadPath::Copy,
                codes: codes(*index, *aspect, channels.len()),
                channels,
            });
        }
    }
    Ok(frame)
}

impl<S: Steps> Prepared for CpuScene<S> {
    fn submit(&mut self) -> Result<FrameTime, BackendError> {
        let start = Instant::now();
        self.surfaces = self
            .scene
            .attachments
            .iter()
            .map(|a| CpuSurface::new(a, |encoding, value| self.steps.clear_code(encoding, value)))
            .collect();
        let counters = self.scene.counters.iter();
        self.counters = counters.map(|c| (c.kind, 0)).collect();
        let mut memory = Memory {
            surfaces: &mut self.surfaces,
            counters: &mut self.counters,
            lists: &mut TexelLists::new(self.scene.pool),
        };
        let stored = memory.stored();
        self.steps.reached(Moment::Initial, &self.scene, stored);
        for pass in 0..self.scene.passes.len() {
            pass::run(&self.scene, pass, &mut memory, &self.steps)?;
        }
        let elapsed = start.elapsed();
        Ok(FrameTime {
            cpu: elapsed,
            gpu: None,
            wall: elapsed,
        })
    }

    fn read_back(&mut self) -> Result<Frame, BackendError> {
        let drawn = !self.surfaces.is_empty();
        let codes = |index: usize, aspect, _| self.surfaces[index].codes(aspect);
        let mut frame = frame(&self.scene, drawn, codes)?;
        frame.counters = self
            .counters
            .iter()
            .map(|(kind, count)| match kind {
                CounterKind::AnySamplesPassed => *count.min(&1),
                _ => *count,
            })
            .collect();
        Ok(frame)
    }
}
