//! Surfaces, framebuffers, buffers, queries and samplers that outlive a scene.

use crate::context::Context;
use crate::enums::address;
use crate::query::QueryObject;
use crate::surface::{Surface, SurfaceKind, framebuffer};
use etalon_backend::BackendError;
use etalon_scene::{FilterMode, Sampler};
use glow::HasContext;
use std::collections::HashMap;

/// The largest number of unused surfaces, framebuffers, buffers and queries kept, and the largest total size
/// of unused surfaces in bytes.
const MAX_FREE: usize = 64;
const MAX_FREE_BYTES: u64 = 64 << 20;
/// The size of the largest buffer kept, in bytes.
const MAX_FREE_BUFFER: usize = 1 << 20;

/// A pass's framebuffer, and the surfaces that it consists of.
#[derive(Debug)]
pub(crate) struct PassFramebuffer {
    pub(crate) framebuffer: glow::Framebuffer,
    key: TargetKey,
}

type TargetKey = (Vec<Option<u64>>, Option<u64>, bool);

/// Unused objects.
#[derive(Default)]
pub(crate) struct ObjectPool {
    surfaces: HashMap<(SurfaceKind, [u32; 2]), Vec<Surface>>,
    count: usize,
    bytes: u64,
    targets: HashMap<TargetKey, Vec<glow::Framebuffer>>,
    buffers: Vec<glow::Buffer>,
    queries: Vec<QueryObject>,
    /// All samplers, used or not.
    samplers: HashMap<Sampler, glow::Sampler>,
}

impl ObjectPool {
    /// Returns a surface of this kind and size with undefined contents.
    pub(crate) fn surface(
        &mut self,
        context: &Context,
        kind: SurfaceKind,
        size: [u32; 2],
    ) -> Result<Surface, BackendError> {
        match self.surfaces.get_mut(&(kind, size)).and_then(Vec::pop) {
            Some(surface) => {
                self.count -= 1;
                self.bytes -= surface.bytes();
                Ok(surface)
            }
            None => Surface::new(context, kind, size),
        }
    }

    /// Returns a surface to the pool.
    pub(crate) fn put_surface(&mut self, context: &Context, surface: Surface) {
        self.count += 1;
        self.bytes += surface.bytes();
        let key = (surface.kind, surface.size);
        self.surfaces.entry(key).or_default().push(surface);
        if self.count > MAX_FREE || self.bytes > MAX_FREE_BYTES {
            self.delete_surfaces(context);
        }
    }

    /// Deletes all unused surfaces, and all targets, since a target must not refer to a deleted surface.
    pub(crate) fn delete_surfaces(&mut self, context: &Context) {
        self.delete_targets(context);
        for surface in self.surfaces.drain().flat_map(|(_, list)| list) {
            surface.delete(context);
        }
        self.count = 0;
        self.bytes = 0;
    }

    fn delete_targets(&mut self, context: &Context) {
        for framebuffer in self.targets.drain().flat_map(|(_, list)| list) {
            // SAFETY: the context is current and owns the object.
            unsafe { context.gl.delete_framebuffer(framebuffer) };
        }
    }

    /// Returns a framebuffer of these surfaces, with all layers of each if `layered` is true. `None` if the
    /// driver does not support the combination.
    pub(crate) fn target(
        &mut self,
        context: &Context,
        color: &[Option<&Surface>],
        depth_stencil: Option<&Surface>,
        layered: bool,
    ) -> Result<Option<PassFramebuffer>, BackendError> {
        let key = (
            color.iter().map(|s| s.map(|s| s.id)).collect::<Vec<_>>(),
            depth_stencil.map(|s| s.id),
            layered,
        );
        if let Some(framebuffer) = self.targets.get_mut(&key).and_then(Vec::pop) {
            return Ok(Some(PassFramebuffer { framebuffer, key }));
        }
        let mut attachments = Vec::new();
        for (surface, point) in color.iter().zip(glow::COLOR_ATTACHMENT0..) {
            attachments.extend(surface.map(|surface| (surface.storage, point)));
        }
        if let Some(surface) = depth_stencil {
            attachments.push((surface.storage, surface.attachment));
        }
        let (framebuffer, status) = framebuffer(context, &attachments, layered)?;
        if status == glow::FRAMEBUFFER_COMPLETE {
            return Ok(Some(PassFramebuffer { framebuffer, key }));
        }
        // SAFETY: the context is current and owns the object.
        unsafe { context.gl.delete_framebuffer(framebuffer) };
        Ok(None)
    }

    /// Returns a target to the pool. Its surfaces must be returned after it.
    pub(crate) fn put_target(&mut self, context: &Context, target: PassFramebuffer) {
        if self.targets.values().map(Vec::len).sum::<usize>() >= MAX_FREE {
            self.delete_targets(context);
        }
        self.targets
            .entry(target.key)
            .or_default()
            .push(target.framebuffer);
    }

    /// Returns a buffer with these contents, for any use.
    pub(crate) fn buffer(
        &mut self,
        context: &Context,
        data: &[u8],
    ) -> Result<glow::Buffer, BackendError> {
        let gl = &context.gl;
        // SAFETY: the context is current.
        unsafe {
            let buffer = match self.buffers.pop() {
                Some(buffer) => buffer,
                None => gl
                    .create_buffer()
                    .map_err(|e| BackendError::refused("a buffer", e))?,
            };
            gl.bind_buffer(glow::ARRAY_BUFFER, Some(buffer));
            gl.buffer_data_u8_slice(glow::ARRAY_BUFFER, data, glow::STATIC_DRAW);
            Ok(buffer)
        }
    }

    /// Returns a query of this target.
    pub(crate) fn query(
        &mut self,
        context: &Context,
        target: u32,
    ) -> Result<QueryObject, BackendError> {
        if let Some(index) = self.queries.iter().position(|q| q.target == target) {
            return Ok(self.queries.swap_remove(index));
        }
        // SAFETY: the context is current.
        let object = unsafe { context.gl.create_query() }
            .map_err(|e| BackendError::refused("a query", e))?;
        Ok(QueryObject { target, object })
    }

    /// Returns a query to the pool. It must not be active.
    pub(crate) fn put_query(&mut self, context: &Context, query: QueryObject) {
        if self.queries.len() < MAX_FREE {
            self.queries.push(query);
        } else {
            // SAFETY: the context is current and owns the object.
            unsafe { context.gl.delete_query(query.object) };
        }
    }

    /// Returns the sampler object of a sampler.
    pub(crate) fn sampler(
        &mut self,
        context: &Context,
        sampler: Sampler,
    ) -> Result<glow::Sampler, BackendError> {
        if let Some(object) = self.samplers.get(&sampler) {
            return Ok(*object);
        }
        let gl = &context.gl;
        // SAFETY: the context is current.
        let object =
            unsafe { gl.create_sampler() }.map_err(|e| BackendError::refused("a sampler", e))?;
        let filter = match sampler.filter {
            FilterMode::Nearest => glow::NEAREST,
            FilterMode::Linear => glow::LINEAR,
        };
        let [across, down] = sampler.address.map(address);
        for (name, value) in [
            (glow::TEXTURE_MIN_FILTER, filter),
            (glow::TEXTURE_MAG_FILTER, filter),
            (glow::TEXTURE_WRAP_S, across),
            (glow::TEXTURE_WRAP_T, down),
        ] {
            // SAFETY: the context is current and owns the object.
            unsafe { gl.sampler_parameter_i32(object, name, value as i32) };
        }
        self.samplers.insert(sampler, object);
        Ok(object)
    }

    /// Returns a buffer of this size in bytes to the pool.
    pub(crate) fn put_buffer(&mut self, context: &Context, buffer: glow::Buffer, size: usize) {
        if self.buffers.len() < MAX_FREE && size <= MAX_FREE_BUFFER {
            self.buffers.push(buffer);
        } else {
            // SAFETY: the context is current and owns the object.
            unsafe { context.gl.delete_buffer(buffer) };
        }
    }
}

impl PassFramebuffer {
    /// Deletes the framebuffer.
    pub(crate) fn delete(self, context: &Context) {
        // SAFETY: the context is current and owns the object.
        unsafe { context.gl.delete_framebuffer(self.framebuffer) };
    }
}
