//! Passes: load operations, clear commands, draws, resolves and store operations, in this order.

use crate::memory::Memory;
use crate::raster;
use crate::steps::{Moment, Steps};
use crate::surface::{CpuSurface, depth_encoding};
use etalon_backend::BackendError;
use etalon_frame::{Aspect, ChannelEncoding};
use etalon_scene::{Clear, ClearTarget, LoadOperation, Pass, Scene};

/// The value that replaces discarded contents. No case clears to it or draws it.
pub(crate) const DISCARDED: f64 = 0.6;

/// Runs a pass on its attachments.
pub(crate) fn run<S: Steps>(
    scene: &Scene,
    number: usize,
    memory: &mut Memory<'_>,
    steps: &S,
) -> Result<(), BackendError> {
    let pass = &scene.passes[number];
    let reached = |moment, memory: &mut Memory<'_>| {
        steps.reached(moment, scene, memory.stored());
    };
    let clears = |draw: usize, memory: &mut Memory<'_>| {
        for command in pass.clears_before(draw) {
            clear(scene, pass, command, memory.surfaces, steps);
            let clear = *command;
            reached(
                Moment::Cleared {
                    pass: number,
                    clear,
                },
                memory,
            );
        }
    };
    reached(Moment::Begin { pass: number }, memory);
    load(scene, pass, memory.surfaces, steps);
    reached(Moment::Loaded { pass: number }, memory);
    for (index, draw) in pass.draws.iter().enumerate() {
        clears(index, memory);
        reached(
            Moment::Draw {
                pass: number,
                draw: index,
            },
            memory,
        );
        raster::draw(scene, pass, draw, memory, steps);
        reached(
            Moment::Drawn {
                pass: number,
                draw: index,
            },
            memory,
        );
    }
    clears(pass.draws.len(), memory);
    let surfaces = &mut *memory.surfaces;
    for (source, target) in pass.color.iter().zip(&pass.resolve) {
        if let Some(target) = target {
            let both = surfaces.get_disjoint_mut([*source, *target]);
            let [source, target] =
                both.map_err(|_| BackendError::internal("an attachment is resolved to itself"))?;
            target.resolve_from(source, |encoding, codes| steps.resolve(encoding, codes));
        }
    }
    if let (Some(source), Some(resolve)) = (pass.depth_stencil, &pass.depth_stencil_resolve) {
        let format = scene.attachments[source].format;
        let both = surfaces.get_disjoint_mut([source, resolve.to]);
        let [source, target] =
            both.map_err(|_| BackendError::internal("depth is resolved to itself"))?;
        if let Some(encoding) = depth_encoding(format) {
            let depth = |codes: &[u32]| steps.resolve_depth(resolve.depth, encoding, codes);
            target.resolve_depth_from(source, resolve.depth, depth);
        }
        let stencil = |values: &[u8]| steps.resolve_stencil(resolve.stencil, values);
        target.resolve_stencil_from(source, resolve.stencil, stencil);
    }
    reached(Moment::End { pass: number }, memory);
    for (index, aspect) in pass.discarded() {
        discard(scene, index, aspect, &mut memory.surfaces[index]);
    }
    Ok(())
}

/// Performs the clears of load operations.
fn load(scene: &Scene, pass: &Pass, surfaces: &mut [CpuSurface], steps: &impl Steps) {
    let everywhere = None;
    for (location, index) in pass.color.iter().enumerate() {
        if let LoadOperation::Clear(value) = pass.color_operations(location).load {
            clear_color(&mut surfaces[*index], value, 0b1111, everywhere, steps);
        }
    }
    let Some(index) = pass.depth_stencil else {
        return;
    };
    let surface = &mut surfaces[index];
    if let LoadOperation::Clear(value) = pass.operations.depth.load
        && let Some(encoding) = depth_encoding(scene.attachments[index].format)
    {
        surface.fill(0, steps.clear_code(encoding, value), everywhere);
    }
    if let LoadOperation::Clear(value) = pass.operations.stencil.load {
        surface.fill_stencil(value, 0xff, everywhere);
    }
}

/// Executes a clear command.
fn clear(
    scene: &Scene,
    pass: &Pass,
    command: &Clear,
    surfaces: &mut [CpuSurface],
    steps: &impl Steps,
) {
    match command.target {
        ClearTarget::Color {
            location,
            value,
            write_mask,
        } => {
            let surface = &mut surfaces[pass.color[location]];
            clear_color(surface, value, write_mask, command.rect, steps);
        }
        ClearTarget::DepthStencil {
            depth,
            stencil,
            depth_write,
            stencil_write_mask,
        } => {
            let Some(index) = pass.depth_stencil else {
                return;
            };
            let surface = &mut surfaces[index];
            if let Some(value) = depth.filter(|_| depth_write)
                && let Some(encoding) = depth_encoding(scene.attachments[index].format)
            {
                surface.fill(0, steps.clear_code(encoding, value), command.rect);
            }
            if let Some(value) = stencil {
                surface.fill_stencil(value, stencil_write_mask, command.rect);
            }
        }
    }
}

fn clear_color(
    surface: &mut CpuSurface,
    value: [f32; 4],
    write_mask: u8,
    rect: Option<[u32; 4]>,
    steps: &impl Steps,
) {
    for (channel, encoding) in surface.encodings.iter().enumerate() {
        if write_mask & (1 << channel) != 0 {
            let code = steps.clear_code(*encoding, value[channel]);
            surface.fill(channel, code, rect);
        }
    }
}

/// Replaces discarded contents, so that a dependency on them shows.
fn discard(scene: &Scene, index: usize, aspect: Aspect, surface: &mut CpuSurface) {
    let code = |encoding: ChannelEncoding| encoding.nearest_code(DISCARDED);
    match aspect {
        Aspect::Color => {
            for (channel, encoding) in surface.encodings.iter().enumerate() {
                surface.fill(channel, code(*encoding), None);
            }
        }
        Aspect::Depth => {
            if let Some(encoding) = depth_encoding(scene.attachments[index].format) {
                surface.fill(0, code(encoding), None);
            }
        }
        Aspect::Stencil => surface.fill_stencil(0x99, 0xff, None),
    }
}
