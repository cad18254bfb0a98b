//! An open device and everything that outlives a scene on it.

use crate::clock::Clock;
use crate::error::Errors;
use crate::format;
use crate::pipelines::SharedPipelines;
use crate::pool::{KeyedPool, Lease};
use crate::state;
use etalon_backend::{BackendError, Fault};
use etalon_webgpu::{CallList, Device, Texture, TextureDimension, TextureView};
use std::cell::RefCell;
use std::rc::Rc;
use wgpu::{BufferUsages, TextureUsages};

/// The largest total size of unused textures, and of unused buffers, in bytes.
const IDLE_BYTES: u64 = 64 << 20;
/// Buffers from this size on are rounded up to a multiple of it instead of a power of two.
const LARGE: u64 = 1 << 20;

/// An open device with its limits, pools and caches.
pub(crate) struct Gpu {
    pub(crate) device: wgpu::Device,
    pub(crate) queue: wgpu::Queue,
    pub(crate) errors: Errors,
    /// The facts about the device that lowering needs.
    pub(crate) facts: Device,
    pub(crate) clock: Option<Clock>,
    /// The fault that a test plants.
    pub(crate) fault: Option<Fault>,
    pub(crate) pipelines: SharedPipelines,
    /// The calls of the scene that was read last, if they are recorded.
    pub(crate) recorded: Option<RefCell<CallList>>,
    textures: KeyedPool<Texture, Rc<Viewed>>,
    buffers: KeyedPool<BufferKey, wgpu::Buffer>,
}

/// A texture and the views of it that were created.
pub(crate) struct Viewed {
    pub(crate) texture: wgpu::Texture,
    views: RefCell<Vec<(TextureView, wgpu::TextureView)>>,
}

#[derive(Clone, Copy, PartialEq, Eq, Hash)]
pub(crate) struct BufferKey {
    usage: BufferUsages,
    size: u64,
}

pub(crate) type TextureLease<'a> = Lease<'a, Texture, Rc<Viewed>>;
pub(crate) type BufferLease<'a> = Lease<'a, BufferKey, wgpu::Buffer>;

impl Gpu {
    pub(crate) fn new(
        device: wgpu::Device,
        queue: wgpu::Queue,
        facts: Device,
        fault: Option<Fault>,
    ) -> Result<Self, BackendError> {
        let errors = Errors::of(&device);
        let clock = errors.guard("opening the device", || {
            let timed = device.features().contains(wgpu::Features::TIMESTAMP_QUERY);
            Ok(timed.then(|| Clock::new(&device, &queue)))
        })?;
        Ok(Self {
            device,
            queue,
            errors,
            facts,
            clock,
            fault,
            pipelines: SharedPipelines::default(),
            recorded: None,
            textures: KeyedPool::new(IDLE_BYTES),
            buffers: KeyedPool::new(IDLE_BYTES),
        })
    }

    /// Runs `action` and returns its first error. An error clears all pools and caches.
    pub(crate) fn guard<T>(
        &self,
        what: &str,
        action: impl FnOnce() -> Result<T, BackendError>,
    ) -> Result<T, BackendError> {
        let result = self.errors.guard(what, action);
        if result.is_err() {
            self.forget();
            if let Some(clock) = &self.clock {
                // The buffer might be mapped. If it is not, the error is discarded.
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

    /// Returns a texture with undefined contents.
    pub(crate) fn texture(&self, texture: &Texture) -> Result<TextureLease<'_>, BackendError> {
        let format = format::known(texture.format)?;
        let view_format = texture.view_format.map(format::known).transpose()?;
        let [width, height, layers] = texture.size;
        let texels = [width, height, layers, texture.samples].map(u64::from);
        // An estimate, without the device's padding.
        let bytes =
            texels.iter().product::<u64>() * u64::from(format.block_copy_size(None).unwrap_or(8));
        Ok(self.textures.take(*texture, bytes, || {
            let texture = self.device.create_texture(&wgpu::TextureDescriptor {
                label: None,
                size: wgpu::Extent3d {
                    width,
                    height,
                    depth_or_array_layers: layers,
                },
                mip_level_count: texture.levels,
                sample_count: texture.samples,
                dimension: match texture.dimension {
                    TextureDimension::D2 => wgpu::TextureDimension::D2,
                    TextureDimension::D3 => wgpu::TextureDimension::D3,
                },
                format,
                usage: TextureUsages::from_bits_truncate(texture.usage),
                view_formats: view_format.as_slice(),
            });
            Rc::new(Viewed {
                texture,
                views: RefCell::default(),
            })
        }))
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

impl Viewed {
    /// Returns a view of the texture.
    pub(crate) fn view(&self, view: TextureView) -> Result<wgpu::TextureView, BackendError> {
        // The texture's index is valid only in its own list of calls.
        let key = TextureView { texture: 0, ..view };
        let mut views = self.views.borrow_mut();
        if let Some((_, known)) = views.iter().find(|(known, _)| *known == key) {
            return Ok(known.clone());
        }
        let part = match view.part {
            Some([level, layer]) => wgpu::TextureViewDescriptor {
                dimension: Some(wgpu::TextureViewDimension::D2),
                base_mip_level: level,
                mip_level_count: Some(1),
                base_array_layer: layer,
                array_layer_count: Some(1),
                ..wgpu::TextureViewDescriptor::default()
            },
            None => wgpu::TextureViewDescriptor::default(),
        };
        let made = self.texture.create_view(&wgpu::TextureViewDescriptor {
            aspect: state::aspect(view.aspect),
            format: view.format.map(format::known).transpose()?,
            ..part
        });
        views.push((key, made.clone()));
        Ok(made)
    }
}

pub(crate) fn extent([width, height]: [u32; 2]) -> wgpu::Extent3d {
    wgpu::Extent3d {
        width,
        height,
        depth_or_array_layers: 1,
    }
}
