//! A scene prepared for drawing.

use crate::bundles::bundles;
use crate::clock::Clock;
use crate::encode;
use crate::gpu::Gpu;
use crate::objects::CallObjects;
use etalon_backend::{BackendError, FrameTime, Prepared};
use etalon_frame::Frame;
use etalon_scene::Scene;
use etalon_webgpu::{CallList, lower, plant};
use std::time::Instant;

/// A scene as calls, with all objects that the calls need.
pub(crate) struct WgpuScene<'a> {
    gpu: &'a Gpu,
    list: CallList,
    objects: CallObjects<'a>,
    submitted: bool,
}

impl<'a> WgpuScene<'a> {
    pub(crate) fn new(gpu: &'a Gpu, scene: &Scene) -> Result<Self, BackendError> {
        let mut list = lower(&gpu.facts, scene).map_err(BackendError::NotSupported)?;
        plant(gpu.fault, &mut list);
        let objects = gpu.guard("preparing a scene", || {
            let mut objects = CallObjects::new(gpu, &list)?;
            objects.bundles = bundles(gpu, &objects, &list)?;
            Ok(objects)
        })?;
        Ok(Self {
            gpu,
            list,
            objects,
            submitted: false,
        })
    }

    /// Records the commands of a frame.
    fn record(&self) -> Vec<wgpu::CommandBuffer> {
        let clock = self.clock();
        let mut first = if self.submitted {
            &[][..]
        } else {
            &self.list.first[..]
        };
        let mut buffers = Vec::new();
        for (number, commands) in self.list.frame.iter().enumerate() {
            let mut encoder = self.gpu.device.create_command_encoder(&Default::default());
            for command in std::mem::take(&mut first).iter().chain(commands) {
                encode::command(&self.objects, &mut encoder, clock, command);
            }
            if let Some(clock) = clock.filter(|_| number + 1 == self.list.frame.len()) {
                encoder.resolve_query_set(&clock.queries, 0..2, &clock.resolved, 0);
                encoder.copy_buffer_to_buffer(&clock.resolved, 0, &clock.mapped, 0, Clock::BYTES);
            }
            buffers.push(encoder.finish());
        }
        buffers
    }

    /// Returns the clock, if a pass writes timestamps.
    fn clock(&self) -> Option<&'a Clock> {
        self.gpu.clock.as_ref().filter(|_| self.list.is_timed())
    }

    fn draw(&mut self) -> Result<FrameTime, BackendError> {
        let begin = Instant::now();
        let commands = self.record();
        let index = self.gpu.queue.submit(commands);
        let cpu = begin.elapsed();
        let clock = self.clock();
        if let Some(clock) = clock {
            clock
                .mapped
                .slice(..)
                .map_async(wgpu::MapMode::Read, |_| {});
        }
        self.gpu.wait(index)?;
        let wall = begin.elapsed();
        self.submitted = true;
        let gpu = clock.and_then(Clock::elapsed);
        Ok(FrameTime { cpu, gpu, wall })
    }

    fn read(&self) -> Result<Frame, BackendError> {
        let mut encoder = self.gpu.device.create_command_encoder(&Default::default());
        for command in &self.list.read {
            encode::command(&self.objects, &mut encoder, None, command);
        }
        let index = self.gpu.queue.submit([encoder.finish()]);
        let output = &self.objects.buffers[self.list.output];
        output.slice(..).map_async(wgpu::MapMode::Read, |_| {});
        self.gpu.wait(index)?;
        let mut frame = {
            let mapped = output.slice(..).get_mapped_range();
            let bytes = mapped.map_err(|error| {
                BackendError::internal_of("mapping a buffer", error.to_string())
            })?;
            let frame = self.list.reading.frame(&bytes);
            frame.ok_or_else(|| BackendError::internal("a mapped buffer is too short"))?
        };
        output.unmap();
        if let Some(fault) = self.gpu.fault {
            for image in &mut frame.images {
                fault.change_codes(&mut image.codes, image.size, image.samples, &image.channels);
            }
        }
        if let Some(recorded) = &self.gpu.recorded {
            recorded.replace(self.list.clone());
        }
        Ok(frame)
    }
}

impl Prepared for WgpuScene<'_> {
    fn submit(&mut self) -> Result<FrameTime, BackendError> {
        let gpu = self.gpu;
        gpu.guard("drawing a scene", || self.draw())
    }

    fn read_back(&mut self) -> Result<Frame, BackendError> {
        if !self.submitted {
            return Err(BackendError::internal(
                "read back before anything was drawn",
            ));
        }
        self.gpu.guard("reading a frame back", || self.read())
    }
}
