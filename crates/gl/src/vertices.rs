//! Vertices, indices and instances, in buffers that all draws of a scene share.
//!
//! Most draws also share the attributes' pointers: their indices are offset to their vertices, since not
//! every version has a base vertex. A draw whose [`Fetch`](etalon_scene::Fetch) needs other numbers sets its
//! own pointers, so that these numbers reach the driver unchanged.

use crate::context::Context;
use crate::state;
use etalon_scene::{Call, Draw, IndexFormat, RESTART, Vertex};
use glow::HasContext;
use std::mem::offset_of;

/// The attributes: location, number of components and offset.
const ATTRIBUTES: [(u32, i32, usize); 3] = [
    (0, 4, offset_of!(Vertex, position)),
    (COLOR, 4, offset_of!(Vertex, color)),
    (2, 2, offset_of!(Vertex, uv)),
];

/// The location of the colour.
const COLOR: u32 = 1;

/// The contents of the buffers.
#[derive(Default)]
pub(crate) struct BufferedGeometry {
    pub(crate) vertices: Vec<u8>,
    pub(crate) indices: Vec<u8>,
    /// The arguments of indirect draws.
    pub(crate) arguments: Vec<u8>,
}

/// Where a draw's geometry is in the buffers, and how it is drawn.
pub(crate) enum Fetched {
    /// Drawn with the shared pointers.
    Shared {
        /// The first vertex of a draw without indices.
        first: i32,
        /// The number of vertices or indices.
        count: i32,
        /// The offset of the first index in bytes, in an indexed draw.
        indices: Option<i32>,
    },
    /// Drawn with its own pointers.
    Own(Own),
}

/// The offsets of the arguments of an indirect draw.
#[derive(Clone, Copy)]
pub(crate) struct Arguments {
    offset: i32,
    /// The offset of the number of draws, which is 1, if the driver reads it from the buffer. The arguments
    /// of a second draw follow it.
    count: Option<i32>,
}

/// The largest number of draws that an indirect draw reads from a buffer.
const MOST_COUNTED: i32 = 2;

impl Arguments {
    /// Returns true if the driver reads the number of draws from a buffer.
    pub(crate) fn is_counted(self) -> bool {
        self.count.is_some()
    }

    /// Calls the driver's draw; `kind` is the type of the indices, if there are indices.
    ///
    /// # Safety
    /// As for [`Fetched::draw`]; the arguments are in the bound buffers.
    unsafe fn draw(self, context: &Context, mode: u32, kind: Option<u32>) {
        let (gl, functions) = (&context.gl, &context.entry_points);
        let place = std::ptr::without_provenance(self.offset as usize);
        // SAFETY: as for this function.
        unsafe {
            match (kind, self.count) {
                (None, None) => gl.draw_arrays_indirect_offset(mode, self.offset),
                (Some(kind), None) => gl.draw_elements_indirect_offset(mode, kind, self.offset),
                (None, Some(count)) => {
                    if let Some(draw) = functions.draw_arrays_indirect_count {
                        draw(mode, place, count as isize, MOST_COUNTED, 0);
                    }
                }
                (Some(kind), Some(count)) => {
                    if let Some(draw) = functions.draw_elements_indirect_count {
                        draw(mode, kind, place, count as isize, MOST_COUNTED, 0);
                    }
                }
            }
        }
    }
}

/// A draw with its own pointers.
#[derive(Clone, Copy)]
pub(crate) struct Own {
    /// The offset of the vertices in bytes.
    vertices: i32,
    /// The offset of the colours of instances in bytes.
    colors: Option<i32>,
    /// The offset of the first index in bytes and its type, in an indexed draw.
    indices: Option<(i32, u32)>,
    /// True if the largest index restarts the primitive.
    restarts: bool,
    first: i32,
    count: i32,
    base_vertex: i32,
    instances: i32,
    first_instance: u32,
}

impl BufferedGeometry {
    /// Adds a draw's vertices, indices and instances.
    pub(crate) fn place(&mut self, draw: &Draw) -> Fetched {
        let call = draw.call();
        let vertices = self.vertices.len();
        self.vertices.extend_from_slice(call.vertex_bytes());
        if draw.fetch != etalon_scene::Fetch::default() {
            return Fetched::Own(self.place_own(vertices, &call));
        }
        let first = vertices / size_of::<Vertex>();
        let indices = call.indices.as_ref().map(|list| {
            let place = self.indices.len();
            let shifted = |index: &u32| match *index {
                RESTART => RESTART,
                index => index + first as u32,
            };
            let bytes = list.iter().flat_map(|i| shifted(i).to_ne_bytes());
            self.indices.extend(bytes);
            place as i32
        });
        Fetched::Shared {
            first: first as i32,
            count: call.count as i32,
            indices,
        }
    }

    /// Adds the arguments of a placed draw, after other arguments that would draw nothing. If `counted` is
    /// true, the number of draws comes between them, and the arguments follow twice.
    pub(crate) fn place_arguments(&mut self, fetched: &Fetched, counted: bool) -> Arguments {
        let words = fetched.arguments();
        let unused = vec![0_u32; words.len()];
        self.arguments
            .extend_from_slice(bytemuck::cast_slice(&unused));
        let count = counted.then_some(self.arguments.len() as i32);
        if counted {
            self.arguments.extend_from_slice(&1_u32.to_ne_bytes());
        }
        let offset = self.arguments.len() as i32;
        for _ in 0..if counted { MOST_COUNTED } else { 1 } {
            self.arguments
                .extend_from_slice(bytemuck::cast_slice(&words));
        }
        Arguments { offset, count }
    }

    fn place_own(&mut self, vertices: usize, call: &Call<'_>) -> Own {
        let colors = (!call.colors.is_empty()).then_some(self.vertices.len() as i32);
        self.vertices.extend_from_slice(call.color_bytes());
        // The next draw's vertices must start at a multiple of the vertex size.
        let padded = self.vertices.len().next_multiple_of(size_of::<Vertex>());
        self.vertices.resize(padded, 0);
        let indices = call.indices.as_ref().map(|_| {
            let place = self.indices.len();
            self.indices.extend(call.index_bytes());
            let padded = self.indices.len().next_multiple_of(size_of::<u32>());
            self.indices.resize(padded, 0);
            let (kind, size) = match call.index {
                IndexFormat::Uint16 => (glow::UNSIGNED_SHORT, size_of::<u16>()),
                IndexFormat::Uint32 => (glow::UNSIGNED_INT, size_of::<u32>()),
            };
            ((place + call.first as usize * size) as i32, kind)
        });
        Own {
            vertices: vertices as i32,
            colors,
            indices,
            restarts: call.restarts(),
            first: call.first as i32,
            count: call.count as i32,
            base_vertex: call.base_vertex,
            instances: call.instances as i32,
            first_instance: call.first_instance,
        }
    }
}

/// Points the attributes at the vertices that start at this offset of the bound buffer.
///
/// # Safety
/// The context is current, and the vertex array and the buffer are bound.
pub(crate) unsafe fn set_pointers(context: &Context, vertices: i32) {
    let stride = size_of::<Vertex>() as i32;
    for (index, size, offset) in ATTRIBUTES {
        let offset = vertices + offset as i32;
        // SAFETY: as for this function.
        unsafe {
            context
                .gl
                .vertex_attrib_pointer_f32(index, size, glow::FLOAT, false, stride, offset);
        }
    }
}

impl Fetched {
    /// Returns the arguments of an indirect draw (OpenGL 4.6, 10.4).
    fn arguments(&self) -> Vec<u32> {
        match self {
            Self::Shared {
                count,
                indices: Some(offset),
                ..
            } => vec![
                *count as u32,
                1,
                *offset as u32 / size_of::<u32>() as u32,
                0,
                0,
            ],
            Self::Shared { first, count, .. } => vec![*count as u32, 1, *first as u32, 0],
            Self::Own(call) => call.arguments(),
        }
    }

    /// Returns the index of the second vertex of a draw without indices.
    pub(crate) fn second_vertex(&self) -> u32 {
        let first = match self {
            Self::Shared { first, .. } => *first,
            Self::Own(call) => call.first,
        };
        first.cast_unsigned() + 1
    }

    /// Calls the driver's draw, with `arguments` in the bound buffer if the draw is indirect.
    ///
    /// # Safety
    /// The context is current, and the vertex array with the scene's buffers is bound.
    pub(crate) unsafe fn draw(&self, context: &Context, mode: u32, arguments: Option<Arguments>) {
        let gl = &context.gl;
        // SAFETY: as for this function; vertices, indices and arguments were counted when the buffers were
        // filled.
        unsafe {
            match self {
                Self::Shared { indices, .. } if let Some(arguments) = arguments => {
                    arguments.draw(context, mode, indices.map(|_| glow::UNSIGNED_INT));
                }
                Self::Shared {
                    count,
                    indices: Some(offset),
                    ..
                } => gl.draw_elements(mode, *count, glow::UNSIGNED_INT, *offset),
                Self::Shared { first, count, .. } => gl.draw_arrays(mode, *first, *count),
                Self::Own(call) => {
                    set_pointers(context, call.vertices);
                    if let Some(offset) = call.colors {
                        let stride = size_of::<[f32; 4]>() as i32;
                        gl.vertex_attrib_pointer_f32(COLOR, 4, glow::FLOAT, false, stride, offset);
                        gl.vertex_attrib_divisor(COLOR, 1);
                    }
                    call.draw(context, mode, arguments);
                    gl.vertex_attrib_divisor(COLOR, 0);
                    set_pointers(context, 0);
                }
            }
        }
    }
}

impl Fetched {
    /// Draws without vertices, and without instances.
    ///
    /// # Safety
    /// As for [`Self::draw`].
    pub(crate) unsafe fn draw_empty(&self, context: &Context, mode: u32) {
        let gl = &context.gl;
        // SAFETY: as for this function; nothing is fetched.
        unsafe {
            match *self {
                Self::Shared {
                    count,
                    indices: Some(offset),
                    ..
                } => {
                    gl.draw_elements(mode, 0, glow::UNSIGNED_INT, offset);
                    gl.draw_elements_instanced(mode, count, glow::UNSIGNED_INT, offset, 0);
                }
                Self::Shared { first, count, .. } => {
                    gl.draw_arrays(mode, first, 0);
                    gl.draw_arrays_instanced(mode, first, count, 0);
                }
                Self::Own(call) => {
                    let (count, instances) = (call.count, call.instances);
                    for (count, instances) in [(0, instances), (count, 0)] {
                        let colors = call.colors.or(Some(0));
                        let call = Own {
                            count,
                            instances,
                            colors,
                            ..call
                        };
                        Self::Own(call).draw(context, mode, None);
                    }
                }
            }
        }
    }
}

impl Own {
    fn arguments(&self) -> Vec<u32> {
        let (count, first_instance) = (self.count as u32, self.first_instance);
        let instances = match self.colors {
            Some(_) => self.instances as u32,
            None => 1,
        };
        match self.indices {
            Some((offset, kind)) => {
                let size = match kind {
                    glow::UNSIGNED_SHORT => size_of::<u16>(),
                    _ => size_of::<u32>(),
                };
                let first = offset as usize / size;
                let base = self.base_vertex.cast_unsigned();
                vec![count, instances, first as u32, base, first_instance]
            }
            None => vec![count, instances, self.first as u32, first_instance],
        }
    }

    /// Calls the simplest function that takes all of the numbers.
    ///
    /// # Safety
    /// As for [`Fetched::draw`], with pointers set.
    unsafe fn draw(&self, context: &Context, mode: u32, arguments: Option<Arguments>) {
        let (gl, entry_points) = (&context.gl, &context.entry_points);
        let Self {
            first,
            count,
            base_vertex,
            instances,
            first_instance,
            ..
        } = *self;
        let instanced = self.colors.is_some();
        // SAFETY: as for this function; the limits deny scenes whose functions are missing.
        unsafe {
            let Some((offset, kind)) = self.indices else {
                if let Some(arguments) = arguments {
                    arguments.draw(context, mode, None);
                    return;
                }
                match entry_points.draw_arrays_instanced_base_instance {
                    Some(draw) if first_instance > 0 => {
                        draw(mode, first, count, instances, first_instance);
                    }
                    _ if instanced => gl.draw_arrays_instanced(mode, first, count, instances),
                    _ => gl.draw_arrays(mode, first, count),
                }
                return;
            };
            state::set_restart_of(context, kind, self.restarts);
            let start = std::ptr::without_provenance(offset as usize);
            let full = entry_points.draw_elements_instanced_base_vertex_base_instance;
            let moved = entry_points.draw_elements_base_vertex;
            let moved_instances = entry_points.draw_elements_instanced_base_vertex;
            match (full, moved, moved_instances) {
                _ if let Some(arguments) = arguments => {
                    arguments.draw(context, mode, Some(kind));
                }
                (Some(draw), ..) if first_instance > 0 => {
                    draw(
                        mode,
                        count,
                        kind,
                        start,
                        instances,
                        base_vertex,
                        first_instance,
                    );
                }
                (_, _, Some(draw)) if instanced && base_vertex != 0 => {
                    draw(mode, count, kind, start, instances, base_vertex);
                }
                (_, Some(draw), _) if base_vertex != 0 => {
                    draw(mode, count, kind, start, base_vertex)
                }
                _ if instanced => gl.draw_elements_instanced(mode, count, kind, offset, instances),
                _ => gl.draw_elements(mode, count, kind, offset),
            }
            state::set_restart(context);
        }
    }
}
