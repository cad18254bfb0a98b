//! An open device and everything that outlives a scene on it.

use crate::clock::Clock;
use crate::error::Errors;
use crate::format;
use crate::layout::Layout;
use crate::limits::{Abilities, fetched};
use crate::path::Shape;
use crate::pipeline::Pipelines;
use crate::pool::{Lease, Pool};
use crate::recording::Recorder;
use crate::target::Target;
use etalon_backend::{BackendError, Fault};
use etalon_frame::{Limits, PathTarget, PathValue, Requirement, TextureFormat};
use std::rc::Rc;
use wgpu::{BufferUsages, TextureUsages};

/// The most bytes of unused textures, and of unused buffers.
const IDLE_BYTES: u64 = 64 << 20;
/// From this size on, buffers are rounded up to a multiple of it instead of a power of two.
const LARGE: u64 = 1 << 20;

/// An open device with its limits, pools and caches.
pub(crate) struct Gpu {
    pub(crate) device: wgpu::Device,
    pub(crate) queue: wgpu::Queue,
    pub(crate) errors: Errors,
    pub(crate) limits: Limits,
    pub(crate) abilities: Abilities,
    pub(crate) clock: Option<Clock>,
    /// The fault that a test plants.
    pub(crate) fault: Option<Fault>,
    pub(crate) pipelines: Pipelines,
    /// Keeps the calls, if they are recorded.
    pub(crate) recorder: Option<Recorder>,
    textures: Pool<TextureKey, Rc<Target>>,
    buffers: Pool<BufferKey, wgpu::Buffer>,
}

#[derive(Clone, Copy, PartialEq, Eq, Hash)]
pub(crate) struct TextureKey {
    format: wgpu::TextureFormat,
    shape: Shape,
    samples: u32,
}

#[derive(Clone, Copy, PartialEq, Eq, Hash)]
pub(crate) struct BufferKey {
    usage: BufferUsages,
    size: u64,
}

pub(crate) type TextureLease<'a> = Lease<'a, TextureKey, Rc<Target>>;
pub(crate) type BufferLease<'a> = Lease<'a, BufferKey, wgpu::Buffer>;

impl Gpu {
    pub(crate) fn new(
        device: wgpu::Device,
        queue: wgpu::Queue,
        limits: Limits,
        abilities: Abilities,
        fault: Option<Fault>,
    ) -> Result<Self, BackendError> {
        let errors = Errors::of(&device);
        let (clock, pipelines) = errors.guard("opening the device", || {
            let timed = device.features().contains(wgpu::Features::TIMESTAMP_QUERY);
            let clock = timed.then(|| Clock::new(&device, &queue));
            Ok((clock, Pipelines::new(&device)))
        })?;
        Ok(Self {
            device,
            queue,
            errors,
            limits,
            abilities,
            clock,
            fault,
            pipelines,
            recorder: None,
            textures: Pool::new(IDLE_BYTES),
            buffers: Pool::new(IDLE_BYTES),
        })
    }

    /// Runs `action` and returns its first error. After an error all pools and caches are cleared.
    pub(crate) fn guard<T>(
        &self,
        what: &str,
        action: impl FnOnce() -> Result<T, BackendError>,
    ) -> Result<T, BackendError> {
        let result = self.errors.guard(what, action);
        if result.is_err() {
            self.forget();
            if let Some(clock) = &self.clock {
                // It may be mapped; the error if it is not is discarded.
                clock.mapped.unmap();
                self.errors.forget();
            }
        }
        result
    }

    /// Clears all pools and caches.
    pub(crate) fn forget(&self) {
        self.textures.clear();
        self.buffers.clear();
        self.pipelines.clear();
    }

    /// Returns a texture for an attachment, with undefined contents.
    pub(crate) fn attachment(
        &self,
        format: TextureFormat,
        size: [u32; 2],
        samples: u32,
        target: PathTarget,
    ) -> Result<TextureLease<'_>, BackendError> {
        let shape = Shape::of(target, size);
        self.check_target(target, shape)?;
        let known = format::known(format)?;
        let drawable = self.draws(format);
        let usage = match (samples, drawable) {
            (1, false) => fetched(format),
            (1, true) => fetched(format) | TextureUsages::RENDER_ATTACHMENT,
            _ => TextureUsages::TEXTURE_BINDING | TextureUsages::RENDER_ATTACHMENT,
        };
        // Copies of depth end in another texture of its format.
        let copied = if samples == 1 && self.abilities.copies {
            TextureUsages::COPY_DST
        } else {
            TextureUsages::empty()
        };
        Ok(self.texture(known, shape, samples, usage | copied))
    }

    /// Checks that the device has textures as large as an attachment's target needs.
    fn check_target(&self, target: PathTarget, shape: Shape) -> Result<(), BackendError> {
        let limits = self.device.limits();
        let most = match shape.dimension {
            wgpu::TextureDimension::D3 => limits.max_texture_dimension_3d,
            _ => limits.max_texture_dimension_2d,
        };
        let fits = shape.size.width.max(shape.size.height) <= most;
        let value = Requirement::Path(PathValue::Target(target));
        (fits || target == PathTarget::Plain)
            .then_some(())
            .ok_or(BackendError::NotSupported(value))
    }

    /// Returns true if attachments of the format can be drawn to.
    pub(crate) fn draws(&self, format: TextureFormat) -> bool {
        let support = self.limits.formats.get(&format);
        support.is_some_and(|support| !support.samples.is_empty())
    }

    /// Returns a texture that a fetch renders to, with undefined contents.
    pub(crate) fn scratch(&self, format: wgpu::TextureFormat, size: [u32; 2]) -> TextureLease<'_> {
        let usage = fetched(TextureFormat::Rgba8Unorm) | TextureUsages::RENDER_ATTACHMENT;
        let shape = Shape::of(PathTarget::Plain, size);
        self.texture(format, shape, 1, usage)
    }

    /// The usages follow from format and sample count, so they are not part of the key.
    fn texture(
        &self,
        format: wgpu::TextureFormat,
        shape: Shape,
        samples: u32,
        usage: TextureUsages,
    ) -> TextureLease<'_> {
        let wgpu::Extent3d {
            width,
            height,
            depth_or_array_layers: layers,
        } = shape.size;
        let sides = [width, height, layers, samples];
        let texels: u64 = sides.into_iter().map(u64::from).product();
        // An estimate, without the device's padding.
        let bytes = texels * u64::from(format.block_copy_size(None).unwrap_or(8));
        let key = TextureKey {
            format,
            shape,
            samples,
        };
        let casts = [format.remove_srgb_suffix()];
        self.textures.take(key, bytes, || {
            let texture = self.device.create_texture(&wgpu::TextureDescriptor {
                label: None,
                size: shape.size,
                mip_level_count: shape.levels,
                sample_count: samples,
                dimension: shape.dimension,
                format,
                usage,
                view_formats: if samples > 1 && format.is_srgb() {
                    &casts
                } else {
                    &[]
                },
            });
            Rc::new(Target::new(texture, shape))
        })
    }

    /// Returns a bind group of texture views, the first at binding 1.
    pub(crate) fn bound(&self, layout: &Layout, views: &[&wgpu::TextureView]) -> wgpu::BindGroup {
        let entries: Vec<_> = (1..)
            .zip(views)
            .map(|(binding, view)| wgpu::BindGroupEntry {
                binding,
                resource: wgpu::BindingResource::TextureView(view),
            })
            .collect();
        self.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: None,
            layout: &layout.bindings,
            entries: &entries,
        })
    }

    /// Returns a buffer of at least this size, with undefined contents.
    pub(crate) fn buffer(&self, usage: BufferUsages, size: u64) -> BufferLease<'_> {
        let size = if size < LARGE {
            size.max(256).next_power_of_two()
        } else {
            size.next_multiple_of(LARGE)
        };
        self.buffers.take(BufferKey { usage, size }, size, || {
            self.device.create_buffer(&wgpu::BufferDescriptor {
                label: None,
                size,
                usage,
                mapped_at_creation: false,
            })
        })
    }

    /// Returns a buffer with these contents, whose length is a multiple of four.
    pub(crate) fn filled(&self, usage: BufferUsages, data: &[u8]) -> BufferLease<'_> {
        let buffer = self.buffer(usage | BufferUsages::COPY_DST, data.len() as u64);
        self.queue.write_buffer(&buffer, 0, data);
        buffer
    }

    /// Waits until the device has finished a submission.
    pub(crate) fn wait(&self, index: wgpu::SubmissionIndex) -> Result<(), BackendError> {
        let poll = wgpu::PollType::Wait {
            submission_index: Some(index),
            timeout: None,
        };
        match self.device.poll(poll) {
            Ok(_) => Ok(()),
            Err(error) => Err(BackendError::internal_of("waiting", error.to_string())),
        }
    }
}

pub(crate) fn extent(size: [u32; 2]) -> wgpu::Extent3d {
    wgpu::Extent3d {
        width: size[0],
        height: size[1],
        depth_or_array_layers: 1,
    }
}
